"""The discrete system: three bodies assembled, constrained, lumped and renumbered."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..common.arrays import Floats, Ints, Mask
from ..common.bodies import Plate, Relaxation
from ..explicit.contact import Contact, MatchedContact, RigidBody
from ..explicit.film import Film
from ..explicit.parts import Rows
from ..explicit.plastic import Plasticity
from .elasticity import BodyMatrices, global_matrix
from .mesh import BodyMesh
from .stack import StackBody
from .tip import ring_edges

BODIES = ("outer", "plate", "inner")
OUTER, PLATE, INNER = range(3)


@dataclass(frozen=True)
class AxisymmetricSystem:
    """See `explicit.system.System`; nodes are ordered outer, plate, inner, components r, z."""

    stiffness: scipy.sparse.csr_matrix
    """(2n, 2n), N/m, fixed rows included (they give the support reaction)."""
    points: Floats
    """(n, 2) m"""
    mass: Floats
    """(n,) kg"""
    inverse_mass: Floats
    """(2n,) 1/kg, zero where the displacement is fixed."""
    velocity: Floats
    """(n, 2) at the start, m/s"""
    first: Ints
    """(4,) first node of each body, then the number of nodes."""
    numbers: tuple[Ints, Ints, Ints]
    """For each body the system's number of each of its nodes."""
    supports: Ints
    """Nodes whose axial displacement is fixed."""
    watched: tuple[Ints, Floats]
    """Nodes (k,) of the plate's faces and their shares (k,) in its observed motion."""
    matched: tuple[MatchedContact, MatchedContact]
    """Outer and inner body, whose nodes are the candidates, with the plate."""
    element_nodes: Ints
    """(m, 4) nodes of all elements."""
    element_stiffness: Floats
    """(m, 8, 8) their matrices, whose sum is ``stiffness``, N/m."""
    element_steps: Floats
    """(m,) critical time step of each element alone, s."""
    film: Film | None = None
    """Between the plate and the inner body."""
    rigid: tuple[RigidBody, ...] = ()
    contacts: tuple[Contact, ...] = ()
    free_axes: tuple[int, ...] = (1,)
    displacement: Floats | None = None
    """(n, 2) at the start, m; None: none."""
    relaxations: tuple[tuple[Relaxation, ...], ...] = ((), (), ())
    tip: int | None = None
    """Node whose motion is the outer body's, if that is a beam."""
    stack: StackBody | None = None
    """The outer body, if it is one; its tip is `tip`."""
    plasticity: Plasticity | None = None
    """Of the boxes around the contacts of bodies that yield."""

    @property
    def owned(self) -> Ints:
        """(n,) all nodes."""
        return np.arange(self.mass.size)

    @property
    def ghosts(self) -> Ints:
        """None: there is one process."""
        return np.zeros(0, dtype=np.int64)

    @property
    def supported(self) -> Mask:
        """(n,) nodes of the support."""
        supported = np.zeros(self.mass.size, dtype=bool)
        supported[self.supports] = True
        return supported

    def element_time_steps(self) -> Floats:
        """(m,) critical time step of each element alone, s."""
        return self.element_steps

    def part(self, chosen: Mask | None) -> scipy.sparse.csr_matrix:
        """(2n, 2n) stiffness of some elements (m,), or of all, N/m."""
        which = slice(None) if chosen is None else chosen
        nodes, stiffness = self.element_nodes[which], self.element_stiffness[which]
        return global_matrix(nodes, stiffness, self.mass.size)

    def operator(self) -> Rows:
        """K for the compiled loop."""
        return Rows.of(self.part, 2)

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


def axis_constraints(mesh: BodyMesh) -> Ints:
    """Fixed components of a body that is held by nothing but its axis: u_r = 0 there."""
    return np.asarray(2 * np.flatnonzero(mesh.points[:, 0] == 0.0))


def renumbering(matrices: BodyMatrices) -> Ints:
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


def critical_time_step(system: AxisymmetricSystem) -> float:
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


def hertz_weights(radii: Floats, circle: float | None = None) -> Floats:
    """Nodal shares (n,) of a unit Hertz pressure over the nodes at ``radii`` (m).

    Each node gets the pressure sqrt(1 - (r/a)^2) integrated over its ring, whose edges lie midway
    to its neighbours.

    Args:
        radii: of the nodes, ascending from 0, m.
        circle: the contact radius a, at most the largest of them, which it is by default, m.
    """
    inside = np.minimum(ring_edges(radii) / (circle or radii[-1]), 1.0)
    return np.asarray(-np.diff((1.0 - inside**2) ** 1.5))
