"""The state of a run and how it advances: in one process (compiled), or in several (PETSc).

Both know vectors of their own nodes only; what concerns the whole system is summed over the
processes. Every process solves the contact problem with all surface nodes, redundantly.
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..fenicsx import block_matrix, petsc_rows, petsc_vectors
from ..mesh import Floats, Ints
from . import kernel
from .elasticity import Assembly, lumped_mass
from .mesh import scatter_sum
from .model import Model
from .problem import Arrays, ContactProblem


@dataclass(frozen=True)
class Energies:
    """Discrete energy (1/2 v_{n+1/2} M v_{n+1/2} + 1/2 u_n K u_{n+1}), J.

    Of the part that is modelled; central differences conserve it without contact.
    """

    elastic: tuple[float, ...]
    rigid_motion: tuple[float, ...]
    """Share of each elastic body's mean translation."""
    rigid: tuple[float, ...]

    @property
    def total(self) -> float:
        """Of all bodies, J."""
        return sum(self.elastic) + sum(self.rigid)


class Loop(ABC):
    """What serial and parallel runs have in common.

    Attributes:
        owned: (n,) nodes of this process, the model's numbering; vectors are in this order.
        mass: (n,) kg. inverse: (3 n,) 1/kg, zero where fixed.
        u, v: (3 n,) displacement, and velocity half a step later.
        diagonal: (3 n,) of K, N/m.
    """

    diagonal: Floats

    def __init__(self, model: Model, comm: Any, owned: Ints) -> None:
        self.model, self.comm, self.owned = model, comm, owned
        masses = np.concatenate(
            [lumped_mass(body.mesh, body.material.density) for body in model.elastic]
        )
        inverse = np.repeat(1.0 / masses, 3)
        for body, offset in zip(model.elastic, model.first, strict=False):
            inverse[body.fixed + 3 * offset] = 0.0
        self.all_masses, self.all_inverse = masses, inverse
        self.rows = (3 * owned[:, None] + np.arange(3)).ravel()
        self.mass = masses[owned]
        self.inverse = inverse[self.rows]
        self.body = np.searchsorted(model.first, owned, side="right") - 1
        self.u = np.zeros(3 * owned.size)
        self.v = np.zeros(3 * owned.size)
        for number, body in enumerate(model.elastic):
            self.v.reshape(-1, 3)[self.body == number] = body.velocity
        self.v[self.inverse == 0.0] = 0.0
        self.problem = ContactProblem(model, inverse, 0.0, 1)
        self._kernel = kernel.load()

    def set_step(self, time_step: float, split: int) -> None:
        """Time step, s, and how many steps of separation divide two contacts."""
        self.problem.state.dt = time_step
        for contact in self.problem.contacts:
            contact.split = split

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self.problem.state.dt)

    @abstractmethod
    def advance(self, steps: int) -> None:
        """Take a number of steps."""

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
        """(N, 3) all nodes' values in the model's numbering, in every process."""
        result = np.zeros((self.all_masses.size, 3))
        result[self.owned] = x.reshape(-1, 3)
        return self.total(result)

    def own(self, x: Floats) -> Floats:
        """This process' part (3 n,) of (N, 3)."""
        return np.ascontiguousarray(x[self.owned].ravel())

    def momenta(self) -> Floats:
        """(bodies, 3) momentum of each elastic body half a step after u, kg m/s."""
        weighted = self.mass[:, None] * self.v.reshape(-1, 3)
        count = len(self.model.elastic)
        result = np.zeros((count, 3))
        np.add.at(result, self.body, weighted)
        return self.total(result)

    def body_masses(self) -> Floats:
        """(bodies,) kg."""
        return np.add.reduceat(self.all_masses, self.model.first[:-1])

    def energies(self) -> Energies:
        """Discrete energies between u_n and u_{n+1}."""
        before = self.u - self.dt * self.v
        mass = np.repeat(self.mass, 3)
        density = 0.5 * mass * self.v**2 + 0.5 * before * self.product(self.u)
        count = len(self.model.elastic)
        each = density.reshape(-1, 3).sum(axis=1)
        elastic = self.total(scatter_sum(self.body, each, count))
        mean = (self.momenta() ** 2).sum(axis=1) / (2.0 * self.body_masses())
        rigid = [
            0.5 * r.mass * sum(x * x for x in r.v) for r in self.problem.rigids[: self.rigid_count]
        ]
        return Energies(tuple(elastic.tolist()), tuple(mean.tolist()), tuple(rigid))

    @property
    def rigid_count(self) -> int:
        """Number of rigid bodies."""
        return len(self.model.rigid)


def _upper_blocks(matrix: scipy.sparse.csr_matrix) -> scipy.sparse.bsr_matrix:
    """The 3x3 blocks on and above the diagonal, the diagonal one first in each row."""
    blocks = matrix.tobsr((3, 3))
    blocks.sort_indices()
    rows = np.repeat(np.arange(blocks.indptr.size - 1), np.diff(blocks.indptr))
    upper = blocks.indices >= rows
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows[upper]))])
    return scipy.sparse.bsr_matrix(
        (blocks.data[upper], blocks.indices[upper], indptr), shape=blocks.shape
    )


def _bandwidth_order(matrix: scipy.sparse.bsr_matrix) -> Ints:
    """Order of the nodes that keeps neighbours close in memory (reverse Cuthill-McKee)."""
    pattern = scipy.sparse.csr_matrix(
        (np.ones(matrix.indices.size, np.int8), matrix.indices, matrix.indptr),
        shape=(matrix.shape[0] // 3,) * 2,
    )
    return np.asarray(reverse_cuthill_mckee(pattern, symmetric_mode=True), dtype=np.int64)


class SerialLoop(Loop):
    """One process: half of K in 3x3 blocks, product and update in one sweep of compiled code."""

    def __init__(self, model: Model, comm: Any) -> None:
        assembly = Assembly(
            [body.mesh for body in model.elastic], [b.material for b in model.elastic], comm
        )
        matrix = petsc_rows(assembly.stiffness())
        order = _bandwidth_order(matrix.tobsr((3, 3)))
        super().__init__(model, comm, assembly.owned[order])
        rows = (3 * order[:, None] + np.arange(3)).ravel()
        self.diagonal = matrix.diagonal()[rows]
        blocks = _upper_blocks(matrix[rows][:, rows])
        arrays = Arrays()
        state = kernel.State()
        state.nodes = order.size
        state.row = arrays.pointer(blocks.indptr, np.int64)
        state.column = arrays.pointer(blocks.indices, np.int32)
        state.block = arrays.pointer(blocks.data, np.float64)
        for name in ("inverse", "u", "v"):
            setattr(state, name, arrays.pointer(getattr(self, name), np.float64))
        state.f = arrays.pointer(np.zeros(3 * order.size), np.float64)
        fixed = np.flatnonzero(self.inverse == 0.0)
        state.fixed = fixed.size
        state.fixed_dof = arrays.pointer(fixed, np.int32)
        local = np.empty(order.size, dtype=np.int64)
        local[self.owned] = np.arange(order.size)
        self.problem.state.map = arrays.pointer(local[self.problem.nodes], np.int32)
        state.problem = ctypes.pointer(self.problem.state)
        self._state, self._arrays = state, arrays

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self._kernel.advance(ctypes.byref(self._state), steps)

    def product(self, x: Floats) -> Floats:
        """K x."""
        x = np.ascontiguousarray(x)
        y = np.empty_like(x)
        pointer = ctypes.POINTER(ctypes.c_double)
        self._kernel.stiffness_product(
            ctypes.byref(self._state), x.ctypes.data_as(pointer), y.ctypes.data_as(pointer)
        )
        return y


class ParallelLoop(Loop):
    """Several processes: PETSc's block matrix, partitioned by dolfinx."""

    def __init__(self, model: Model, comm: Any) -> None:
        assembly = Assembly(
            [body.mesh for body in model.elastic], [b.material for b in model.elastic], comm
        )
        self._matrix = block_matrix(assembly.stiffness())
        self._x, self._y = petsc_vectors(self._matrix)
        self.diagonal = np.array(self._matrix.getDiagonal().array)
        super().__init__(model, comm, assembly.owned)
        local = np.full(self.all_masses.size, -1, dtype=np.int64)
        local[self.owned] = np.arange(self.owned.size)
        mine = np.flatnonzero(local[self.problem.nodes] >= 0)
        self._surface = (3 * local[self.problem.nodes[mine]][:, None] + np.arange(3)).ravel()
        self._mine = (3 * mine[:, None] + np.arange(3)).ravel()
        self._counts = np.array(comm.allgather(9 * mine.size))
        self._order = np.concatenate(comm.allgather(self._mine)).reshape(-1, 3)
        self._exchanged = np.empty(9 * self.problem.nodes.size)
        self._fixed = np.flatnonzero(self.inverse == 0.0)
        self._reaction = np.zeros(3)

    def product(self, x: Floats) -> Floats:
        """K x."""
        self._x.array[:] = x
        self._matrix.mult(self._x, self._y)
        return np.asarray(self._y.array).copy()

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        u, v, dt, problem = self.u, self.v, self.dt, self.problem
        scale = dt * self.inverse
        scale_surface = scale[self._surface]
        reaction = np.zeros(3)
        for _ in range(steps):
            before = v[self._surface]
            f = self.product(u)
            v -= scale * f
            u += dt * v
            np.add.at(reaction, self._fixed % 3, dt * f[self._fixed])
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


def make_loop(model: Model, comm: Any) -> Loop:
    """The loop for the number of processes in ``comm``."""
    return SerialLoop(model, comm) if comm.size == 1 else ParallelLoop(model, comm)
