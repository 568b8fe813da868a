"""The state of a run and how it advances: in one process (compiled), or in several (PETSc).

Sub-cycling: K is the sum of the levels' K_l, and K_l acts at every 2^l-th step (see `levels`).

Both know vectors of their own nodes only; what concerns the whole system is summed over the
processes. Every process solves the contact problem with all surface nodes, redundantly.
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..common.arrays import Floats, Ints
from ..common.fenicsx import block_matrix, block_rows, petsc_rows, petsc_vectors
from ..explicit.problem import Arrays, ContactProblem
from . import kernel
from .elasticity import Assembly, lumped_mass
from .levels import model_levels
from .mesh import scatter_sum
from .model import Model

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Energies:
    """Discrete energy of the part that is modelled, J.

    1/2 w M w + 1/2 u_n K' u_{n+1}, w = (u_{n+1} - u_n)/D, with the step D at whose ends all levels
    meet and u_{n+1} - 2 u_n + u_{n-1} = -D^2 M^-1 K' u_n. With one level K' = K, and the loop
    without contact conserves it. With several, K' is close to K and nearly symmetric for what is
    slower than D: 1e-6 is missed in a run, 1 % with white noise.
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
        self.levels: tuple[int, ...] = (masses.size,)

    def set_step(self, time_step: float, split: int, most_levels: int = 1) -> None:
        """Set what a run is stepped with.

        Args:
            time_step: s.
            split: how many steps of separation divide two contacts.
            most_levels: of sub-cycling; 1: every element at every step.
        """
        self.problem.state.dt = time_step
        for contact in self.problem.contacts:
            contact.split = split
        element, node = model_levels(self.model, self.problem.nodes, time_step, most_levels)
        count = int(element.max()) + 1
        if count == 1 == len(self.levels):
            return
        self._take_levels(element, node[self.owned], count)
        self.levels = tuple(np.bincount(node, minlength=count).tolist())

    @abstractmethod
    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        """Split K by the level of each element; ``node`` (n,) has the levels of own nodes."""

    @property
    def meeting(self) -> int:
        """Steps after which all levels meet."""
        return 1 << (len(self.levels) - 1)

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self.problem.state.dt)

    @abstractmethod
    def advance(self, steps: int) -> None:
        """Take a number of steps."""

    @abstractmethod
    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""

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
        sums = [scatter_sum(self.body, weighted[:, axis], count) for axis in range(3)]
        return self.total(np.stack(sums, axis=1))

    def body_masses(self) -> Floats:
        """(bodies,) kg."""
        return np.add.reduceat(self.all_masses, self.model.first[:-1])

    def energies(self) -> Energies:
        """Discrete energies at an instant at which all levels meet."""
        if self.meeting == 1:
            other, velocity, force = self.u - self.dt * self.v, self.v, self.product(self.u)
        else:
            other, velocity, force = self._long_step()
        mass = np.repeat(self.mass, 3)
        density = 0.5 * mass * velocity**2 + 0.5 * other * force
        count = len(self.model.elastic)
        each = density.reshape(-1, 3).sum(axis=1)
        elastic = self.total(scatter_sum(self.body, each, count))
        mean = (self.momenta() ** 2).sum(axis=1) / (2.0 * self.body_masses())
        rigid = [
            0.5 * r.mass * sum(x * x for x in r.v) for r in self.problem.rigids[: self.rigid_count]
        ]
        return Energies(tuple(elastic.tolist()), tuple(mean.tolist()), tuple(rigid))

    def _long_step(self) -> tuple[Floats, Floats, Floats]:
        """u_{n+1}, w and K' u_n of `Energies`, without contact; the state stays as it is."""
        now, velocity = self.u.copy(), self.v.copy()
        long_step = self.meeting * self.dt
        self.drift(self.meeting)
        following = self.u.copy()
        # One step from rest leads to (u_{n+1} + u_{n-1}) / 2: half the impulses, which the step
        # itself gives in full.
        self.u[:], self.v[:] = now, 0.0
        for level in range(len(self.levels)):
            impulse = 0.5 * 2**level * self.dt * self.level_product(level, now)
            self.v += self.inverse * impulse
        self.drift(self.meeting)
        force = 2.0 * np.repeat(self.mass, 3) * (now - self.u) / long_step**2
        self.u[:], self.v[:] = now, velocity
        return following, (following - now) / long_step, force

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


def _level(matrix: scipy.sparse.csr_matrix, moves: Mask, arrays: Arrays) -> kernel.Level:
    """A level from its stiffness, all nodes, and a mask of the nodes that move with it."""
    touched = np.flatnonzero(np.diff(matrix.indptr)[::3])
    nodes = np.concatenate([touched[~moves[touched]], touched[moves[touched]]])
    rows = (3 * nodes[:, None] + np.arange(3)).ravel()
    blocks = _upper_blocks(matrix[rows][:, rows])
    level = kernel.Level()
    level.shared, level.rows = np.count_nonzero(~moves[touched]), nodes.size
    level.node = arrays.pointer(nodes, np.int32)
    level.row = arrays.pointer(blocks.indptr, np.int64)
    level.column = arrays.pointer(nodes[blocks.indices], np.int32)
    level.block = arrays.pointer(blocks.data, np.float64)
    return level


class SerialLoop(Loop):
    """One process: half of K in 3x3 blocks, product and update in one sweep of compiled code."""

    def __init__(self, model: Model, comm: Any) -> None:
        self._assembly = Assembly(
            [body.mesh for body in model.elastic], [b.material for b in model.elastic], comm
        )
        matrix = petsc_rows(self._assembly.stiffness())
        self._order = _bandwidth_order(matrix.tobsr((3, 3)))
        super().__init__(model, comm, self._assembly.owned[self._order])
        self.diagonal = matrix.diagonal()[self._rows()]
        arrays = Arrays()
        state = kernel.State()
        state.nodes = self._order.size
        for name in ("inverse", "u", "v"):
            setattr(state, name, arrays.pointer(getattr(self, name), np.float64))
        state.f = arrays.pointer(np.zeros(3 * self._order.size), np.float64)
        local = np.empty(self._order.size, dtype=np.int64)
        local[self.owned] = np.arange(self._order.size)
        self.problem.state.map = arrays.pointer(local[self.problem.nodes], np.int32)
        state.problem = ctypes.pointer(self.problem.state)
        self._state, self._arrays = state, arrays
        self._point_at([(matrix, np.ones(self._order.size, dtype=bool))])

    def _rows(self) -> Ints:
        """Rows as dolfinx numbers them, in the order of the loop."""
        return np.asarray((3 * self._order[:, None] + np.arange(3)).ravel())

    def _point_at(self, parts: Iterable[tuple[scipy.sparse.csr_matrix, Mask]]) -> None:
        """Make these the levels: stiffness in dolfinx's order, and the nodes that move with it."""
        rows, arrays = self._rows(), Arrays()
        levels = [_level(matrix[rows][:, rows], moves, arrays) for matrix, moves in parts]
        structures = (kernel.Level * len(levels))(*levels)
        self._state.levels = len(levels)
        self._state.level = ctypes.cast(structures, ctypes.POINTER(kernel.Level))
        self._level_arrays = (structures, arrays)

    def _take_levels(self, element: Ints, node: Ints, count: int) -> None:
        self._state.levels = 0
        del self._level_arrays
        self._point_at((self._assembly.part(element == k), node == k) for k in range(count))

    def drift(self, steps: int) -> None:
        """Move the elastic bodies alone, without contact and ledger; all levels meet before."""
        self._kernel.drift(ctypes.byref(self._state), steps)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self._kernel.advance(ctypes.byref(self._state), steps)

    def level_product(self, level: int, x: Floats) -> Floats:
        """K_l x."""
        return self._product(x, level, level + 1)

    def product(self, x: Floats) -> Floats:
        """K x."""
        return self._product(x, 0, len(self.levels))

    def _product(self, x: Floats, first: int, end: int) -> Floats:
        x = np.ascontiguousarray(x)
        y = np.empty_like(x)
        pointer = ctypes.POINTER(ctypes.c_double)
        state = ctypes.byref(self._state)
        self._kernel.stiffness_product(
            state, first, end, x.ctypes.data_as(pointer), y.ctypes.data_as(pointer)
        )
        return y


class ParallelLoop(Loop):
    """Several processes: PETSc's block matrix, partitioned by dolfinx."""

    def __init__(self, model: Model, comm: Any) -> None:
        self._assembly = Assembly(
            [body.mesh for body in model.elastic], [b.material for b in model.elastic], comm
        )
        whole = block_matrix(self._assembly.stiffness())
        self._x, self._y = petsc_vectors(whole)
        self.diagonal = np.array(whole.getDiagonal().array)
        super().__init__(model, comm, self._assembly.owned)
        self._parts: list[tuple[Any, Any]] = [(whole, slice(None))]
        local = np.full(self.all_masses.size, -1, dtype=np.int64)
        local[self.owned] = np.arange(self.owned.size)
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
                block_rows(self._assembly.part(element == k), self.comm),
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


def make_loop(model: Model, comm: Any) -> Loop:
    """The loop for the number of processes in ``comm``."""
    return SerialLoop(model, comm) if comm.size == 1 else ParallelLoop(model, comm)
