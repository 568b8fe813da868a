"""The mesh of one axisymmetric body and what can be said about its elements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError


@dataclass(frozen=True)
class BodyMesh:
    """Quadrilaterals of one body in the (r, z) half-plane."""

    name: str
    points: Floats
    """(n, 2): r and z of the nodes, m."""
    quads: Ints
    """(m, 4): nodes of each element, counter-clockwise."""

    def volume(self) -> float:
        """Volume of the body of revolution, m^3 (exact for the polygon)."""
        return float(np.sum(element_volumes(self.points, self.quads)))


def face_nodes(points: Floats, z: float) -> Ints:
    """Nodes of the flat face at z (m), which is not 0, by radius."""
    face = np.flatnonzero(np.abs(points[:, 1] - z) < 1e-9 * abs(z))
    return np.asarray(face[np.argsort(points[face, 0])])


def element_volumes(points: Floats, quads: Ints) -> Floats:
    """(m,) volumes swept by the elements: 2 pi times area times centroid radius (Pappus), m^3."""
    corners = points[quads]
    following = np.roll(corners, -1, axis=1)
    cross = corners[..., 0] * following[..., 1] - following[..., 0] * corners[..., 1]
    first_moment = np.sum((corners[..., 0] + following[..., 0]) * cross, axis=1) / 6.0
    return np.asarray(2.0 * math.pi * first_moment)


def scaled_jacobians(points: Floats, quads: Ints) -> Floats:
    """(m,) least sine of the corner angles, signed: 1 for a rectangle, <= 0 if degenerate."""
    corners = points[quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    lengths = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        sines = np.where(lengths > 0.0, cross / lengths, 0.0)
    return np.asarray(sines.min(axis=1))


def edge_lengths(points: Floats, quads: Ints) -> Floats:
    """(m, 4) lengths of the elements' edges, m."""
    corners = points[quads]
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))


MINIMUM_QUALITY = 0.05
"""Least scaled Jacobian accepted."""


def check_elements(mesh: BodyMesh) -> float:
    """Return the least scaled Jacobian of a mesh.

    Raises:
        SolverError: an element is degenerate or nearly so; its number and place are named.
    """
    quality = scaled_jacobians(mesh.points, mesh.quads)
    worst = int(np.argmin(quality))
    if not quality[worst] > MINIMUM_QUALITY:
        r, z = mesh.points[mesh.quads[worst]].mean(axis=0)
        raise SolverError(
            f"element {worst} of body '{mesh.name}' at r = {r:.6g} m, z = {z:.6g} m is degenerate: "
            f"scaled Jacobian {quality[worst]:.3g}, at least {MINIMUM_QUALITY} is required"
        )
    return float(quality[worst])
