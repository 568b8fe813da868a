"""Degenerate tetrahedra at edges of the geometry that are far shorter than the elements there.

Where two surfaces nearly meet a third one in a point, the exact geometry has an edge of some
micrometres, and no element on it can be good. Its two ends become one node.
"""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints
from .mesh import MINIMUM_QUALITY, edge_lengths, qualities

LARGEST_CHANGE = 1e-6
"""Change of the body's volume by a collapse, over the volume, that is borne."""
SHORT = 0.2
"""Length over the mean edge of the elements around it up to which an edge may collapse."""


def _volume(points: Floats, corners: Ints) -> float:
    a, b, c, d = (points[corners[:, k]] for k in range(4))
    return float(np.einsum("ij,ij->", np.cross(b - a, c - a), d - a)) / 6.0


def _without(corners: Ints, gone: int, remaining: int) -> Ints:
    """The elements when node ``gone`` becomes ``remaining``; those that had both are omitted."""
    both = (corners == gone).any(axis=1) & (corners == remaining).any(axis=1)
    remaining_elements: Ints = np.where(corners == gone, remaining, corners)[~both]
    return remaining_elements


def collapse_short_edges(points: Floats, corners: Ints) -> tuple[Floats, Ints]:
    """Merge the ends of short edges of degenerate elements while that makes the mesh better.

    What cannot be mended is left as it is. Unused points are removed.
    """
    volume = _volume(points, corners)
    while True:
        quality = qualities(points, corners)
        bad = np.flatnonzero(~(quality > MINIMUM_QUALITY))
        if bad.size == 0:
            break
        best: tuple[float, Ints] | None = None
        for element in corners[bad]:
            pairs = [(a, b) for a in element for b in element if a != b]
            for gone, remaining in pairs:
                around = corners[(corners == gone).any(axis=1)]
                length = np.linalg.norm(points[gone] - points[remaining])
                if length > SHORT * edge_lengths(points, around).mean():
                    continue
                merged = _without(corners, gone, remaining)
                least = float(qualities(points, merged).min())
                same = abs(_volume(points, merged) / volume - 1.0) <= LARGEST_CHANGE
                if same and least > quality.min() and (best is None or least > best[0]):
                    best = (least, merged)
        if best is None:
            break
        corners = best[1]
    used, inverse = np.unique(corners, return_inverse=True)
    return points[used], inverse.reshape(-1, 4)
