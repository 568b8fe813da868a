"""When a seal-seat run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..common.arrays import Floats
from ..explicit.energies import Energies
from ..explicit.loop import Loop
from ..explicit.spectrum import conjugate_gradients, free_components
from ..impact.ending import Approach, Ending
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
    return relieved_flexibility(loop, mesh.points.mean(axis=0), load)


def seat_ending(loop: Loop, seat: SeatModel, scene: SeatScene) -> Ending:
    """When sphere and actuator can be proven never to touch the seat again."""
    ring = scene.ring()
    axis = np.array(ring.axis)[[0, 2]]
    across = np.array([axis[1], -axis[0]])
    sin, cos = math.sin(ring.half_angle), math.cos(ring.half_angle)
    # The stiffness that lasts bounds what an energy can displace.
    lasting = scene.seat.material.lasting
    at_ring, at_tip = (
        max(flexibility(loop, seat.patches[k]) for k in which) / lasting
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
