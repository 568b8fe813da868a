"""Contact with a sphere that deforms: pairs of nodes of another body and facets of the sphere.

While a sphere slides, the pairs have to be made anew as it moves. The distance is always that of
the exact, displaced sphere, plus what its mesh says about its deformation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from .mesh import TetMesh
from .model import project


@dataclass(frozen=True)
class Ball:
    """A sphere before any displacement."""

    centre: tuple[float, float, float]
    """m"""
    radius: float
    """m"""


@dataclass(frozen=True)
class Pairs:
    """Candidates of the other body and what of the sphere lies opposite."""

    facets: Ints
    """(n, 3) or (n, 6) nodes of the sphere."""
    weights: Floats
    normals: Floats
    """(n, 3) from the sphere to the candidate."""
    gaps: Floats
    """(n,) m, for the displacements the pairs were made with: distance = gap + normal .
    (candidate's - facet's displacement)."""


def sphere_pairs(
    ball: Ball,
    mesh: TetMesh,
    facets: Ints,
    places: Floats,
    sphere_displacement: Floats,
    mean: Floats | None = None,
    displacement: Floats | None = None,
) -> Pairs:
    """Pair the candidates at ``places`` (n, 3), in their present state, with the sphere's facets.

    The sphere's rotation is left out where its facets are looked up: it is the same all around.

    Args:
        ball: the exact sphere.
        mesh: of the sphere.
        facets: those that can touch.
        places: of the candidates before any displacement, m.
        sphere_displacement: (m, 3) of the sphere's nodes, m.
        mean: (3,) displacement of the sphere's centre of mass, m; None: zero.
        displacement: (n, 3) of the candidates, m; None: zero.
    """
    radius, start = ball.radius, np.array(ball.centre)
    moved = np.zeros(3) if mean is None else mean
    of_candidates = np.zeros_like(places) if displacement is None else displacement
    away = places + of_candidates - start - moved
    distance = np.linalg.norm(away, axis=1)
    normals = away / distance[:, None]
    # The mesh at rest: deformation moves a place on it by far less than an element.
    chosen, weights, _ = project(start + radius * normals, mesh, facets)
    of_sphere = np.einsum("nk,nkd->nd", weights, sphere_displacement[chosen])
    bulge = ((of_sphere - moved) * normals).sum(axis=1)
    gaps = distance - radius - bulge - ((of_candidates - of_sphere) * normals).sum(axis=1)
    return Pairs(chosen, weights, normals, gaps)
