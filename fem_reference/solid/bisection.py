"""Local refinement of tetrahedra by bisection of longest edges (Rivara 1984).

All elements with an edge are cut there, the longest edges first, so that faces match. Nothing is
random, and what is fine enough stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from .mesh import EDGES, FACES, edge_lengths

MOST_ROUNDS = 200


def bisected(
    points: Floats,
    corners: Ints,
    sizes: Callable[[Floats], Floats],
    on_surface: Callable[[Floats], Floats],
) -> tuple[Floats, Ints]:
    """The mesh, refined until no edge is longer than it may be.

    Args:
        points: (n, 3) m.
        corners: (m, 4)
        sizes: longest edge (k,) of elements with centres (k, 3), m.
        on_surface: where new nodes (k, 3) of the surface go.
    """
    for _ in range(MOST_ROUNDS):
        too_long = edge_lengths(points, corners).max(axis=1) > sizes(points[corners].mean(axis=1))
        if not too_long.any():
            break
        points, corners = _round(points, corners, too_long, on_surface)
    return points, corners


def _pairs(corners: Ints) -> Ints:
    """(m, 6, 2) ends of the edges, the smaller number first."""
    return np.sort(np.stack([corners[:, list(edge)] for edge in EDGES], axis=1), axis=2)


def _round(
    points: Floats, corners: Ints, too_long: Mask, on_surface: Callable[[Floats], Floats]
) -> tuple[Floats, Ints]:
    edges, number = np.unique(_pairs(corners).reshape(-1, 2), axis=0, return_inverse=True)
    number = number.reshape(-1, len(EDGES))
    lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    rank = np.empty(lengths.size, dtype=np.int64)
    rank[np.lexsort((np.arange(lengths.size), lengths))] = np.arange(lengths.size)
    longest = np.take_along_axis(number, rank[number].argmax(axis=1)[:, None], axis=1)[:, 0]
    split = np.zeros(lengths.size, dtype=bool)
    split[longest[too_long]] = True
    # an element that is cut anywhere is cut at its longest edge too, which keeps it well shaped
    while True:
        more = split[number].any(axis=1) & ~split[longest]
        if not more.any():
            break
        split[longest[more]] = True
    chosen = np.flatnonzero(split)
    middles = points[edges[chosen]].mean(axis=1)
    outside = _on_the_surface(edges[chosen], corners, points.shape[0])
    if outside.any():
        middles[outside] = on_surface(middles[outside])
    made = points.shape[0] + np.arange(chosen.size)
    return np.vstack([points, middles]), _cut(corners, edges[chosen], rank[chosen], made)


def _on_the_surface(edges: Ints, corners: Ints, count: int) -> Mask:
    """Which edges are those of a face that only one element has."""
    faces = np.sort(np.concatenate([corners[:, list(face)] for face in FACES]), axis=1)
    faces, times = np.unique(faces, axis=0, return_counts=True)
    own = faces[times == 1]
    border = np.concatenate([own[:, [0, 1]], own[:, [1, 2]], own[:, [0, 2]]])
    return np.isin(edges @ [count, 1], border @ [count, 1])


def _cut(corners: Ints, edges: Ints, rank: Ints, made: Ints) -> Ints:
    """Elements cut at all these edges, those of the highest rank first; ``made``: new nodes."""
    count = int(max(corners.max(), made.max())) + 1
    keys = edges @ np.array([count, 1])
    order = np.argsort(keys)
    keys, rank, made = keys[order], rank[order], made[order]
    done = []
    while corners.size:
        own = _pairs(corners) @ np.array([count, 1])
        at = np.minimum(np.searchsorted(keys, own), keys.size - 1)
        of_edge = np.where(keys[at] == own, rank[at], -1)
        highest = of_edge.argmax(axis=1)
        rows = np.arange(corners.shape[0])
        whole = of_edge[rows, highest] < 0
        done.append(corners[whole])
        corners, highest, rows = corners[~whole], highest[~whole], rows[~whole]
        new, ends = made[at[rows, highest]], np.array(EDGES)[highest]
        halves = [corners.copy(), corners.copy()]
        for side, half in enumerate(halves):
            half[np.arange(half.shape[0]), ends[:, side]] = new
        corners = np.concatenate(halves)
    return np.concatenate(done)
