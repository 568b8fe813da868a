"""When a seal-seat run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math

import numpy as np

from ..mesh import Floats
from ..solid.ending import no_further_contact
from ..solid.loop import Energies, Loop
from ..solid.spectrum import conjugate_gradients, free_components
from .model import ACTUATOR, LEFT, RIGHT, SPHERE, Patch, SeatModel
from .scene import SeatScene


def flexibility(loop: Loop, patch: Patch) -> float:
    """Static flexibility p^T K^-1 p of the seat over a patch along its normals, m/N.

    Of the part modelled; the weights fall off parabolically with the distance from the ring or
    from under the tip, and their sum is 1.
    """
    weights = patch.areas * np.maximum(0.0, 1.0 - (patch.distances / patch.reach) ** 2)
    load = np.zeros((loop.all_masses.size, 3))
    load[patch.nodes] = (weights / weights.sum())[:, None] * patch.normals
    force = loop.own(load)
    return loop.dot(force, conjugate_gradients(loop, force, free_components(loop, 0)))


class Ending:
    """Whether sphere and actuator can be proven never to touch the seat again."""

    def __init__(self, loop: Loop, seat: SeatModel, scene: SeatScene) -> None:
        self.loop, self.seat = loop, seat
        ring = scene.ring()
        self.axis = np.array(ring.axis)[[0, 2]]
        self.across = np.array([self.axis[1], -self.axis[0]])
        self.sin, self.cos = math.sin(ring.half_angle), math.cos(ring.half_angle)
        self.ring_flexibility = max(flexibility(loop, seat.patches[k]) for k in (LEFT, RIGHT))
        self.tip_flexibility = max(flexibility(loop, seat.patches[k]) for k in seat.tips)

    def _clear_of_cone(self, motion: Floats) -> float:
        """Least clearance (or its rate) over the cone after a motion (x, z) of the sphere.

        The cone's tangent plane at each flank opens by the motion's component along its normal.
        """
        return float((motion @ self.axis) * self.sin - abs(float(motion @ self.across)) * self.cos)

    def __call__(self, energies: Energies) -> bool:
        """The proof at the present instant."""
        problem = self.loop.problem
        if any(any(contact.force) for contact in problem.contacts):
            return False
        sphere, actuator = problem.rigids[SPHERE], problem.rigids[ACTUATOR]
        energy = energies.elastic[0]
        return no_further_contact(
            clearance=self._clear_of_cone(np.array([sphere.u[0], sphere.u[2]])),
            opening_speed=self._clear_of_cone(np.array([sphere.v[0], sphere.v[2]])),
            plate_energy=energy,
            plate_flexibility=self.ring_flexibility,
            sphere_energy=0.0,
            sphere_flexibility=0.0,
        ) and no_further_contact(
            clearance=-actuator.u[2],
            opening_speed=-actuator.v[2],
            plate_energy=energy,
            plate_flexibility=self.tip_flexibility,
            sphere_energy=0.0,
            sphere_flexibility=0.0,
        )
