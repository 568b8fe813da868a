"""A run in several processes: each steps its own nodes and tells its neighbours of them."""

from __future__ import annotations

import ctypes
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from . import kernel, structures
from .loop import SerialLoop
from .problem import ContactProblem
from .relaxation import Springs
from .system import System

FIRST = 0
"""The process that owns all nodes that can touch."""


class DistributedSystem(System, Protocol):
    """A system whose nodes lie in several processes."""

    @property
    def owner(self) -> Ints:
        """(N,) process of each node."""


class Exchange:
    """Values of some nodes, from the processes that own them to those that read them.

    Args:
        library: the compiled kernel.
        comm: of the processes.
        tag: of the messages.
        partners: other processes, with the places in this one's vectors of what goes there and of
            what comes from there; both sides have the nodes in the same order.
        components: values per node.
    """

    def __init__(
        self,
        library: ctypes.CDLL,
        comm: Any,
        tag: int,
        partners: list[tuple[int, Ints, Ints]],
        components: int,
    ) -> None:
        self._library, self._arrays = library, kernel.Arrays()
        self._going: list[tuple[Any, ...]] = []
        self._coming: list[tuple[Any, ...]] = []
        self._requests: list[Any] = []
        for rank, sent, got in partners:
            for places, ends, prepare in (
                (got, self._coming, comm.Recv_init),
                (sent, self._going, comm.Send_init),
            ):
                values = np.zeros(components * places.size)
                where = self._arrays.pointer(places, np.int64)
                ends.append((where, places.size, self._arrays.pointer(values, np.float64)))
                self._requests.append(prepare(values, rank, tag))

    def __call__(self, x: Any) -> None:
        """Send and take over; ``x`` points to the components of own and others' nodes."""
        for end in self._going:
            self._library.pack(x, *end)
        MPI.Prequest.Startall(self._requests)
        MPI.Request.Waitall(self._requests)
        for end in self._coming:
            self._library.unpack(x, *end)

    def free(self) -> None:
        """Give back what MPI has prepared."""
        for request in self._requests:
            request.Free()
        self._requests = []


class ParallelLoop(SerialLoop):
    """Several processes: each has all elements at its own nodes.

    At the end of each step a node that moved is sent to the processes that read it, once, whatever
    the levels: those that act in the same step do not read what slower ones moved. Nodes that can
    touch are all the first process', which alone solves their problem.
    """

    def __init__(self, system: DistributedSystem, comm: Any, threads: int = 1) -> None:
        super().__init__(system, comm, threads)
        self._owner = system.owner
        if comm.rank != FIRST:
            self._idle = structures.Problem()
            self._state.problem = ctypes.pointer(self._idle)
        self._told = _told(self.problem)
        self._exchanges: list[Exchange] = []
        self._meet(np.zeros(system.mass.size, dtype=np.int64), 1)

    def _meet(self, node: Ints, count: int) -> None:
        """Prepare an exchange of all nodes that move with each level, or a faster one."""
        for exchange in self._exchanges:
            exchange.free()
        elements, rank = self.system.element_nodes, self.comm.rank
        place = np.full(node.size, -1, dtype=np.int64)
        kept = np.concatenate([self.system.owned, self.system.ghosts])
        place[kept] = np.arange(kept.size)
        processes = self._owner[elements]
        read = [np.unique(elements[(processes == p).any(axis=1)]) for p in range(self.comm.size)]

        def partners(level: int) -> list[tuple[int, Ints, Ints]]:
            moving = [nodes[node[nodes] <= level] for nodes in read]
            both = [
                (p, moving[p][self._owner[moving[p]] == rank], mine)
                for p in range(self.comm.size)
                for mine in [moving[rank][self._owner[moving[rank]] == p]]
                if p != rank
            ]
            return [(p, place[sent], place[got]) for p, sent, got in both if sent.size + got.size]

        self._exchanges = [
            Exchange(self._kernel, self.comm, level, partners(level), self.components)
            for level in range(count)
        ]

    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        super()._take_levels(element, node, count)
        self._meet(node, count)

    def _take_springs(self, springs: Springs, node: Ints) -> None:
        raise SolverError("materials that relax are for one process: run without --np")

    def _read(self, x: Floats) -> Floats:
        """(C n,) with the other processes' nodes that own rows read, of all levels."""
        values = self._readable(np.zeros(self.displacement.size))
        values[: x.size] = x
        self._exchanges[-1](kernel.doubles(values))
        return values

    def _moved(self, step: int) -> Exchange:
        """The exchange of what moves in a step."""
        slowest = len(self._exchanges) - 1
        while step % (1 << slowest):
            slowest -= 1
        return self._exchanges[slowest]

    def _begin(self) -> Any:
        """Take over what was changed from outside; this process' problem."""
        self.displacement[:] = self._read(self.u)
        problem = self._state.problem.contents
        problem.dt, problem.step = self.dt, self.problem.state.step
        return problem

    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""
        self._begin()
        state, u = ctypes.byref(self._state), kernel.doubles(self.displacement)
        for step in range(steps):
            self._kernel.drift(state, step, 1)
            self._moved(step)(u)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        first = self._begin().step
        state, u = ctypes.byref(self._state), kernel.doubles(self.displacement)
        for step in range(first, first + steps):
            self._kernel.advance(state, 1)
            self._moved(step)(u)
        self._tell()

    def _tell(self) -> None:
        """Tell all processes what the first one's problem has come to, supports of all included."""
        reaction = np.zeros(3)
        if self.comm.rank != FIRST:
            reaction[:] = self._idle.reaction
            self._idle.reaction[:] = [0.0, 0.0, 0.0]
        reaction = self.total(reaction) + np.array(self.problem.state.reaction)
        self.problem.state.reaction[:] = reaction.tolist()
        message = np.concatenate(self._told)
        self.comm.Bcast(message, FIRST)
        start = 0
        for part in self._told:
            part[:] = message[start : start + part.size]
            start += part.size


def _told(problem: ContactProblem) -> list[npt.NDArray[np.uint8]]:
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
