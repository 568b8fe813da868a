"""When a seal-seat run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..common.arrays import Floats
from ..explicit.energies import Energies
from ..explicit.free_motions import flexibility
from ..explicit.loop import Loop
from ..impact.ending import Approach, Ending
from ..solid.model import nodal_areas
from .model import ELASTIC_SPHERE, LEFT, RIGHT, SEAT, SeatModel
from .motion import sphere_motion
from .scene import SeatScene


def _sphere_flexibility(loop: Loop, seat: SeatModel, scene: SeatScene) -> float:
    """Of an elastic sphere over the surface that can touch, m/N; 0 of a rigid one."""
    if seat.sphere_facets is None:
        return 0.0
    mesh = seat.model.elastic[ELASTIC_SPHERE].mesh
    areas = nodal_areas(mesh, seat.sphere_facets)
    nodes = np.flatnonzero(areas > 0.0)
    weights = areas[nodes] / areas[nodes].sum()
    load = np.zeros((loop.system.mass.size, 3))
    first = int(loop.system.first[ELASTIC_SPHERE])
    load[first + nodes] = weights[:, None] * np.array(scene.ring().axis)
    return flexibility(loop, ELASTIC_SPHERE, loop.own(load))


def seat_ending(loop: Loop, seat: SeatModel, scene: SeatScene) -> Ending:
    """When sphere and actuator can be proven never to touch the seat again."""
    ring = scene.ring()
    axis = np.array(ring.axis)[[0, 2]]
    across = np.array([axis[1], -axis[0]])
    sin, cos = math.sin(ring.half_angle), math.cos(ring.half_angle)
    # The stiffness that lasts bounds what an energy can displace.
    lasting = scene.seat.material.lasting
    at_ring, at_tip = (
        max(flexibility(loop, SEAT, seat.patches[k].load(loop, SEAT)) for k in which) / lasting
        for which in ((LEFT, RIGHT), seat.tips)
    )
    of_sphere = _sphere_flexibility(loop, seat, scene)

    def clear_of_cone(motion: Floats) -> float:
        """Least clearance (or its rate) over the cone after a motion (x, z) of the sphere.

        The cone's tangent plane at each flank opens by the motion's component along its normal.
        """
        return float((motion @ axis) * sin - abs(float(motion @ across)) * cos)

    def approaches(energies: Energies) -> Iterator[Approach]:
        actuator = loop.problem.rigids[seat.actuator]
        place, speed = sphere_motion(loop, seat)
        of_seat = energies.elastic[SEAT]
        vibration = 0.0
        if seat.sphere_facets is not None:
            vibration = energies.elastic[ELASTIC_SPHERE] - energies.rigid_motion[ELASTIC_SPHERE]
        yield Approach(
            clear_of_cone(place[[0, 2]]),
            clear_of_cone(speed[[0, 2]]),
            ((of_seat, at_ring), (vibration, of_sphere)),
        )
        yield Approach(-actuator.u[2], -actuator.v[2], ((of_seat, at_tip),))

    return Ending(loop, approaches)
