"""The only module that touches dolfinx: its API differs between releases (0.5 to 0.10).

Written against 0.5.2; the branches for later releases follow their published API.
"""

from __future__ import annotations

import logging
from typing import Any

import dolfinx
import numpy as np
import scipy.sparse
import ufl
from dolfinx import fem
from dolfinx.mesh import create_mesh
from mpi4py import MPI
from petsc4py import PETSc

try:  # up to 0.5 the functions hang off fem.petsc only after an explicit import
    from dolfinx.fem import petsc as fem_petsc
except ImportError as error:  # pragma: no cover - a dolfinx without PETSc
    raise ImportError("dolfinx was built without PETSc") from error

from .mesh import BodyMesh, Floats, Ints

# FFCx logs through the root logger, at INFO and WARNING.
for _name in ("FFCx", "UFL", "ffcx", "root"):
    logging.getLogger(_name if _name != "root" else None).setLevel(logging.ERROR)


def _vector_element(degree: int) -> Any:
    try:
        import basix.ufl
    except ImportError:
        cell = ufl.Cell("quadrilateral", geometric_dimension=2)
        return ufl.VectorElement("Lagrange", cell, degree)
    return basix.ufl.element("Lagrange", "quadrilateral", degree, shape=(2,))


def _function_space(mesh: Any, family: str, degree: int, shape: tuple[int, ...]) -> Any:
    if hasattr(fem, "functionspace"):
        return fem.functionspace(mesh, (family, degree, shape) if shape else (family, degree))
    if shape:
        return fem.VectorFunctionSpace(mesh, (family, degree), dim=shape[0])
    return fem.FunctionSpace(mesh, (family, degree))


def _interpolation_points(space: Any) -> Any:
    points = space.element.interpolation_points
    return points() if callable(points) else points


class Domain:
    """A body's mesh as dolfinx sees it, with its vector space of the given degree."""

    def __init__(self, body: BodyMesh, degree: int = 1, *, discontinuous: bool = False) -> None:
        # dolfinx numbers the corners of a quadrilateral row by row.
        cells = np.ascontiguousarray(body.quads[:, [0, 1, 3, 2]])
        element = _vector_element(1)
        points = np.ascontiguousarray(body.points)
        try:
            self.mesh = create_mesh(MPI.COMM_SELF, cells, points, ufl.Mesh(element))
        except TypeError:  # since 0.10 the coordinate element comes before the points
            self.mesh = create_mesh(MPI.COMM_SELF, cells, ufl.Mesh(element), points)
        family = "DQ" if discontinuous else "Lagrange"
        self.space = _function_space(self.mesh, family, degree, (2,))
        self.degree = degree

    def points_of_nodes(self) -> Floats:
        """(n, 2) r and z of the space's nodes, dolfinx's numbering, m."""
        return np.asarray(self.space.tabulate_dof_coordinates()[:, :2], dtype=np.float64)

    def body_nodes(self) -> Ints:
        """(n,) for each node of a space of degree 1 the number of the same node in the body."""
        dofs = self.cell_dofs()
        original = np.empty(dofs.max() + 1, dtype=np.int64)
        original[dofs.ravel()] = self.cell_corners().ravel()
        return original

    def cell_dofs(self) -> Ints:
        """(m, k) nodes of each cell, both in dolfinx's numbering."""
        cells = self.mesh.topology.index_map(2).size_local
        return np.array([self.space.dofmap.cell_dofs(c) for c in range(cells)], dtype=np.int64)

    def cell_corners(self) -> Ints:
        """(m, 4) the body's nodes at each dolfinx cell's corners, row by row."""
        geometry = self.mesh.geometry
        links = geometry.dofmap
        if hasattr(links, "links"):
            cells = self.mesh.topology.index_map(2).size_local
            corner = np.array([links.links(c) for c in range(cells)])
        else:
            corner = np.asarray(links)
        return np.asarray(np.asarray(geometry.input_global_indices, dtype=np.int64)[corner])

    def body_cells(self) -> Ints:
        """(m,) for each dolfinx cell the number of the same element in the body."""
        return np.asarray(self.mesh.topology.original_cell_index, dtype=np.int64)

    def constant(self, value: float) -> Any:
        """A constant that does not trigger recompilation when it changes."""
        return fem.Constant(self.mesh, PETSc.ScalarType(value))

    def matrix(self, form: Any) -> scipy.sparse.csr_matrix:
        """Assemble a bilinear form; row and column 2 * node + component."""
        matrix = fem_petsc.assemble_matrix(fem.form(form))
        matrix.assemble()
        indptr, indices, values = matrix.getValuesCSR()
        result = scipy.sparse.csr_matrix((values, indices, indptr), shape=matrix.getSize())
        matrix.destroy()
        return result

    def vector(self, form: Any) -> Floats:
        """Assemble a linear form."""
        vector = fem_petsc.assemble_vector(fem.form(form))
        result = np.array(vector.array, dtype=np.float64)
        vector.destroy()
        return result

    def function(self, values: Floats) -> Any:
        """A function of the space with the values (n, 2) at its nodes."""
        function = fem.Function(self.space)
        array = function.x.array
        array[:] = values.ravel()
        return function

    def cell_values(self, expression: Any, size: int) -> Floats:
        """(m, size) values of a vector expression at the elements' midpoints."""
        space = _function_space(self.mesh, "DG", 0, (size,))
        function = fem.Function(space)
        function.interpolate(fem.Expression(expression, _interpolation_points(space)))
        return np.array(function.x.array, dtype=np.float64).reshape(-1, size)


def petsc_matrix(matrix: scipy.sparse.csr_matrix) -> Any:
    """The matrix for PETSc and SLEPc."""
    csr = matrix.tocsr()
    return PETSc.Mat().createAIJ(
        size=csr.shape,
        csr=(csr.indptr.astype(PETSc.IntType), csr.indices.astype(PETSc.IntType), csr.data),
        comm=PETSc.COMM_SELF,
    )


def version() -> str:
    """Release of dolfinx."""
    return str(dolfinx.__version__)
