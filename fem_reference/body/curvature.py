"""Principal curvatures of a surface: fitted to the nodes of a mesh, or of a CAD face."""

from __future__ import annotations

from dataclasses import dataclass

import gmsh
import numpy as np
from scipy.linalg import eigh

from ..common.arrays import Floats
from .skin import Skin, SurfacePoint

FIRST_RADIUS = 2.0
"""Distance of the nodes that a surface is fitted to, over the size of the elements there."""
LAST_RADIUS = 8.0
ENOUGH_FOR = {4: 30, 2: 9}
"""Nodes that a polynomial of a degree takes: twice its coefficients, or half as many more."""
ASIDE = 1e-5
"""Step away from a pole, over the range of the parameters."""
DEGENERATE = 1e-6


@dataclass(frozen=True)
class Curvature:
    """Of a surface at a point."""

    values: tuple[float, float]
    """1/m, the larger first; positive where the body is convex."""
    directions: Floats
    """(2, 3) unit vectors."""
    normal: Floats
    """(3,) outward."""
    source: str
    """cad, fit, flat."""


def frame(normal: Floats) -> Floats:
    """(2, 3) unit vectors square to a unit vector and to each other."""
    axis = np.eye(3)[int(np.argmin(np.abs(normal)))]
    first = np.cross(normal, axis)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first)])


def fitted(skin: Skin, point: SurfacePoint, size: float) -> Curvature:
    """Curvature of the smooth face around a point, by a polynomial through its nodes.

    Args:
        skin: the body's surface.
        point: on it.
        size: of the elements there, m.
    """
    axes = frame(point.normal)
    places = _nodes(skin, point) - point.place
    away = np.linalg.norm(places, axis=1)
    radius = FIRST_RADIUS * size
    while (away <= radius).sum() < ENOUGH_FOR[4] and radius < LAST_RADIUS * size:
        radius *= 1.25
    near = places[away <= radius] / radius
    x, y, z = near @ axes[0], near @ axes[1], near @ point.normal
    degree = next((d for d, enough in ENOUGH_FOR.items() if x.size >= enough), None)
    if degree is None:
        return Curvature((0.0, 0.0), axes, point.normal, "flat")
    powers = [(i, j) for n in range(degree + 1) for i in range(n, -1, -1) for j in (n - i,)]
    terms = np.stack([x**i * y**j for i, j in powers], axis=1)
    c, *_ = np.linalg.lstsq(terms, z, rcond=None)
    gradient = c[1:3]
    hessian = np.array([[2.0 * c[3], c[4]], [c[4], 2.0 * c[5]]]) / radius
    tangents = axes + gradient[:, None] * point.normal
    return _principal(tangents, hessian[..., None] * point.normal, point.normal, "fit")


def _nodes(skin: Skin, point: SurfacePoint) -> Floats:
    """Nodes of the smooth face, midside nodes only if the mesh has curved edges."""
    smooth = skin.smooth == skin.smooth[point.face]
    own, curved = skin.faces[smooth], skin.curved[smooth].any()
    return np.asarray(skin.points[np.unique(own if curved else own[:, :3])])


def _principal(tangents: Floats, second: Floats, outward: Floats, source: str) -> Curvature:
    """From the tangents (2, 3) and second derivatives (2, 2, 3) of a parametric surface."""
    normal = np.cross(tangents[0], tangents[1])
    normal /= np.linalg.norm(normal)
    normal *= 1.0 if normal @ outward >= 0.0 else -1.0
    values, vectors = eigh(-second @ normal, tangents @ tangents.T)
    directions = vectors.T[::-1] @ tangents
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Curvature((float(values[1]), float(values[0])), directions, normal, source)


def of_face(face: int, place: Floats, outward: Floats, unit: float) -> Curvature | None:
    """Curvature of a face of gmsh's CAD model; None where it has none.

    Args:
        face: its tag.
        place: on it, in the model's unit.
        outward: roughly the outward normal; the parameters need not turn the right way round.
        unit: metres per unit of the model.
    """
    uv = np.array(gmsh.model.getParametrization(2, face, place.tolist()))
    least, most = (np.array(each) for each in gmsh.model.getParametrizationBounds(2, face))
    for _ in range(2):
        tangents = np.array(gmsh.model.getDerivative(2, face, uv.tolist())).reshape(2, 3)
        sizes = np.linalg.norm(tangents, axis=1)
        area = np.linalg.norm(np.cross(tangents[0], tangents[1]))
        scale = np.linalg.norm(tangents * (most - least)[:, None], axis=1)
        if area > DEGENERATE * sizes.prod() and scale.min() > DEGENERATE * scale.max():
            break
        # a pole, where one direction has no length: aside, towards the middle of the parameters
        uv = uv + ASIDE * (0.5 * (least + most) - uv)
    else:
        return None
    uu, vv, cross = np.array(gmsh.model.getSecondDerivative(2, face, uv.tolist())).reshape(3, 3)
    second = np.array([[uu, cross], [cross, vv]])
    found = _principal(tangents, second, outward, "cad")
    if not np.isfinite([*found.values, *found.directions.ravel()]).all():
        return None
    k1, k2 = (value / unit for value in found.values)
    return Curvature((k1, k2), found.directions, found.normal, "cad")
