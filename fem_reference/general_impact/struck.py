"""What the outer body strikes, as an elastic body with its contacts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh
import numpy as np

from ..body.fine import Strike, fine_body
from ..common.arrays import Floats, Ints
from ..common.bodies import Material, Plate, Sphere
from ..common.errors import SceneError
from ..solid.mesh import TetMesh, check_elements, surface, tetrahedra
from ..solid.meshing import QUARTER, generate_part, part_of_plate, part_of_sphere, share
from ..solid.model import ElasticBody, symmetry_plane
from .estimate import ECHO, PER_WALL, WALLS, Sizes
from .scene import OUTER, Scene

UP = np.array([0.0, 0.0, 1.0])
WHOLE: tuple[int, ...] = ()
"""No plane of symmetry."""


@dataclass(frozen=True)
class Struck:
    """An elastic body that is struck."""

    body: ElasticBody
    strikes: dict[str, Strike]
    places: Floats
    """(n, 3) of its nodes, those around the contacts on the exact body, m."""
    planes: tuple[int, ...]
    """Axes that the model's planes of symmetry are normal to."""
    kept: float = 0.0
    """Share of the volume whose elements are those of a mesh that was given."""

    @property
    def share(self) -> float:
        """Of the bodies that is modelled."""
        return share(self.planes)


def struck(scene: Scene, sizes: Sizes, file: Path | None) -> Struck | None:
    """What the outer body strikes; None: a rigid wall.

    Args:
        scene: the scene.
        sizes: of the elements.
        file: of the body.

    Raises:
        SceneError, SolverError: it cannot be meshed.
    """
    if scene.body is not None:
        if file is None:
            raise SceneError("the scene has a body, but --body does not name its file")
        return _body(scene, scene.body.material, sizes, file)
    if scene.plate is not None:
        return _plate(scene, scene.plate, sizes)
    if scene.wall is not None:
        material = scene.wall.material
        return None if material is None else _wall(scene, material, sizes)
    if not isinstance(scene.inner, Sphere):
        raise SceneError("inner is missing: nothing is struck")
    return _sphere(scene, scene.inner, sizes)


def _all(nodes: Ints) -> Ints:
    """Components of nodes."""
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def symmetry(mesh: TetMesh, planes: Sequence[int]) -> Ints:
    """Fixed components of the nodes on the planes of symmetry."""
    none = np.zeros(0, dtype=np.int64)
    return np.unique(np.concatenate([none, *(symmetry_plane(mesh, axis) for axis in planes)]))


def _body(scene: Scene, material: Material, sizes: Sizes, file: Path) -> Struck:
    made = fine_body(scene.body_scene(file), scene.element_order, sizes.body(material))
    # the mass is the exact body's
    density = material.density * made.volume / made.mesh.volume()
    body = ElasticBody(made.mesh, replace(material, density=density), _all(made.fixed))
    return Struck(body, made.strikes, made.places, WHOLE, made.kept)


def _plate(scene: Scene, plate: Plate, sizes: Sizes) -> Struck:
    from ..plate_impact.solid_model import plate_supports

    half, order = 0.5 * plate.thickness, scene.element_order
    largest = min(WALLS * plate.thickness, sizes.per_wave(plate.material))
    mesh = part_of_plate(plate, sizes.field(OUTER, largest, (0.0, 0.0, half)), order)
    fixed = np.union1d(symmetry(mesh, QUARTER), plate_supports(plate, mesh, surface(mesh)))
    strike = Strike(half * UP, UP, 0.0)
    body = ElasticBody(mesh, plate.material, fixed)
    return Struck(body, {OUTER: strike}, mesh.points, QUARTER)


def _wall(scene: Scene, material: Material, sizes: Sizes) -> Struck:
    """A half ball of the wall, held at its surface, so large that no echo comes back in time."""
    radius = wall_radius(material, sizes.duration)

    def build() -> None:
        quarter = 0.5 * math.pi
        gmsh.model.occ.addSphere(0.0, 0.0, 0.0, radius, -1, -quarter, 0.0, quarter)

    size = sizes.field(OUTER, radius / PER_WALL)
    points, corners = generate_part("wall", build, size, QUARTER, radius)
    points[np.abs(points[:, 2]) < 1e-9 * radius, 2] = 0.0
    mesh = tetrahedra("wall", points, corners, scene.element_order)
    check_elements(mesh)
    facets = surface(mesh)
    corner = np.linalg.norm(mesh.points[facets[:, :3]], axis=2)
    far = np.unique(facets[np.all(corner > (1.0 - 1e-6) * radius, axis=1)])
    fixed = np.union1d(symmetry(mesh, QUARTER), _all(far))
    strike = Strike(np.zeros(3), UP, 0.0)
    return Struck(ElasticBody(mesh, material, fixed), {OUTER: strike}, mesh.points, QUARTER)


def wall_radius(material: Material, duration: float) -> float:
    """Of the half ball that stands for a wall, m."""
    return ECHO * pressure_wave_speed(material) * duration


def first_echo(duration: float) -> float:
    """When the first echo comes back from the end of the half ball, s."""
    return 2.0 * ECHO * duration


def pressure_wave_speed(material: Material) -> float:
    """Of longitudinal waves in bulk, m/s."""
    modulus = material.lame_lambda + 2.0 * material.shear_modulus
    return math.sqrt(modulus / material.density)


def _sphere(scene: Scene, inner: Sphere, sizes: Sizes) -> Struck:
    """The inner sphere, below the origin, which it touches."""
    size = sizes.sphere("inner", inner.radius, inner.material)
    mesh = part_of_sphere("inner", inner, size, scene.element_order, -1.0)
    strike = Strike(np.zeros(3), UP, 1.0 / inner.radius)
    away = mesh.points + inner.radius * UP
    distance = np.linalg.norm(away, axis=1, keepdims=True)
    places = inner.radius * (away / np.maximum(distance, 1e-9 * inner.radius) - UP)
    velocity = (0.0, 0.0, scene.inner_speed)
    body = ElasticBody(mesh, inner.material, symmetry(mesh, QUARTER), velocity)
    return Struck(body, {OUTER: strike}, places, QUARTER)
