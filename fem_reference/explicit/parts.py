"""K as the compiled loop of two components reads it: half of it, in parts for threads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse

from ..common.arrays import Floats, Ints, Mask
from . import kernel, structures
from .stiffness import Divided

PADDING = 2
"""Numbers after the last block: the rows of a 3x3 block are read by fours."""


@dataclass(frozen=True)
class Rows:
    """The stiffness of a system in one process, as sparse rows.

    Attributes:
        part: K of some elements (m,), or of all.
        diagonal: (C n,) of K, N/m.
        components: C.
    """

    part: Callable[[Mask | None], scipy.sparse.csr_matrix]
    diagonal: Floats
    components: int

    @staticmethod
    def of(part: Callable[[Mask | None], scipy.sparse.csr_matrix], components: int) -> Rows:
        """From what gives the rows, components C node + direction."""
        return Rows(part, part(None).diagonal(), components)

    def divided(
        self, element: Ints, node: Ints, supported: Mask, threads: int, arrays: kernel.Arrays
    ) -> Divided:
        """See `explicit.stiffness.Stiffness`."""
        levels = int(element.max()) + 1
        parts: list[structures.RowPart] = []
        for level in range(levels):
            matrix = self.part(None if levels == 1 else element == level)
            blocks = Blocks.of(matrix, self.components, node == level, supported)
            parts += level_parts(blocks, threads, arrays)
        rows = np.reshape([int(part.rows) for part in parts], (levels, threads)).sum(axis=1)
        blocks_stored = sum(int(part.row[part.rows] + part.outer[part.border]) for part in parts)
        size = self.components**2 * 8 + 4
        return Divided(list(parts), tuple(rows.tolist()), blocks_stored * size)


@dataclass(frozen=True)
class Blocks:
    """The blocks of K_l that are not zero, and what its nodes do.

    Attributes:
        row, column: (k,) nodes; columns from ``moves.size`` on are other processes' nodes.
        data: (k, C, C) N/m.
        moves, held: (n,) nodes that move with the level, and those that are held somewhere.
    """

    row: Ints
    column: Ints
    data: Floats
    moves: Mask
    supported: Mask

    @staticmethod
    def of(matrix: scipy.sparse.csr_matrix, size: int, moves: Mask, supported: Mask) -> Blocks:
        """From the rows of this process' nodes, ``size`` components each."""
        blocks = matrix.tobsr((size, size))
        row = np.repeat(np.arange(blocks.indptr.size - 1), np.diff(blocks.indptr))
        return Blocks(row, blocks.indices.astype(np.int64), blocks.data, moves, supported)

    def divided(self, parts: int) -> Ints:
        """Part of each node: stretches of the numbering with as many blocks; -1: another process.

        Neighbours have numbers close to each other, so that few blocks lie between two parts.
        """
        nodes = self.moves.size
        count = np.bincount(self.row, minlength=nodes)
        middle = np.cumsum(count) - 0.5 * count
        part = (parts * middle / max(1, self.row.size)).astype(np.int64)
        others = np.full(max(0, int(self.column.max(initial=-1)) + 1 - nodes), -1)
        return np.concatenate([part, others])


def level_parts(blocks: Blocks, parts: int, arrays: kernel.Arrays) -> list[structures.RowPart]:
    """The parts of a level for so many threads."""
    part = blocks.divided(parts)
    crossing = part[blocks.row] != part[blocks.column]
    border = np.zeros(part.size, dtype=bool)
    border[blocks.row[crossing]] = True
    return [_part(blocks, part == number, border, crossing, arrays) for number in range(parts)]


def _part(
    blocks: Blocks, inside: Mask, border: Mask, crossing: Mask, arrays: kernel.Arrays
) -> structures.RowPart:
    """The part of the nodes ``inside``; ``crossing`` are the blocks between two parts."""
    present = np.zeros(inside.size, dtype=bool)
    present[blocks.row] = True
    reached = np.flatnonzero(present & inside)
    edge, inner = reached[border[reached]], reached[~border[reached]]
    groups = [edge[blocks.moves[edge] == moving] for moving in (False, True)] + [
        inner[(blocks.moves[inner] == moving) & (blocks.supported[inner] == hold)]
        for moving in (False, True)
        for hold in (False, True)
    ]
    nodes = np.concatenate(groups)
    place = np.full(inside.size, -1)
    place[nodes] = np.arange(nodes.size)
    mine = place[blocks.row] >= 0
    made = structures.RowPart()
    ends = np.cumsum([group.size for group in groups]).tolist()
    made.border_shared, made.border, made.shared_free, made.shared, made.free, made.rows = ends
    made.node = arrays.pointer(nodes, np.int32)
    upper = mine & ~crossing & (place[blocks.column] >= place[blocks.row])
    made.row, made.column, made.block = _rows(blocks, upper, place, nodes.size, arrays)
    made.outer, made.outer_column, made.outer_block = _rows(
        blocks, mine & crossing, place, edge.size, arrays
    )
    return made


def _rows(
    blocks: Blocks, chosen: Mask, place: Ints, rows: int, arrays: kernel.Arrays
) -> tuple[object, object, object]:
    """Begin of each row, columns and numbers of the blocks ``chosen``, ordered by ``place``."""
    which = np.flatnonzero(chosen)
    order = which[np.lexsort((place[blocks.column[which]], place[blocks.row[which]]))]
    begin = np.zeros(rows + 1, dtype=np.int64)
    np.cumsum(np.bincount(place[blocks.row[order]], minlength=rows), out=begin[1:])
    numbers = np.empty(blocks.data[0].size * order.size + PADDING)
    # Vectors of two components take the columns of a block.
    data = blocks.data.transpose(0, 2, 1) if blocks.data.shape[1] == 2 else blocks.data
    numbers[:-PADDING] = data[order].ravel()
    numbers[-PADDING:] = 0.0
    return (
        arrays.pointer(begin, np.int64),
        arrays.pointer(blocks.column[order], np.int32),
        arrays.pointer(numbers, np.float64),
    )
