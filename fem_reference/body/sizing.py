"""Element sizes for a CAD part: by its walls, by the contacts, by its singular edges.

Lengths are in the unit of gmsh's model. The wall's thickness is found by rays through a first,
coarse mesh of the surface; gmsh interpolates the sizes that follow from it on a grid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh
import numpy as np
from scipy.integrate import trapezoid
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from ..common.arrays import Floats
from .skin import Skin

WALL_SHARE = 0.5
"""Largest element over the wall: two layers. With 0.68 some walls of a thin box had one, and its
efficiency was 3.7 % off, where the coarser mesh showed 1 %."""
CONTACT_SHARE = 0.12
"""Element at a contact over the wall there."""
LEAST_CONTACT_SHARE = 0.03
"""The same next to an edge, at least."""
CIRCLES = 3.0
"""Radius of the zone of smallest elements at a contact, over their size."""
EDGE_SHARE = 0.28
"""Element at a contact over the distance of an edge: the circles stay inside the face."""
SINGULAR_EDGE_SHARE = 0.5
"""Element along a fixed edge or in a sharp inner corner, where the stress is singular, over that of
the wall there. Without smaller ones a box's frequencies fall so slowly that five meshes do not show
how far."""
GROWTH = 0.3
"""Of the element size per distance."""
MOST_DOFS = 250_000
LEAST_DOFS = 40_000
FINEST_SCALE, COARSEST_SCALE, SCALE_STEP = 0.25, 20.0, 1.02
"""Least and largest factor on the sizes that keeps to these bounds; steps in which it is found."""
DOFS_PER_CUBE = 14.4
"""Degrees of freedom in the volume of size^3, as gmsh's Delaunay meshes have them."""
RAYS = 2000
GRID = 40
"""Intervals of the grid along the body's longest side."""
SMALLEST_SHARE = 1e-3
"""Smallest element over the body's longest side: at the tip of a cone curvature has no bound."""
PER_CIRCLE, LEAST_PER_CIRCLE = 10.0, 6.0
"""Elements around a circle at size factor 1, and at any."""
OBLIQUE = 0.5
"""Least cosine between a ray and the normal where it leaves; others measure no wall."""


@dataclass(frozen=True)
class Walls:
    """Thickness of a body at points of its surface."""

    places: Floats
    """(k, 3)"""
    thickness: Floats
    """(k,) infinite where the other side lies askew."""
    areas: Floats
    """(k,) of the surface around each."""

    def radii(self) -> Floats:
        """(k,) of the surface around each."""
        return np.asarray(np.sqrt(self.areas / math.pi))


@dataclass(frozen=True)
class ContactSize:
    """Elements at a contact."""

    point: int
    """Tag of gmsh's point there."""
    place: Floats
    size: float
    zone: float
    """Radius of the zone in which they are that small."""


@dataclass(frozen=True)
class Sizes:
    """Element sizes at size factor 1."""

    places: Floats
    radii: Floats
    """(k,) within which the size at a place holds."""
    far: Floats
    """(k,) at the places of the surface."""
    contacts: Sequence[ContactSize]
    scale: float
    """Factor on the sizes away from the contacts that keeps the number of unknowns within bounds:
    above 1 the mesh is coarser."""
    dofs: float
    """Estimated."""

    def at(self, places: Floats) -> Floats:
        """(n,) sizes of the walls alone."""
        tree = cKDTree(self.places)
        distance, index = tree.query(places, k=min(8, self.places.shape[0]))
        away = np.maximum(distance - self.radii[index], 0.0)
        return np.asarray((self.far[index] + GROWTH * away).min(axis=1)) * self.scale


def walls(skin: Skin) -> Walls:
    """Thickness by a ray from each triangle of the surface, or from as many of them as suffice."""
    step = max(1, math.ceil(skin.faces.shape[0] / RAYS))
    chosen = np.arange(0, skin.faces.shape[0], step)
    places, normals = skin.centres[chosen], skin.normals(np.full(3, 1 / 3))[chosen]
    thickness = np.full(chosen.size, np.inf)
    facing = skin.normals(np.full(3, 1 / 3))
    for k, (place, normal) in enumerate(zip(places, normals, strict=True)):
        through = skin.exit(place, -normal)
        if through and -normal @ facing[through[1]] > OBLIQUE:
            thickness[k] = through[0]
    return Walls(places, thickness, skin.areas[chosen] * step)


def graded(places: Floats, radii: Floats, sizes: Floats) -> Floats:
    """Sizes that grow by at most `GROWTH` per distance from the places, beyond their radii."""
    found = np.empty_like(sizes)
    for k in range(0, sizes.size, 500):
        away = cdist(places[k : k + 500], places)
        beyond = np.maximum(away - radii[None], 0.0)
        found[k : k + 500] = (sizes[None] + GROWTH * beyond).min(axis=1)
    return found


def requested_sizes(found: Walls, largest: float | None) -> Floats:
    """(k,) sizes that the walls, and a largest size, ask for at the places of the surface."""
    requested = np.minimum(WALL_SHARE * found.thickness, largest or math.inf)
    requested = np.minimum(requested, WALL_SHARE * np.ptp(found.places, axis=0).max())
    return graded(found.places, found.radii(), requested)


def wall_at(found: Walls, place: Floats, along_normal: float) -> float:
    """The wall that decides at a contact: the one along its normal, or a neighbouring one.

    A rod that is struck at its end is as thick as its diameter, not as long as it is.
    """
    near = Sizes(found.places, found.radii(), requested_sizes(found, None), (), 1.0, 0.0)
    return min(along_normal, float(near.at(place[None])[0]) / WALL_SHARE)


def chosen_sizes(found: Walls, contacts: Sequence[ContactSize], largest: float | None) -> Sizes:
    """Sizes everywhere, scaled so that the number of unknowns stays within bounds."""
    far = requested_sizes(found, largest)
    finite = found.thickness[np.isfinite(found.thickness)]
    thickest = finite.max() if finite.size else np.ptp(found.places, axis=0).max()
    thick = np.minimum(found.thickness, thickest)
    cubes = float((0.5 * found.areas * thick / far**3).sum())
    near = [int(np.argmin(np.linalg.norm(found.places - each.place, axis=1))) for each in contacts]

    def dofs(scale: float) -> float:
        at_contacts = sum(
            _cubes_at(each.size, float(thick[k]), scale * float(far[k]))
            for each, k in zip(contacts, near, strict=True)
        )
        return DOFS_PER_CUBE * (cubes / scale**3 + at_contacts)

    scale = 1.0
    while dofs(scale) > MOST_DOFS and scale < COARSEST_SCALE:
        scale *= SCALE_STEP
    while dofs(scale) < LEAST_DOFS and scale > FINEST_SCALE:
        scale /= SCALE_STEP
    return Sizes(found.places, found.radii(), far, contacts, scale, dofs(scale))


def _cubes_at(size: float, wall: float, far: float) -> float:
    """Cubes of an element's size around a contact, beyond those of the wall."""
    radius = np.linspace(0.0, CIRCLES * size + max(far - size, 0.0) / GROWTH, 400)
    there = np.minimum(size + GROWTH * np.maximum(0.0, radius - CIRCLES * size), far)
    shell = 2.0 * math.pi * radius * np.minimum(radius, wall)
    return float(trapezoid(shell * (1.0 / there**3 - 1.0 / far**3), radius))


def set_sizes(
    sizes: Sizes, factor: float, edges: Sequence[tuple[int, float]], folder: Path
) -> None:
    """Make the sizes gmsh's background field.

    Args:
        sizes: at factor 1.
        factor: all of them times this.
        edges: tags of curves along which the stress is singular, and the size along each.
        folder: for the grid's file, which has to stay until the mesh is made.
    """
    contacts = [replace(c, size=factor * c.size, zone=factor * c.zone) for c in sizes.contacts]
    edges = [(curve, factor * size) for curve, size in edges]
    grid = grid_field(folder / "sizes.txt", sizes.places, lambda at: factor * sizes.at(at))
    side = float(np.ptp(sizes.places, axis=0).max())
    requested = [each.size for each in contacts] + [size for _, size in edges]
    smallest = min(SMALLEST_SHARE * side, *(0.5 * size for size in requested))
    gmsh.option.setNumber("Mesh.MeshSizeMin", smallest)
    set_fields([grid], contacts, edges, max(PER_CIRCLE / factor, LEAST_PER_CIRCLE))


def set_fields(
    fields: list[int],
    contacts: Sequence[ContactSize],
    edges: Sequence[tuple[int, float]] = (),
    per_circle: float = 0.0,
    growth: float = GROWTH,
) -> None:
    """Make the least of several sizes gmsh's background field.

    Args:
        fields: of gmsh.
        contacts: elements at them.
        edges: tags of curves, and the size along each.
        per_circle: elements around a circle, at least; 0: any number.
        growth: of the size per distance from contacts and edges.
    """
    for contact in contacts:
        distance = gmsh.model.mesh.field.add("Distance")
        gmsh.model.mesh.field.setNumbers(distance, "PointsList", [contact.point])
        fields.append(_threshold(distance, contact.size, contact.zone, growth))
    for curve, size in edges:
        distance = gmsh.model.mesh.field.add("Distance")
        gmsh.model.mesh.field.setNumbers(distance, "CurvesList", [curve])
        gmsh.model.mesh.field.setNumber(distance, "Sampling", 200)
        fields.append(_threshold(distance, size, 0.0, growth))
    least = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(least, "FieldsList", fields)
    gmsh.model.mesh.field.setAsBackgroundMesh(least)
    for source, value in (
        ("ExtendFromBoundary", 0),
        ("FromPoints", 0),
        ("FromCurvature", per_circle),
    ):
        gmsh.option.setNumber(f"Mesh.MeshSize{source}", value)


def _threshold(distance: int, size: float, constant: float, growth: float) -> int:
    field = gmsh.model.mesh.field.add("Threshold")
    far = 1e3 * size
    for key, value in (
        ("InField", distance),
        ("SizeMin", size),
        ("SizeMax", far),
        ("DistMin", constant),
        ("DistMax", constant + (far - size) / growth),
    ):
        gmsh.model.mesh.field.setNumber(field, key, value)
    return int(field)


def grid_field(path: Path, places: Floats, sizes: Callable[[Floats], Floats]) -> int:
    """A field of gmsh that interpolates sizes on a grid; its tag.

    Args:
        path: where the grid's file goes, which has to stay until the mesh is made.
        places: (n, 3) points of the body.
        sizes: sizes (n,) at points (n, 3).
    """
    least, most = places.min(axis=0), places.max(axis=0)
    spacing = float((most - least).max()) / GRID
    counts = np.maximum(np.ceil((most - least) / spacing).astype(int), 4) + 3
    steps = np.maximum((most - least) / (counts - 3), 1e-9 * spacing)
    origin = least - steps
    axes = [o + s * np.arange(n) for o, s, n in zip(origin, steps, counts, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    with path.open("w", encoding="ascii") as stream:
        for row, form in ((origin, "%.9g"), (steps, "%.9g"), (counts, "%d")):
            stream.write(" ".join(form % x for x in row) + "\n")
        np.savetxt(stream, sizes(grid), fmt="%.6g")
    field = gmsh.model.mesh.field.add("Structured")
    gmsh.model.mesh.field.setString(field, "FileName", str(path))
    gmsh.model.mesh.field.setNumber(field, "TextFormat", 1)
    return int(field)
