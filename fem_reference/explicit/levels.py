"""Sub-cycling: which elements act at every step, which at every second, fourth, ... one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse

from ..axisymmetric.elasticity import scatter
from ..axisymmetric.system import System
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


@dataclass(frozen=True)
class LevelMatrix:
    """The elements of one level, in the layout of ``Level`` in kernel.c."""

    nodes: Ints
    shared: int
    shared_fixed: int
    inner: int
    indptr: Ints
    columns: Ints
    blocks: Floats
    """(k, 2, 2), N/m"""
    stiffness: scipy.sparse.csr_matrix
    """(2n, 2n), N/m."""


def element_levels(system: System, time_step: float, most: int = MOST_LEVELS) -> Ints:
    """(m,) level of each element: it acts at every 2^level-th step of ``time_step`` (s).

    Elements at the contacts have level 0.
    """
    touching = np.zeros(system.mass.size, dtype=bool)
    for pairs in system.contacts:
        touching[pairs.sphere_nodes] = True
        touching[pairs.plate_nodes] = True
    steps = system.element_time_steps / time_step
    return graded_levels(steps, system.element_nodes, touching, most)


def graded_levels(steps: Floats, nodes: Ints, touching: npt.NDArray[np.bool_], most: int) -> Ints:
    """(m,) level of each element of any mesh.

    Args:
        steps: (m,) critical time steps of the elements over that of level 0.
        nodes: (m, k) of the elements.
        touching: (n,) nodes whose elements have level 0.
        most: levels.
    """
    level = np.floor(np.log2(np.maximum(LEVEL_MARGIN * steps, 1.0))).astype(np.int64)
    level = np.minimum(level, max(0, most - 1))
    level[touching[nodes].any(axis=1)] = 0
    # A level begins only `BUFFER` layers behind the elements two levels faster, and not within
    # `BUFFER` layers of an element that is too fast for it.
    for bound in range(int(level.max())):
        near = level <= bound
        for _ in range(BUFFER):
            reached = np.zeros(touching.size, dtype=bool)
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


def fastest_levels(level: Ints, nodes: Ints, count: int) -> Ints:
    """(count,) level with which each node moves: that of its fastest element."""
    fastest = np.full(count, np.iinfo(np.int64).max)
    for corner in range(nodes.shape[1]):
        np.minimum.at(fastest, nodes[:, corner], level)
    return fastest


def level_matrices(system: System, level: Ints) -> list[LevelMatrix]:
    """The stiffness of every level; their sum is the whole."""
    count = system.mass.size
    fastest = fastest_levels(level, system.element_nodes, count)
    supported = np.zeros(count, dtype=bool)
    supported[system.supports] = True
    result = []
    for number in range(int(level.max()) + 1):
        chosen = level == number
        stiffness = scatter(system.element_nodes[chosen], system.element_stiffness[chosen], count)
        touched = np.unique(system.element_nodes[chosen])
        shared = touched[fastest[touched] < number]
        own = touched[fastest[touched] == number]
        groups = [
            part[mask] for part in (shared, own) for mask in (~supported[part], supported[part])
        ]
        ends = np.cumsum([part.size for part in groups])
        result.append(_layout(stiffness, np.concatenate(groups), ends))
    return result


def _layout(stiffness: scipy.sparse.csr_matrix, nodes: Ints, ends: Ints) -> LevelMatrix:
    rows = (2 * nodes[:, None] + np.arange(2)).ravel()
    local = stiffness[rows][:, rows].tobsr((2, 2))
    local.sort_indices()
    row = np.repeat(np.arange(nodes.size), np.diff(local.indptr))
    upper = local.indices >= row
    indptr = np.concatenate([[0], np.cumsum(np.bincount(row[upper], minlength=nodes.size))])
    columns = nodes[local.indices[upper]]
    shared_fixed, shared, inner = (int(end) for end in ends[:3])
    blocks = local.data[upper]
    return LevelMatrix(nodes, shared, shared_fixed, inner, indptr, columns, blocks, stiffness)
