"""Curved tetrahedra of ten nodes: shape functions, volume, quality."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints
from ..solid.mesh import EDGES, edge_lengths

QUADRATURE = np.array([[0.25] * 4, *(np.full((4, 4), 1 / 6) + np.eye(4) / 3)])
"""Barycentric points that integrate cubics exactly, as the Jacobian's determinant is one."""
WEIGHTS = np.array([-0.8, 0.45, 0.45, 0.45, 0.45]) / 6.0
SAMPLES = np.array(
    [*np.eye(4), *(0.5 * (np.eye(4)[a] + np.eye(4)[b]) for a, b in EDGES), [0.25] * 4]
)
"""Barycentric points at which the quality is found: the nodes and the centre."""
CHUNK = 50_000


def derivatives(barycentric: Floats) -> Floats:
    """(10, 3) derivatives of the shape functions by the coordinates of corners 1, 2, 3."""
    by_corner = np.zeros((10, 4))
    for corner in range(4):
        by_corner[corner, corner] = 4.0 * barycentric[corner] - 1.0
    for node, (a, b) in enumerate(EDGES, start=4):
        by_corner[node, a], by_corner[node, b] = 4.0 * barycentric[b], 4.0 * barycentric[a]
    return by_corner[:, 1:] - by_corner[:, :1]


def tangents(points: Floats, cells: Ints, barycentric: Floats) -> Floats:
    """(m, 3, 3) derivatives of the place: [element, corner 1 to 3, component]."""
    return np.asarray(np.einsum("nk,mni->mki", derivatives(barycentric), points[cells]))


def volume(points: Floats, cells: Ints) -> float:
    """Of all elements together, curved as they are."""
    total = 0.0
    for place, weight in zip(QUADRATURE, WEIGHTS, strict=True):
        total += weight * float(np.linalg.det(tangents(points, cells, place)).sum())
    return total


def qualities(points: Floats, cells: Ints) -> Floats:
    """(m,) least scaled Jacobian over nodes and centre: 1 for a regular tetrahedron, <= 0 inverted.

    At a point it is sqrt(2) times the determinant over the largest product of the tangents along
    three edges that meet in a corner (Knupp 2000).
    """
    return np.concatenate(
        [_qualities(points, cells[k : k + CHUNK]) for k in range(0, cells.shape[0], CHUNK)]
    )


def _qualities(points: Floats, cells: Ints) -> Floats:
    least = np.full(cells.shape[0], np.inf)
    for place in SAMPLES:
        t = tangents(points, cells, place)
        a, b, c = (np.linalg.norm(t[:, k], axis=1) for k in range(3))
        ab, bc, ca = (np.linalg.norm(t[:, k] - t[:, k - 2], axis=1) for k in range(3))
        products = np.max([a * b * c, a * ab * ca, b * ab * bc, c * bc * ca], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            scaled = np.sqrt(2.0) * np.linalg.det(t) / products
        least = np.minimum(least, np.where(products > 0.0, scaled, 0.0))
    return least


def lengths(points: Floats, cells: Ints) -> Floats:
    """(m, 6) straight lengths of the elements' edges."""
    return edge_lengths(points, cells[:, :4])
