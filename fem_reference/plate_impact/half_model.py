"""The plate scene struck off the axis or at an angle: a half of each body.

y = 0 is the only plane of symmetry. Candidates are nodes of the plate. What lies opposite to them
is a sphere, rigid or elastic, that slides along the plate and turns: the gap is that of the exact
sphere where it is, so that pairs with an elastic one are made anew as it moves.
"""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Body, Sphere
from ..common.hertz import effective_modulus, hertz_stiffness, hertz_time_scale
from ..explicit.contact import Contact, RigidBody, SphereContact, SurfaceContact, guided
from ..solid.mesh import TetMesh, surface
from ..solid.meshing import HALF, part_of_plate, part_of_sphere, share
from ..solid.model import ElasticBody, Model, nodal_areas, symmetry_plane
from ..solid.sphere_pairs import Ball, Pairs, sphere_pairs
from .estimate import ContactEstimate
from .motion import INNER, OUTER, PLATE, observed_circle
from .scene import Scene
from .solid_model import (
    CANDIDATE_ZONE,
    Pairing,
    PlateModel,
    face_of,
    of_both,
    plate_supports,
    size_fields,
    watched_nodes,
)

OPPOSITE = 1.25
"""Radius of the zone of a sphere's facets that can touch over that of the candidates."""
FAR = 1.0
"""Gap of candidates that lie opposite to no facet, m."""


def travel(scene: Scene) -> float:
    """How far the outer body slides along the plate during Hertz's contact on a rigid one, m."""
    effective = effective_modulus(scene.outer.material, scene.plate.material)
    stiffness = hertz_stiffness(effective, scene.outer.tip_radius)
    duration = 3.218 * hertz_time_scale(scene.outer.mass, stiffness, scene.normal_speed)
    return abs(scene.tangential_velocity) * duration


def half_model(
    scene: Scene,
    estimate: ContactEstimate,
    wavelengths: tuple[float, float, float],
    factor: float,
) -> PlateModel:
    """Mesh the scene and define its contacts, as `solid_model.plate_model`.

    Raises:
        SceneError, SolverError: see `size_fields` and `meshing`.
    """
    radii, slid = (estimate.outer_radius, estimate.inner_radius), travel(scene)
    outer_size, plate_size, inner_size = size_fields(scene, radii, wavelengths, factor, slid)
    # A plate that gives way is in contact for several times as long as a rigid one.
    zone = CANDIDATE_ZONE * max(radii) + 4.0 * slid
    half, order = 0.5 * scene.plate.thickness, scene.element_order
    struck = ((scene.offset, 0.0, half), (0.0, 0.0, -half))
    plate = part_of_plate(scene.plate, plate_size, order, HALF, struck)
    facets = surface(plate)
    fixed = np.union1d(symmetry_plane(plate, 1), plate_supports(scene.plate, plate, facets))
    elastic = [ElasticBody(plate, scene.plate.material, fixed)]
    numbers, rigid_numbers = {PLATE: 0}, {}
    rigid: list[RigidBody] = []
    contacts: list[Contact] = []
    pairings: list[Pairing] = []
    patches: dict[tuple[str, str], tuple[Ints, Floats]] = {}
    watched: list[tuple[Ints, Floats]] = []
    start = (scene.tangential_velocity, 0.0, -scene.normal_speed)
    for name, body, size, side, x, gap, velocity in (
        (OUTER, scene.outer, outer_size, 1.0, scene.offset, 0.0, start),
        (INNER, scene.inner, inner_size, -1.0, 0.0, scene.gap, (0.0, 0.0, scene.inner_speed)),
    ):
        areas = nodal_areas(plate, face_of(plate, facets, side * half))
        near = _around(plate, areas, x, zone)
        patches[PLATE, name] = (near, areas[near])
        axial = np.hypot(plate.points[:, 0], plate.points[:, 1])
        watched.append(watched_nodes(areas, axial, observed_circle(scene)))
        ball = Ball((x, 0.0, side * (half + body.tip_radius + gap)), body.tip_radius)
        if name in scene.rigid or not isinstance(body, Sphere):
            rigid_numbers[name] = len(rigid)
            rigid.append(_rigid(name, body, velocity))
            contacts.append(
                SphereContact(
                    *(name, 0, near, len(rigid) - 1, ball.centre, ball.radius),
                    friction=scene.frictions[name],
                )
            )
            continue
        mesh = part_of_sphere(name, body, size, order, side, HALF)
        mesh.points[:] += (x, 0.0, side * (half + gap))
        pairing = Pairing(
            len(contacts), len(elastic), ball, _facing(mesh, ball, side, OPPOSITE * zone), zone
        )
        numbers[name] = len(elastic)
        elastic.append(ElasticBody(mesh, body.material, symmetry_plane(mesh, 1), velocity))
        contacts.append(_contact(name, pairing, plate, near, mesh, scene.frictions[name]))
        pairings.append(pairing)
        areas = nodal_areas(mesh, pairing.facets)
        nodes = _around(mesh, areas, x, zone)
        patches[name, name] = (nodes, areas[nodes])
    return PlateModel(
        model=Model(tuple(elastic), tuple(rigid), tuple(contacts)),
        size=outer_size.least,
        zone=zone,
        elastic=numbers,
        rigid=rigid_numbers,
        watched=of_both(watched),
        patches=patches,
        off_axis=True,
        fraction=share(HALF),
        offset=scene.offset,
        pairings=tuple(pairings),
    )


def _around(mesh: TetMesh, areas: Floats, x: float, zone: float) -> Ints:
    """The nodes of a surface within a distance of a contact, nearest first."""
    distance = np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1])
    near = np.flatnonzero((areas > 0.0) & (distance <= zone))
    return near[np.argsort(distance[near], kind="stable")]


def _rigid(name: str, body: Body, velocity: tuple[float, float, float]) -> RigidBody:
    """A sphere turns about y; how a compact body would, nothing tells, and nothing makes it."""
    mass = share(HALF) * body.mass
    in_plane = guided((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    turning = np.zeros((3, 3))
    if isinstance(body, Sphere):
        turning = guided((0.0, 1.0, 0.0)) / (0.4 * mass * body.radius**2)
    return RigidBody(name, mass, in_plane, velocity, turning)


def _facing(mesh: TetMesh, ball: Ball, side: float, zone: float) -> Ints:
    """Facets of a half sphere near its pole."""
    facets = surface(mesh)
    corners = mesh.points[facets[:, :3]]
    outside = ~np.all(corners[:, :, 1] == 0.0, axis=1)
    distance = np.hypot(corners[:, :, 0] - ball.centre[0], corners[:, :, 1]).min(axis=1)
    below = side * (corners[:, :, 2] - ball.centre[2]).mean(axis=1) < 0.0
    return np.asarray(facets[outside & below & (distance <= zone)])


def paired(
    pairing: Pairing,
    mesh: TetMesh,
    places: Floats,
    sphere_displacement: Floats,
    mean: Floats,
    displacement: Floats,
) -> Pairs:
    """As `sphere_pairs`; candidates beyond the facets' reach have a gap that never closes."""
    lateral = places + displacement - np.array(pairing.ball.centre) - mean
    near = np.hypot(lateral[:, 0], lateral[:, 1]) <= pairing.reach
    width = pairing.facets.shape[1]
    facets = np.repeat(pairing.facets[:1], near.size, axis=0)
    weights, normals = np.zeros((near.size, width)), np.tile([0.0, 0.0, 1.0], (near.size, 1))
    gaps = np.full(near.size, FAR)
    if near.any():
        found = sphere_pairs(
            *(pairing.ball, mesh, pairing.facets, places[near], sphere_displacement),
            mean,
            displacement[near],
        )
        facets[near], weights[near] = found.facets, found.weights
        normals[near], gaps[near] = found.normals, found.gaps
    return Pairs(facets, weights, normals, gaps)


def _contact(
    name: str, pairing: Pairing, plate: TetMesh, near: Ints, mesh: TetMesh, friction: float
) -> SurfaceContact:
    places = plate.points[near]
    still = np.zeros_like(places)
    pairs = paired(pairing, mesh, places, np.zeros_like(mesh.points), np.zeros(3), still)
    return SurfaceContact(
        *(name, 0, near, pairing.body, pairs.facets, pairs.weights, pairs.normals, pairs.gaps),
        np.unique(pairing.facets),
        friction,
    )
