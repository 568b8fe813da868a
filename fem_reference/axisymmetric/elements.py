"""Bilinear quadrilaterals with incompatible modes, axisymmetric: stiffness and mass per element.

A bilinear element cannot bend: its shear strain grows with the moment (parasitic shear), by some
(1 - nu)/2 (length/thickness)^2 of the bending stiffness. Wilson's two bubbles 1 - xi^2 and
1 - eta^2 per displacement component, condensed out inside each element, take that away. The mean
strain of the bubbles over the element is subtracted (Wilson & Ibrahimbegovic 1990, Finite Elements
in Analysis and Design 7, 229): then a state of constant stress does no work on them, and the patch
test holds for any shape of element and with the weight 2 pi r.

dolfinx integrates in the discontinuous biquadratic space, which contains the corner functions and
the bubbles of one element each; what is left is algebra on small matrices.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
import ufl

from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from ..common.errors import SolverError
from ..common.fenicsx import Domain
from .mesh import BodyMesh

_REFERENCE = np.array(
    [(0, 0), (1, 0), (0, 1), (1, 1), (0.5, 0), (0, 0.5), (1, 0.5), (0.5, 1), (0.5, 0.5)]
)
"""Nodes of the biquadratic element in dolfinx's order."""


@dataclass(frozen=True)
class ElementMatrices:
    """Matrices of all elements of a body."""

    nodes: Ints
    """(m, 4) the body's nodes of each element, in the order of the matrices."""
    stiffness: Floats
    """(m, 8, 8), row 2 * corner + component (r, z), N/m."""
    mass: Floats
    """(m, 4) row sums of the consistent mass matrix, kg."""

    def critical_time_steps(self) -> Floats:
        """(m,) 2/omega_max of each element alone, s; no system of them has a smaller one.

        Infinite without stiffness.
        (Irons' bound: the largest eigenvalue of assembled matrices is at most that of the worst
        element.)
        """
        root = np.repeat(1.0 / np.sqrt(self.mass), 2, axis=1)
        scaled = root[:, :, None] * self.stiffness * root[:, None, :]
        with np.errstate(divide="ignore"):
            return np.asarray(2.0 / np.sqrt(np.linalg.eigvalsh(scaled)[:, -1]))


def _shape_functions() -> tuple[Floats, Floats]:
    """Values at the biquadratic nodes: (9, 4) corner functions and (9, 2) bubbles."""
    s, t = _REFERENCE.T
    corners = np.stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t], axis=1)
    return corners, np.stack([4 * s * (1 - s), 4 * t * (1 - t)], axis=1)


def _by_component(values: Floats) -> Floats:
    """(18, 2k) transformation of vector functions from (9, k) values of scalar ones."""
    return np.asarray(np.kron(values, np.eye(2)))


def _elasticity_matrix(material: Material) -> Floats:
    """(4, 4) from (e_rr, e_tt, e_zz, g_rz) to stress, Pa."""
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = material.lame_lambda
    matrix[range(3), range(3)] += 2.0 * material.shear_modulus
    matrix[3, 3] = material.shear_modulus
    return matrix


def _condense(raw: Floats, strain: Floats, volume: Floats, material: Material) -> Floats:
    """(m, 8, 8) stiffness without the bubbles.

    Args:
        raw: (m, 18, 18) biquadratic stiffness.
        strain: (m, 4, 18) integral of each strain component over the element, m^3 per m.
        volume: (m,) m^3.
        material: of the body.
    """
    corner_values, bubble_values = _shape_functions()
    corner, bubble = _by_component(corner_values), _by_component(bubble_values)
    d = _elasticity_matrix(material)
    corner_strain, bubble_strain = strain @ corner, strain @ bubble
    mean = bubble_strain / volume[:, None, None]
    kcc = corner.T @ raw @ corner
    kbc = bubble.T @ raw @ corner - mean.transpose(0, 2, 1) @ d @ corner_strain
    kbb = bubble.T @ raw @ bubble - mean.transpose(0, 2, 1) @ d @ bubble_strain
    stiffness = kcc - kbc.transpose(0, 2, 1) @ np.linalg.solve(kbb, kbc)
    return np.asarray(0.5 * (stiffness + stiffness.transpose(0, 2, 1)))


def element_matrices(
    body: BodyMesh, material: Material, strain_of: Any, form: Any
) -> ElementMatrices:
    """Integrate with dolfinx and condense.

    Args:
        body: the mesh.
        material: of the body.
        strain_of: (u, r) -> UFL vector (e_rr, e_tt, e_zz, g_rz).
        form: (domain, material) -> UFL bilinear form of the stiffness, quadrature of the
            bilinear element.

    Raises:
        SolverError: dolfinx numbers the nodes of an element in an unexpected way.
    """
    domain = Domain(body.points, body.quads, 2, discontinuous=True)
    count = body.quads.shape[0]
    dofs = domain.cell_dofs()
    corners = domain.cell_corners()
    nodes = domain.points_of_nodes()[dofs]
    expected = _shape_functions()[0] @ body.points[corners]
    size = np.abs(body.points).max()
    if not np.allclose(nodes, expected, rtol=0.0, atol=1e-9 * size):
        raise SolverError("this release of dolfinx numbers biquadratic nodes in another order")
    rows = (2 * dofs[:, :, None] + np.arange(2)).reshape(count, 18)
    matrix = domain.matrix(form(domain, material))[rows.ravel()][:, rows.ravel()]
    blocks = scipy.sparse.bsr_matrix(matrix.tobsr((18, 18)))
    if not np.array_equal(blocks.indices, np.arange(count)):
        raise SolverError("the stiffness of the discontinuous space couples elements")
    v = ufl.TestFunction(domain.space)
    r = ufl.SpatialCoordinate(domain.mesh)[0]
    measure = ufl.Measure("dx", domain=domain.mesh, metadata={"quadrature_degree": 3})
    factors = [domain.constant(0.0) for _ in range(5)]
    strains = strain_of(v, r)
    integrand = sum(factor * strains[k] for k, factor in enumerate(factors[:4])) + factors[4] * v[1]
    linear = integrand * 2.0 * math.pi * r * measure
    integrals = np.empty((count, 5, 18))
    for k in range(5):
        for j, factor in enumerate(factors):
            factor.value = float(j == k)
        integrals[:, k] = domain.vector(linear)[rows]
    corner = _by_component(_shape_functions()[0])
    shares = (integrals[:, 4] @ corner)[:, 1::2]
    stiffness = _condense(blocks.data, integrals[:, :4], shares.sum(axis=1), material)
    return ElementMatrices(corners, stiffness, material.density * shares)
