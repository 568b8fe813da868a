"""When the run of a plate impact may end: no further contact of either sphere is possible."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Relaxation
from ..explicit.energies import Energies
from ..impact.ending import NONE, Approach, Ending
from .motion import SIDES, Motion

ENERGY_MARGIN = 1e-3
"""Share of the plate's energy added to that of its unknown modes: the time loop's frequencies and
energies are those of its time step."""


@dataclass(frozen=True)
class Patch:
    """How the contact patch of one sphere moves."""

    plate: float
    """Flexibility of the plate without its known modes, m/N."""
    sphere: float
    """Flexibility of the sphere, m/N; 0 if it is rigid."""
    shares: Floats = field(default_factory=lambda: NONE)
    """(k,) mean axial displacement over the patch of each known mode of the plate, 1/sqrt(kg)."""


@dataclass(frozen=True)
class Free:
    """Modes that move freely: Re sum A exp(s t) over the oscillations of each, and creep."""

    energy: float
    """J"""
    mode: Ints
    """(m,) number of each oscillation's."""
    amplitudes: Floats
    """(m,) complex A, m sqrt(kg)."""
    exponents: Floats
    """(m,) complex s, 1/s."""
    creep: Floats
    """(k,) largest displacement of each mode apart from its oscillation, m sqrt(kg)."""


@dataclass(frozen=True)
class Followed:
    """The plate's lowest modes, as they move.

    q'' + 2 zeta omega q' + omega^2 ((1 - sum g) q + sum g d) = 0, d' = q' - d/tau for each term of
    a relaxation (see `explicit.relaxation`): a linear system for q, q'/omega and the d.
    """

    frequencies: Floats
    """(k,) angular, rad/s."""
    damping_ratio: float
    """Of critical damping, below 1."""
    relaxation: tuple[Relaxation, ...]
    coordinates: Callable[[], tuple[Floats, Floats, Floats]]
    """Displacement and velocity of each mode at present, m sqrt(kg) and m sqrt(kg)/s, and the
    extension (k, terms) of its springs, m sqrt(kg)."""

    @cached_property
    def _motions(self) -> Any:
        """Eigenvalues (k, 2 + terms), 1/s, and eigenvectors of each mode's system."""
        ratios = np.array([term.ratio for term in self.relaxation])
        omega = self.frequencies[:, None]
        system = np.zeros((omega.size, 2 + ratios.size, 2 + ratios.size))
        system[:, 0, 1] = self.frequencies
        system[:, 1, :] = -omega * np.array([1.0 - ratios.sum(), 2.0 * self.damping_ratio, *ratios])
        system[:, 2:, 1] = omega
        for k, term in enumerate(self.relaxation, 2):
            system[:, k, k] = -1.0 / term.time
        return np.linalg.eig(system)

    def motion(self) -> Free:
        """How the modes go on from here without any force."""
        position, velocity, extension = self.coordinates()
        ratios = np.array([term.ratio for term in self.relaxation])
        squares = (1.0 - ratios.sum()) * position**2 + extension**2 @ ratios
        energy = 0.5 * float((velocity**2 + self.frequencies**2 * squares).sum())
        exponents, vectors = self._motions
        state = np.column_stack([position, velocity / self.frequencies, extension])
        shares = np.linalg.solve(vectors, state[:, :, None] + 0j)[:, :, 0] * vectors[:, 0, :]
        # Of a conjugate pair the one, twice.
        mode, root = np.nonzero(exponents.imag > 0.0)
        creep = np.where(exponents.imag == 0.0, np.abs(shares), 0.0).sum(axis=1)
        return Free(energy, mode, 2.0 * shares[mode, root], exponents[mode, root], creep)


NOTHING = Free(0.0, np.zeros(0, dtype=np.int64), NONE, NONE, NONE)


def plate_ending(
    motion: Motion,
    patches: tuple[Patch, Patch],
    window: float = 1.0,
    followed: Followed | None = None,
) -> Ending:
    """When the run may end.

    Args:
        motion: of the bodies.
        patches: of outer and inner contact.
        window: the run lasts at least this many times as long as its last contact.
        followed: modes of the plate, if they are followed.
    """

    def approaches(energies: Energies) -> Iterator[Approach]:
        energy = motion.plate_energy(energies)
        modes = followed.motion() if followed is not None else NOTHING
        energy = max(energy - modes.energy, 0.0) + (ENERGY_MARGIN * energy if followed else 0.0)
        for state, patch, side in zip(motion.states(energies), patches, SIDES, strict=True):
            yield Approach(
                state.clearance - float(np.abs(patch.shares) @ modes.creep),
                state.opening_speed,
                ((energy, patch.plate), (state.sphere_energy, patch.sphere)),
                np.asarray(side * patch.shares[modes.mode] * modes.amplitudes),
                modes.exponents,
            )

    return Ending(motion.loop, approaches, window)
