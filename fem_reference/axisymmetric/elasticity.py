"""Axisymmetric linear elasticity without torsion: stiffness, mass, stress.

Displacement (u_r, u_z) in the (r, z) half-plane; strains e_rr = du_r/dr, e_tt = u_r/r,
e_zz = du_z/dz, g_rz = du_r/dz + du_z/dr; every integral carries the weight 2 pi r
(e.g. Zienkiewicz & Taylor, The Finite Element Method, vol. 1, axisymmetric stress analysis).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse
import ufl

from ..common.arrays import Floats, Ints, Mask
from ..common.beam import Beam
from ..common.bodies import Material
from ..common.fenicsx import Domain
from ..common.fields import Fields
from .elements import ElementMatrices, element_matrices
from .mesh import BodyMesh

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


def _measure(domain: Domain, degree: int) -> Any:
    # Gauss points, two per direction for bilinear elements: full integration, none on the axis.
    return ufl.Measure("dx", domain=domain.mesh, metadata={"quadrature_degree": 2 * degree + 1})


def _stiffness_form(domain: Domain, material: Material, degree: int = 1) -> Any:
    u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    r = ufl.SpatialCoordinate(domain.mesh)[0]
    lame, shear = (domain.constant(material.lame_lambda), domain.constant(material.shear_modulus))
    weight = 2.0 * math.pi * r
    return ufl.inner(_stress(u, r, lame, shear), _strain(v, r)) * weight * _measure(domain, degree)


def _mass_form(domain: Domain, material: Material, degree: int) -> Any:
    u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    r = ufl.SpatialCoordinate(domain.mesh)[0]
    density = domain.constant(material.density)
    return density * ufl.inner(u, v) * 2.0 * math.pi * r * _measure(domain, degree)


@dataclass(frozen=True)
class BodyMatrices:
    """Matrices of one body, in the body's own node numbering."""

    stiffness: scipy.sparse.csr_matrix
    """(2n, 2n), row 2 * node + component (r, z), N/m."""
    mass: Floats
    """(n,) row sums of the consistent mass matrix, kg; the same for both components."""
    elements: ElementMatrices


def global_matrix(nodes: Ints, stiffness: Floats, count: int) -> scipy.sparse.csr_matrix:
    """(2 count, 2 count) sum of element matrices (m, 8, 8) over the elements' ``nodes`` (m, 4)."""
    dofs = (2 * nodes[:, :, None] + np.arange(2)).reshape(-1, 8)
    rows = np.repeat(dofs, 8, axis=1).ravel()
    columns = np.tile(dofs, (1, 8)).ravel()
    shape = (2 * count, 2 * count)
    return scipy.sparse.coo_matrix((stiffness.ravel(), (rows, columns)), shape=shape).tocsr()


def assemble(body: BodyMesh, material: Material) -> BodyMatrices:
    """Stiffness and lumped mass of a body: bilinear elements with incompatible modes."""
    elements = element_matrices(body, material, _strain, _stiffness_form)
    count = body.points.shape[0]
    shares = np.bincount(elements.nodes.ravel(), elements.mass.ravel(), minlength=count)
    mass = np.asarray(shares, dtype=np.float64)
    return BodyMatrices(global_matrix(elements.nodes, elements.stiffness, count), mass, elements)


def rigid_node(mass: float) -> BodyMatrices:
    """A body of ``mass`` (kg) that is one node: an element without stiffness lets it step."""
    nodes, none = np.zeros((1, 4), dtype=np.int64), np.zeros((1, 8, 8))
    elements = ElementMatrices(nodes, none, np.full((1, 4), 0.25 * mass))
    return BodyMatrices(global_matrix(nodes, none, 1), np.array([mass]), elements)


def with_rigid_part(matrices: BodyMatrices, rigid: Mask, mass: float) -> tuple[BodyMatrices, Ints]:
    """A body whose ``rigid`` nodes (n,) are one, the last, and the new number of each node.

    That node gets what the others leave of the body's ``mass`` (kg).
    """
    count = int(np.count_nonzero(~rigid))
    place = np.where(rigid, count, np.cumsum(~rigid) - 1)
    elements = replace(matrices.elements, nodes=place[matrices.elements.nodes])
    others = matrices.mass[~rigid]
    lumped = np.append(others, mass - others.sum())
    return BodyMatrices(
        global_matrix(elements.nodes, elements.stiffness, count + 1), lumped, elements
    ), place


def beam_body(beam: Beam) -> BodyMatrices:
    """A beam as a body whose nodes have a scaled rotation in the place of the radial component."""
    ends = np.arange(beam.elements)[:, None] + np.array([0, 1, 1, 1])
    # Two ends in an element of four corners: the others have no stiffness.
    stiffness = np.zeros((beam.elements, 8, 8))
    stiffness[:, :4, :4] = beam.element_stiffness
    mass = np.full((beam.elements, 4), 0.5 * beam.line_mass * beam.element_length)
    mass[-1, 1:] += beam.tip_mass
    elements = ElementMatrices(ends, stiffness, mass)
    return BodyMatrices(global_matrix(ends, stiffness, beam.elements + 1), beam.mass, elements)


def assemble_consistent(
    body: BodyMesh, material: Material, degree: int
) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix, Floats]:
    """Stiffness, consistent mass and node positions (n, 2) for elements of ``degree``.

    Rows 2 * node + component in dolfinx's numbering; for eigenmodes.
    """
    domain = Domain(body.points, body.quads, degree)
    stiffness = domain.matrix(_stiffness_form(domain, material, degree))
    return stiffness, domain.matrix(_mass_form(domain, material, degree)), domain.points_of_nodes()


def cell_stress(body: BodyMesh, material: Material, displacement: Floats) -> Floats:
    """(m, 4) stress `STRESS_COMPONENTS` at the elements' midpoints, Pa; of a node alone none.

    Args:
        body: the mesh.
        material: its material.
        displacement: (n, 2), m.
    """
    if body.quads.size == 0:
        return np.zeros((0, len(STRESS_COMPONENTS)))
    domain = Domain(body.points, body.quads)
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


def fields(bodies: Sequence[BodyMesh], materials: Sequence[Material]) -> Fields:
    """Of bodies in the (r, z) half-plane."""
    return Fields(
        "quad",
        [(body.points, body.quads) for body in bodies],
        STRESS_COMPONENTS,
        lambda number, local: cell_stress(bodies[number], materials[number], local),
        von_mises,
    )
