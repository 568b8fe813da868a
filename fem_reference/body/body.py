"""A body as one mesh of quadratic tetrahedra with named groups, sound or refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..common.arrays import Floats, Ints, Mask
from ..common.errors import SceneError
from ..solid.mesh import FACES, TetMesh, surface
from .scene import Place
from .skin import Skin
from .source import Group, MeshFile, named
from .split import quadratic
from .tets import qualities, volume

LARGEST, SMALLEST = 2.0, 20e-6
"""Bounds of the largest side of a body's bounding box, m."""
LARGEST_IN_METRES = 1.0
"""The same of a mesh whose unit is not stated: larger ones are rather in millimetres."""
FIXABLE = ("surface", "nodes", "curve", "point", "elements", "volume")


@dataclass(frozen=True)
class Body:
    """Quadratic tetrahedra, m."""

    points: Floats
    cells: Ints
    """(m, 10), VTK's order."""
    groups: Sequence[Group]

    @cached_property
    def skin(self) -> Skin:
        """Its surface."""
        return Skin(self.points, surface(TetMesh("body", self.points, self.cells)))

    def faces_of(self, group: Group) -> Mask:
        """Triangles of the skin that lie in a group: its facets, or all of whose nodes it has."""
        faces = self.skin.faces[:, :3]
        chosen = np.zeros(faces.shape[0], dtype=bool)
        for facets in group.facets:
            for corners in _triples(facets):
                chosen |= _rows_in(faces, corners)
        if not group.facets:
            chosen = np.isin(faces, self._nodes_of(group)).all(axis=1)
        return chosen

    def _nodes_of(self, group: Group) -> Ints:
        if group.elements.size:
            return np.unique(self.cells[group.elements])
        return group.nodes

    def fixed_nodes(self, group: Group) -> Ints:
        """Nodes that a group fixes: of its faces, midside nodes too, and those it names."""
        if group.kind == "surface":
            return np.unique(self.skin.faces[self.faces_of(group)])
        own = self._nodes_of(group)
        lines = [facets for facets in group.facets if facets.shape[1] == 2]
        middles = [self._midsides(facets) for facets in lines]
        of_faces = self.skin.faces[self.faces_of(group)].ravel()
        return np.unique(np.concatenate([own, of_faces, *middles]))

    def _midsides(self, lines: Ints) -> Ints:
        """Midside nodes of edges (k, 2) of the skin."""
        found = []
        for side, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), start=3):
            faces = self.skin.faces
            found.append(faces[_rows_in(faces[:, [a, b]], lines), side])
        return np.concatenate(found)


def _triples(facets: Ints) -> list[Ints]:
    """The triangles that a triangle or quadrilateral may have been cut into."""
    if facets.shape[1] == 3:
        return [facets]
    if facets.shape[1] == 4:
        return [np.delete(facets, k, axis=1) for k in range(4)]
    return []


def _rows_in(rows: Ints, among: Ints) -> Mask:
    """Which rows of node numbers are, in any order, also in the other table."""
    both = np.sort(np.concatenate([rows, among]), axis=1)
    _, number = np.unique(both, axis=0, return_inverse=True)
    number = number.ravel()
    return np.isin(number[: rows.shape[0]], number[rows.shape[0] :])


def bounding_box(points: Floats) -> list[list[float]]:
    """Least and greatest coordinates."""
    return [points.min(axis=0).tolist(), points.max(axis=0).tolist()]


def check_size(box: list[list[float]], largest: float = LARGEST) -> None:
    """Refuse a body whose unit of length cannot be right.

    Args:
        box: its bounding box, m.
        largest: side that is possible, m.

    Raises:
        SceneError: the bounding box is too large or too small.
    """
    sides = np.subtract(box[1], box[0])
    if not SMALLEST <= sides.max() <= largest:
        what = " x ".join(f"{side:.4g}" for side in sides)
        question = "millimetres taken for metres" if sides.max() > largest else "metres for others"
        raise SceneError(
            f"the body's bounding box is {what} m ({question}?); its largest side must lie between "
            f"{SMALLEST:g} and {largest:g} m: set body.unit"
        )


def body_of(source: MeshFile, unit: float | None, name: str) -> Body:
    """The body that a mesh file describes.

    Args:
        source: the file's content.
        unit: metres per number of the file; None: not stated, metres.
        name: of the file, for messages.

    Raises:
        SceneError: it has no volume elements, several parts, inverted elements, or the wrong size.
    """
    if not source.solids:
        have = ", ".join(f"{count} {kind}" for kind, count in source.counts.items())
        raise SceneError(
            f"{name} has no volume elements ({have or 'no elements'}); a solid mesh is needed "
            "(gmsh leaves out what belongs to no physical group: give the volume one)"
        )
    points = source.points * (unit or 1.0)
    if not np.isfinite(points).all():
        raise SceneError(f"{name} has nodes without finite coordinates")
    points, cells, owner = quadratic(points, source.solids)
    _check_nodes(cells, name)
    body = _compressed(points, cells, owner, source)
    check_size(bounding_box(body.points), LARGEST if unit else LARGEST_IN_METRES)
    body = replace(body, cells=_all_turned(body))
    check_quality(body, name)
    check_one_part(body, name)
    return body


def _check_nodes(cells: Ints, name: str) -> None:
    twice = np.flatnonzero((np.diff(np.sort(cells[:, :4], axis=1), axis=1) == 0).any(axis=1))
    if twice.size:
        raise SceneError(
            f"{name} has {twice.size} elements with a corner named twice (the first splits into "
            f"tetrahedron {twice[0]}); collapsed elements are not read"
        )


def _compressed(points: Floats, cells: Ints, owner: Ints, source: MeshFile) -> Body:
    """Without the nodes that no element has."""
    used = np.unique(cells)
    at = np.full(points.shape[0], -1, dtype=np.int64)
    at[used] = np.arange(used.size)
    count = sum(nodes.shape[0] for _, nodes in source.solids)
    order = np.argsort(owner, kind="stable")
    start = np.searchsorted(owner[order], np.arange(count + 1))

    def moved(group: Group) -> Group:
        nodes = at[group.nodes]
        facets = [at[each] for each in group.facets]
        parts = [order[start[e] : start[e + 1]] for e in group.elements]
        return replace(
            group,
            nodes=nodes[nodes >= 0],
            facets=[each[(each >= 0).all(axis=1)] for each in facets],
            elements=np.concatenate(parts) if parts else group.elements,
        )

    return Body(points[used], at[cells], [moved(each) for each in source.groups])


def _all_turned(body: Body) -> Ints:
    """Elements, all mirrored if the file numbers all of them the other way round."""
    if volume(body.points, body.cells) < 0.0:
        return body.cells[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    return body.cells


def check_quality(body: Body, name: str) -> Floats:
    """Qualities of the elements.

    Raises:
        SceneError: elements are inverted or flat.
    """
    quality = qualities(body.points, body.cells)
    wrong = np.flatnonzero(~(quality > 0.0))
    if wrong.size:
        x, y, z = body.points[body.cells[wrong[0], :4]].mean(axis=0)
        raise SceneError(
            f"{name} has {wrong.size} inverted or flat elements of {quality.size}; the first is "
            f"number {wrong[0]} at ({x:.6g}, {y:.6g}, {z:.6g}) m with the scaled Jacobian "
            f"{quality[wrong[0]]:.3g}, which must be above 0; mesh it again"
        )
    return quality


def check_one_part(body: Body, name: str) -> None:
    """Refuse elements that do not all hang together by their faces.

    Raises:
        SceneError: there are several parts; their sizes are stated.
    """
    count = body.cells.shape[0]
    faces = np.sort(np.concatenate([body.cells[:, list(face)] for face in FACES]), axis=1)
    owner = np.tile(np.arange(count), len(FACES))
    order = np.lexsort(faces.T)
    same = (faces[order[1:]] == faces[order[:-1]]).all(axis=1)
    a, b = owner[order[:-1][same]], owner[order[1:][same]]
    graph = coo_matrix((np.ones(a.size), (a, b)), shape=(count, count))
    parts, label = connected_components(graph, directed=False)
    if parts > 1:
        sizes = sorted(np.bincount(label).tolist(), reverse=True)
        listed = ", ".join(map(str, sizes[:5])) + (", ..." if parts > 5 else "")
        raise SceneError(
            f"{name} has {parts} parts that share no faces (of {listed} tetrahedra); one body is "
            "needed: merge coincident nodes or export one part"
        )


def fixed_mask(body: Body, places: Sequence[Place]) -> Mask:
    """Which nodes are fixed, by names or by points on the faces meant.

    Raises:
        SceneError: a name is missing, a point is off the surface, or nothing is fixed by it.
    """
    fixed = np.zeros(body.points.shape[0], dtype=bool)
    for k, each in enumerate(places):
        path = f"body.fixed[{k}]"
        if isinstance(each, str):
            nodes = body.fixed_nodes(named(body.groups, each, path, FIXABLE))
        else:
            point = body.skin.nearest(each)
            size = body.skin.mean_edge(body.skin.around(point))
            require_near(path, each, float(np.linalg.norm(point.place - each)), 0.5 * size)
            smooth = body.skin.smooth
            nodes = body.skin.faces[smooth == smooth[point.face]].ravel()
        if nodes.size == 0:
            raise SceneError(f"{path} is {each!r}, which has no nodes on the body's surface")
        fixed[nodes] = True
    return fixed


def require_near(path: str, place: Floats, distance: float, bound: float) -> None:
    """Refuse a point that is farther from the surface than half an element.

    Raises:
        SceneError: it is.
    """
    if distance > bound:
        x, y, z = place
        raise SceneError(
            f"{path} ({x:.6g}, {y:.6g}, {z:.6g}) m is {distance:.3g} m away from the body's "
            f"surface; at most half an element ({bound:.3g} m) is allowed: move it to the surface"
        )
