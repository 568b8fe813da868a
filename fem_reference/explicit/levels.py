"""Sub-cycling: which elements act at every step, which at every second, fourth, ... one."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..common.arrays import Floats, Ints

LEVEL_MARGIN = 0.7
"""Time step of a level over the critical one of its elements, at most.

Impulses of a level can resonate with vibrations of the faster elements at half the level's
frequency (Fong, Darve & Lew 2008, J. Comput. Phys. 227, 8367). Where the elements next to the
interface are as slow as this, they do not carry such vibrations, which die out within
`BUFFER` layers.
"""

BUFFER = 2
"""Layers of elements on each side of an interface in which the level does not change again."""

MOST_LEVELS = 5


def graded_levels(
    steps: Floats, nodes: Ints, contact_nodes: npt.NDArray[np.bool_], most: int
) -> Ints:
    """(m,) level of each element of any mesh.

    Args:
        steps: (m,) critical time steps of the elements over that of level 0.
        nodes: (m, k) of the elements.
        contact_nodes: (n,) nodes whose elements have level 0.
        most: levels.
    """
    octaves = np.floor(np.log2(np.maximum(LEVEL_MARGIN * steps, 1.0)))
    level = np.minimum(octaves, max(0, most - 1)).astype(np.int64)
    level[contact_nodes[nodes].any(axis=1)] = 0
    # A level begins only `BUFFER` layers behind the elements two levels faster, and not within
    # `BUFFER` layers of an element that is too fast for it.
    for bound in range(int(level.max())):
        near = level <= bound
        for _ in range(BUFFER):
            reached = np.zeros(contact_nodes.size, dtype=bool)
            reached[nodes[near]] = True
            near = reached[nodes].any(axis=1)
        level[near & (level > bound + 1)] = bound + 1
    used = np.unique(level)
    # Without a gap in the numbers: a level that no element has would only cost time.
    return level if used.size == used[-1] + 1 else _fill(level)


def _fill(level: Ints) -> Ints:
    """Lower levels until every one up to the highest occurs."""
    while True:
        used = np.unique(level)
        gaps = np.setdiff1d(np.arange(used[-1] + 1), used)
        if gaps.size == 0:
            return level
        level = np.where(level > gaps[0], level - 1, level)


def least_at_nodes(values: Ints, nodes: Ints, count: int) -> Ints:
    """(count,) least of the values (m,) of the elements at each node: of levels, the fastest."""
    least = np.full(count, np.iinfo(np.int64).max)
    for corner in range(nodes.shape[1]):
        np.minimum.at(least, nodes[:, corner], values)
    return least
