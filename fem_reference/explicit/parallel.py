"""A run in several processes: PETSc's block matrix, partitioned by dolfinx."""

from __future__ import annotations

import ctypes
from typing import Any, Protocol

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from ..common.fenicsx import petsc_vectors
from .loop import Loop
from .system import System


class DistributedSystem(System, Protocol):
    """A system whose stiffness lies in several processes."""

    def blocks(self, chosen: Mask | None) -> Any:
        """PETSc's block matrix of some elements, or of all."""


class ParallelLoop(Loop):
    """Several processes, three components."""

    def __init__(self, system: DistributedSystem, comm: Any) -> None:
        super().__init__(system, comm)
        self._blocks = system.blocks
        whole = system.blocks(None)
        self._x, self._y = petsc_vectors(whole)
        self.diagonal = np.array(whole.getDiagonal().array)
        self._parts: list[tuple[Any, Any]] = [(whole, slice(None))]
        local = np.full(system.mass.size, -1, dtype=np.int64)
        local[system.owned] = np.arange(system.owned.size)
        mine = np.flatnonzero(local[self.problem.nodes] >= 0)
        self._surface = (3 * local[self.problem.nodes[mine]][:, None] + np.arange(3)).ravel()
        self._mine = (3 * mine[:, None] + np.arange(3)).ravel()
        self._counts = np.array(comm.allgather(9 * mine.size))
        self._order = np.concatenate(comm.allgather(self._mine)).reshape(-1, 3)
        self._exchanged = np.empty(9 * self.problem.nodes.size)
        self._fixed = np.flatnonzero(self.inverse == 0.0)

    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        for matrix, _ in self._parts:
            matrix.destroy()
        self._parts = [
            (
                self._blocks(element == k),
                np.flatnonzero(np.repeat(node == k, 3)),
            )
            for k in range(count)
        ]

    def level_product(self, level: int, x: Floats) -> Floats:
        """K_l x."""
        self._x.array[:] = x
        self._parts[level][0].mult(self._x, self._y)
        return np.asarray(self._y.array).copy()

    def product(self, x: Floats) -> Floats:
        """K x."""
        result = self.level_product(0, x)
        for level in range(1, len(self.levels)):
            result += self.level_product(level, x)
        return result

    def _predict(self, step: int) -> Floats:
        """A step without contact; (3,) impulse of the supports on this process' nodes, N s."""
        u, v, reaction = self.u, self.v, np.zeros(3)
        # Slower levels come first: they still need u_n of the faster nodes.
        for level in range(len(self._parts) - 1, -1, -1):
            if step % (1 << level) == 0:
                h = self.dt * (1 << level)
                f = self.level_product(level, u)
                v -= h * self.inverse * f
                moves = self._parts[level][1]
                u[moves] += h * v[moves]
                np.add.at(reaction, self._fixed % 3, h * f[self._fixed])
        return reaction

    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""
        for step in range(steps):
            self._predict(step)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        u, v, dt, problem = self.u, self.v, self.dt, self.problem
        scale_surface = (dt * self.inverse)[self._surface]
        reaction = np.zeros(3)
        for _ in range(steps):
            before = v[self._surface]
            reaction += self._predict(problem.state.step)
            self._exchange(u[self._surface], v[self._surface], before)
            self._kernel.contact_step(ctypes.byref(problem.state))
            change = scale_surface * problem.force[self._mine]
            v[self._surface] += change
            u[self._surface] += dt * change
        reaction = self.total(reaction)
        for direction in range(3):
            problem.state.reaction[direction] += reaction[direction]

    def _exchange(self, u: Floats, v: Floats, before: Floats) -> None:
        packed = np.stack([u.reshape(-1, 3), v.reshape(-1, 3), before.reshape(-1, 3)], axis=1)
        self.comm.Allgatherv(packed.ravel(), (self._exchanged, self._counts))
        values = self._exchanged.reshape(-1, 3, 3)
        self.problem.u[self._order] = values[:, 0]
        self.problem.predicted[self._order] = values[:, 1]
        self.problem.before[self._order] = values[:, 2]
