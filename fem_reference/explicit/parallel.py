"""A run in several processes: each has elements of its own, and nodes in common with others."""

from __future__ import annotations

import ctypes
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ..common.arrays import Floats, Ints, Mask
from ..common.errors import SolverError
from . import kernel, structures
from .exchange import COMPONENTS, Exchange, Sum
from .levels import least_at_nodes
from .loop import SerialLoop
from .problem import ContactProblem
from .relaxation import Springs
from .system import System

FIRST = 0
"""The process that owns all nodes that can touch."""


class DistributedSystem(System, Protocol):
    """A system whose elements lie in several processes."""

    @property
    def element_owner(self) -> Ints:
        """(m,) process of each element."""


class ParallelLoop(SerialLoop):
    """Several processes: each has elements of its own and moves all nodes at them.

    In each step they tell each other the forces on the nodes they share, once, whatever the
    levels: those that act in the same step do not read what slower ones moved. All move a shared
    node by the same sum, to the same bits; it belongs to the first of them. Nodes that can touch
    are not shared: all their elements are the first process', which alone solves their problem.
    """

    def __init__(self, system: DistributedSystem, comm: Any, threads: int = 1) -> None:
        super().__init__(system, comm, threads)
        if comm.rank != FIRST:
            self._idle = structures.Problem()
            self._state.problem = ctypes.pointer(self._idle)
        self._broadcast_memory = _broadcast_memory(self.problem)
        count = system.mass.size
        self._present = [np.zeros(count, dtype=bool) for _ in range(comm.size)]
        for rank, present in enumerate(self._present):
            present[system.element_nodes[system.element_owner == rank]] = True
        self._owner = least_at_nodes(system.element_owner, system.element_nodes, count)
        self._sums: list[Sum] = []
        self._meet(np.zeros(count, dtype=np.int64), 1)
        self._copies = self._copied()
        self._product_sum = self._sum(np.ones(count, dtype=bool), COMPONENTS)
        diagonal = self._stiffness.diagonal.copy()
        self._product_sum(kernel.doubles(diagonal))
        self.diagonal = diagonal[: self.u.size]

    def _place(self) -> Ints:
        """(N,) place of each node in this process' vectors, -1: none."""
        place = np.full(self.system.mass.size, -1, dtype=np.int64)
        local_nodes = np.concatenate([self.system.owned, self.system.ghosts])
        place[local_nodes] = np.arange(local_nodes.size)
        return place

    def _sum(self, moves: Mask, stride: int) -> Sum:
        """The sum at those of the shared nodes that move (N,)."""
        place, mine = self._place(), self._present[self.comm.rank] & moves
        shared = [
            (rank, place[np.flatnonzero(mine & present)])
            for rank, present in enumerate(self._present)
            if rank != self.comm.rank
        ]
        used = [(rank, places) for rank, places in shared if places.size]
        number = self.system.owned.size + self.system.ghosts.size
        return Sum(self._kernel, self.comm, used, stride, number)

    def _copied(self) -> Exchange:
        """Values of shared nodes from the processes to which they belong."""
        place, here = self._place(), self.comm.rank
        others = [rank for rank in range(self.comm.size) if rank != here]
        sent = [
            (rank, place[np.flatnonzero(self._present[rank] & (self._owner == here))])
            for rank in others
        ]
        got = [
            (rank, place[np.flatnonzero(self._present[here] & (self._owner == rank))])
            for rank in others
        ]
        going, coming = ([end for end in ends if end[1].size] for ends in (sent, got))
        return Exchange(self._kernel, self.comm, going, coming, COMPONENTS)

    def _meet(self, node: Ints, count: int) -> None:
        """Prepare the sums at nodes that move with each level, or a faster one."""
        stride = kernel.LANES[COMPONENTS]
        self._sums = [self._sum(node <= level, stride) for level in range(count)]

    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        super()._take_levels(element, node, count)
        self._meet(node, count)

    def _take_springs(self, springs: Springs, node: Ints) -> None:
        raise SolverError("materials that relax are for one process: run without --np")

    def _product(self, x: Floats, first: int, end: int) -> Floats:
        values = np.zeros(self.displacement.size)
        values[: x.size] = x
        self._copies.replace(kernel.doubles(values))
        y = super()._product(values, first, end)
        self._product_sum(kernel.doubles(y))
        return y[: x.size]

    def _summed(self, step: int) -> Sum:
        """Of the nodes that move in a step."""
        slowest = len(self._sums) - 1
        while step % (1 << slowest):
            slowest -= 1
        return self._sums[slowest]

    def _begin(self) -> Any:
        """Take over what was changed from outside; this process' problem."""
        self._copies.replace(kernel.doubles(self.displacement))
        self._copies.replace(kernel.doubles(self.velocity))
        problem = self._state.problem.contents
        problem.dt, problem.step = self.dt, self.problem.state.step
        return problem

    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""
        self._begin()
        library, state, f = self._kernel, ctypes.byref(self._state), self._state.f
        for step in range(steps):
            library.process_acts(state, step)
            self._summed(step)(f)
            library.process_drifts(state, step)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        first = self._begin().step
        library, state, f = self._kernel, ctypes.byref(self._state), self._state.f
        for step in range(first, first + steps):
            library.process_acts(state, step)
            self._summed(step)(f)
            library.process_follows(state)
        self._send_state()

    def _send_state(self) -> None:
        """Tell all processes what the first one's problem has come to, supports of all included."""
        reaction = np.zeros(3)
        if self.comm.rank != FIRST:
            reaction[:] = self._idle.reaction
            self._idle.reaction[:] = [0.0, 0.0, 0.0]
        reaction = self.total(reaction) + np.array(self.problem.state.reaction)
        self.problem.state.reaction[:] = reaction.tolist()
        message = np.concatenate(self._broadcast_memory)
        self.comm.Bcast(message, FIRST)
        start = 0
        for part in self._broadcast_memory:
            part[:] = message[start : start + part.size]
            start += part.size


def _broadcast_memory(problem: ContactProblem) -> list[npt.NDArray[np.uint8]]:
    """Memory of all numbers of a problem that steps change and that runs look at."""

    def memory(structure: ctypes.Structure, start: int) -> npt.NDArray[np.uint8]:
        size = ctypes.sizeof(structure) - start
        found = (ctypes.c_uint8 * size).from_address(ctypes.addressof(structure) + start)
        return np.ctypeslib.as_array(found)

    state = problem.state
    return [
        memory(state, structures.Problem.step.offset),
        *(memory(rigid, 0) for rigid in problem.rigids[: state.rigids]),
        *(
            memory(contact, structures.Contact.rubbed.offset)
            for contact in problem.contacts[: state.contacts]
        ),
    ]
