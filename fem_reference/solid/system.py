"""A model as what the loop steps: dolfinx's numbering, stiffness by dolfinx, lumped masses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..common.arrays import Floats, Ints, Mask
from ..common.fenicsx import petsc_rows
from ..explicit.loop import Loop, SerialLoop
from ..explicit.parallel import ParallelLoop
from ..explicit.partition import owners
from ..explicit.parts import worthwhile
from ..explicit.problem import touching
from .elasticity import Assembly, lumped_mass
from .elements import element_time_steps
from .model import Model


class SolidSystem:
    """See `explicit.system.System`; the bodies of ``model`` in the processes of ``comm``."""

    def __init__(self, model: Model, comm: Any) -> None:
        bodies = model.elastic
        self.model, self.comm, self.first = model, comm, model.first
        self.rigid, self.contacts, self.matched = model.rigid, model.contacts, ()
        self.film = self.plasticity = None
        self.relaxations = tuple(body.material.relaxation for body in bodies)
        self.free_axes = (0, 1, 2)
        self.points = np.concatenate([body.mesh.points for body in bodies])
        self.mass = np.concatenate([lumped_mass(b.mesh, b.material.density) for b in bodies])
        self.inverse_mass = np.repeat(1.0 / self.mass, 3)
        for body, offset in zip(bodies, self.first, strict=False):
            self.inverse_mass[body.fixed + 3 * offset] = 0.0
        self.velocity = np.concatenate(
            [np.tile(body.velocity, (body.mesh.points.shape[0], 1)) for body in bodies]
        )
        self.held = np.ones(self.mass.size, dtype=bool)
        self.element_nodes = np.concatenate(
            [body.mesh.cells + offset for body, offset in zip(bodies, self.first, strict=False)]
        )
        self._steps: Floats | None = None
        self.owner = self._owners()
        # All elements at own nodes are assembled here, so that own rows are whole.
        self._near = np.any(self.owner[self.element_nodes] == comm.rank, axis=1)
        elements = np.split(self._near, np.cumsum([b.mesh.cells.shape[0] for b in bodies])[:-1])
        meshes = [
            replace(body.mesh, cells=body.mesh.cells[near])
            for body, near in zip(bodies, elements, strict=True)
        ]
        self._assembly = Assembly(meshes, [body.material for body in bodies])
        nodes = self._assembly.nodes
        self._whole: scipy.sparse.csr_matrix | None = petsc_rows(self._assembly.stiffness())
        mine = self.owner[nodes] == comm.rank
        own = np.flatnonzero(mine)[_bandwidth_order(self._whole.tobsr((3, 3)), mine)]
        others = np.flatnonzero(~mine)
        self.owned, self.ghosts = nodes[own], nodes[others]
        self._rows, self._columns = _rows_of(own), _rows_of(np.concatenate([own, others]))

    def _owners(self) -> Ints:
        """(N,) process of each node."""
        if self.comm.size == 1:
            return np.zeros(self.mass.size, dtype=np.int64)
        near = touching(self.contacts, self.first)
        steps = self.element_time_steps()
        return owners(self.points, self.element_nodes, steps, near, self.comm.size)

    def element_time_steps(self) -> Floats:
        """(m,) critical time step of each element alone, s."""
        if self._steps is None:
            steps = [element_time_steps(b.mesh, b.material) for b in self.model.elastic]
            self._steps = np.concatenate(steps)
        return self._steps

    def part(self, chosen: Mask | None) -> scipy.sparse.csr_matrix:
        """Own rows of the stiffness of some elements (m,), or of all, N/m.

        Columns as `owned`, then `ghosts`.
        """
        if chosen is not None:
            matrix = self._assembly.part(chosen[self._near])
        else:
            matrix, self._whole = self._whole, None
            if matrix is None:
                matrix = petsc_rows(self._assembly.stiffness())
        return matrix[self._rows][:, self._columns]


def _rows_of(nodes: Ints) -> Ints:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def _bandwidth_order(matrix: scipy.sparse.bsr_matrix, chosen: Mask) -> Ints:
    """Order of some nodes that keeps neighbours close in memory (reverse Cuthill-McKee)."""
    pattern = scipy.sparse.csr_matrix(
        (np.ones(matrix.indices.size, np.int8), matrix.indices, matrix.indptr),
        shape=(matrix.shape[0] // 3,) * 2,
    )
    if not chosen.all():
        pattern = pattern[chosen][:, chosen]
    return np.asarray(reverse_cuthill_mckee(pattern, symmetric_mode=True), dtype=np.int64)


def make_loop(model: Model, comm: Any, threads: int = 1) -> Loop:
    """The loop for the number of processes in ``comm``, each with at most so many threads."""
    system = SolidSystem(model, comm)
    threads = worthwhile(threads, 3 * system.owned.size)
    if comm.size == 1:
        return SerialLoop(system, comm, threads)
    return ParallelLoop(system, comm, threads)
