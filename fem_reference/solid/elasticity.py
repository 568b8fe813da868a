"""Linear elasticity of tetrahedra: stiffness by dolfinx, lumped mass, stress."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
import ufl
from scipy.spatial import cKDTree

from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from ..common.errors import SolverError
from ..common.fenicsx import TetDomain, petsc_rows
from ..common.fields import Fields
from ..explicit.frames import Recorder
from .mesh import TetMesh, nodal_sum, volumes
from .model import Model

STRESS_COMPONENTS = (
    "stress_xx",
    "stress_yy",
    "stress_zz",
    "stress_xy",
    "stress_yz",
    "stress_zx",
)

LUMPED_SHARES = {1: (0.25, 0.0), 2: (1.0 / 36.0, 4.0 / 27.0)}
"""Share of an element's mass at a corner and at a midside node, by order.

Hinton, Rock & Zienkiewicz 1976 (Earthquake Eng. Struct. Dyn. 4, 245): in proportion to the diagonal
of the consistent mass, which for a straight quadratic tetrahedron is 6 : 32. Row sums would make
the corners' masses negative.
"""


def lumped_mass(mesh: TetMesh, density: float) -> Floats:
    """(n,) nodal masses, kg; all positive, their sum is the mesh's."""
    corner, midside = LUMPED_SHARES[mesh.order]
    shares = np.array([corner] * 4 + [midside] * (mesh.cells.shape[1] - 4))
    masses = density * volumes(mesh.points, mesh.corners)[:, None] * shares
    return nodal_sum(mesh.cells, masses, mesh.points.shape[0])


def _stress(u: Any, lame: Any, shear: Any) -> Any:
    strain = ufl.sym(ufl.grad(u))
    return lame * ufl.tr(strain) * ufl.Identity(3) + 2.0 * shear * strain


def stiffness_form(domain: TetDomain, lame: Any, shear: Any) -> Any:
    """Bilinear form of the stiffness."""
    u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    return ufl.inner(_stress(u, lame, shear), ufl.sym(ufl.grad(v))) * ufl.dx


def mass_form(domain: TetDomain, density: Any) -> Any:
    """Bilinear form of the consistent mass."""
    u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    return density * ufl.inner(u, v) * ufl.dx


class Assembly:
    """Several bodies, or the elements of them that are given, in one dolfinx mesh.

    Nodes are numbered body after body in the order of their meshes.

    Attributes:
        nodes: (n,) of the elements, in dolfinx's order.
    """

    nodes: Ints

    def __init__(self, meshes: Sequence[TetMesh], materials: Sequence[Material]) -> None:
        order = meshes[0].order
        self.first = np.cumsum([0, *(mesh.points.shape[0] for mesh in meshes)])
        # Bodies that touch are moved apart, so that a place belongs to one node only.
        height = max(float(np.ptp(mesh.points[:, 2])) for mesh in meshes)
        lift = 2.0 * height * np.arange(len(meshes))
        points = np.vstack(
            [
                mesh.points - [0.0, 0.0, mesh.points[:, 2].min() - z]
                for mesh, z in zip(meshes, lift, strict=True)
            ]
        )
        corners = np.vstack(
            [mesh.corners + offset for mesh, offset in zip(meshes, self.first, strict=False)]
        )
        # Midside nodes are dolfinx's own: it gets the corners only, numbered without gaps.
        used = np.unique(corners)
        number = np.empty(points.shape[0], dtype=np.int64)
        number[used] = np.arange(used.size)
        self.domain = TetDomain(points[used], number[corners], order)
        counts = [mesh.cells.shape[0] for mesh in meshes]
        self._lame = np.repeat([m.lame_lambda for m in materials], counts)
        self._shear = np.repeat([m.shear_modulus for m in materials], counts)
        self.lame = self.domain.cell_constants(self._lame)
        self.shear = self.domain.cell_constants(self._shear)
        distance, self.nodes = cKDTree(points).query(self.domain.points_of_nodes())
        scale = float(np.ptp(points[:, 0]))
        if distance.size and distance.max() > 1e-9 * scale:
            raise SolverError("dolfinx's nodes are not those of the mesh")

    def stiffness(self) -> Any:
        """PETSc matrix, N/m."""
        return self.domain.petsc_matrix(stiffness_form(self.domain, self.lame, self.shear))

    def part(self, chosen: npt.NDArray[np.bool_]) -> scipy.sparse.csr_matrix:
        """Stiffness of some elements, N/m.

        Args:
            chosen: (m,) whether an element counts, body after body.
        """
        lame = self.domain.cell_constants(np.where(chosen, self._lame, 0.0))
        shear = self.domain.cell_constants(np.where(chosen, self._shear, 0.0))
        rows = petsc_rows(self.domain.petsc_matrix(stiffness_form(self.domain, lame, shear)))
        rows.eliminate_zeros()
        return rows


def cell_stress(mesh: TetMesh, material: Material, displacement: Floats) -> Floats:
    """(m, 6) `STRESS_COMPONENTS` at the elements' midpoints from the displacement (n, 3), Pa."""
    assembly = Assembly([mesh], [material])
    domain = assembly.domain
    u = domain.function(displacement[assembly.nodes])
    s = _stress(u, assembly.lame, assembly.shear)
    vector = ufl.as_vector([s[0, 0], s[1, 1], s[2, 2], s[0, 1], s[1, 2], s[2, 0]])
    return domain.cell_values(vector, 6)


def von_mises(stress: Floats) -> Floats:
    """(m,) von Mises stress from (m, 6) `STRESS_COMPONENTS`, Pa."""
    xx, yy, zz, xy, yz, zx = stress.T
    deviator = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(0.5 * deviator + 3.0 * (xy**2 + yz**2 + zx**2)))


def write_fields(folder: Path, model: Model, recorder: Recorder) -> list[float]:
    """``mesh.vtu`` of all elastic bodies and the fields kept of a run; their instants, s."""
    meshes = [body.mesh for body in model.elastic]

    def stress(number: int, local: Floats) -> Floats:
        return cell_stress(meshes[number], model.elastic[number].material, local)

    writer = Fields(
        "tetra" if meshes[0].order == 1 else "tetra10",
        [(mesh.points, mesh.cells) for mesh in meshes],
        STRESS_COMPONENTS,
        stress,
        von_mises,
    )
    writer.write_mesh(folder / "mesh.vtu")
    inner = model.first[1:-1]
    return writer.write_frames(folder, [(t, np.split(u, inner)) for t, u in recorder.frames()])
