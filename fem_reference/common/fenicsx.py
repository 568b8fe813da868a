"""The only module that touches dolfinx: its API differs between the supported releases.

Developed with 0.11 (PyPI); Debian's 0.5 and 0.9 take other branches.
"""

from __future__ import annotations

import inspect
import logging
from typing import Any

import numpy as np
import scipy.sparse

from .arrays import Floats, Ints
from .jit_cache import clear_unusable, compiles
from .supported import MPI, PETSc, dolfinx

# isort: split
import ufl
from dolfinx import fem
from dolfinx.fem import petsc as fem_petsc  # 0.5 has it only after an explicit import
from dolfinx.mesh import create_mesh

clear_unusable()

# FFCx logs through the root logger, at INFO and WARNING.
for _name in ("FFCx", "UFL", "ffcx", "root"):
    logging.getLogger(_name if _name != "root" else None).setLevel(logging.ERROR)


def _coordinate_element(cell: str, dimension: int) -> Any:
    try:
        import basix.ufl
    except ImportError:
        return ufl.VectorElement("Lagrange", ufl.Cell(cell, geometric_dimension=dimension), 1)
    return basix.ufl.element("Lagrange", cell, 1, shape=(dimension,))


@compiles
def _mesh(comm: Any, points: Floats, cells: Ints, cell: str) -> Any:
    points, cells = np.ascontiguousarray(points), np.ascontiguousarray(cells)
    domain = ufl.Mesh(_coordinate_element(cell, points.shape[1]))
    if "e" in inspect.signature(create_mesh).parameters:  # since 0.10
        return create_mesh(comm, cells, e=domain, x=points)
    return create_mesh(comm, cells, points, domain)


@compiles
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
    """A body's mesh as dolfinx sees it, with its space of the given degree and components."""

    def __init__(
        self,
        points: Floats,
        quads: Ints,
        degree: int = 1,
        *,
        discontinuous: bool = False,
        components: int = 2,
    ) -> None:
        # dolfinx numbers the corners of a quadrilateral row by row.
        self.mesh = _mesh(MPI.COMM_SELF, points, quads[:, [0, 1, 3, 2]], "quadrilateral")
        family = "DQ" if discontinuous else "Lagrange"
        shape = (components,) if components > 1 else ()
        self.space = _function_space(self.mesh, family, degree, shape)
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
        return fem.Constant(self.mesh, np.float64(value))

    @compiles
    def matrix(self, form: Any) -> scipy.sparse.csr_matrix:
        """Assemble a bilinear form; row and column components * node + component."""
        matrix = fem_petsc.assemble_matrix(fem.form(form))
        matrix.assemble()
        indptr, indices, values = matrix.getValuesCSR()
        result = scipy.sparse.csr_matrix((values, indices, indptr), shape=matrix.getSize())
        matrix.destroy()
        return result

    @compiles
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

    @compiles
    def cell_values(self, expression: Any, size: int) -> Floats:
        """(m, size) values of a vector expression at the elements' midpoints."""
        space = _function_space(self.mesh, "DG", 0, (size,))
        function = fem.Function(space)
        function.interpolate(fem.Expression(expression, _interpolation_points(space)))
        return np.array(function.x.array, dtype=np.float64).reshape(-1, size)


class TetDomain:
    """Tetrahedra of this process with a vector space of degree 1 or 2."""

    def __init__(self, points: Floats, corners: Ints, degree: int) -> None:
        self.mesh = _mesh(MPI.COMM_SELF, points, corners, "tetrahedron")
        self.space = _function_space(self.mesh, "Lagrange", degree, (3,))

    def points_of_nodes(self) -> Floats:
        """(n, 3) places of the nodes, m."""
        return np.asarray(self.space.tabulate_dof_coordinates(), dtype=np.float64)

    def cell_constants(self, of_element: Floats) -> Any:
        """A piecewise constant function from one value per element as handed in."""
        space = _function_space(self.mesh, "DG", 0, ())
        function = fem.Function(space)
        # A scalar of degree 0 has its dofs in the order of the cells.
        function.x.array[:] = of_element[self.local_cells()]
        return function

    def local_cells(self) -> Ints:
        """For each of dolfinx's elements its number as handed in."""
        return np.asarray(self.mesh.topology.original_cell_index, dtype=np.int64)

    @compiles
    def petsc_matrix(self, form: Any) -> Any:
        """Assemble a bilinear form: a PETSc matrix in blocks of 3, row 3 * node + component."""
        matrix = fem_petsc.assemble_matrix(fem.form(form))
        matrix.assemble()
        return matrix

    def function(self, values: Floats) -> Any:
        """A function of the space with the values (n, 3) at its nodes."""
        function = fem.Function(self.space)
        function.x.array[:] = values.ravel()
        return function

    @compiles
    def cell_values(self, expression: Any, size: int) -> Floats:
        """(m, size) values of a vector expression at the elements' midpoints, as handed in."""
        space = _function_space(self.mesh, "DG", 0, (size,))
        function = fem.Function(space)
        function.interpolate(fem.Expression(expression, _interpolation_points(space)))
        values = np.empty((self.local_cells().size, size))
        values[self.local_cells()] = np.asarray(function.x.array).reshape(-1, size)
        return values


def petsc_rows(matrix: Any) -> scipy.sparse.csr_matrix:
    """The matrix; that of PETSc is destroyed."""
    indptr, indices, values = matrix.getValuesCSR()
    columns = matrix.getSize()[1]
    matrix.destroy()
    return scipy.sparse.csr_matrix((values, indices, indptr), shape=(indptr.size - 1, columns))


def world() -> Any:
    """The communicator of all processes."""
    return MPI.COMM_WORLD


def on_this_machine(comm: Any) -> Any:
    """The processes of ``comm`` that share this machine's memory."""
    return comm.Split_type(MPI.COMM_TYPE_SHARED)


def alone() -> Any:
    """The communicator of this process only."""
    return MPI.COMM_SELF


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
