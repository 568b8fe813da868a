"""Rigid bodies, and what can touch what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..common.arrays import Floats, Ints

FREE = np.eye(3)


@dataclass(frozen=True)
class RigidBody:
    """A body that does not deform, and turns by friction alone."""

    name: str
    mass: float
    """kg, of the part that is modelled (a half or a quarter with planes of symmetry)."""
    directions: Floats = field(default_factory=lambda: FREE.copy())
    """(3, 3) projector on the directions in which it may move: `guided`, or all."""
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """At the start, m/s."""
    turning: Floats = field(default_factory=lambda: np.zeros((3, 3)))
    """(3, 3) inverse inertia about its centre, of the part modelled, 1/(kg m^2)."""


def guided(*axes: Sequence[float]) -> Floats:
    """Projector on the space spanned by ``axes``: one for a guide, two for a plane of symmetry."""
    basis, _ = np.linalg.qr(np.array(axes, dtype=np.float64).T)
    return np.asarray(basis @ basis.T)


@dataclass(frozen=True)
class SphereContact:
    """Nodes of an elastic body against a sphere that is part of a rigid body."""

    name: str
    body: int
    nodes: Ints
    """Candidates: nodes of the body that can touch."""
    rigid: int
    centre: tuple[float, float, float]
    """At the start, m."""
    radius: float
    places: Floats | None = None
    """(n, 3) where the exact body has its candidates, if not where its mesh has them, m."""
    friction: float = 0.0
    """Coulomb's coefficient."""


@dataclass(frozen=True)
class SurfaceContact:
    """Nodes of an elastic body against the surface of another one, meshes not matching.

    The pairs stay as they are made (displacements small against the elements), unless whoever
    runs the model makes new ones (`ContactProblem.pair`).
    """

    name: str
    body: int
    nodes: Ints
    """(n,) candidates."""
    target: int
    facets: Ints
    """(n, 3) or (n, 6) nodes of the facet opposite each candidate."""
    weights: Floats
    """Shape functions of the facet where the candidate meets it."""
    normals: Floats
    """(n, 3) unit normal, from the target to the candidate."""
    gaps: Floats
    """(n,) initial gap, m, of the exact bodies rather than their meshes."""
    reachable: Ints | None = None
    """Nodes of the target that later pairs may have, if there are to be any."""
    friction: float = 0.0
    """Coulomb's coefficient."""


@dataclass(frozen=True)
class MatchedContact:
    """Surface nodes of two bodies that match, in the numbering of all nodes."""

    name: str
    normal: float
    """+1 if the candidates lie above the nodes opposite along the last axis, else -1."""
    candidates: Ints
    opposite: Ints
    radii: Floats
    """(n,) distances from the axis, ascending, m."""
    gaps: Floats
    """(n,) initial gap of each pair, m."""
    flexibility: Floats | None = None
    """(n, n) of a tip without mass that stands between the pairs' two sides, m/N; the candidates
    are then one and the same node."""
    friction: float = 0.0
    """Coulomb's coefficient; only without such a tip."""


Contact = SphereContact | SurfaceContact
