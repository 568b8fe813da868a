"""Solid cells of any kind to quadratic tetrahedra whose faces match.

Every quadrilateral is cut from its corner of least number, so that both of its cells cut it alike
(Dompierre, Labbe, Vallet & Camarero 1999). Curved cells stay curved: the midside node of a new edge
lies where the cell's shape functions put the middle of its face or the cell's centre.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..common.arrays import Floats, Ints
from ..solid.mesh import EDGES
from .cells import SOLIDS, Cell


@dataclass
class _Edges:
    """Midside nodes known so far, by the corners of their edges."""

    points: Floats
    pairs: list[Ints] = field(default_factory=list)
    nodes: list[Ints] = field(default_factory=list)

    def add(self, ends: Ints, nodes: Ints) -> None:
        """Midside nodes (m,) of edges with the corners (m, 2); those added first count."""
        self.pairs.append(np.sort(ends, axis=1))
        self.nodes.append(nodes)

    def new(self, places: Floats) -> Ints:
        """Numbers of new nodes (m, 3)."""
        first = self.points.shape[0]
        self.points = np.vstack([self.points, places])
        return np.arange(first, first + places.shape[0])


def quadratic(points: Floats, blocks: list[tuple[str, Ints]]) -> tuple[Floats, Ints, Ints]:
    """Quadratic tetrahedra of solid cells.

    Args:
        points: (n, 3) nodes.
        blocks: kinds of cells (`SOLIDS`), and their nodes.

    Returns:
        Points, the old ones first; (m, 10) tetrahedra in VTK's order; the cell (m,) of each,
        counted through the blocks.
    """
    edges = _Edges(points)
    corners, owners, first = [], [], 0
    # all nodes of the file first: they go before places that shape functions give
    for name, nodes in blocks:
        _add_given(edges, SOLIDS[name], nodes)
    for name, nodes in blocks:
        cell = SOLIDS[name]
        if cell.quadratic:
            _add_mapped(edges, cell, nodes)
        for tets, cells in _tetrahedra(cell, nodes[:, : cell.corners]):
            corners.append(tets)
            owners.append(first + cells)
        first += nodes.shape[0]
    tets, owner = np.concatenate(corners), np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    cells = _with_midsides(edges, tets[order])
    return edges.points, cells, owner[order]


def _add_given(edges: _Edges, cell: Cell, nodes: Ints) -> None:
    for k, ends in enumerate(cell.middles):
        middle = nodes[:, cell.corners + k]
        for pair in _diagonals(ends):
            edges.add(nodes[:, list(pair)], middle)


def _diagonals(corners: tuple[int, ...]) -> tuple[tuple[int, int], ...]:
    """Edges whose middle is that of an edge, a quadrilateral, a hexahedron."""
    if len(corners) == 2:
        return ((corners[0], corners[1]),)
    if len(corners) == 4:
        return ((corners[0], corners[2]), (corners[1], corners[3]))
    return ((0, 6), (1, 7), (2, 4), (3, 5))


def _add_mapped(edges: _Edges, cell: Cell, nodes: Ints) -> None:
    """Middles of faces and of hexahedra that have no node, by the serendipity shape functions."""
    middle = {frozenset(ends): cell.corners + k for k, ends in enumerate(cell.middles)}
    wanted: list[tuple[int, ...]] = [face for face in cell.faces if len(face) == 4]
    wanted += [tuple(range(8))] if cell.corners == 8 else []
    for each in wanted:
        if frozenset(each) in middle:
            continue
        mids = [node for ends, node in middle.items() if len(ends) == 2 and ends <= set(each)]
        corner_sum = edges.points[nodes[:, list(each)]].sum(axis=1)
        mid_sum = edges.points[nodes[:, mids]].sum(axis=1)
        # 4 corners and 4 midsides; 8 corners and 12 midsides
        place = (
            0.5 * mid_sum - 0.25 * corner_sum if len(each) == 4 else 0.25 * (mid_sum - corner_sum)
        )
        number = edges.new(place)
        for pair in _diagonals(each):
            edges.add(nodes[:, list(pair)], number)


def _tetrahedra(cell: Cell, corners: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Tetrahedra (m, 4) from a cell's least corner to its far faces; the cells they are of."""
    least = np.argmin(corners, axis=1)
    for apex in range(cell.corners):
        cells = np.flatnonzero(least == apex)
        for face in cell.faces:
            if cells.size == 0 or apex in face:
                continue
            for triangle, chosen in _triangles(corners[cells][:, list(face)]):
                tip = corners[cells[chosen], apex]
                # seen from inside the faces turn the other way
                yield np.column_stack([triangle[:, [0, 2, 1]], tip]), cells[chosen]


def _triangles(face: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Triangles of faces (m, 3 or 4), and which face each is of."""
    every = np.arange(face.shape[0])
    if face.shape[1] == 3:
        yield face, every
        return
    least = np.argmin(face, axis=1)
    turned = np.take_along_axis(face, (least[:, None] + np.arange(4)) % 4, axis=1)
    yield turned[:, [0, 1, 2]], every
    yield turned[:, [0, 2, 3]], every


def _with_midsides(edges: _Edges, tets: Ints) -> Ints:
    """Tetrahedra (m, 10); an edge without a node gets one in its middle."""
    ends = np.sort(np.stack([tets[:, list(pair)] for pair in EDGES], axis=1), axis=2)
    size = edges.points.shape[0] + 1
    wanted, inverse = np.unique(ends[..., 0] * size + ends[..., 1], return_inverse=True)
    node = np.full(wanted.size, -1, dtype=np.int64)
    if edges.pairs:
        pairs, given = np.concatenate(edges.pairs), np.concatenate(edges.nodes)
        known, index = np.unique(pairs[:, 0] * size + pairs[:, 1], return_index=True)
        at = np.minimum(np.searchsorted(known, wanted), known.size - 1)
        found = known[at] == wanted
        node[found] = given[index[at[found]]]
    missing = np.flatnonzero(node < 0)
    a, b = wanted[missing] // size, wanted[missing] % size
    node[missing] = edges.new(0.5 * (edges.points[a] + edges.points[b]))
    return np.hstack([tets, node[inverse].reshape(-1, len(EDGES))])
