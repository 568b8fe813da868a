"""Preconditioner of static solutions: the linear elements of a quadratic mesh, solved directly."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from ..common.arrays import Floats
from ..common.bodies import Material
from ..explicit.loop import Loop
from .elements import CHUNK, element_stiffness
from .mesh import EDGES, TetMesh

SHIFT = 1e-10
"""Added to the diagonal of a body that nothing holds, over its largest value."""


class TwoLevel:
    """r -> D^-1 r + P (P^T K P)^-1 P^T r: the diagonal and the mesh of the corners.

    The corners carry what is smooth, for which the diagonal alone takes a thousand steps. P puts
    the mean of its corners into a midside node, so that P^T K P is the stiffness of the linear
    elements on the same corners.

    Args:
        loop: the assembled system.
        mesh: of a body, order 2.
        material: of it.
        first: number of its first node in the system.
        free: (3 n,) 1 for its components that can move, in the loop's order.
    """

    def __init__(
        self, loop: Loop, mesh: TetMesh, material: Material, first: int, free: Floats
    ) -> None:
        self._loop, self._weight = loop, free / loop.diagonal
        count = int(mesh.corners.max()) + 1
        self._nodes = slice(first, first + mesh.points.shape[0])
        self._interpolation = _interpolation(mesh, count)
        self._free = loop.gather(free)[self._nodes][:count].ravel() > 0.0
        stiffness = _stiffness(mesh, material, count)[self._free][:, self._free]
        if self._free.all():
            shift = SHIFT * float(stiffness.diagonal().max())
            stiffness = stiffness + diags_array(np.full(stiffness.shape[0], shift))
        options = {"SymmetricMode": True}
        self._solved = splu(
            stiffness.tocsc(), "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options
        )

    def __call__(self, residual: Floats) -> Floats:
        """The preconditioned residual (3 n,)."""
        whole = self._loop.gather(residual)
        corners = (self._interpolation.T @ whole[self._nodes]).ravel()
        solution = np.zeros_like(corners)
        solution[self._free] = self._solved.solve(corners[self._free])
        smooth = np.zeros_like(whole)
        smooth[self._nodes] = self._interpolation @ solution.reshape(-1, 3)
        return np.asarray(self._weight * residual + self._loop.own(smooth) * (self._weight > 0.0))


def _interpolation(mesh: TetMesh, count: int) -> csr_array:
    """(n, count) values at all nodes from those at the corners."""
    middles, place = np.unique(mesh.cells[:, 4:], return_index=True)
    cell, edge = np.divmod(place, len(EDGES))
    ends = np.stack([mesh.cells[cell, np.array(EDGES)[edge, k]] for k in (0, 1)], axis=1)
    rows = np.concatenate([np.arange(count), np.repeat(middles, 2)])
    columns = np.concatenate([np.arange(count), ends.ravel()])
    values = np.concatenate([np.ones(count), np.full(2 * middles.size, 0.5)])
    return csr_array(coo_array((values, (rows, columns)), (mesh.points.shape[0], count)))


def _stiffness(mesh: TetMesh, material: Material, count: int) -> csr_array:
    """(3 count, 3 count) of the linear elements, N/m."""
    matrix = csr_array((3 * count, 3 * count))
    for start in range(0, mesh.cells.shape[0], 20 * CHUNK):
        corners = mesh.corners[start : start + 20 * CHUNK]
        parts = element_stiffness(mesh.points, corners, material)
        numbers = (3 * corners[:, :, None] + np.arange(3)).reshape(corners.shape[0], 12)
        rows, columns = np.repeat(numbers, 12, axis=1), np.tile(numbers, (1, 12))
        entries = (parts.ravel(), (rows.ravel(), columns.ravel()))
        matrix = matrix + csr_array(coo_array(entries, matrix.shape))
    return matrix
