"""When a seal-seat run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math

import numpy as np

from ..common.arrays import Floats
from ..explicit.ending import no_further_contact
from ..explicit.energies import Energies
from ..explicit.loop import Loop
from ..explicit.spectrum import conjugate_gradients, free_components
from ..solid.model import nodal_areas
from .model import ELASTIC_SPHERE, LEFT, RIGHT, SEAT, Patch, SeatModel
from .motion import sphere_motion
from .scene import SeatScene


def flexibility(loop: Loop, patch: Patch) -> float:
    """Static flexibility p^T K^-1 p of the seat over a patch along its normals, m/N.

    Of the part modelled; the weights fall off parabolically with the distance from the ring or
    from under the tip, and their sum is 1.
    """
    weights = patch.areas * np.maximum(0.0, 1.0 - (patch.distances / patch.reach) ** 2)
    load = np.zeros((loop.system.mass.size, 3))
    load[patch.nodes] = (weights / weights.sum())[:, None] * patch.normals
    force = loop.own(load)
    return loop.dot(force, conjugate_gradients(loop, force, free_components(loop, SEAT)))


def relieved_flexibility(loop: Loop, centre: Floats, load: Floats) -> float:
    """Flexibility of the free half sphere about ``centre`` under a load (N, 3), m/N.

    Inertia relief: the rigid motions in the plane of symmetry (along x and z, about y) are taken
    out of load and displacement.
    """
    free = free_components(loop, ELASTIC_SPHERE)
    mass = np.repeat(loop.mass, 3)
    points = loop.system.points - centre
    x, z = points[:, 0], points[:, 2]
    zero, one = np.zeros_like(x), np.ones_like(x)
    rigid: list[Floats] = []
    for motion in ((one, zero, zero), (zero, zero, one), (z, zero, -x)):
        vector = loop.own(np.stack(motion, axis=1)) * free
        for before in rigid:
            vector -= before * loop.dot(before, mass * vector)
        rigid.append(vector / math.sqrt(loop.dot(vector, mass * vector)))

    def balanced(force: Floats) -> Floats:
        for motion in rigid:
            force = force - mass * motion * loop.dot(motion, force)
        return force

    relieved = balanced(loop.own(load) * free)
    x_static = conjugate_gradients(loop, relieved, free, balanced, tolerance=1e-4)
    return loop.dot(relieved, x_static)


class Ending:
    """Whether sphere and actuator can be proven never to touch the seat again."""

    def __init__(self, loop: Loop, seat: SeatModel, scene: SeatScene) -> None:
        self.loop, self.seat = loop, seat
        ring = scene.ring()
        self.axis = np.array(ring.axis)[[0, 2]]
        self.across = np.array([self.axis[1], -self.axis[0]])
        self.sin, self.cos = math.sin(ring.half_angle), math.cos(ring.half_angle)
        # The stiffness that lasts bounds what an energy can displace.
        lasting = scene.seat.material.lasting
        self.ring_flexibility, self.tip_flexibility = (
            max(flexibility(loop, seat.patches[k]) for k in which) / lasting
            for which in ((LEFT, RIGHT), seat.tips)
        )

        self.sphere_flexibility = 0.0
        if seat.sphere_facets is not None:
            mesh = seat.model.elastic[ELASTIC_SPHERE].mesh
            areas = nodal_areas(mesh, seat.sphere_facets)
            nodes = np.flatnonzero(areas > 0.0)
            weights = areas[nodes] / areas[nodes].sum()
            load = np.zeros((loop.system.mass.size, 3))
            first = int(loop.system.first[ELASTIC_SPHERE])
            load[first + nodes] = weights[:, None] * np.array(ring.axis)
            self.sphere_flexibility = relieved_flexibility(loop, mesh.points.mean(axis=0), load)

    def _clear_of_cone(self, motion: Floats) -> float:
        """Least clearance (or its rate) over the cone after a motion (x, z) of the sphere.

        The cone's tangent plane at each flank opens by the motion's component along its normal.
        """
        return float((motion @ self.axis) * self.sin - abs(float(motion @ self.across)) * self.cos)

    def __call__(self, energies: Energies, now: float) -> bool:
        """The proof at the present instant."""
        problem = self.loop.problem
        if self.loop.touching:
            return False
        actuator = problem.rigids[self.seat.actuator]
        place, speed = sphere_motion(self.loop, self.seat)
        energy = energies.elastic[SEAT]
        of_sphere = 0.0
        if self.seat.sphere_facets is not None:
            of_sphere = energies.elastic[ELASTIC_SPHERE] - energies.rigid_motion[ELASTIC_SPHERE]
        return no_further_contact(
            self._clear_of_cone(place[[0, 2]]),
            self._clear_of_cone(speed[[0, 2]]),
            ((energy, self.ring_flexibility), (of_sphere, self.sphere_flexibility)),
        ) and no_further_contact(-actuator.u[2], -actuator.v[2], ((energy, self.tip_flexibility),))
