"""Tetrahedral meshes: nodes of linear and quadratic elements, surface, quality."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError

EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
"""Corners of a tetrahedron's edges, in VTK's order of a quadratic tetrahedron's midside nodes."""
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
"""Corners of a tetrahedron's faces, counter-clockwise seen from outside."""
FACE_EDGES = ((0, 1), (1, 2), (2, 0))

MINIMUM_QUALITY = 0.05
"""Least `qualities` accepted."""


@dataclass(frozen=True)
class TetMesh:
    """Tetrahedra of one body with flat faces and straight edges, of order 1 or 2."""

    name: str
    points: Floats
    """(n, 3) nodes, m: first the corners, then (order 2) the edges' midpoints."""
    cells: Ints
    """(m, 4) or (m, 10): nodes of each element, VTK's order."""

    @property
    def order(self) -> int:
        """1 linear, 2 quadratic."""
        return 1 if self.cells.shape[1] == 4 else 2

    @property
    def corners(self) -> Ints:
        """(m, 4) corner nodes."""
        return self.cells[:, :4]

    def volume(self) -> float:
        """Of the body, m^3."""
        return float(volumes(self.points, self.corners).sum())


def volumes(points: Floats, corners: Ints) -> Floats:
    """(m,) signed volumes, m^3; negative if inverted."""
    edges = points[corners[:, 1:]] - points[corners[:, :1]]
    return np.asarray(np.linalg.det(edges) / 6.0)


def qualities(points: Floats, corners: Ints) -> Floats:
    """(m,) mean ratio 12 (3 V)^(2/3) / sum of squared edges (Liu & Joe 1994), signed.

    1 for a regular tetrahedron, at most 0 for a flat or inverted one.
    """
    volume = volumes(points, corners)
    squares = np.zeros(corners.shape[0])
    for a, b in EDGES:
        squares += ((points[corners[:, a]] - points[corners[:, b]]) ** 2).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = 12.0 * np.sign(volume) * np.cbrt(3.0 * np.abs(volume)) ** 2 / squares
    return np.where(squares > 0.0, ratio, 0.0)


def edge_lengths(points: Floats, corners: Ints) -> Floats:
    """(m, 6) lengths of the elements' edges, m."""
    return np.stack(
        [np.linalg.norm(points[corners[:, a]] - points[corners[:, b]], axis=1) for a, b in EDGES],
        axis=1,
    )


def check_elements(mesh: TetMesh) -> float:
    """Return the least quality of a mesh.

    Raises:
        SolverError: an element is inverted or nearly flat; its number and place are named.
    """
    quality = qualities(mesh.points, mesh.corners)
    worst = int(np.argmin(quality))
    if not quality[worst] > MINIMUM_QUALITY:
        x, y, z = mesh.points[mesh.corners[worst]].mean(axis=0)
        what = "inverted" if quality[worst] < 0.0 else "degenerate"
        raise SolverError(
            f"element {worst} of body '{mesh.name}' at x = {x:.6g} m, y = {y:.6g} m, "
            f"z = {z:.6g} m is {what}: quality (mean ratio) {quality[worst]:.3g}, "
            f"at least {MINIMUM_QUALITY} is required"
        )
    return float(quality[worst])


def tetrahedra(name: str, points: Floats, corners: Ints, order: int) -> TetMesh:
    """A mesh of the given order from its corners; midside nodes lie in the edges' middle."""
    if order == 1:
        return TetMesh(name, points, corners)
    pairs = np.sort(np.stack([corners[:, list(edge)] for edge in EDGES], axis=1), axis=2)
    edges, inverse = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    midside = points.shape[0] + inverse.reshape(-1, len(EDGES))
    middle = 0.5 * (points[edges[:, 0]] + points[edges[:, 1]])
    return TetMesh(name, np.vstack([points, middle]), np.hstack([corners, midside]))


def surface(mesh: TetMesh) -> Ints:
    """(k, 3) or (k, 6) nodes of the faces on the surface, counter-clockwise from outside."""
    columns = [list(face) for face in FACES]
    if mesh.order == 2:
        number = {frozenset(edge): 4 + i for i, edge in enumerate(EDGES)}
        for face in columns:
            face += [number[frozenset((face[a], face[b]))] for a, b in FACE_EDGES]
    faces = np.concatenate([mesh.cells[:, face] for face in columns])
    _, index, count = np.unique(
        np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    return np.asarray(faces[np.sort(index[count == 1])])


def nodal_sum(nodes: Ints, values: Floats, count: int) -> Floats:
    """(count,) sums of the values that belong to each node."""
    weights = np.broadcast_to(values, nodes.shape).ravel()
    return np.asarray(np.bincount(nodes.ravel(), weights, count), dtype=np.float64)


def shape_functions(barycentric: Floats, order: int) -> Floats:
    """(n, 3) or (n, 6) shape functions of a triangle at barycentric coordinates (n, 3)."""
    if order == 1:
        return barycentric
    corner = barycentric * (2.0 * barycentric - 1.0)
    edge = np.stack([4.0 * barycentric[:, a] * barycentric[:, b] for a, b in FACE_EDGES], axis=1)
    return np.hstack([corner, edge])


def mesh_report(meshes: Sequence[TetMesh]) -> dict[str, Any]:
    """Numbers that say how large and how good the meshes of a model are together."""
    quality = np.concatenate([qualities(m.points, m.corners) for m in meshes])
    edges = np.concatenate([edge_lengths(m.points, m.corners).ravel() for m in meshes])
    nodes = sum(int(m.points.shape[0]) for m in meshes)
    return {
        "nodes": nodes,
        "dofs": 3 * nodes,
        "elements": int(quality.size),
        "element_order": meshes[0].order,
        "smallest_element": float(edges.min()),
        "largest_element": float(edges.max()),
        "min_quality": float(quality.min()),
        "mean_quality": float(quality.mean()),
    }
