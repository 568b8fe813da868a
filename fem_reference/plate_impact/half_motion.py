"""Motion of bodies struck beside the axis or obliquely: they move along the plate and turn, too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..common.arrays import Floats, Ints
from ..explicit.energies import Energies
from ..explicit.loop import Loop
from ..explicit.spectrum import body_rotation
from .half_model import paired
from .motion import PLATE, SIDES, SPHERES, Further, Sideways, State
from .scene import Scene
from .solid_model import Pairing, PlateModel
from .solid_motion import SolidMotion

MOVED = 0.005
"""Way of a sphere after which its pairs are made anew, over the size of the elements it meets."""


class HalfMotion(SolidMotion):
    """See `motion.Motion`; of `half_model`."""

    def __init__(self, loop: Loop, plate: PlateModel, scene: Scene) -> None:
        super().__init__(loop, plate, scene)
        self._start = (scene.tangential_velocity * self.share * scene.outer.mass, 0.0)
        self._struck, self._rim = (scene.offset, 0.0), scene.plate.radius
        mass = np.repeat(loop.mass, 3)
        self._turning = {
            name: (rotation * mass, loop.dot(rotation, rotation * mass))
            for name, number in plate.elastic.items()
            for rotation in (body_rotation(loop, number),)
        }
        self._pairings = {pairing.contact: pairing for pairing in plate.pairings}
        self._looked: list[Floats | None] = [None, None]
        faces = [side * 0.5 * scene.plate.thickness for side in SIDES]
        points = plate.model.elastic[plate.elastic[PLATE]].mesh.points
        self._off_centre: list[Ints] = [
            np.setdiff1d(np.flatnonzero(points[:, 2] == face), contact.nodes)
            for face, contact in zip(faces, plate.model.contacts, strict=True)
        ]
        self._balls = [
            (np.array([x, 0.0, face + side * (body.tip_radius + gap)]), body.tip_radius)
            for x, face, side, body, gap in zip(
                self._struck, faces, SIDES, (scene.outer, scene.inner), self.gaps, strict=True
            )
        ]

    def _mean(self, vector: str, row: int) -> Floats:
        """(3,) of a sphere: displacement "u", m, or velocity "v", m/s."""
        name = SPHERES[row]
        if name in self.plate.rigid:
            return np.array(getattr(self.loop.problem.rigids[self.plate.rigid[name]], vector))
        values = getattr(self.loop, vector).reshape(-1, 3)
        return self.loop.total(self._weights[row] @ values)

    def _turn(self, vector: Floats, name: str) -> float:
        """Mean rotation (rad) or spin (rad/s) of an elastic body about y."""
        momentum, inertia = self._turning[name]
        return self.loop.dot(momentum, vector) / inertia

    def spin(self, name: str) -> float:
        """Of a body about y, rad/s."""
        if name in self.plate.rigid:
            return float(self.loop.problem.rigids[self.plate.rigid[name]].spin[1])
        return self._turn(self.loop.v, name)

    def _turning_energy(self, name: str) -> float:
        """Of an elastic body's mean rotation, J."""
        return 0.5 * self._turning[name][1] * self._turn(self.loop.v, name) ** 2

    def _sample(self, stride: int) -> list[float]:
        self._follow()
        return super()._sample(stride)

    def _follow(self) -> None:
        """Pair spheres that have moved with what lies opposite now."""
        displacement = None
        for row in range(len(SPHERES)):
            mean, looked = self._mean("u", row), self._looked[row]
            way = np.inf if looked is None else float(np.linalg.norm(mean - looked))
            if way < MOVED * self.plate.size:
                continue
            self._looked[row] = mean
            if displacement is None:
                displacement = self.loop.gather(self.loop.u)
            if row in self._pairings:
                self._pair(self._pairings[row], mean, displacement)
            self._look_off_centre(row, mean, displacement)

    def _pair(self, pairing: Pairing, mean: Floats, displacement: Floats) -> None:
        model, first = self.plate.model, self.plate.model.first
        nodes = model.contacts[pairing.contact].nodes
        mesh, start = model.elastic[pairing.body].mesh, int(first[pairing.body])
        pairs = paired(
            *(pairing, mesh, model.elastic[0].mesh.points[nodes]),
            displacement[start : first[pairing.body + 1]],
            mean,
            displacement[nodes],
        )
        self.loop.problem.pair(
            *(pairing.contact, start, pairs.facets, pairs.weights, pairs.normals, pairs.gaps)
        )

    def _look_off_centre(self, row: int, mean: Floats, displacement: Floats) -> None:
        """Notice a sphere that meets nodes which are no candidates: infinitely far out."""
        nodes, (centre, radius) = self._off_centre[row], self._balls[row]
        points = self.plate.model.elastic[0].mesh.points[nodes] + displacement[nodes]
        if np.any(((points - centre - mean) ** 2).sum(axis=1) < radius**2):
            outer, inner = (
                np.full_like(radii, np.inf) if k == row else radii
                for k, radii in enumerate(self.radii)
            )
            self.radii = (outer, inner)
            self.records[row].outermost = max(self.records[row].outermost, 0)

    @property
    def further(self) -> Further:
        """See `Motion.further`."""
        loop, state = self.loop, self.loop.problem.state
        momenta = loop.momenta()[:, 0]
        speeds = [float(self._mean("v", row)[0]) for row in range(len(SPHERES))]
        misses, total = [], -float(state.reaction[0]) + float(momenta[self.plate.elastic[PLATE]])
        for row, name in enumerate(SPHERES):
            if name in self.plate.elastic:
                momentum = float(momenta[self.plate.elastic[name]])
            else:
                momentum = loop.problem.rigids[self.plate.rigid[name]].mass * speeds[row]
            gained = momentum - self._start[row]
            total += gained
            # Candidates are the plate's.
            misses.append(gained + float(loop.problem.contacts[row].impulse[0]))
        outer, inner = (self.spin(name) for name in SPHERES)
        return replace(
            super().further,
            sideways=Sideways((speeds[0], speeds[1]), (outer, inner), (total, *misses)),
        )

    def plate_energy(self, energies: Energies) -> float:
        """See `Motion.plate_energy`; the turning of a free plate is rigid motion, too."""
        return super().plate_energy(energies) - (self._turning_energy(PLATE) if self.free else 0.0)

    def states(self, energies: Energies) -> tuple[State, State]:
        """See `Motion.states`; the clearance is that over the face of a plate that may tilt.

        It opens at least at the smaller of its rates now and when the sphere leaves the plate.
        """
        outer, inner = super().states(energies)
        return self._tilted(0, outer), self._tilted(1, inner)

    def _tilted(self, row: int, flat: State) -> State:
        name, side = SPHERES[row], SIDES[row]
        energy = flat.sphere_energy
        if name in self.plate.elastic:
            energy -= self._turning_energy(name)
        tilt = tilting = 0.0
        if self.free:
            tilt, tilting = (self._turn(vector, PLATE) for vector in (self.loop.u, self.loop.v))
        place = self._struck[row] + float(self._mean("u", row)[0])
        speed = float(self._mean("v", row)[0])
        left = max(self._rim - np.sign(speed) * place, 0.0) / abs(speed) if speed else 0.0
        now = flat.opening_speed + side * (tilting * place + tilt * speed)
        then = now + 2.0 * side * tilting * speed * left
        return State(flat.clearance + side * tilt * place, min(now, then), energy)
