"""The squeeze film between the plate's inner face and the body behind it, on the plate's nodes.

Nodes of the film between those of the plate would load nodes that touch, against the contact's
multipliers of the same step: a loss that hardly falls with the mesh size.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ..common.arrays import Floats, Ints
from ..common.fluid import Fluid
from ..explicit.film import Film, Viscosity
from .mesh import BodyMesh

RATES = (1e-4, 1e8)
"""Range of the viscosity's table, over the inverse of the relaxation time."""
TABLE = 4096


def facing_nodes(body: BodyMesh, pole: float, height: float) -> Ints:
    """Surface nodes of a body within ``height`` (m) of its pole at z = ``pole``, by radius."""
    edges = np.sort(np.stack([body.quads, np.roll(body.quads, -1, axis=1)], axis=2), axis=2)
    unique, count = np.unique(edges.reshape(-1, 2), axis=0, return_counts=True)
    outline = unique[count == 1]
    # Edges on the axis are those of the half-plane only.
    outline = outline[(body.points[outline, 0] > 0.0).any(axis=1)]
    nodes = np.unique(outline)
    nodes = nodes[np.abs(body.points[nodes, 1] - pole) <= height]
    return np.asarray(nodes[np.argsort(body.points[nodes, 0])])


def _between(radii: Floats, at: Floats) -> tuple[Ints, Floats]:
    """Of the two nodes around each place ``at`` (n,): their numbers and shares, both (n, 2)."""
    if radii.size == 1:
        return np.zeros((at.size, 2), dtype=np.int64), np.tile([1.0, 0.0], (at.size, 1))
    low = np.clip(np.searchsorted(radii, at, side="right") - 1, 0, radii.size - 2)
    share = np.clip((at - radii[low]) / (radii[low + 1] - radii[low]), 0.0, 1.0)
    return np.stack([low, low + 1], axis=1), np.stack([1.0 - share, share], axis=1)


def ring_areas(radii: Floats) -> Floats:
    """(n,) integrals of the linear shape functions of all nodes but the last, m^2."""
    inner, outer = radii[:-1], radii[1:]
    length = outer - inner
    low = math.pi / 3.0 * length * (2.0 * inner + outer)
    high = math.pi / 3.0 * length * (inner + 2.0 * outer)
    return np.asarray(low + np.concatenate([[0.0], high[:-1]]))


def squeeze_film(
    fluid: Fluid,
    plate: tuple[Ints, Floats],
    body: tuple[Ints, Floats],
    tip_radius: float,
    gap: float,
) -> Film:
    """The film of a fluid.

    The tip is a paraboloid, which is what lubrication theory resolves of a sphere. The film ends at
    the plate's edge or where the tip is as wide as its radius.

    Args:
        fluid: see there.
        plate: nodes (k,) of its inner face and their radii (k,), ascending from 0 to its edge, m.
        body: the same of the surface behind it; of a compact body one node.
        tip_radius: of the body, m.
        gap: at the start, m.
    """
    edge = min(float(plate[1][-1]), tip_radius)
    count = int(np.searchsorted(plate[1], edge * (1.0 - 1e-9)))
    nodes, radii = plate[0][:count], np.append(plate[1][:count], edge)
    numbers, shares = _between(body[1], radii[:-1])
    return Film(
        radii=radii,
        areas=ring_areas(radii),
        nodes=np.concatenate([nodes, body[0]]),
        corners=np.hstack([np.arange(count)[:, None], count + numbers]),
        weights=np.hstack([np.ones((count, 1)), -shares]),
        gap=gap,
        curvature=0.5 / tip_radius,
        minimum_gap=fluid.minimum_gap,
        viscosity=effective_viscosity(fluid),
    )


def effective_viscosity(fluid: Fluid) -> Viscosity:
    """Of the flow through a slit, by the profile of the rate of shear across it.

    With the stress tau at the wall the flow per width is h^2/(2 tau^2) times the integral of
    s rate(s) ds from 0 to tau (Rabinowitsch); the effective viscosity is tau over the apparent
    rate.
    """
    law = fluid.shear_thinning
    if law is None:
        return Viscosity(np.ones(1), np.array([fluid.viscosity]))
    rate = np.geomspace(1e-3 * RATES[0], 1e2 * RATES[1], 100_001) / law.relaxation_time
    fall = (1.0 + (law.relaxation_time * rate) ** 2) ** (0.5 * (law.power_index - 1.0))
    least = law.infinite_shear_viscosity
    stress = (least + (fluid.viscosity - least) * fall) * rate
    # Below the first rate the fluid is Newtonian.
    moment = cumulative_trapezoid(stress * rate, stress, initial=0.0) + stress[0] ** 2 * rate[0] / 3
    apparent = 3.0 * moment / stress**2
    rates = np.geomspace(*RATES, TABLE) / law.relaxation_time
    return Viscosity(rates, np.interp(rates, apparent, stress / apparent))
