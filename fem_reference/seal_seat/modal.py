"""Eigenfrequencies of the seat by SLEPc, on the discrete system of the time loop."""

from __future__ import annotations

import math
from pathlib import Path

import meshio
import numpy as np
import scipy.sparse

from ..common.arrays import Floats
from ..common.errors import SceneError, SolverError
from ..solid.elasticity import Assembly, lumped_mass
from ..solid.mesh import TetMesh, check_elements
from .model import seat_model
from .scene import SeatScene


def read_mesh(path: Path) -> TetMesh:
    """The tetrahedra of a .vtu file.

    Raises:
        SceneError: the file cannot be read or holds no tetrahedra.
        SolverError: an element is inverted or degenerate.
    """
    try:
        grid = meshio.read(path)
    except Exception as error:
        raise SceneError(f"mesh {path} cannot be read: {error}") from error
    for kind in ("tetra10", "tetra"):
        if kind in grid.cells_dict:
            cells = np.asarray(grid.cells_dict[kind], dtype=np.int64)
            mesh = TetMesh("seat", np.asarray(grid.points, dtype=np.float64), cells)
            check_elements(mesh)
            return mesh
    raise SceneError(f"mesh {path} holds no tetrahedra")


def seat_modes(scene: SeatScene, mesh: TetMesh, count: int) -> Floats:
    """(count,) lowest eigenfrequencies, Hz, ascending.

    Of the half seat with clamped rim, symmetric about y = 0, with the lumped mass of the time loop.
    Shift-invert Krylov-Schur.

    Raises:
        SolverError: SLEPc found fewer, or the mesh is not one of this scene.
    """
    from slepc4py import SLEPc

    from ..common.fenicsx import petsc_matrix, petsc_rows

    body = seat_model(scene, mesh).model.elastic[0]
    assembly = Assembly([mesh], [body.material])
    rows = np.argsort(assembly.nodes)
    rows = (3 * rows[:, None] + np.arange(3)).ravel()
    keep = np.setdiff1d(np.arange(rows.size), body.fixed)
    stiffness = petsc_rows(assembly.stiffness())[rows[keep]][:, rows[keep]]
    mass = np.repeat(lumped_mass(mesh, body.material.density), 3)[keep]
    solver = SLEPc.EPS().create()
    solver.setOperators(petsc_matrix(stiffness), petsc_matrix(scipy.sparse.diags(mass)))
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(0.0)
    solver.getST().setType("sinvert")
    solver.setDimensions(count)
    solver.setTolerances(1e-11)
    solver.solve()
    found = solver.getConverged()
    if found < count:
        raise SolverError(f"SLEPc found {found} of {count} modes of the seat requested")
    values = sorted(solver.getEigenvalue(index).real for index in range(count))
    solver.destroy()
    return np.array([math.sqrt(value) / (2.0 * math.pi) for value in values])
