"""Motion of the bodies of a plate model in three dimensions, and their run."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..explicit import structures
from ..explicit.energies import Energies
from ..explicit.loop import Loop
from ..explicit.spectrum import critical_time_step, patch_flexibility
from ..impact.ending import Ending
from ..impact.run import Losses
from .ending import Patch, plate_ending
from .motion import INNER, OUTER, PLATE, SIDES, SPHERES, Further, State
from .run import Run, integrate
from .scene import Scene
from .solid_model import PlateModel


class SolidMotion:
    """See `motion.Motion`."""

    def __init__(self, loop: Loop, plate: PlateModel, scene: Scene) -> None:
        self.loop, self.plate, self.share = loop, plate, plate.fraction
        self._rough = scene.rubs
        self.gaps, self.free = (0.0, scene.gap), scene.plate.edge == "free"
        masses = loop.body_masses()

        def mean(name: str) -> Floats:
            number = plate.elastic[name]
            return np.where(loop.body == number, loop.mass / masses[number], 0.0)

        owned = loop.system.owned
        self._plate = mean(PLATE)
        self._weights = np.zeros((3, owned.size))
        for row, name in enumerate(SPHERES):
            if name in plate.elastic:
                self._weights[row] = mean(name)
        first = int(loop.system.first[plate.elastic[PLATE]])
        shares = np.zeros(int(loop.system.first[-1]))
        shares[first + plate.watched[0]] = plate.watched[1]
        self._weights[2] = shares[owned]
        outer, inner = (self._candidate_radii(number) for number in (0, 1))
        self.radii = (outer, inner)

    def _candidate_radii(self, number: int) -> Floats:
        contact = self.plate.model.contacts[number]
        points = self.plate.model.elastic[contact.body].mesh.points[contact.nodes]
        struck = (self.plate.offset, 0.0)[number]
        return np.asarray(np.hypot(points[:, 0] - struck, points[:, 1]))

    @property
    def further(self) -> Further:
        """See `Motion.further`."""
        if not self._rough:
            return Further()
        outer, inner = (-self.loop.problem.contacts[number].rubbed for number in (0, 1))
        return Further(Losses(contacts=(outer, inner)))

    def by_role(self, of_bodies: tuple[float, ...]) -> tuple[float, float, float]:
        """See `Motion.by_role`; a rigid body has 0."""
        numbers = [self.plate.elastic.get(name) for name in (OUTER, PLATE, INNER)]
        outer, plate, inner = (0.0 if k is None else of_bodies[k] for k in numbers)
        return outer, plate, inner

    @property
    def records(self) -> list[structures.Record]:
        """Of the two contacts."""
        return self.loop.problem.records()

    def _along(self, vector: Floats, name: str) -> Floats:
        """Outer, inner, plate's centre of the displacement ``u`` or the velocity ``v``."""
        values = self.loop.total(self._weights @ vector[2::3])
        for row, body in enumerate(SPHERES):
            if body in self.plate.rigid:
                values[row] = getattr(self.loop.problem.rigids[self.plate.rigid[body]], name)[2]
        return values

    def _compressive(self, quantity: str) -> tuple[float, float]:
        """Impulse or force of each contact, on the whole bodies."""
        # Candidates are the sphere's nodes or the plate's.
        of_plate = self.plate.elastic[PLATE]
        outer, inner = (
            float((-side if made.body == of_plate else side) * getattr(c, quantity)[2] / self.share)
            for side, made, c in zip(
                SIDES, self.plate.model.contacts, self.loop.problem.contacts, strict=False
            )
        )
        return outer, inner

    def sample(self, samples: int, stride: int) -> Floats:
        """See `Motion.sample`."""
        return np.array([self._sample(stride) for _ in range(samples)])

    def _sample(self, stride: int) -> list[float]:
        loop = self.loop
        places, before = self._along(loop.u, "u"), self._along(loop.v, "v")
        loop.advance(1)
        speeds = 0.5 * (before + self._along(loop.v, "v"))
        # The multiplier of a step acts half a step before and after its instant.
        impulses = [
            impulse - 0.5 * loop.dt * force
            for impulse, force in zip(
                self._compressive("impulse"), self._compressive("force"), strict=True
            )
        ]
        loop.advance(stride - 1)
        return [
            *(places[0], speeds[0], impulses[0]),
            *(places[2], speeds[2]),
            *(places[1], speeds[1], impulses[1]),
        ]

    def velocities(self) -> tuple[float, float]:
        """Mean velocity of each sphere, half a step after the displacements, m/s."""
        outer, inner, _ = self._along(self.loop.v, "v")
        return float(outer), float(inner)

    def momenta(self) -> tuple[float, float, float]:
        """Of outer sphere, plate and inner sphere, of the part modelled, kg m/s."""
        momenta, speeds = self.loop.momenta()[:, 2], self.velocities()
        outer, inner = (
            float(momenta[self.plate.elastic[name]])
            if name in self.plate.elastic
            else self.loop.problem.rigids[self.plate.rigid[name]].mass * speeds[row]
            for row, name in enumerate(SPHERES)
        )
        return outer, float(momenta[self.plate.elastic[PLATE]]), inner

    def impulses(self) -> tuple[float, float]:
        """Compressive impulse of each contact so far, on the whole bodies, N s."""
        return self._compressive("impulse")

    def plate_energy(self, energies: Energies) -> float:
        """Elastic energy of the plate, rigid motion of a free one apart, J."""
        number = self.plate.elastic[PLATE]
        return energies.elastic[number] - (energies.rigid_motion[number] if self.free else 0.0)

    def states(self, energies: Energies) -> tuple[State, State]:
        """Of each sphere against the plate in its rigid motion."""
        loop = self.loop
        place = speed = 0.0
        if self.free:
            place, speed = (float(loop.total(self._plate @ x[2::3])) for x in (loop.u, loop.v))
        places, speeds = self._along(loop.u, "u"), self._along(loop.v, "v")

        def state(row: int) -> State:
            body = self.plate.elastic.get(SPHERES[row])
            energy = 0.0 if body is None else energies.elastic[body] - energies.rigid_motion[body]
            return State(
                self.gaps[row] + SIDES[row] * float(places[row] - place),
                SIDES[row] * float(speeds[row] - speed),
                energy,
            )

        return state(0), state(1)


def ending(motion: SolidMotion) -> Ending:
    """When a run may end."""
    loop, plate = motion.loop, motion.plate

    def flexibility(body: str, contact: str) -> float:
        if body not in plate.elastic:
            return 0.0
        nodes, areas = plate.patches[body, contact]
        number = plate.elastic[body]
        points = plate.model.elastic[number].mesh.points[nodes]
        struck = (plate.offset if contact == OUTER else 0.0, 0.0)
        squares = ((points[:, :2] - struck) ** 2).sum(axis=1) / plate.zone**2
        weights = areas * np.sqrt(np.maximum(0.0, 1.0 - squares))
        # The stiffness that lasts bounds what an energy can displace.
        lasting = plate.model.elastic[number].material.lasting
        return patch_flexibility(loop, number, nodes, weights / weights.sum()) / lasting

    of_plate = max(flexibility(PLATE, name) for name in SPHERES)
    return plate_ending(
        motion,
        (Patch(of_plate, flexibility(OUTER, OUTER)), Patch(of_plate, flexibility(INNER, INNER))),
    )


def integrate_solid(
    loop: Loop,
    plate: PlateModel,
    scene: Scene,
    contact_duration: float,
    made: type[SolidMotion] = SolidMotion,
    **options: Any,
) -> Run:
    """Step a plate model to ``scene.end_time``; see `run.integrate` for the options.

    A run with a given end, which may cut a contact, has one level: only then can its energy be
    read.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    motion = made(loop, plate, scene)
    if scene.end_time is not None:
        options["most_levels"] = 1
    return integrate(
        motion,
        scene,
        contact_duration,
        lambda: ending(motion),
        lambda: critical_time_step(loop),
        end_time=scene.end_time,
        **options,
    )
