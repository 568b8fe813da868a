"""A mesh of a body with elements of half the size: each tetrahedron is cut into eight.

The corners keep a tetrahedron each, and the octahedron between them is cut along its shortest
diagonal (Bey 1995, Tetrahedral grid refinement). Curved elements stay curved: new nodes lie where
the shape functions of the old element put them.
"""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints
from ..solid.mesh import EDGES
from .tets import CHUNK, SAMPLES

CORNERS = ((0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3))
"""The tetrahedra at the corners, by the ten nodes of the old one."""
DIAGONALS = (((4, 9), (5, 6, 7, 8)), ((5, 7), (4, 6, 9, 8)), ((6, 8), (4, 5, 9, 7)))
"""Diagonals of the octahedron, and the nodes around each, in order."""
PLACES = SAMPLES[:10]
"""Barycentric coordinates of the ten nodes."""


def _turned(cells: tuple[tuple[int, ...], ...]) -> Ints:
    """The tetrahedra with the orientation of the old one."""
    made = np.array(cells)
    wrong = np.linalg.det(PLACES[made]) < 0.0
    made[wrong] = made[wrong][:, [0, 2, 1, 3]]
    return made


def _around(diagonal: tuple[int, int], ring: tuple[int, ...]) -> Ints:
    """The eight tetrahedra if the octahedron is cut along a diagonal."""
    inner = [(*diagonal, ring[k], ring[(k + 1) % 4]) for k in range(4)]
    return _turned((*CORNERS, *inner))


CUTS = np.array([_around(*each) for each in DIAGONALS])
"""(3, 8, 4): by diagonal, the new tetrahedra's corners among the ten nodes."""


def halved(points: Floats, cells: Ints) -> tuple[Floats, Ints]:
    """Points and tetrahedra of ten nodes (8 m, 10); the eight of an old one follow each other."""
    ends = np.array([diagonal for diagonal, _ in DIAGONALS])
    spans = points[cells[:, ends]]
    cut = np.linalg.norm(spans[:, :, 1] - spans[:, :, 0], axis=2).argmin(axis=1)
    # corners among the ten nodes of the old element, (m, 8, 4), and both ends of all edges
    corners = CUTS[cut]
    edges = corners[:, :, np.array(EDGES)]
    old = np.arange(cells.shape[0])[:, None, None]
    pairs = np.sort(cells[old[..., None], edges].reshape(-1, 2), axis=1)
    _, first, number = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    middles = 0.5 * PLACES[edges].sum(axis=-2).reshape(-1, 4)[first]
    owners = cells[first // (8 * len(EDGES))]
    made = np.concatenate([points, _placed(points, owners, middles)])
    nodes = (points.shape[0] + number.ravel()).reshape(*edges.shape[:3])
    return made, np.concatenate([cells[old, corners], nodes], axis=2).reshape(-1, 10)


def _placed(points: Floats, cells: Ints, barycentric: Floats) -> Floats:
    """(k, 3) where each curved element (k, 10) has the barycentric place (k, 4)."""
    found = []
    for k in range(0, cells.shape[0], CHUNK):
        at = barycentric[k : k + CHUNK]
        shapes = np.concatenate(
            [at * (2.0 * at - 1.0), *(4.0 * at[:, [a]] * at[:, [b]] for a, b in EDGES)], axis=1
        )
        found.append(np.einsum("kn,kni->ki", shapes, points[cells[k : k + CHUNK]]))
    return np.concatenate(found)
