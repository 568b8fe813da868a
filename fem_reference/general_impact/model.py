"""The scene as a three-dimensional model: what is struck, and the bodies that touch it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..body.curvature import frame
from ..body.fine import Strike
from ..common.arrays import Floats, Ints
from ..common.bodies import Compact, Sphere
from ..common.errors import SolverError
from ..explicit.contact import Contact, RigidBody, SphereContact, SurfaceContact, guided
from ..solid.mesh import TetMesh, surface
from ..solid.meshing import QUARTER, part_of_sphere, share
from ..solid.model import ElasticBody, Model, nodal_areas
from ..solid.patch import Patch
from ..solid.sphere_pairs import Ball, sphere_pairs
from .estimate import Sizes
from .scene import INNER, OUTER, Scene
from .struck import UP, Struck, struck, symmetry

STRUCK = 0
"""Number of the body that is struck among the elastic ones; with a rigid wall of the outer body."""
OPPOSITE = 1.25
"""Radius of the zone of a sphere's facets that can touch over that of the candidates."""
FACING = 0.5
"""Least cosine between the normals of a contact and of the facets that can touch there."""
RIGID_WALL = 1e6
"""Radius of the rigid sphere that stands for a rigid wall, over that of the striking one: the
contact is softer by 5e-7 than on a plane."""


@dataclass(frozen=True)
class Side:
    """A body that strikes or is struck, and its contact."""

    name: str
    contact: int
    """Number of the contact."""
    strike: Strike
    along: Floats
    """(3,) direction in which its motion counts: the outward normal for the outer body, the inward
    one for the inner body."""
    gap: float
    """m"""
    body: int | None
    """Number among the elastic bodies; None: it is rigid."""
    ball: Ball
    size: float
    """Of the elements at the contact, m."""
    patch: Patch
    """Candidates."""
    places: Floats
    """(n, 3) of the candidates on the exact body, m."""
    facets: Ints | None = None
    """Of an elastic sphere those that can touch; None: the pairs stay."""
    own: Patch | None = None
    """Nodes of an elastic sphere around the contact, if the candidates are the struck body's."""


@dataclass(frozen=True)
class ImpactModel:
    """The model and where its parts are."""

    model: Model
    planes: tuple[int, ...]
    """Axes that the planes of symmetry are normal to."""
    sides: tuple[Side, ...]
    has_struck: bool
    """Whether the first elastic body is what is struck; else it strikes a rigid wall."""
    kept: float = 0.0
    """Share of the volume of what is struck whose elements are those of a mesh that was given."""

    @property
    def share(self) -> float:
        """Of the bodies that is modelled."""
        return share(self.planes)


def impact_model(scene: Scene, sizes: Sizes, file: Path | None) -> ImpactModel:
    """Mesh the scene and define its contacts.

    Raises:
        SceneError, SolverError: a body cannot be meshed.
    """
    target = struck(scene, sizes, file)
    if target is None:
        return _on_rigid_wall(scene, sizes)
    elastic, rigid = [target.body], []
    contacts: list[Contact] = []
    sides: list[Side] = []
    for name, body in scene.partners().items():
        strike, gap = target.strikes[name], scene.gap if name == INNER else 0.0
        along = strike.normal if name == OUTER else -strike.normal
        velocity = (-scene.speed if name == OUTER else scene.inner_speed) * along
        patch = _candidates(target, strike, sizes.zone(name))
        places = target.places[patch.nodes]
        centre = strike.point + (body.tip_radius + gap) * strike.normal
        ball = Ball(_tuple(centre), body.tip_radius)
        common = (name, len(contacts), strike, along, gap)
        if name in scene.rigid or isinstance(body, Compact):
            rigid.append(_rigid(name, body, target, along, velocity))
            number = len(rigid) - 1
            contacts.append(
                SphereContact(name, STRUCK, patch.nodes, number, ball.centre, ball.radius, places)
            )
            sides.append(Side(*common, None, ball, sizes.least(name), patch, places))
            continue
        placed, mesh, facets, own = _sphere(scene, sizes, name, body, target.planes, strike, gap)
        number = len(elastic)
        elastic.append(ElasticBody(mesh, body.material, placed, _tuple(velocity)))
        pairs = sphere_pairs(ball, mesh, facets, places, np.zeros_like(mesh.points))
        contacts.append(
            SurfaceContact(
                *(name, STRUCK, patch.nodes, number),
                *(pairs.facets, pairs.weights, pairs.normals, pairs.gaps),
                reachable=np.unique(facets),
            )
        )
        sides.append(Side(*common, number, ball, sizes.least(name), patch, places, facets, own))
    model = Model(tuple(elastic), tuple(rigid), tuple(contacts))
    return ImpactModel(model, target.planes, tuple(sides), has_struck=True, kept=target.kept)


def _tuple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = (float(each) for each in vector)
    return x, y, z


def _rigid(
    name: str, body: Sphere | Compact, target: Struck, along: Floats, velocity: Floats
) -> RigidBody:
    return RigidBody(name, target.share * body.mass, guided(_tuple(along)), _tuple(velocity))


def _around(mesh: TetMesh, areas: Floats, places: Floats, strike: Strike, zone: float) -> Patch:
    """The nodes of a surface within a distance of a contact, nearest first."""
    distance = np.linalg.norm(places - strike.point, axis=1)
    near = np.flatnonzero((areas > 0.0) & (distance <= zone))
    near = near[np.argsort(distance[near], kind="stable")]
    normals = np.tile(strike.normal, (near.size, 1))
    if near.size == 0:
        raise SolverError(f"the mesh of body '{mesh.name}' has no node at the contact")
    return Patch(near, areas[near], normals, zone, distance[near])


def _candidates(target: Struck, strike: Strike, zone: float) -> Patch:
    """Nodes of the struck body that can touch."""
    mesh = target.body.mesh
    facets = _outside(mesh, target.planes)
    a, b, c = (mesh.points[facets[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    facing = normals @ strike.normal > FACING * np.linalg.norm(normals, axis=1)
    areas = nodal_areas(mesh, facets[facing])
    return _around(mesh, areas, target.places, strike, zone)


def _outside(mesh: TetMesh, planes: Sequence[int]) -> Ints:
    """Facets that lie on no plane of symmetry."""
    facets = surface(mesh)
    corners = mesh.points[facets[:, :3]]
    inside = np.zeros(facets.shape[0], dtype=bool)
    for axis in planes:
        inside |= np.all(corners[:, :, axis] == 0.0, axis=1)
    return np.asarray(facets[~inside])


def _sphere(
    scene: Scene,
    sizes: Sizes,
    name: str,
    sphere: Sphere,
    planes: tuple[int, ...],
    strike: Strike,
    gap: float,
) -> tuple[Ints, TetMesh, Ints, Patch]:
    """A sphere whose pole lies over a contact.

    Returns:
        Its fixed components, its mesh, the facets that can touch, and its nodes around the pole.
    """
    size = sizes.sphere(name, sphere.radius, sphere.material)
    mesh = part_of_sphere(name, sphere, size, scene.element_order, 1.0, planes)
    fixed, facets = symmetry(mesh, planes), _outside(mesh, planes)
    distance = np.linalg.norm(mesh.points[facets[:, :3]], axis=2).min(axis=1)
    near = facets[distance <= OPPOSITE * sizes.zone(name)]
    if planes == ():
        mesh.points[:] = mesh.points @ np.vstack([frame(strike.normal), strike.normal])
    mesh.points[:] += strike.point + gap * strike.normal
    pole = Strike(strike.point + gap * strike.normal, strike.normal, 0.0)
    own = _around(mesh, nodal_areas(mesh, near), mesh.points, pole, sizes.zone(name))
    return fixed, mesh, near, own


def _on_rigid_wall(scene: Scene, sizes: Sizes) -> ImpactModel:
    """The outer sphere above a rigid wall, which is the top of a huge rigid sphere that is held."""
    sphere = scene.outer
    strike = Strike(np.zeros(3), UP, 0.0)
    if not isinstance(sphere, Sphere):
        raise SolverError("a rigid body on a rigid wall")
    fixed, mesh, _, own = _sphere(scene, sizes, OUTER, sphere, QUARTER, strike, 0.0)
    elastic = ElasticBody(mesh, sphere.material, fixed, (0.0, 0.0, -scene.speed))
    away = mesh.points[own.nodes] - sphere.radius * UP
    places = sphere.radius * (away / np.linalg.norm(away, axis=1, keepdims=True) + UP)
    ball = Ball((0.0, 0.0, -RIGID_WALL * sphere.radius), RIGID_WALL * sphere.radius)
    wall = RigidBody("wall", 1.0, np.zeros((3, 3)))
    contact = SphereContact(OUTER, STRUCK, own.nodes, 0, ball.centre, ball.radius, places)
    side = Side(OUTER, 0, strike, UP, 0.0, STRUCK, ball, sizes.least(OUTER), own, places)
    model = Model((elastic,), (wall,), (contact,))
    return ImpactModel(model, QUARTER, (side,), has_struck=False)
