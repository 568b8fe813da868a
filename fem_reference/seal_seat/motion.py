"""The sphere's motion, rigid or elastic, and its pairs with the seat while it moves."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats
from ..explicit.loop import Loop
from ..solid.sphere_pairs import sphere_pairs
from .model import ELASTIC_SPHERE, LEFT, RIGHT, SeatModel
from .scene import SeatScene


def sphere_motion(loop: Loop, seat: SeatModel) -> tuple[Floats, Floats]:
    """Displacement (m) and velocity (m/s, half a step later) of the sphere's centre of mass."""
    if seat.sphere_facets is None:
        rigid = loop.problem.rigids[0]
        return np.array(rigid.u), np.array(rigid.v)
    weights = np.where(loop.body == ELASTIC_SPHERE, loop.mass, 0.0)
    weights /= loop.body_masses()[ELASTIC_SPHERE]
    both = np.concatenate([weights @ x.reshape(-1, 3) for x in (loop.u, loop.v)])
    both = loop.total(both)
    return both[:3], both[3:]


def pair_again(loop: Loop, seat: SeatModel, scene: SeatScene) -> None:
    """New pairs of seat and elastic sphere in their present state."""
    if seat.sphere_facets is None:
        return
    displacement = loop.gather(loop.u)
    first = int(loop.system.first[ELASTIC_SPHERE])
    mean, _ = sphere_motion(loop, seat)
    for number in (LEFT, RIGHT):
        nodes = seat.patches[number].nodes
        pairs = sphere_pairs(
            scene.ball,
            seat.model.elastic[ELASTIC_SPHERE].mesh,
            seat.sphere_facets,
            seat.places[number],
            displacement[first:],
            mean,
            displacement[nodes],
        )
        loop.problem.pair(number, first, pairs.facets, pairs.weights, pairs.normals, pairs.gaps)
