"""The state of a run and how it advances in one process; several have `parallel`.

Sub-cycling: K is the sum of the levels' K_l, and K_l acts at every 2^l-th step (see `levels`).
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from . import kernel, structures
from .levels import graded_levels, least_at_nodes
from .problem import ContactProblem
from .relaxation import Ledger, Springs
from .stiffness import Divided
from .system import System


class Loop(ABC):
    """What serial and parallel runs have in common.

    Vectors have the components of own nodes, in the order of `System.owned`; what concerns the
    whole system is summed over the processes. The first one has all surface nodes that can touch
    and alone solves the contact problem.

    Attributes:
        components: of displacement per node.
        mass: (n,) kg. inverse: (C n,) 1/kg, zero where fixed. body: (n,) number of each node's.
        u, v: (C n,) displacement, and velocity half a step later.
        springs, ledger: of bodies that relax; None: all are elastic.
        effective: (C n,) displacement that K acts on: u itself unless there are springs.
        displacement, velocity: u and v, then those of other processes' nodes at this one's
            elements.
        diagonal: (C n,) of K, N/m.
        levels: nodes that move with each level.
        divided: K as the compiled loop reads it.
        threads: among which the nodes of a process are divided. Of two components sums have
            another order for another number of them: results differ by rounding.
    """

    diagonal: Floats
    divided: Divided
    threads = 1

    def __init__(self, system: System, comm: Any) -> None:
        self.system, self.comm = system, comm
        self.components = system.points.shape[1]
        self.mass = system.mass[system.owned]
        local_nodes = np.concatenate([system.owned, system.ghosts])
        rows = (self.components * local_nodes[:, None] + np.arange(self.components)).ravel()
        own = slice(self.components * system.owned.size)
        self._inverse = system.inverse_mass[rows]
        self.rows, self.inverse = rows[own], self._inverse[own]
        self.body = np.searchsorted(system.first, system.owned, side="right") - 1
        self.displacement = self._readable(np.zeros(rows.size))
        self.velocity = np.where(self._inverse == 0.0, 0.0, system.velocity.ravel()[rows])
        self.u, self.v = self.displacement[own], self.velocity[own]
        self.springs: Springs | None = None
        self.ledger: Ledger | None = None
        self._looked = 0
        self.effective = self.u
        if any(system.relaxations):
            self.springs = Springs(system.relaxations, self.body, self.components)
            self.ledger = Ledger(self.springs)
            self.effective = self._readable(np.zeros_like(self.u))
        self.problem = ContactProblem(system)
        self._kernel = kernel.load(self.components)
        self.levels: tuple[int, ...] = (system.mass.size,)

    @staticmethod
    def _readable(x: Floats) -> Floats:
        """The same numbers with some behind them that the kernel may read with the last ones."""
        return np.asarray(np.concatenate([x, np.zeros(kernel.READ_BEYOND)])[: x.size])

    def element_levels(self, time_step: float, most: int) -> Ints:
        """(m,) level of each element for a time step (s); those that can touch have level 0."""
        system = self.system
        if most <= 1:
            return np.zeros(system.element_nodes.shape[0], dtype=np.int64)
        contact_nodes = np.zeros(system.mass.size, dtype=bool)
        contact_nodes[self.problem.nodes] = True
        for contact in system.matched:
            contact_nodes[contact.candidates] = contact_nodes[contact.opposite] = True
        if system.film is not None:
            contact_nodes[system.film.nodes] = True
        if system.plasticity is not None:
            contact_nodes[system.plasticity.nodes] = True
        steps = system.element_time_steps() / time_step
        return graded_levels(steps, system.element_nodes, contact_nodes, most)

    def set_step(self, time_step: float, split: int, most_levels: int = 1) -> None:
        """Set what a run is stepped with.

        Args:
            time_step: s.
            split: how many steps of separation divide two contacts.
            most_levels: of sub-cycling; 1: every element at every step.
        """
        self.problem.set_step(time_step, split)
        element = self.element_levels(time_step, most_levels)
        count = int(element.max()) + 1
        node = least_at_nodes(element, self.system.element_nodes, self.system.mass.size)
        if count > 1 or len(self.levels) > 1:
            self._take_levels(element, node, count)
            self.levels = tuple(np.bincount(node, minlength=count).tolist())
        if self.springs is not None:
            self._take_springs(self.springs, node[self.system.owned])

    @abstractmethod
    def _take_springs(self, springs: Springs, node: Ints) -> None:
        """Let the springs move; ``node`` (n,) has the levels of own nodes."""

    def restore_ledger(self, saved: dict[str, Floats]) -> None:
        """Continue with the state saved at a look."""
        if self.ledger is not None:
            self.ledger.restore(saved, self.u, self.product(self.u))
            self._looked = self.problem.state.step

    def strain(self) -> None:
        """Make `effective` what it is at the present displacement and extensions."""
        if self.springs is not None:
            self.effective[:] = self.springs.effective(self.u)

    @abstractmethod
    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        """Split K by the level of each element; ``node`` (N,) has the levels of the nodes."""

    @property
    def meeting(self) -> int:
        """Steps after which all levels meet."""
        return 1 << (len(self.levels) - 1)

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self.problem.state.dt)

    @property
    def is_in_contact(self) -> bool:
        """Whether any contact carried a force in the last step."""
        return any(record.force > 0.0 for record in self.problem.records())

    @abstractmethod
    def advance(self, steps: int) -> None:
        """Take a number of steps."""

    @abstractmethod
    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""

    @abstractmethod
    def drift_elastic(self, steps: int) -> None:
        """The same of bodies that do not relax."""

    @abstractmethod
    def level_product(self, level: int, x: Floats) -> Floats:
        """K_l x."""

    @abstractmethod
    def product(self, x: Floats) -> Floats:
        """K x."""

    def total(self, values: Floats) -> Floats:
        """Sum over the processes."""
        return values if self.comm.size == 1 else np.asarray(self.comm.allreduce(values))

    def dot(self, x: Floats, y: Floats) -> float:
        """Inner product."""
        return float(self.total(np.array([x @ y]))[0])

    def gather(self, x: Floats) -> Floats:
        """(N, C) all nodes' values in the system's numbering, in every process."""
        result = np.zeros((self.system.mass.size, self.components))
        result[self.system.owned] = x.reshape(-1, self.components)
        return self.total(result)

    def own(self, x: Floats) -> Floats:
        """This process' part (C n,) of (N, C)."""
        return np.ascontiguousarray(x[self.system.owned].ravel())

    def body_sums(self, values: Floats) -> Floats:
        """(bodies, ...) sums over each elastic body of values (n, ...) per own node."""
        count = self.system.first.size - 1
        columns = values.reshape(values.shape[0], -1).T
        sums = [np.bincount(self.body, column, count) for column in columns]
        stacked = np.stack(sums, axis=-1).reshape(count, *values.shape[1:])
        return self.total(np.asarray(stacked, dtype=np.float64))

    def momenta(self) -> Floats:
        """(bodies, C) momentum of each elastic body half a step after u, kg m/s."""
        return self.body_sums(self.mass[:, None] * self.v.reshape(-1, self.components))

    def body_masses(self) -> Floats:
        """(bodies,) kg."""
        return np.add.reduceat(self.system.mass, self.system.first[:-1])

    def impulse(self, x: Floats) -> Floats:
        """(C n,) what the levels take from the momenta where all meet at a displacement, N s."""
        products = (2**k * self.level_product(k, x) for k in range(len(self.levels)))
        return np.asarray(self.dt * sum(products))

    def look(self) -> None:
        """Let the ledger of what relaxes follow to this instant, at which all levels meet."""
        step = self.problem.state.step
        if self.ledger is not None and step > self._looked:
            time = (step - self._looked) * self.dt
            self.ledger.look(time, self.u, self.product(self.u))
            self._looked = step


class SerialLoop(Loop):
    """One process: the compiled loop on the stiffness of the system."""

    def __init__(self, system: System, comm: Any, threads: int = 1) -> None:
        super().__init__(system, comm)
        self.threads = threads
        self._stiffness, arrays = system.operator(), kernel.Arrays()
        self.diagonal = self._stiffness.diagonal
        state = structures.State()
        state.nodes = system.owned.size + system.ghosts.size
        state.inverse = arrays.pointer(self._inverse, np.float64)
        state.u = arrays.pointer(self.displacement, np.float64)
        state.effective = arrays.pointer(self.effective, np.float64)
        state.v = arrays.pointer(self.velocity, np.float64)
        lanes = kernel.LANES[self.components]
        state.f = arrays.pointer(np.zeros(lanes * (state.nodes + threads)), np.float64)
        state.support = arrays.pointer(np.zeros(kernel.SPACED * threads), np.float64)
        state.parts = threads
        local = np.full(system.mass.size, -1, dtype=np.int64)
        local[system.owned] = np.arange(system.owned.size)
        self.problem.state.map = arrays.pointer(local[self.problem.nodes], np.int32)
        state.problem = ctypes.pointer(self.problem.state)
        self._state, self._arrays = state, arrays
        self._divide(
            np.zeros(system.element_nodes.shape[0], dtype=np.int64),
            np.zeros(system.mass.size, dtype=np.int64),
        )

    def _divide(self, element: Ints, node: Ints) -> None:
        """Let elements (m,) act and nodes (N,) move with these levels."""
        system, arrays = self.system, kernel.Arrays()
        local_nodes = np.concatenate([system.owned, system.ghosts])
        # The supports' share of a node is its own process'.
        supported = system.supported[local_nodes] & (
            np.arange(local_nodes.size) < system.owned.size
        )
        self.divided = self._stiffness.divided(
            element, node[local_nodes], supported, self.threads, arrays
        )
        made = self.divided.parts
        parts = (structures.PARTS[self.components] * len(made))(*made)
        self._state.levels = len(made) // self.threads
        self._state.part = ctypes.cast(parts, ctypes.c_void_p)
        self._level_arrays = (parts, arrays)

    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        self._state.levels = 0
        del self._level_arrays
        self._divide(element, node)

    def _take_springs(self, springs: Springs, node: Ints) -> None:
        arrays, state = kernel.Arrays(), self._state
        groups = springs.groups(node, self.dt, arrays)
        state.relaxings, state.springs = len(groups), springs.extension.shape[1]
        state.relaxing = ctypes.cast(groups, ctypes.POINTER(structures.Relaxing))
        state.extension = arrays.pointer(springs.extension, np.float64)
        self._spring_arrays = (groups, arrays)
        self.strain()

    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""
        self._kernel.drift(ctypes.byref(self._state), 0, steps)

    def drift_elastic(self, steps: int) -> None:
        """The same of bodies that do not relax."""
        if self.springs is None:
            self.drift(steps)
            return
        state = structures.State.from_buffer_copy(self._state)
        state.relaxings, state.effective = 0, state.u
        self._kernel.drift(ctypes.byref(state), 0, steps)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self._kernel.advance(ctypes.byref(self._state), steps)

    def run(self, bodies: Any, watched: Any, samples: int, stride: int) -> Floats:
        """Advance by samples * stride steps; (samples, 8) rows as ``run`` in kernel.c has them."""
        rows = np.empty((samples, kernel.SAMPLED))
        state = ctypes.byref(self._state)
        self._kernel.run(state, bodies, watched, samples, stride, kernel.doubles(rows))
        return rows

    def level_product(self, level: int, x: Floats) -> Floats:
        """K_l x."""
        return self._product(x, level, level + 1)

    def product(self, x: Floats) -> Floats:
        """K x."""
        return self._product(x, 0, len(self.levels))

    def _product(self, x: Floats, first: int, end: int) -> Floats:
        y, x = np.empty(x.size), self._readable(x)
        state = ctypes.byref(self._state)
        self._kernel.stiffness_product(state, first, end, kernel.doubles(x), kernel.doubles(y))
        return y
