"""What a three-dimensional model consists of: elastic bodies, rigid bodies, contacts.

Nothing here knows what the bodies are: plate and spheres are one use.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from ..common.errors import SolverError
from ..explicit.contact import Contact, RigidBody
from .mesh import FACE_EDGES, TetMesh, nodal_sum, shape_functions


@dataclass(frozen=True)
class ElasticBody:
    """A meshed body of one material."""

    mesh: TetMesh
    material: Material
    fixed: Ints
    """Fixed components, 3 * node + direction: supports and planes of symmetry."""
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """At the start, m/s."""


def symmetry_plane(mesh: TetMesh, axis: int) -> Ints:
    """Fixed components of the nodes on the plane of symmetry x_axis = 0."""
    length = float(np.ptp(mesh.points, axis=0).max())
    on = np.flatnonzero(np.abs(mesh.points[:, axis]) < 1e-9 * length)
    return np.asarray(3 * on + axis)


@dataclass(frozen=True)
class Model:
    """Bodies and contacts; all elastic bodies have elements of one order."""

    elastic: tuple[ElasticBody, ...]
    rigid: tuple[RigidBody, ...]
    contacts: tuple[Contact, ...]

    @property
    def first(self) -> Ints:
        """(bodies + 1) first node of each elastic body, then the number of nodes."""
        counts = [body.mesh.points.shape[0] for body in self.elastic]
        return np.cumsum([0, *counts])

    @property
    def meshes(self) -> list[tuple[Floats, Ints]]:
        """Points and cells of the elastic bodies."""
        return [(body.mesh.points, body.mesh.cells) for body in self.elastic]


def _barycentric(points: Floats, triangles: Floats) -> Floats:
    """(n, 3) barycentric coordinates of the projections of points on the triangles' planes."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    e, f, d = b - a, c - a, points - a
    ee, ef, ff = (e * e).sum(1), (e * f).sum(1), (f * f).sum(1)
    de, df = (d * e).sum(1), (d * f).sum(1)
    area = ee * ff - ef * ef
    v, w = (ff * de - ef * df) / area, (ee * df - ef * de) / area
    return np.stack([1.0 - v - w, v, w], axis=1)


def project(points: Floats, mesh: TetMesh, facets: Ints) -> tuple[Ints, Floats, Floats]:
    """The facet nearest to each point: its nodes, shape functions and the place (n, 3) on it.

    Raises:
        SolverError: a point has no facet it projects on.
    """
    triangles = mesh.points[facets[:, :3]]
    centres = triangles.mean(axis=1)
    near = min(16, facets.shape[0])
    _, candidates = cKDTree(centres).query(points, k=near)
    candidates = candidates.reshape(points.shape[0], near)
    best = np.full(points.shape[0], -np.inf)
    chosen = np.zeros(points.shape[0], dtype=np.int64)
    inside = np.zeros((points.shape[0], 3))
    for column in candidates.T:
        coordinates = _barycentric(points, triangles[column])
        least = coordinates.min(axis=1)
        better = least > best + 1e-12
        best[better], chosen[better] = least[better], column[better]
        inside[better] = coordinates[better]
    if best.size and best.min() < -0.05:
        x, y, z = points[int(np.argmin(best))]
        raise SolverError(
            f"no facet of body '{mesh.name}' lies opposite the node at x = {x:.6g} m, "
            f"y = {y:.6g} m, z = {z:.6g} m"
        )
    # At the rim of the surface a projection may lie outside by rounding.
    inside = np.clip(inside, 0.0, None)
    inside /= inside.sum(axis=1, keepdims=True)
    place = np.einsum("nk,nkd->nd", inside, triangles[chosen])
    return facets[chosen], shape_functions(inside, mesh.order), place


def nodal_areas(mesh: TetMesh, facets: Ints) -> Floats:
    """(n,) share of each node in the area of flat facets, m^2; positive, their sum is the area.

    In proportion to the diagonal of the facets' consistent mass (6 : 32), as the lumped mass.
    """
    a, b, c = (mesh.points[facets[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    corner, midside = (1.0 / 3.0, 0.0) if mesh.order == 1 else (1.0 / 19.0, 16.0 / 57.0)
    shares = np.array([corner] * 3 + [midside] * (len(FACE_EDGES) * (mesh.order - 1)))
    count = mesh.points.shape[0]
    return nodal_sum(facets, area[:, None] * shares, count)
