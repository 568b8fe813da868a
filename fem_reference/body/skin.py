"""The surface of a body: curved triangles, smooth faces, nearest points, rays through it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..common.arrays import Floats, Ints, Mask

FEATURE_ANGLE = math.radians(40.0)
"""Normals that turn by more at an edge make it a sharp one."""
STRAIGHT = 1e-6
"""Distance of a midside node from its edge's middle, over the edge, up to which it is straight."""
PARTS = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
"""Four flat triangles of a curved one."""
CORNERS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]])
"""Barycentric coordinates of its nodes."""
SIDES = ((0, 1), (1, 2), (2, 0))


@dataclass(frozen=True)
class SurfacePoint:
    """A point of the surface."""

    place: Floats
    normal: Floats
    """Outward, of length 1."""
    face: int


@dataclass(frozen=True)
class _Flat:
    """Flat triangles, for rays."""

    triangles: Floats
    """(t, 3, 3)"""
    faces: Ints
    """(t,) the curved triangle of each."""
    middles: Floats
    squares: Floats
    """(t,) squared distances of the middles from the origin."""
    radii: Floats


@dataclass(frozen=True)
class Skin:
    """Triangles of six nodes, counter-clockwise seen from outside."""

    points: Floats
    faces: Ints
    """(k, 6)"""

    @cached_property
    def sub(self) -> Floats:
        """(4 k, 3, 3) corners of flat triangles; four of every face, one after the other."""
        return self.points[self.faces[:, PARTS]].reshape(-1, 3, 3)

    @cached_property
    def centres(self) -> Floats:
        """(k, 3) places of the faces' centres."""
        return self.place(np.full(3, 1 / 3))

    @cached_property
    def areas(self) -> Floats:
        """(k,) areas."""
        a, b, c = self.sub[:, 0], self.sub[:, 1], self.sub[:, 2]
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return np.asarray(area.reshape(-1, 4).sum(axis=1))

    def place(self, barycentric: Floats, faces: Ints | slice = slice(None)) -> Floats:
        """(k, 3) places at barycentric coordinates (3,)."""
        s = barycentric
        shape = np.array([x * (2.0 * x - 1.0) for x in s] + [4.0 * s[a] * s[b] for a, b in SIDES])
        return np.asarray(np.einsum("n,kni->ki", shape, self.points[self.faces[faces]]))

    def tangents(self, barycentric: Floats, faces: Ints | slice = slice(None)) -> Floats:
        """(k, 2, 3) derivatives of the place by the second and third coordinate."""
        by = np.zeros((6, 3))
        for corner in range(3):
            by[corner, corner] = 4.0 * barycentric[corner] - 1.0
        for node, (a, b) in enumerate(SIDES, start=3):
            by[node, a], by[node, b] = 4.0 * barycentric[b], 4.0 * barycentric[a]
        shape = by[:, 1:] - by[:, :1]
        return np.asarray(np.einsum("nc,kni->kci", shape, self.points[self.faces[faces]]))

    def normals(self, barycentric: Floats, faces: Ints | slice = slice(None)) -> Floats:
        """(k, 3) outward unit normals."""
        t = self.tangents(barycentric, faces)
        return _unit(np.cross(t[:, 0], t[:, 1]))

    @cached_property
    def _edges(self) -> tuple[Ints, Ints, Mask]:
        """Ends and middle (e, 3) of edges, the two faces (e, 2) of each, whether it is sharp.

        An edge that has not just two faces counts as sharp and has the first two.
        """
        count = self.faces.shape[0]
        ends = np.sort(np.concatenate([self.faces[:, list(side)] for side in SIDES]), axis=1)
        normals = np.concatenate([self.normals(0.5 * (CORNERS[a] + CORNERS[b])) for a, b in SIDES])
        face = np.tile(np.arange(count), 3)
        order = np.lexsort((face, ends[:, 1], ends[:, 0]))
        _, start, size = np.unique(ends[order], axis=0, return_index=True, return_counts=True)
        first = order[start]
        second = order[start + np.minimum(size, 2) - 1]
        cosine = np.einsum("ei,ei->e", normals[first], normals[second])
        sharp = (size != 2) | (cosine < math.cos(FEATURE_ANGLE))
        nodes = np.column_stack([ends, self.faces[:, 3:].T.ravel()])[first]
        return nodes, np.column_stack([face[first], face[second]]), sharp

    @cached_property
    def smooth(self) -> Ints:
        """(k,) number of the smooth face that each triangle belongs to."""
        _, faces, sharp = self._edges
        a, b = faces[~sharp].T
        count = self.faces.shape[0]
        graph = coo_matrix((np.ones(a.size), (a, b)), shape=(count, count))
        return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)

    def border(self, face: int) -> Floats:
        """(b, 3, 3) ends and middle of the sharp edges around the smooth face of a triangle."""
        nodes, faces, sharp = self._edges
        own = self.smooth == self.smooth[face]
        return np.asarray(self.points[nodes[sharp & own[faces].any(axis=1)]])

    def border_distance(self, point: SurfacePoint) -> float | None:
        """Distance from the nearest sharp edge of the smooth face; None: it has none."""
        border = self.border(point.face)
        if border.size == 0:
            return None
        halves = np.concatenate([border[:, [0, 2]], border[:, [2, 1]]])
        near = _on_segments(point.place, halves[:, 0], halves[:, 1])
        return float(np.linalg.norm(near - point.place, axis=1).min())

    def nearest(self, place: Floats, among: Mask | None = None) -> SurfacePoint:
        """The point of the surface, or of some of its faces, that is nearest to a place."""
        chosen = np.arange(self.faces.shape[0]) if among is None else np.flatnonzero(among)
        triangles = self.sub.reshape(-1, 4, 3, 3)[chosen].reshape(-1, 3, 3)
        weights = _on_triangles(place, triangles)
        near = np.einsum("kc,kci->ki", weights, triangles)
        best = int(np.argmin(((near - place) ** 2).sum(axis=1)))
        start = weights[best] @ CORNERS[list(PARTS[best % 4])]
        return self._polished(int(chosen[best // 4]), start, place)

    def _polished(self, face: int, barycentric: Floats, place: Floats) -> SurfacePoint:
        """The nearest point of the curved triangle, from that of its flat parts (Gauss-Newton)."""
        at, one = barycentric, np.array([face])
        for _ in range(8):
            t = self.tangents(at, one)[0]
            step, *_ = np.linalg.lstsq(t.T, place - self.place(at, one)[0], rcond=None)
            moved = np.clip(np.array([at[0] - step.sum(), at[1] + step[0], at[2] + step[1]]), 0, 1)
            at = moved / moved.sum()
        start = self.place(barycentric, one)[0]
        if np.linalg.norm(self.place(at, one)[0] - place) > np.linalg.norm(start - place):
            at = barycentric
        return SurfacePoint(self.place(at, one)[0], self.normals(at, one)[0], face)

    def exit(self, place: Floats, direction: Floats) -> tuple[float, int] | None:
        """Where a ray from the surface into the body leaves it: distance and triangle."""
        flat = self._flat
        # spheres around the triangles that the line meets
        along = flat.middles @ direction - place @ direction
        square = flat.squares - 2.0 * (flat.middles @ place) + place @ place
        near = np.flatnonzero(square - along**2 <= flat.radii**2 + 1e-12 * flat.squares.max())
        a, b, c = flat.triangles[near].transpose(1, 0, 2)
        u, v, s = b - a, c - a, place - a
        p, q = np.cross(direction, v), np.cross(s, u)
        det = np.einsum("ki,ki->k", u, p)
        with np.errstate(divide="ignore", invalid="ignore"):
            x = np.einsum("ki,ki->k", s, p) / det
            y = q @ direction / det
            distance = np.einsum("ki,ki->k", v, q) / det
            # a front face has a positive determinant: the ray leaves through the others
            hit = (det < 0.0) & (x >= -1e-9) & (y >= -1e-9) & (x + y <= 1.0 + 1e-9)
            hit &= distance > 1e-6 * flat.radii[near]
        if not hit.any():
            return None
        best = near[hit][np.argmin(distance[hit])]
        return float(distance[hit].min()), int(flat.faces[best])

    @cached_property
    def _flat(self) -> _Flat:
        """Flat triangles: one of a face with straight edges, four of a curved one."""
        curved = self.curved.any(axis=1)
        parts = self.sub.reshape(-1, 4, 3, 3)[curved].reshape(-1, 3, 3)
        straight = self.points[self.faces[~curved, :3]]
        triangles = np.concatenate([straight, parts])
        faces = np.concatenate([np.flatnonzero(~curved), np.repeat(np.flatnonzero(curved), 4)])
        middles = triangles.mean(axis=1)
        radii = np.linalg.norm(triangles - middles[:, None], axis=2).max(axis=1) * (1.0 + 1e-6)
        return _Flat(triangles, faces, middles, (middles**2).sum(axis=1), radii)

    @cached_property
    def curved(self) -> Mask:
        """(k, 3) whether a midside node lies off the middle of its edge."""
        a, b = self.points[self.faces[:, :3]], self.points[np.roll(self.faces[:, :3], -1, axis=1)]
        off = np.linalg.norm(self.points[self.faces[:, 3:]] - 0.5 * (a + b), axis=2)
        return np.asarray(off > STRAIGHT * np.linalg.norm(b - a, axis=2))

    def around(self, point: SurfacePoint) -> Ints:
        """Triangles at a point: those of the node that it is, else of its triangle's corners."""
        corners = self.faces[point.face, :3]
        away = np.linalg.norm(self.points[corners] - point.place, axis=1)
        size = np.linalg.norm(self.points[corners[0]] - self.points[corners[1]])
        if away.min() < 1e-6 * size:
            corners = corners[[int(np.argmin(away))]]
        return np.flatnonzero(np.isin(self.faces[:, :3], corners).any(axis=1))

    def mean_edge(self, faces: Ints) -> float:
        """Mean length of the edges of some triangles."""
        corner = self.points[self.faces[faces, :3]]
        return float(np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).mean())


def _unit(vectors: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.nan_to_num(unit)


def _on_segments(place: Floats, a: Floats, b: Floats) -> Floats:
    """(k, 3) points of segments nearest to a place."""
    along = b - a
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((place - a) * along).sum(axis=1) / square, 0.0, 1.0)
    return np.asarray(a + share[:, None] * along)


def _on_triangles(place: Floats, triangles: Floats) -> Floats:
    """(k, 3) barycentric coordinates of the points of triangles nearest to a place."""
    a, u, v = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    w = place - a
    uu, uv, vv = ((x * y).sum(axis=1) for x, y in ((u, u), (u, v), (v, v)))
    wu, wv = (w * u).sum(axis=1), (w * v).sum(axis=1)
    det = np.maximum(uu * vv - uv * uv, 1e-300)
    s, t = (vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det
    inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
    best = np.stack([1.0 - s - t, s, t], axis=1)
    distance = np.full(s.size, np.inf)
    for i, j in SIDES:
        first, along = triangles[:, i], triangles[:, j] - triangles[:, i]
        square = np.maximum((along**2).sum(axis=1), 1e-300)
        share = np.clip(((place - first) * along).sum(axis=1) / square, 0.0, 1.0)
        away = ((first + share[:, None] * along - place) ** 2).sum(axis=1)
        closer = ~inside & (away < distance)
        weights = np.zeros((s.size, 3))
        weights[:, i], weights[:, j] = 1.0 - share, share
        best[closer], distance[closer] = weights[closer], away[closer]
    return best
