"""Mass of the fluid that a plate moves: potential flow on one side, a rigid wall around the plate.

Laplace's equation for the potential phi of the velocity in the half-space behind the plate,
dphi/dn = w on the plate, 0 on the wall. Seen from afar the plate is a source: on the outer faces
dphi/dn = -phi (n . x)/|x|^2, which the flow misses by the fifth power of their distance only. The
fluid's kinetic energy is 1/2 w^T M w; incompressible and without viscosity (Lamb 1920, Proc. R.
Soc. A 98, 205, for the clamped plate).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse.linalg
import ufl

from ..common.arrays import Floats, Ints
from ..common.bodies import Plate
from ..common.errors import SolverError
from ..common.fenicsx import Domain
from .mesh import BodyMesh
from .modal import plate_modes

ELEMENTS = 24
"""Along the plate's radius."""
GROWTH = 6.0
"""Of neighbouring elements away from the plate, times the number of `ELEMENTS`."""
OUTSIDE = 8.0
"""Distance of the outer faces over the plate's radius."""


@dataclass(frozen=True)
class AddedMass:
    """Of one side of a plate."""

    radii: Floats
    """(n,) of the nodes on the plate's face, ascending from 0 to its edge, m."""
    matrix: Floats
    """(n, n) m^3; times the fluid's density it is the mass that goes with the nodes' velocity."""


def _stretched(first: float, growth: float, end: float) -> Floats:
    """Places from 0 to at least ``end``, elements longer by ``growth`` each, from ``first`` on."""
    count = math.ceil(math.log1p(growth * end / first) / math.log1p(growth))
    return np.asarray(first * ((1.0 + growth) ** np.arange(count + 1) - 1.0) / growth)


def _fluid_mesh(radius: float, elements: int) -> BodyMesh:
    """Rectangles, even along the plate's face at z = 0."""
    z = _stretched(radius / elements, GROWTH / elements, OUTSIDE * radius)
    r = np.concatenate([np.linspace(0.0, radius, elements + 1), radius + z[1:]])
    points = np.stack(np.meshgrid(r, z, indexing="ij"), axis=2).reshape(-1, 2)
    corner = (np.arange(r.size - 1)[:, None] * z.size + np.arange(z.size - 1)).ravel()
    quads = np.stack([corner, corner + z.size, corner + z.size + 1, corner + 1], axis=1)
    return BodyMesh("fluid", points, quads)


def _flow_matrices(mesh: BodyMesh, domain: Domain, radius: float) -> tuple[Any, Any]:
    """Of the flow and of the plate's face: int grad phi . grad psi, and int phi psi there."""
    phi, psi = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
    x, normal = ufl.SpatialCoordinate(domain.mesh), ufl.FacetNormal(domain.mesh)
    degree = {"quadrature_degree": 2 * domain.degree + 2}
    dx = ufl.Measure("dx", domain=domain.mesh, metadata=degree)
    ds = ufl.Measure("ds", domain=domain.mesh, metadata=degree)
    around = 2.0 * math.pi * x[0]
    far_r, far_z = mesh.points.max(axis=0) * (1.0 - 1e-9)
    outside = ufl.conditional(ufl.Or(ufl.gt(x[0], far_r), ufl.gt(x[1], far_z)), 1.0, 0.0)
    on_plate = ufl.conditional(ufl.And(ufl.lt(x[0], radius), ufl.lt(x[1], 1e-9 * radius)), 1.0, 0.0)
    source = ufl.dot(normal, x) / ufl.dot(x, x)
    flow = ufl.inner(ufl.grad(phi), ufl.grad(psi)) * around * dx
    flow += outside * source * phi * psi * around * ds
    return domain.matrix(flow), domain.matrix(on_plate * phi * psi * around * ds)


def added_mass(radius: float, elements: int = ELEMENTS, degree: int = 2) -> AddedMass:
    """Of the fluid on one side of a plate of ``radius`` (m), by finite elements of ``degree``."""
    mesh = _fluid_mesh(radius, elements)
    domain = Domain(mesh.points, mesh.quads, degree, components=1)
    flow, face = _flow_matrices(mesh, domain, radius)
    nodes = domain.points_of_nodes()
    on_plate: Ints = np.flatnonzero(
        (nodes[:, 1] < 1e-9 * radius) & (nodes[:, 0] < radius * (1.0 + 1e-9))
    )
    on_plate = on_plate[np.argsort(nodes[on_plate, 0])]
    loads = face.tocsc()[:, on_plate].toarray()
    potentials = scipy.sparse.linalg.splu(flow.tocsc()).solve(loads)
    radii = nodes[on_plate, 0]
    radii[0] = 0.0
    return AddedMass(radii, np.asarray(loads.T @ potentials))


def wet_frequencies(plate: Plate, mesh: BodyMesh, count: int, density: float) -> Floats:
    """(count,) lowest eigenfrequencies with a fluid (kg/m^3) on one side of the plate, Hz.

    The wet shapes are sums of the dry ones (Rayleigh & Ritz), of which twice as many are taken and
    eight more; the rigid motion of a free plate is among them and left out of the result.

    Raises:
        SolverError: as `plate_modes`.
    """
    dry = plate_modes(plate, mesh, 2 * count + 8, rigid=True)
    fluid = added_mass(plate.radius, max(ELEMENTS, 2 * len(dry)))
    shapes = np.array([np.interp(fluid.radii, *mode.face) for mode in dry])
    stiffness = np.diag([(2.0 * math.pi * mode.frequency) ** 2 for mode in dry])
    mass = np.eye(len(dry)) + density * shapes @ fluid.matrix @ shapes.T
    squares = scipy.linalg.eigh(stiffness, mass, eigvals_only=True)
    rigid = 1 if plate.edge == "free" else 0
    if not squares[rigid] > 0.0:
        raise SolverError("the wet plate's lowest eigenvalue is not positive")
    return np.asarray(np.sqrt(squares[rigid : rigid + count]) / (2.0 * math.pi))
