"""K as the compiled loop of three components reads it: tetrahedra by fours, no matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from . import kernel, structures
from .stiffness import Divided

LANES = 4
"""Elements at once."""


@dataclass(frozen=True)
class Tetrahedra:
    """The elements of a process, with straight edges, linear or quadratic.

    Forces on a node are added in their order: any number of threads finds the same bits.

    Attributes:
        nodes: (e, 4 or 10) numbers from 0 on.
        gradients: (e, 3, 3) of the barycentric coordinates 1, 2, 3, 1/m.
        lame, shear: (e,) Lame's constants times what `elements.c` has of the volume, N m.
        element: (e,) number of each in the system.
        diagonal: (3 n,) of K, N/m.
    """

    nodes: Ints
    gradients: Floats
    lame: Floats
    shear: Floats
    element: Ints
    diagonal: Floats

    def divided(
        self, element: Ints, node: Ints, supported: Mask, threads: int, arrays: kernel.Arrays
    ) -> Divided:
        """See `explicit.stiffness.Stiffness`."""
        level = element[self.element]
        levels = range(int(element.max()) + 1)
        part = self._shares(node, threads)
        shared = arrays.pointer(part, np.int32)
        parts = []
        for number in levels:
            moves = node == number
            groups = [np.flatnonzero(moves & ~supported), np.flatnonzero(moves & supported)]
            for q in range(threads):
                made = self._part(level == number, part == q, arrays)
                made.number, made.part = q, shared
                free, fixed = (group[part[group] == q] for group in groups)
                made.free, made.moving = free.size, free.size + fixed.size
                made.moves = arrays.pointer(np.concatenate([free, fixed]), np.int32)
                parts.append(made)
        acting = [np.unique(self.nodes[level == number]) for number in levels]
        size = (8 * 11 + 4 * self.nodes.shape[1]) * LANES
        return Divided(
            parts,
            tuple(nodes.size for nodes in acting),
            size * sum(int(part.fours) for part in parts),
        )

    def _shares(self, node: Ints, threads: int) -> Ints:
        """(n,) part of each node: stretches of each level with as much work."""
        part = np.zeros(node.size, dtype=np.int64)
        work = np.bincount(self.nodes.ravel(), minlength=node.size)
        for level in range(int(node.max()) + 1):
            nodes = np.flatnonzero(node == level)
            middle = np.cumsum(work[nodes]) - 0.5 * work[nodes]
            part[nodes] = threads * middle / max(1, work[nodes].sum())
        return part

    def _part(self, acts: Mask, inside: Mask, arrays: kernel.Arrays) -> structures.ElementPart:
        """The elements that act on nodes ``inside``, by fours."""
        chosen = np.flatnonzero(acts & inside[self.nodes].any(axis=1))
        made = structures.ElementPart()
        made.size, made.fours = self.nodes.shape[1], -(-chosen.size // LANES)
        # the last four is filled up with copies of an element that have no stiffness
        which = np.concatenate([chosen, np.repeat(chosen[-1:], made.fours * LANES - chosen.size)])
        numbers = np.empty((which.size, 11))
        numbers[:, :9] = self.gradients[which].reshape(-1, 9)
        numbers[:, 9], numbers[:, 10] = self.lame[which], self.shear[which]
        numbers[chosen.size :, 9:] = 0.0
        made.element = arrays.pointer(_by_fours(numbers), np.float64)
        made.node = arrays.pointer(_by_fours(self.nodes[which]), np.int32)
        return made


def _by_fours(rows: Floats | Ints) -> Floats | Ints:
    """(fours, columns, 4) of (4 fours, columns)."""
    fours: Floats | Ints = rows.reshape(-1, LANES, rows.shape[1]).transpose(0, 2, 1)
    return fours
