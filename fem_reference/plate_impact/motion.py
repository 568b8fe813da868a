"""How the bodies of a plate impact move in a run, whatever their geometry."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from ..common.arrays import Floats
from ..common.hertz import effective_modulus, hertz_approach, hertz_stiffness
from ..explicit import structures
from ..explicit.energies import Energies
from ..explicit.loop import Loop
from ..impact.run import Losses
from .scene import Scene

OUTER, PLATE, INNER = "outer", "plate", "inner"
SPHERES = (OUTER, INNER)
CIRCLE = 0.5
"""Radius over which the plate's motion is observed, over the contact radius of the outer body's
impact on a rigid plate."""
SIDES = (1.0, -1.0)
"""Where the spheres lie along z, seen from the plate."""


def observed_circle(scene: Scene) -> float:
    """Radius over which the plate's motion is observed, with Hertz's weight sqrt(1 - (r/b)^2), m.

    A node would follow every wave of the mesh. As `LocalCentre` of the reduced models has it.
    """
    outer = scene.outer
    effective = effective_modulus(outer.material, scene.plate.material)
    stiffness = hertz_stiffness(effective, outer.tip_radius)
    approach = hertz_approach(outer.mass, scene.normal_speed, stiffness)
    return min(CIRCLE * math.sqrt(outer.tip_radius * approach), scene.plate.radius)


@dataclass(frozen=True)
class State:
    """What decides whether a sphere and the plate can touch again."""

    clearance: float
    """Of the undeformed bodies in their rigid motion, m."""
    opening_speed: float
    """Rate of the clearance, m/s."""
    sphere_energy: float
    """Elastic energy of the sphere, rigid motion apart, J."""


@dataclass(frozen=True)
class Yielded:
    """Energy that went into yielding, at outer and inner contact, J."""

    work: tuple[float, float] = (0.0, 0.0)
    """Plastic."""
    locked_in: tuple[float, float] = (0.0, 0.0)
    """Elastic energy that stays at rest, gained during the run."""

    @property
    def lost(self) -> tuple[float, float]:
        """Both."""
        return self.work[0] + self.locked_in[0], self.work[1] + self.locked_in[1]


@dataclass(frozen=True)
class Sideways:
    """Motion along the plate and about the y axis, of what is struck beside its axis or obliquely.

    Of outer and inner body; a spin is positive from z to x, as that of a ball that rolls towards +x
    on a plate below it.
    """

    velocities: tuple[float, float]
    """Along x, m/s."""
    spins: tuple[float, float]
    """rad/s"""
    misses: tuple[float, ...]
    """Momentum along x that no impulse accounts for, of independent balances, N s."""


@dataclass(frozen=True)
class Further:
    """What acts besides contacts and supports."""

    losses: Losses | None = None
    """None: nothing that could lose."""
    on_all: float = 0.0
    """Impulse on the bodies together so far, along z, N s."""
    on_inner: float = 0.0
    """On the inner one, N s."""
    yielded: Yielded | None = None
    """None: nothing that could yield."""
    locked_in: float = 0.0
    """Elastic energy that would be left at rest, J."""
    sideways: Sideways | None = None
    """None: symmetry leaves no such motion."""
    supplied: float = 0.0
    """Energy that bodies were given beyond the measure of what they had at the start, J."""
    taken: tuple[float, float] | None = None
    """Electrical energy that a stack took and work of its voltage on it, J; None: no stack."""


class Motion(Protocol):
    """Positions, velocities and momenta along z; outer and inner sphere in this order."""

    @property
    def loop(self) -> Loop:
        """Bodies and contacts."""

    @property
    def further(self) -> Further:
        """What has acted besides contacts and supports, on the part modelled."""

    def by_role(self, of_bodies: tuple[float, ...]) -> tuple[float, float, float]:
        """Values of the loop's elastic bodies (bodies,) as those of outer body, plate, inner."""

    @property
    def share(self) -> float:
        """Of the bodies that is modelled."""

    @property
    def records(self) -> list[structures.Record]:
        """Of the two contacts."""

    @property
    def radii(self) -> tuple[Floats, Floats]:
        """Of the candidates of each contact, ascending, m."""

    def sample(self, samples: int, stride: int) -> Floats:
        """Advance by samples * stride steps; (samples, 8) rows of the strides' first steps.

        Outer displacement, velocity, impulse so far; displacement and velocity of the plate (mean
        of both faces over `observed_circle`); inner displacement, velocity, impulse so far.
        """

    def velocities(self) -> tuple[float, float]:
        """Mean velocity of each sphere, half a step after the displacements, m/s."""

    def momenta(self) -> tuple[float, float, float]:
        """Of outer sphere, plate and inner sphere, of the part modelled, kg m/s."""

    def impulses(self) -> tuple[float, float]:
        """Compressive impulse of each contact so far, on the whole bodies, N s."""

    def states(self, energies: Energies) -> tuple[State, State]:
        """Of each sphere against the plate in its rigid motion."""

    def plate_energy(self, energies: Energies) -> float:
        """Elastic energy of the plate, rigid motion of a free one apart, J."""
