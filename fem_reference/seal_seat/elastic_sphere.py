"""Contact of the seat with a sphere that deforms: pairs of seat nodes and facets of the sphere.

While the sphere is launched it slides up the cone by as much as an element, so that the pairs have
to be made anew as it moves. The distance is always that of the exact, displaced sphere, plus what
its mesh says about its deformation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from ..solid.mesh import TetMesh, surface
from ..solid.model import project
from .scene import SeatScene


@dataclass(frozen=True)
class Pairs:
    """Candidates of the seat and what of the sphere lies opposite."""

    facets: Ints
    """(n, 3) or (n, 6) nodes of the sphere."""
    weights: Floats
    normals: Floats
    """(n, 3) from the sphere to the candidate."""
    gaps: Floats
    """(n,) m, for the displacements the pairs were made with: distance = gap + normal .
    (candidate's - facet's displacement)."""


def touching_facets(scene: SeatScene, mesh: TetMesh) -> Ints:
    """Facets of the sphere's surface that the cone can meet."""
    ring = scene.ring()
    facets = surface(mesh)
    outside = ~np.all(mesh.points[facets[:, :3]][:, :, 1] == 0.0, axis=1)
    s, _ = ring.coordinates(mesh.points[facets[:, :3]].mean(axis=1))
    # The lower part, well beyond the ring to both sides.
    return np.asarray(facets[outside & (s < 0.3 * ring.offset)])


def sphere_pairs(
    scene: SeatScene,
    mesh: TetMesh,
    facets: Ints,
    places: Floats,
    sphere_displacement: Floats,
    mean: Floats | None = None,
    seat_displacement: Floats | None = None,
) -> Pairs:
    """Pair the candidates at ``places`` (n, 3), in their present state, with the sphere's facets.

    Args:
        scene: for the exact sphere.
        mesh: of the sphere.
        facets: those that can touch.
        places: of the candidates before any displacement, m.
        sphere_displacement: (m, 3) of the sphere's nodes, m.
        mean: (3,) displacement of the sphere's centre of mass, m; None: zero.
        seat_displacement: (n, 3) of the candidates, m; None: zero.
    """
    radius, start = scene.sphere_radius, np.array(scene.ring().sphere_centre)
    moved = np.zeros(3) if mean is None else mean
    of_seat = np.zeros_like(places) if seat_displacement is None else seat_displacement
    away = places + of_seat - start - moved
    distance = np.linalg.norm(away, axis=1)
    normals = away / distance[:, None]
    # The mesh at rest: deformation moves a place on it by far less than an element.
    chosen, weights, _ = project(start + radius * normals, mesh, facets)
    of_sphere = np.einsum("nk,nkd->nd", weights, sphere_displacement[chosen])
    bulge = ((of_sphere - moved) * normals).sum(axis=1)
    gaps = distance - radius - bulge - ((of_seat - of_sphere) * normals).sum(axis=1)
    return Pairs(chosen, weights, normals, gaps)
