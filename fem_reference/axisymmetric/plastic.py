"""Boxes around the contacts in which a body may yield: elements with mean dilatation.

Plastic flow keeps the volume; a bilinear element that has to do so at every Gauss point locks. In
the boxes the dilatation is therefore its mean over the element (B-bar: Nagtegaal, Parks & Rice
1974, Comput. Meth. Appl. Mech. Eng. 4, 153; Hughes 1980, Int. J. Numer. Meth. Eng. 15, 1413). The
deviator at a point is the point's own, and that is all that yielding asks for.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from ..common.bodies import Material
from ..explicit.plastic import Plasticity
from .elasticity import BodyMatrices, global_matrix

_CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)])
"""In dolfinx's order, as `ElementMatrices.nodes`."""
_POINTS = _CORNERS / math.sqrt(3.0)


def point_gradients(corners: Floats) -> tuple[Floats, Floats]:
    """What `Plasticity` has as ``gradients`` (m, 12, 4) and ``weights`` (m, 4).

    Args:
        corners: (m, 4, 2) r and z in the order of `ElementMatrices.nodes`, m.
    """
    gradients, weights = np.empty((corners.shape[0], 12, 4)), np.empty((corners.shape[0], 4))
    for k, point in enumerate(_POINTS):
        factors = 1.0 + _CORNERS * point
        shape = 0.25 * factors[:, 0] * factors[:, 1]
        local = 0.25 * _CORNERS * factors[:, ::-1]
        jacobian = np.einsum("ad,mac->mdc", local, corners)
        radius = corners[:, :, 0] @ shape
        gradients[:, :8, k] = (
            np.linalg.solve(jacobian, np.broadcast_to(local.T, (corners.shape[0], 2, 4)))
        ).reshape(-1, 8)
        gradients[:, 8:, k] = shape / radius[:, None]
        weights[:, k] = 2.0 * math.pi * radius * np.abs(np.linalg.det(jacobian))
    return gradients, weights


def mean_dilatation(gradients: Floats, weights: Floats, material: Material) -> Floats:
    """(m, 8, 8) stiffness of elements with the mean of their dilatation, N/m."""
    count = weights.shape[0]
    strain = np.zeros((count, 4, 4, 8))
    r, z, hoop = (gradients[:, 4 * k : 4 * k + 4].transpose(0, 2, 1) for k in range(3))
    strain[:, :, 0, 0::2], strain[:, :, 1, 0::2], strain[:, :, 2, 1::2] = r, hoop, z
    strain[:, :, 3, 0::2], strain[:, :, 3, 1::2] = z, r
    dilatation = strain[:, :, :3].sum(axis=2)
    strain[:, :, :3] -= dilatation[:, :, None] / 3.0
    shear = material.shear_modulus * np.array([2.0, 2.0, 2.0, 1.0])
    stiffness = np.einsum("mg,mgki,k,mgkj->mij", weights, strain, shear, strain, optimize=True)
    volume = weights.sum(axis=1)
    mean = np.einsum("mg,mgi->mi", weights, dilatation) / volume[:, None]
    bulk = material.lame_lambda + 2.0 / 3.0 * material.shear_modulus
    return np.asarray(stiffness + bulk * volume[:, None, None] * mean[:, :, None] * mean[:, None])


@dataclass(frozen=True)
class Box:
    """Elements of a body that may yield."""

    chosen: Mask
    """(m,) of the body's elements."""
    contact: Ints
    """(m,) number of the contact each element of the body is nearest to."""


def boxes(points: Floats, quads: Ints, poles: Mapping[int, float], size: float) -> Box:
    """Elements whose middle lies within ``size`` (m) of a contact, in r and in z.

    Args:
        points: (n, 2) of the body, m.
        quads: (m, 4) its elements.
        poles: z of the body's contacts by their number, m.
        size: m.
    """
    middle = points[quads].mean(axis=1)
    distance = np.array([np.abs(middle[:, 1] - pole) for pole in poles.values()])
    chosen = (middle[:, 0] < size) & (distance.min(axis=0) < size)
    return Box(chosen, np.array(list(poles))[distance.argmin(axis=0)])


def with_box(matrices: BodyMatrices, points: Floats, material: Material, box: Box) -> BodyMatrices:
    """The matrices of a body with mean dilatation in a box."""
    nodes, stiffness = matrices.elements.nodes, matrices.elements.stiffness.copy()
    chosen = box.chosen
    stiffness[chosen] = mean_dilatation(*point_gradients(points[nodes[chosen]]), material)
    elements = replace(matrices.elements, stiffness=stiffness)
    whole = global_matrix(nodes, stiffness, points.shape[0])
    return replace(matrices, stiffness=whole, elements=elements)


def plasticity(nodes: Ints, points: Floats, material: Material, box: Box) -> Plasticity:
    """The elements of a box as the loop steps them.

    Args:
        nodes: (m, 4) of all elements of the body, in the numbering of ``points``.
        points: (n, 2) m.
        material: that yields.
        box: of the body.
    """
    law, inside = material.yielding, nodes[box.chosen]
    if law is None:
        raise ValueError(f"material {material.name} does not yield")
    gradients, weights = point_gradients(points[inside])
    constant = np.ones(inside.shape[0])
    outside = np.isin(inside, nodes[~box.chosen]).any(axis=1)
    return Plasticity(
        nodes=inside,
        gradients=gradients,
        weights=weights,
        shear=material.shear_modulus * constant,
        yield_strength=law.strength * constant,
        hardening=law.hardening * constant,
        rate=law.rate * constant,
        exponent=law.exponent * constant,
        contact=box.contact[box.chosen],
        edge=outside,
    )


def together(parts: Sequence[Plasticity]) -> Plasticity | None:
    """Those of several bodies; None if none yields."""
    if not parts:
        return None
    names = [field.name for field in fields(Plasticity)]
    return Plasticity(**{n: np.concatenate([getattr(p, n) for p in parts]) for n in names})
