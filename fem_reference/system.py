"""The discrete system: three bodies assembled, constrained, lumped and renumbered."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from scipy.sparse.csgraph import reverse_cuthill_mckee

from .contact import ContactPairs, pair_nodes
from .elasticity import BodyMatrices, assemble
from .errors import SolverError
from .mesh import BodyMesh, Floats, Ints
from .meshing import ImpactMesh
from .scene import Plate, Scene

BODIES = ("outer", "plate", "inner")
OUTER, PLATE, INNER = range(3)


@dataclass(frozen=True)
class System:
    """Everything the time loop needs; nodes are ordered outer, plate, inner."""

    stiffness: scipy.sparse.csr_matrix
    """(2n, 2n), N/m, fixed rows included (they give the support reaction)."""
    mass: Floats
    """(n,) kg"""
    inverse_mass: Floats
    """(2n,) 1/kg, zero where the displacement is fixed."""
    first: Ints
    """(4,) first node of each body, then the number of nodes."""
    numbers: tuple[Ints, Ints, Ints]
    """For each body the system's number of each of its nodes."""
    supports: Ints
    """Nodes whose axial displacement is fixed."""
    centre: tuple[int, int]
    """The plate's centre nodes on its two faces."""
    contacts: tuple[ContactPairs, ContactPairs]
    element_nodes: Ints
    """(m, 4) nodes of all elements."""
    element_stiffness: Floats
    """(m, 8, 8) their matrices, whose sum is ``stiffness``, N/m."""
    element_time_steps: Floats
    """(m,) critical time step of each element alone, s."""

    def body(self, index: int) -> slice:
        """Rows of a body's displacements."""
        return slice(2 * int(self.first[index]), 2 * int(self.first[index + 1]))

    def body_mass(self, index: int) -> float:
        """Mass of a body, kg."""
        return float(self.mass[self.first[index] : self.first[index + 1]].sum())


def plate_constraints(plate: Plate, mesh: BodyMesh) -> Ints:
    """Fixed components (2 * node + component) of the plate.

    On the axis u_r = 0. Clamped: both displacements on the whole rim. Simply supported: u_z on
    the whole rim, which may still rotate since u_r is free there.
    """
    axis = np.flatnonzero(mesh.points[:, 0] == 0.0)
    rim = np.flatnonzero(mesh.points[:, 0] > plate.radius * (1.0 - 1e-9))
    fixed = [2 * axis]
    if plate.edge in ("clamped", "simply-supported"):
        fixed.append(2 * rim + 1)
    if plate.edge == "clamped":
        fixed.append(2 * rim)
    return np.asarray(np.unique(np.concatenate(fixed)))


def _axis_constraints(mesh: BodyMesh) -> Ints:
    return np.asarray(2 * np.flatnonzero(mesh.points[:, 0] == 0.0))


def _renumbering(matrices: BodyMatrices) -> Ints:
    """New number of each node of a body (reverse Cuthill-McKee: neighbours close in memory)."""
    graph = matrices.stiffness.tobsr((2, 2))
    pattern = scipy.sparse.csr_matrix(
        (np.ones(graph.indices.size), graph.indices, graph.indptr),
        shape=(matrices.mass.size, matrices.mass.size),
    )
    order = reverse_cuthill_mckee(pattern, symmetric_mode=True)
    number = np.empty(order.size, dtype=np.int64)
    number[order] = np.arange(order.size)
    return number


def build_system(scene: Scene, mesh: ImpactMesh) -> System:
    """Assemble with dolfinx, constrain and renumber.

    Raises:
        SolverError: a lumped mass is not positive.
    """
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    materials = (scene.outer.material, scene.plate.material, scene.inner.material)
    fixed_of = (
        _axis_constraints(mesh.outer),
        plate_constraints(scene.plate, mesh.plate),
        _axis_constraints(mesh.inner),
    )
    stiffness, mass, inverse, numbers = [], [], [], []
    element_nodes, element_stiffness, element_steps = [], [], []
    first = np.zeros(4, dtype=np.int64)
    for index, (body, material, fixed) in enumerate(zip(bodies, materials, fixed_of, strict=True)):
        matrices = assemble(body, material)
        if not matrices.mass.min() > 0.0:
            node = int(np.argmin(matrices.mass))
            r, z = body.points[node]
            raise SolverError(
                f"node {node} of body '{body.name}' at r = {r:.6g} m, z = {z:.6g} m has the mass "
                f"{matrices.mass[node]:.3g} kg; it must be positive"
            )
        number = _renumbering(matrices)
        order = np.argsort(number)
        rows = (2 * order[:, None] + np.arange(2)).ravel()
        stiffness.append(matrices.stiffness[rows][:, rows])
        mass.append(matrices.mass[order])
        body_inverse = np.repeat(1.0 / matrices.mass, 2)
        body_inverse[fixed] = 0.0
        inverse.append(body_inverse[rows])
        numbers.append(number + first[index])
        elements = matrices.elements
        element_nodes.append(numbers[index][elements.nodes])
        element_stiffness.append(elements.stiffness)
        element_steps.append(elements.critical_time_steps())
        first[index + 1] = first[index] + order.size
    plate_fixed = fixed_of[1]
    supports = numbers[1][plate_fixed[plate_fixed % 2 == 1] // 2]
    contacts = []
    for name, surface, index, gap, normal in (
        ("outer", mesh.outer_contact, 0, 0.0, 1.0),
        ("inner", mesh.inner_contact, 2, scene.gap, -1.0),
    ):
        sphere = scene.outer if index == 0 else scene.inner
        contacts.append(
            pair_nodes(
                name,
                normal,
                numbers[index][surface.sphere_nodes],
                numbers[1][surface.plate_nodes],
                surface.radii,
                sphere,
                gap,
            )
        )
    return System(
        stiffness=scipy.sparse.block_diag(stiffness, format="csr"),
        mass=np.concatenate(mass),
        inverse_mass=np.concatenate(inverse),
        first=first,
        numbers=(numbers[0], numbers[1], numbers[2]),
        supports=np.sort(supports),
        centre=(int(contacts[0].plate_nodes[0]), int(contacts[1].plate_nodes[0])),
        contacts=(contacts[0], contacts[1]),
        element_nodes=np.concatenate(element_nodes),
        element_stiffness=np.concatenate(element_stiffness),
        element_time_steps=np.concatenate(element_steps),
    )


def critical_time_step(system: System) -> float:
    """2 / omega_max of the lumped system, s, from a safe upper estimate of omega_max.

    Lanczos on M^-1/2 K M^-1/2 gives the largest Ritz value; adding the norm of its residual
    makes it an upper bound of the eigenvalue it belongs to.
    """
    root = np.sqrt(system.inverse_mass)
    scaling = scipy.sparse.diags(root)
    operator = (scaling @ system.stiffness @ scaling).tocsr()
    start = np.random.default_rng(1).standard_normal(root.size)
    values, vectors = scipy.sparse.linalg.eigsh(operator, k=1, which="LA", tol=1e-6, v0=start)
    vector = vectors[:, 0]
    residual = float(np.linalg.norm(operator @ vector - values[0] * vector))
    return 2.0 / math.sqrt(float(values[0]) + residual)


def hertz_weights(radii: Floats) -> Floats:
    """Nodal shares (n,) of a unit Hertz pressure over the zone of the nodes at ``radii`` (m).

    Each node gets the pressure sqrt(1 - (r/a)^2) integrated over its ring, whose edges lie midway
    to its neighbours.
    """
    edges = np.concatenate([[0.0], 0.5 * (radii[1:] + radii[:-1]), radii[-1:]])
    return np.asarray(-np.diff((1.0 - (edges / radii[-1]) ** 2) ** 1.5))


def patch_flexibility(system: System, body: int, nodes: Ints, weights: Floats) -> float:
    """Axial flexibility of a body over a patch, p^T K^-1 p, m/N.

    The mean displacement, weighted with ``weights``, under a unit axial force spread with the
    same weights over ``nodes``: static if the body is supported, otherwise that of the free
    body under the force and its own inertia, rigid motion apart (inertia relief).
    """
    rows = system.body(body)
    stiffness = system.stiffness[rows, rows].tocsc()
    free = np.flatnonzero(system.inverse_mass[rows] > 0.0)
    mass = system.mass[system.first[body] : system.first[body + 1]]
    load = np.zeros(2 * mass.size)
    load[2 * (nodes - system.first[body]) + 1] = weights
    patch = load.copy()
    supported = bool(
        np.any((system.supports >= system.first[body]) & (system.supports < system.first[body + 1]))
    )
    if not supported:
        load[1::2] -= mass / mass.sum()
        # One axial component pinned: the load is in equilibrium, so the pin carries nothing.
        free = free[free != 2 * mass.size - 1]
    solution = np.zeros_like(load)
    solution[free] = scipy.sparse.linalg.splu(stiffness[free][:, free]).solve(load[free])
    if not supported:
        solution[1::2] -= mass @ solution[1::2] / mass.sum()
    return float(patch @ solution)
