"""Tetrahedral meshes of plate and spheres by gmsh's CAD kernel: a quarter or half of each body.

The planes x = 0 and y = 0 are planes of symmetry, of halves y = 0 alone. The element size
grows linearly with the distance from the contact zone; a mesh refined by a factor is so everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Plate, Sphere
from ..common.errors import SolverError
from ..common.mesher import start_gmsh
from .mesh import MINIMUM_QUALITY, TetMesh, check_elements, qualities, tetrahedra

DELAUNAY = 1
"""gmsh's classic algorithm. HXT makes slightly better elements, but other ones at every call."""


TRIES = 5
"""Meshes of a body, until one has no flat element."""
RADIUS_STEP = 1.04
"""Ratio of neighbouring contact radii for which a mesh is made again."""


def rounded(radius: float) -> float:
    """The nearest of a series of radii, `RADIUS_STEP` apart.

    An unstructured mesh changes altogether with the last digit of a size, and the radius found
    differs in its last digits with the number of processes, in its first with the mesh.
    """
    step = math.log(RADIUS_STEP)
    return math.exp(step * round(math.log(radius) / step))


@dataclass(frozen=True)
class RimEdges:
    """The circles in which a plate's faces meet its rim, and the element size there."""

    radius: float
    """m"""
    half: float
    """Half the plate's thickness, m."""
    least: float
    """m"""

    def expression(self, slope: float) -> str:
        """Size that grows with the distance from them, for gmsh's MathEval."""
        inwards = f"(Sqrt(x*x+y*y)-({self.radius!r}))"
        across = f"(Fabs(z)-({self.half!r}))"
        return f"{self.least!r}+{slope!r}*Sqrt({inwards}*{inwards}+{across}*{across})"


@dataclass(frozen=True)
class SizeField:
    """Element size h = min(largest, least + slope * max(0, d - zone)).

    d is the distance from the nearest of the centres. At ``edges`` elements are smaller, too.
    """

    centres: tuple[tuple[float, float, float], ...]
    zone: float
    """m"""
    least: float
    """m"""
    slope: float
    largest: float
    """m"""
    edges: RimEdges | None = None

    def expression(self) -> str:
        """For gmsh's MathEval."""
        terms = [
            f"Max(0,Sqrt((x-({x!r}))*(x-({x!r}))+(y-({y!r}))*(y-({y!r}))+(z-({z!r}))*(z-({z!r})))"
            f"-{self.zone!r})"
            for x, y, z in self.centres
        ]
        nearest = terms[0]
        for term in terms[1:]:
            nearest = f"Min({nearest},{term})"
        size = f"Min({self.largest!r},{self.least!r}+{self.slope!r}*{nearest})"
        if self.edges is None:
            return size
        return f"Min({size},{self.edges.expression(self.slope)})"


class Sized(Protocol):
    """Where elements are to be how large."""

    def expression(self) -> str:
        """For gmsh's MathEval."""
        ...


def generate(name: str, build: Callable[[], None], size: Sized) -> tuple[Floats, Ints]:
    """Mesh what ``build`` adds to gmsh's OCC model; points (n, 3), corners (m, 4).

    Raises:
        SolverError: gmsh failed.
    """
    start_gmsh()
    try:
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.model.add(name)
        build()
        gmsh.model.occ.synchronize()
        field = gmsh.model.mesh.field.add("MathEval")
        gmsh.model.mesh.field.setString(field, "F", size.expression())
        gmsh.model.mesh.field.setAsBackgroundMesh(field)
        for source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
            gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
        gmsh.option.setNumber("Mesh.Algorithm3D", DELAUNAY)
        gmsh.option.setNumber("Mesh.Optimize", 1)
        gmsh.model.mesh.generate(3)
        types, _, connectivity = gmsh.model.mesh.getElements(3)
        if [int(kind) for kind in types] != [4]:
            raise SolverError(f"gmsh made no tetrahedra of body '{name}'")
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
    except SolverError:
        raise
    except Exception as error:
        raise SolverError(f"gmsh could not mesh body '{name}': {error}") from error
    finally:
        gmsh.finalize()
    corner_tags = connectivity[0].astype(np.int64)
    used = np.unique(corner_tags)
    order = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    order[used] = np.arange(used.size)
    points = np.empty((used.size, 3))
    number = order[tags.astype(np.int64)]
    points[number[number >= 0]] = coordinates.reshape(-1, 3)[number >= 0]
    return points, order[corner_tags].reshape(-1, 4)


def _snap(points: Floats, planes: Sequence[int], length: float) -> None:
    """Put points that lie on a plane of symmetry up to rounding exactly on it."""
    for axis in planes:
        points[np.abs(points[:, axis]) < 1e-9 * length, axis] = 0.0


def _mended(name: str, build: Callable[[], None], size: SizeField) -> tuple[Floats, Ints]:
    """As `generate`; while that leaves a flat element, again with slightly smaller ones."""
    for _ in range(TRIES):
        points, corners = generate(name, build, size)
        if qualities(points, corners).min() > MINIMUM_QUALITY:
            break
        size = replace(size, least=0.99 * size.least, largest=0.99 * size.largest)
    return points, corners


def generate_part(
    name: str, build: Callable[[], None], size: SizeField, planes: Sequence[int], length: float
) -> tuple[Floats, Ints]:
    """As `generate` without flat elements, points on the planes of symmetry exactly on them."""
    points, corners = _mended(name, build, size)
    _snap(points, planes, length)
    return points, corners


QUARTER, HALF = (0, 1), (1,)
"""Parts of a body, by the axes that its planes of symmetry are normal to."""


def share(planes: Sequence[int]) -> float:
    """Of a body, that is on one side of so many planes of symmetry."""
    return 0.5 ** len(planes)


def part_of_sphere(
    name: str,
    sphere: Sphere,
    size: SizeField,
    order: int,
    side: float,
    planes: Sequence[int] = QUARTER,
) -> TetMesh:
    """The part of a sphere that touches the origin from above (side +1) or below (-1).

    The polyhedron is enlarged about the pole until its volume is exact.
    """
    radius = sphere.radius

    def build() -> None:
        half, around = 0.5 * math.pi, 2.0 * math.pi * share(planes)
        gmsh.model.occ.addSphere(0.0, 0.0, side * radius, radius, -1, -half, half, around)

    points, corners = generate_part(name, build, size, planes, radius)
    pole = int(np.argmin(np.linalg.norm(points, axis=1)))
    points[pole] = 0.0
    volume = TetMesh(name, points, corners).volume()
    points *= math.cbrt(sphere.volume * share(planes) / volume)
    mesh = tetrahedra(name, points, corners, order)
    check_elements(mesh)
    return mesh


def part_of_plate(
    plate: Plate,
    size: SizeField,
    order: int,
    planes: Sequence[int] = QUARTER,
    struck: Sequence[tuple[float, float, float]] = (),
) -> TetMesh:
    """The part of the plate, z = 0 at its midplane, widened until its volume is exact.

    ``struck`` are places on its surface where a node has to be, m; those on the axis of a quarter
    are corners of it anyway.
    """
    radius, thickness = plate.radius, plate.thickness

    def build() -> None:
        around = 2.0 * math.pi * share(planes)
        whole = gmsh.model.occ.addCylinder(
            0.0, 0.0, -0.5 * thickness, 0.0, 0.0, thickness, radius, -1, around
        )
        if struck:
            places = [(0, gmsh.model.occ.addPoint(*place)) for place in struck]
            gmsh.model.occ.fragment([(3, whole)], places)

    points, corners = generate_part("plate", build, size, planes, radius)
    for face in (-0.5, 0.5):
        points[np.abs(points[:, 2] - face * thickness) < 1e-9 * thickness, 2] = face * thickness
    volume = TetMesh("plate", points, corners).volume()
    # Only the rim moves noticeably: the polygon's area is made that of the circle.
    points[:, :2] *= math.sqrt(share(planes) * math.pi * radius**2 * thickness / volume)
    mesh = tetrahedra("plate", points, corners, order)
    check_elements(mesh)
    return mesh
