"""A model as what the loop steps: dolfinx's numbering, stiffness by dolfinx, lumped masses."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..common.arrays import Floats, Ints, Mask
from ..common.fenicsx import block_matrix, block_rows, petsc_rows
from ..explicit.loop import Loop, SerialLoop
from ..explicit.parallel import ParallelLoop
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
        self._assembly = Assembly([b.mesh for b in bodies], [b.material for b in bodies], comm)
        self.owned: Ints = self._assembly.owned
        self._whole: scipy.sparse.csr_matrix | None = None
        self._rows: Ints | slice = slice(None)
        if comm.size == 1:
            self._whole = petsc_rows(self._assembly.stiffness())
            order = _bandwidth_order(self._whole.tobsr((3, 3)))
            self.owned = self._assembly.owned[order]
            self._rows = (3 * order[:, None] + np.arange(3)).ravel()

    def element_time_steps(self) -> Floats:
        """(m,) critical time step of each element alone, s."""
        if self._steps is None:
            steps = [element_time_steps(b.mesh, b.material) for b in self.model.elastic]
            self._steps = np.concatenate(steps)
        return self._steps

    def part(self, chosen: Mask | None) -> scipy.sparse.csr_matrix:
        """Stiffness of some elements (m,), or of all: own rows and columns, as `owned`, N/m."""
        if chosen is not None:
            matrix = self._assembly.part(chosen)
        else:
            matrix, self._whole = self._whole, None
            if matrix is None:
                matrix = petsc_rows(self._assembly.stiffness())
        return matrix[self._rows][:, self._rows]

    def blocks(self, chosen: Mask | None) -> Any:
        """PETSc's block matrix of some elements, or of all."""
        if chosen is None:
            return block_matrix(self._assembly.stiffness())
        return block_rows(self._assembly.part(chosen), self.comm)


def _bandwidth_order(matrix: scipy.sparse.bsr_matrix) -> Ints:
    """Order of the nodes that keeps neighbours close in memory (reverse Cuthill-McKee)."""
    pattern = scipy.sparse.csr_matrix(
        (np.ones(matrix.indices.size, np.int8), matrix.indices, matrix.indptr),
        shape=(matrix.shape[0] // 3,) * 2,
    )
    return np.asarray(reverse_cuthill_mckee(pattern, symmetric_mode=True), dtype=np.int64)


def make_loop(model: Model, comm: Any) -> Loop:
    """The loop for the number of processes in ``comm``."""
    system = SolidSystem(model, comm)
    return SerialLoop(system, comm) if comm.size == 1 else ParallelLoop(system, comm)
