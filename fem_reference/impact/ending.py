"""When a run may end: the proof that two bodies never touch again.

A body of elastic energy E (kinetic and strain, rigid motion apart) displaces its contact patch by
at most sqrt(2 E C), C = p^T K^-1 p the flexibility of the patch with the weights p (Cauchy's
inequality in the norm of K: |p^T u| = |p^T K^-1 K u| <= sqrt(p^T K^-1 p) sqrt(u^T K u)). The
weights are Hertz's pressure: a single node's flexibility grows without bound on finer meshes. Two
bodies whose rigid motions part, and are further apart than both bounds, stay apart. Where the
lowest modes of a body are known, they move as known oscillations, and E and C are those of the
others. Damped ones shrink on their way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from ..common.arrays import Floats
from ..explicit.energies import Energies
from ..explicit.loop import Loop

MOST_INSTANTS = 20000
NONE = np.zeros(0)


def least_clearance(
    clearance: float, opening_speed: float, amplitudes: Floats, exponents: Floats
) -> float:
    """Lower bound of clearance + opening_speed t - Re sum A_k exp(s_k t) over t >= 0, m.

    Args:
        clearance: m.
        opening_speed: m/s.
        amplitudes: (k,) complex A_k, m.
        exponents: (k,) complex s_k, i omega_k of undamped modes, Re s_k <= 0, 1/s.
    """
    reach = float(np.abs(amplitudes).sum())
    if clearance > reach and opening_speed >= 0.0:
        return float(clearance - reach)
    if not opening_speed > 0.0 or amplitudes.size == 0:
        return -math.inf
    # From here on the oscillations cannot follow any more.
    last = (reach - clearance) / opening_speed
    frequencies = np.abs(exponents)
    step = 2.0 * math.pi / float(frequencies.max()) / 40.0
    count = math.ceil(last / step) + 1
    if count > MOST_INSTANTS:
        return -math.inf
    t = np.linspace(0.0, last, count + 1)
    plate = (amplitudes[:, None] * np.exp(exponents[:, None] * t)).real.sum(axis=0)
    # Between two instants a curve lies below its chord by at most its curvature times step^2/8.
    curvature = float((np.abs(amplitudes) * frequencies**2).sum())
    sag = curvature * (t[1] - t[0]) ** 2 / 8.0
    return float((clearance + opening_speed * t - plate).min() - sag)


@dataclass(frozen=True)
class Approach:
    """Two bodies that no longer touch, as they move on."""

    clearance: float
    """Distance of the undeformed bodies in their rigid motion, m."""
    opening_speed: float
    """Rate of the clearance, m/s."""
    vibrating: tuple[tuple[float, float], ...]
    """Elastic energy (J) and flexibility of the patch (m/N), known modes apart, of each body."""
    amplitudes: Floats = field(default_factory=lambda: NONE)
    """Of the known modes, see `least_clearance`."""
    exponents: Floats = field(default_factory=lambda: NONE)
    """Of the known modes, see `least_clearance`."""

    def is_over(self) -> bool:
        """Whether the bodies can be proven never to touch again."""
        reach = sum(math.sqrt(2.0 * max(energy, 0.0) * c) for energy, c in self.vibrating)
        clearance = self.clearance - reach
        return least_clearance(clearance, self.opening_speed, self.amplitudes, self.exponents) > 0.0


class Ending:
    """Whether any further contact is possible.

    Args:
        loop: bodies and contacts.
        approaches: of all bodies that could touch, from the energies at present.
        window: the run lasts at least this many times as long as its last contact.
    """

    def __init__(
        self, loop: Loop, approaches: Callable[[Energies], Iterable[Approach]], window: float = 0.0
    ) -> None:
        self.loop, self.approaches, self.window = loop, approaches, window

    def __call__(self, energies: Energies, now: float) -> bool:
        """Whether the state at an instant (s) allows no further contact."""
        last = max(record.last + 1 for record in self.loop.problem.records()) * self.loop.dt
        if now < last * self.window or self.loop.is_in_contact:
            return False
        return all(approach.is_over() for approach in self.approaches(energies))
