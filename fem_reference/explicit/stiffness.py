"""What a loop needs of the stiffness of a system, however it is kept."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from ..common.arrays import Floats, Ints, Mask
from .kernel import Arrays

DOFS_PER_THREAD = 5000
"""Fewer do not pay: threads wait for each other several times a step, which with other work on the
machine takes longer than the step."""


def worthwhile(threads: int, dofs: int) -> int:
    """How many of at most so many threads a process with so many degrees of freedom has."""
    return max(1, min(threads, dofs // DOFS_PER_THREAD))


@dataclass(frozen=True)
class Divided:
    """The levels of K, each in parts for the threads.

    Attributes:
        parts: (levels * threads) as in C.
        acting: nodes on which the elements of each level act.
        size: bytes that a product with K reads of it.
    """

    parts: Sequence[ctypes.Structure]
    acting: tuple[int, ...]
    size: int


class Stiffness(Protocol):
    """K of this process' elements, at n nodes; C components of displacement per node."""

    @property
    def diagonal(self) -> Floats:
        """(C n,) of K, N/m."""

    def divided(
        self, element: Ints, node: Ints, supported: Mask, threads: int, arrays: Arrays
    ) -> Divided:
        """Divide K for the compiled loop, which reads what ``arrays`` keeps.

        Args:
            element: (m,) level of each element of the system.
            node: (n,) level of each node, that of its fastest element.
            supported: (n,) nodes with a support in some direction.
            threads: that sum one part of every level each.
            arrays: keeps what the parts point to.
        """
