"""Axisymmetric linear elasticity without torsion: stiffness, mass, stress.

Displacement (u_r, u_z) in the (r, z) half-plane; strains e_rr = du_r/dr, e_tt = u_r/r,
e_zz = du_z/dz, g_rz = du_r/dz + du_z/dr; every integral carries the weight 2 pi r
(e.g. Zienkiewicz & Taylor, The Finite Element Method, vol. 1, axisymmetric stress analysis).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
import ufl

from .fenicsx import Domain
from .mesh import BodyMesh, Floats
from .scene import Material

STRESS_COMPONENTS = ("stress_rr", "stress_tt", "stress_zz", "stress_rz")


def _strain(u: Any, r: Any) -> Any:
    """(e_rr, e_tt, e_zz, g_rz)."""
    return ufl.as_vector([u[0].dx(0), u[0] / r, u[1].dx(1), u[0].dx(1) + u[1].dx(0)])


def _stress(u: Any, r: Any, lame: Any, shear: Any) -> Any:
    """(s_rr, s_tt, s_zz, s_rz), Pa."""
    e = _strain(u, r)
    trace = lame * (e[0] + e[1] + e[2])
    return ufl.as_vector(
        [trace + 2 * shear * e[0], trace + 2 * shear * e[1], trace + 2 * shear * e[2], shear * e[3]]
    )


def _forms(domain: Domain, material: Material) -> tuple[Any, Any]:
    u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    r = ufl.SpatialCoordinate(domain.mesh)[0]
    # Gauss points, two per direction for bilinear elements: full integration, none on the axis.
    measure = ufl.Measure(
        "dx", domain=domain.mesh, metadata={"quadrature_degree": 2 * domain.degree + 1}
    )
    weight = 2.0 * math.pi * r
    lame, shear = (domain.constant(material.lame_lambda), domain.constant(material.shear_modulus))
    density = domain.constant(material.density)
    stiffness = ufl.inner(_stress(u, r, lame, shear), _strain(v, r)) * weight * measure
    mass = density * ufl.inner(u, v) * weight * measure
    return stiffness, mass


@dataclass(frozen=True)
class BodyMatrices:
    """Matrices of one body of bilinear elements, in the body's own node numbering."""

    stiffness: scipy.sparse.csr_matrix
    """(2n, 2n), row 2 * node + component (r, z), N/m."""
    mass: Floats
    """(n,) row sums of the consistent mass matrix, kg; the same for both components."""


def assemble(body: BodyMesh, material: Material) -> BodyMatrices:
    """Assemble stiffness and lumped mass of a body with dolfinx."""
    domain = Domain(body)
    stiffness_form, mass_form = _forms(domain, material)
    nodes = domain.body_nodes()
    permutation = np.empty(2 * nodes.size, dtype=np.int64)
    permutation[2 * nodes] = 2 * np.arange(nodes.size)
    permutation[2 * nodes + 1] = 2 * np.arange(nodes.size) + 1
    stiffness = domain.matrix(stiffness_form)[permutation][:, permutation]
    row_sums = np.asarray(domain.matrix(mass_form).sum(axis=1)).ravel()
    mass = row_sums[permutation][1::2]
    return BodyMatrices(stiffness.tocsr(), np.ascontiguousarray(mass))


def assemble_consistent(
    body: BodyMesh, material: Material, degree: int
) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix, Floats]:
    """Stiffness, consistent mass and node positions (n, 2) for elements of ``degree``.

    Rows 2 * node + component in dolfinx's numbering; for eigenmodes.
    """
    domain = Domain(body, degree)
    stiffness, mass = _forms(domain, material)
    return domain.matrix(stiffness), domain.matrix(mass), domain.points_of_nodes()


def cell_stress(body: BodyMesh, material: Material, displacement: Floats) -> Floats:
    """(m, 4) stress `STRESS_COMPONENTS` at the elements' midpoints, Pa.

    Args:
        body: the mesh.
        material: its material.
        displacement: (n, 2), m.
    """
    domain = Domain(body)
    u = domain.function(displacement[domain.body_nodes()])
    r = ufl.SpatialCoordinate(domain.mesh)[0]
    stress = _stress(
        u, r, domain.constant(material.lame_lambda), domain.constant(material.shear_modulus)
    )
    values = domain.cell_values(stress, 4)
    result = np.empty_like(values)
    result[domain.body_cells()] = values
    return result


def von_mises(stress: Floats) -> Floats:
    """(m,) von Mises stress from (m, 4) `STRESS_COMPONENTS`, Pa."""
    rr, tt, zz, rz = stress.T
    return np.asarray(
        np.sqrt(0.5 * ((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2) + 3.0 * rz**2)
    )
