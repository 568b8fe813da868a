"""K as the compiled loop of three components reads it: tetrahedra by fours, no matrix."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from . import kernel, structures
from .stiffness import Divided

LANES = 4
"""Elements at once."""


@dataclass(frozen=True)
class Tetrahedra:
    """The elements at this process' nodes, with straight edges, linear or quadratic.

    Forces on a node are added in their order: where all processes have the same order, the same
    bits are found by any number of threads and processes.

    Attributes:
        nodes: (e, 4 or 10) numbers from 0 on, this process' own first.
        gradients: (e, 3, 3) of the barycentric coordinates 1, 2, 3, 1/m.
        lame, shear: (e,) Lame's constants times what `elements.c` has of the volume, N m.
        element: (e,) number of each in the system.
        diagonal: (3 n,) of K, N/m; of own nodes.
    """

    nodes: Ints
    gradients: Floats
    lame: Floats
    shear: Floats
    element: Ints
    diagonal: Floats

    def divided(
        self, element: Ints, node: Ints, held: Mask, threads: int, arrays: kernel.Arrays
    ) -> Divided:
        """See `explicit.stiffness.Stiffness`."""
        level = element[self.element]
        levels = range(int(element.max()) + 1)
        ends = self._ends(0.5**level, node.size, threads)
        parts = [
            self._part(level == number, node == number, held, begin, end, arrays)
            for number in levels
            for begin, end in pairwise(ends)
        ]
        acting = [np.unique(self.nodes[level == number]) for number in levels]
        size = (8 * 11 + 4 * self.nodes.shape[1]) * LANES
        return Divided(
            parts,
            tuple(int(np.count_nonzero(nodes < node.size)) for nodes in acting),
            size * sum(int(part.fours) for part in parts),
        )

    def _ends(self, work: Floats, nodes: int, threads: int) -> list[int]:
        """Stretches of the own nodes with as much work of their elements each."""
        size = self.nodes.shape[1]
        at_node = np.bincount(self.nodes.ravel(), np.repeat(work, size), nodes)[:nodes]
        done = np.cumsum(at_node)
        inner = np.searchsorted(done, done[-1] * np.arange(1, threads) / threads)
        return [0, *inner.tolist(), nodes]

    def _part(
        self, acts: Mask, moves: Mask, held: Mask, begin: int, end: int, arrays: kernel.Arrays
    ) -> structures.ElementPart:
        inside = (self.nodes >= begin) & (self.nodes < end)
        chosen = np.flatnonzero(acts & inside.any(axis=1))
        made = structures.ElementPart()
        made.begin, made.end, made.size = begin, end, self.nodes.shape[1]
        made.fours = -(-chosen.size // LANES)
        filled = made.fours * LANES - chosen.size
        # the last four is filled up with copies of an element that have no stiffness
        which = np.concatenate([chosen, np.repeat(chosen[-1:], filled)])
        numbers = np.empty((which.size, 11))
        numbers[:, :9] = self.gradients[which].reshape(-1, 9)
        numbers[:, 9], numbers[:, 10] = self.lame[which], self.shear[which]
        numbers[chosen.size :, 9:] = 0.0
        made.element = arrays.pointer(_by_fours(numbers), np.float64)
        made.node = arrays.pointer(_by_fours(self.nodes[which]), np.int32)
        moving = begin + np.flatnonzero(moves[begin:end])
        free, fixed = moving[~held[moving]], moving[held[moving]]
        made.free, made.moving = free.size, moving.size
        made.moves = arrays.pointer(np.concatenate([free, fixed]), np.int32)
        return made


def _by_fours(rows: Floats | Ints) -> Floats | Ints:
    """(fours, columns, 4) of (4 fours, columns)."""
    return np.asarray(rows.reshape(-1, LANES, rows.shape[1]).transpose(0, 2, 1))
