"""What processes tell each other of the nodes they have in common, with prepared messages."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from mpi4py import MPI

from ..common.arrays import Floats, Ints
from . import kernel

COMPONENTS = 3
"""Of displacement per node: what is divided among processes is solid."""

Places = list[tuple[int, Ints]]
"""Other processes, each with the places of nodes in this one's vectors."""


class Exchange:
    """Vectors of some nodes to other processes, and of some from them.

    Args:
        library: the compiled kernel.
        comm: of the processes.
        sent, got: other processes, with the places of the nodes in this one's vectors; both sides
            have them in the same order.
        stride: numbers from a node's vector to the next one's.
    """

    def __init__(
        self,
        library: ctypes.CDLL,
        comm: Any,
        sent: Places,
        got: Places,
        stride: int,
    ) -> None:
        self._library, self._arrays, self._stride = library, kernel.Arrays(), stride
        self._going = [self._end(places) for _, places in sent]
        self._coming = [self._end(places) for _, places in got]
        self._requests = [
            prepare(values, rank)
            for prepare, ends, neighbours in (
                (comm.Recv_init, self._coming, got),
                (comm.Send_init, self._going, sent),
            )
            for (_, values), (rank, _) in zip(ends, neighbours, strict=True)
        ]

    def _end(self, places: Ints) -> tuple[tuple[Any, ...], Floats]:
        """Nodes as the kernel takes them, with the memory of a message."""
        values = np.zeros(COMPONENTS * places.size)
        where = self._arrays.pointer(places, np.int64)
        pointer = self._arrays.pointer(values, np.float64)
        return (self._stride, where, places.size, pointer), values

    def _pass(self, x: Any) -> None:
        for end, _ in self._going:
            self._library.pack(x, *end)
        MPI.Prequest.Startall(self._requests)
        MPI.Request.Waitall(self._requests)

    def replace(self, x: Any) -> None:
        """Take over what comes; ``x`` points to the vectors."""
        self._pass(x)
        for end, _ in self._coming:
            self._library.unpack(x, *end)

    def __del__(self) -> None:
        """Return what MPI has prepared."""
        if not MPI.Is_finalized():
            for request in self._requests:
                request.Free()


class Sum(Exchange):
    """Adds up what processes have of the nodes they share, for all of them in the same order.

    Args:
        shared: as ``sent`` and ``got`` of an exchange.
        number: of nodes in this process' vectors.
    """

    def __init__(
        self, library: ctypes.CDLL, comm: Any, shared: Places, stride: int, number: int
    ) -> None:
        super().__init__(library, comm, shared, shared, stride)
        mine = np.zeros(number, dtype=bool)
        for _, places in shared:
            mine[places] = True
        self._mine, _ = self._end(np.flatnonzero(mine))
        self._terms = [end for end, _ in self._coming]
        # Two numbers have one sum, whatever their order.
        self._ordered = len(shared) > 1
        if self._ordered:
            self._terms.insert(sum(rank < comm.rank for rank, _ in shared), self._mine)

    def __call__(self, x: Any) -> None:
        """Add; ``x`` points to the vectors."""
        self._pass(x)
        if self._ordered:
            self._library.take(x, *self._mine)
        for term in self._terms:
            self._library.put(x, *term)
