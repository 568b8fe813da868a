"""When the run of a plate impact may end: no further contact of either sphere is possible."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..common.arrays import Floats
from ..explicit.ending import NONE, no_further_contact
from ..explicit.loop import Energies
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
class Followed:
    """The plate's lowest modes, as they move."""

    frequencies: Floats
    """(k,) angular, rad/s."""
    damping_ratio: float
    """Of critical damping, below 1."""
    coordinates: Callable[[], tuple[Floats, Floats]]
    """Displacement and velocity of each mode at present, m sqrt(kg) and m sqrt(kg)/s."""


class Ending:
    """Whether any further contact is possible.

    Args:
        motion: of the bodies.
        patches: of outer and inner contact.
        window: the run lasts at least this many times as long as its last contact.
        modes: of the plate, if they are followed.
    """

    def __init__(
        self,
        motion: Motion,
        patches: tuple[Patch, Patch],
        window: float = 1.0,
        modes: Followed | None = None,
    ) -> None:
        self.motion, self.patches, self.window, self.modes = motion, patches, window, modes

    def __call__(self, energies: Energies, now: float) -> bool:
        """Whether the state allows no further contact at an instant (s) of the run."""
        motion = self.motion
        last = max(record.last + 1 for record in motion.records) * motion.loop.dt
        if now < last * self.window or motion.loop.touching:
            return False
        energy = motion.plate_energy(energies)
        oscillation = exponents = NONE
        if self.modes is not None:
            frequencies = self.modes.frequencies
            position, velocity = self.modes.coordinates()
            modal = 0.5 * (velocity**2 + (frequencies * position) ** 2)
            # Of A exp((i omega_d - zeta omega) t) the real part counts: undamped
            # q cos + (dq/dt / omega) sin.
            decay = self.modes.damping_ratio * frequencies
            damped = frequencies * math.sqrt(1.0 - self.modes.damping_ratio**2)
            exponents = 1j * damped - decay
            oscillation = position - 1j * (velocity + decay * position) / damped
            energy = max(energy - float(modal.sum()), 0.0) + ENERGY_MARGIN * energy
        return all(
            no_further_contact(
                state.clearance,
                state.opening_speed,
                ((energy, patch.plate), (state.sphere_energy, patch.sphere)),
                np.asarray(side * patch.shares * oscillation),
                exponents,
            )
            for state, patch, side in zip(motion.states(energies), self.patches, SIDES, strict=True)
        )
