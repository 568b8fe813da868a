"""The plate scene as a three-dimensional model: a quarter of each body, elastic or rigid.

Off the axis or at an angle it is a half (`half_model`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Plate, Sphere, sphere_profile
from ..common.errors import SceneError
from ..explicit.contact import Contact, RigidBody, SphereContact, SurfaceContact, guided
from ..solid.mesh import TetMesh, surface
from ..solid.meshing import QUARTER, RimEdges, SizeField, part_of_plate, part_of_sphere, share
from ..solid.model import ElasticBody, Model, nodal_areas, project, symmetry_plane
from ..solid.sphere_pairs import Ball
from .estimate import ContactEstimate
from .motion import INNER, OUTER, PLATE, observed_circle
from .scene import Scene

FINE_ZONE = 1.3
"""Radius of the zone of smallest elements over the largest contact radius expected."""
CANDIDATE_ZONE = 1.8
"""Radius of the zone of nodes that may touch over the largest contact radius expected."""
LARGEST, LARGEST_TURNING = 0.25, 0.15
"""Largest element of a sphere over its radius; the moment of inertia of one that turns is 0.5 % too
large with the latter."""
SLOPE = 0.3
"""Growth of the element size per distance from the contact, at factor 1."""


@dataclass(frozen=True)
class Pairing:
    """What it takes to pair nodes of the plate with an elastic sphere that slides along it."""

    contact: int
    """Number of the contact, of the plate's nodes."""
    body: int
    """Number of the sphere among the elastic bodies."""
    ball: Ball
    facets: Ints
    """Facets of the sphere that can touch."""
    reach: float
    """Distance from the sphere's axis up to which they lie opposite to candidates, m."""


@dataclass(frozen=True)
class PlateModel:
    """The model and where its parts are."""

    model: Model
    size: float
    """Element size at the contacts, m."""
    zone: float
    """Radius of the candidates' zone, m."""
    elastic: dict[str, int]
    """Number of each elastic body by name."""
    rigid: dict[str, int]
    watched: tuple[Ints, Floats]
    """Nodes (k,) of the plate's faces in the numbering of its mesh, and their shares (k,) in the
    mean of both over `observed_circle`."""
    patches: dict[tuple[str, str], tuple[Ints, Floats]]
    """Nodes and areas (m^2) of a body in the zone of a contact, by body and contact."""
    off_axis: bool = False
    """Whether y = 0 is the only plane of symmetry."""
    fraction: float = share(QUARTER)
    """Share of the bodies that is modelled."""
    offset: float = 0.0
    """Distance of the point of impact from the axis, along x, m."""
    pairings: tuple[Pairing, ...] = ()
    """Contacts whose pairs follow the sphere."""


def plate_supports(plate: Plate, mesh: TetMesh, facets: Ints) -> Ints:
    """Clamped: all displacements on the whole rim; simply supported: the axial one."""
    if plate.edge == "free":
        return np.zeros(0, dtype=np.int64)
    place = mesh.points[facets]
    half = 0.5 * plate.thickness
    flat = np.zeros(facets.shape[0], dtype=bool)
    for axis, value in ((2, -half), (2, half), (0, 0.0), (1, 0.0)):
        flat |= np.all(place[:, :, axis] == value, axis=1)
    rim = np.unique(facets[~flat])
    fixed = 3 * rim + 2
    if plate.edge == "clamped":
        fixed = np.concatenate([fixed, 3 * rim, 3 * rim + 1])
    return np.asarray(np.unique(fixed))


def _symmetry(mesh: TetMesh) -> Ints:
    return np.concatenate([symmetry_plane(mesh, 0), symmetry_plane(mesh, 1)])


def size_fields(
    scene: Scene,
    radii: tuple[float, float],
    wavelengths: tuple[float, float, float],
    factor: float,
    travel: float = 0.0,
) -> tuple[SizeField, SizeField, SizeField]:
    """Element sizes of outer sphere, plate and inner sphere.

    Args:
        scene: the scene.
        radii: outer and inner contact radius expected, m.
        wavelengths: shortest in the three bodies, m.
        factor: on the number of elements in every direction.
        travel: of the outer body along the plate during its contact, m.

    Raises:
        SceneError: the contact is too large for a body, or too near to the plate's rim.
    """
    order = scene.element_order
    zone = max(radii)
    plate = scene.plate
    least = min(min(radii) / scene.elements_per_contact_radius, plate.thickness / 4.0) / factor
    for name, radius in (
        (f"outer.{scene.outer.RADIUS_KEY}", scene.outer.tip_radius),
        (f"inner.{scene.inner.RADIUS_KEY}", scene.inner.tip_radius),
        ("plate.radius", plate.radius - scene.offset),
    ):
        if 3.0 * CANDIDATE_ZONE * zone > radius:
            less = " less outer.offset" if name == "plate.radius" and scene.offset > 0.0 else ""
            raise SceneError(
                f"{name}{less} is {radius:g} m, but a contact radius of {zone:.3g} m is expected; "
                f"{3.0 * CANDIDATE_ZONE:g} times as much is the least"
            )
    # Elements per wavelength; linear tetrahedra are far too stiff in bending with fewer.
    per_wave = {1: 24.0, 2: 8.0}[order]
    # Size of an element over that of a quadratic one that bends as well.
    relative = {1: 0.25, 2: 1.0}[order]

    def field(
        centres: tuple[tuple[float, float, float], ...],
        largest: float,
        edges: RimEdges | None = None,
    ) -> SizeField:
        reach, slope, size = FINE_ZONE * zone + travel, SLOPE / factor, max(least, largest / factor)
        return SizeField(centres, reach, least, slope, size, edges)

    half, ratio = 0.5 * plate.thickness, scene.elements_per_thickness
    through = relative * plate.thickness / ratio
    # The stress is singular where a held rim meets the faces: with large elements the plate is too
    # stiff. One element through the thickness everywhere raised the first frequency by 0.9 %.
    at_rim = max(least, through / ratio / factor)
    rim = None if plate.edge == "free" else RimEdges(plate.radius, half, at_rim)
    largest = LARGEST if scene.centred else LARGEST_TURNING
    # Above and below, a sphere is meshed with its pole at the origin.
    pole = ((0.0, 0.0, 0.0),)
    return (
        field(pole, min(largest * scene.outer.tip_radius, wavelengths[0] / per_wave)),
        field(
            ((scene.offset, 0.0, half), (0.0, 0.0, -half)),
            min(through, plate.radius / 8.0, wavelengths[1] / per_wave),
            rim,
        ),
        field(pole, min(largest * scene.inner.tip_radius, wavelengths[2] / per_wave)),
    )


def face_of(mesh: TetMesh, facets: Ints, height: float) -> Ints:
    """The facets at a height (m)."""
    return np.asarray(facets[np.all(mesh.points[facets][:, :, 2] == height, axis=1)])


def _outer_surface(mesh: TetMesh, facets: Ints) -> Ints:
    """The facets of a quarter body that are on none of its planes of symmetry."""
    place = mesh.points[facets]
    inside = np.all(place[:, :, 0] == 0.0, axis=1) | np.all(place[:, :, 1] == 0.0, axis=1)
    return np.asarray(facets[~inside])


def plate_model(
    scene: Scene,
    estimate: ContactEstimate,
    wavelengths: tuple[float, float, float],
    factor: float,
) -> PlateModel:
    """Mesh the scene and define its contacts.

    Raises:
        SceneError, SolverError: see `size_fields` and `meshing`.
    """
    radii = (estimate.outer_radius, estimate.inner_radius)
    outer_size, plate_size, inner_size = size_fields(scene, radii, wavelengths, factor)
    zone = CANDIDATE_ZONE * max(radii)
    order = scene.element_order
    plate = part_of_plate(scene.plate, plate_size, order)
    plate_facets = surface(plate)
    fixed = np.union1d(_symmetry(plate), plate_supports(scene.plate, plate, plate_facets))
    elastic = [ElasticBody(plate, scene.plate.material, fixed)]
    numbers, rigid_numbers = {PLATE: 0}, {}
    rigid: list[RigidBody] = []
    contacts: list[Contact] = []
    patches: dict[tuple[str, str], tuple[Ints, Floats]] = {}
    watched: list[tuple[Ints, Floats]] = []
    for name, body, size, side, gap, speed in (
        (OUTER, scene.outer, outer_size, 1.0, 0.0, -scene.speed),
        (INNER, scene.inner, inner_size, -1.0, scene.gap, scene.inner_speed),
    ):
        height = side * 0.5 * scene.plate.thickness
        face = face_of(plate, plate_facets, height)
        areas = nodal_areas(plate, face)
        distance = np.hypot(plate.points[:, 0], plate.points[:, 1])
        near = np.flatnonzero((areas > 0.0) & (distance <= zone))
        # By increasing radius: the record of the outermost contact goes by it.
        near = near[np.argsort(distance[near], kind="stable")]
        patches[PLATE, name] = (near, areas[near])
        watched.append(watched_nodes(areas, distance, observed_circle(scene)))
        if name in scene.rigid or not isinstance(body, Sphere):
            rigid_numbers[name] = len(rigid)
            along = guided((0.0, 0.0, 1.0))
            rigid.append(RigidBody(name, share(QUARTER) * body.mass, along, (0.0, 0.0, speed)))
            place = (0.0, 0.0, height + side * (body.tip_radius + gap))
            tip = SphereContact(
                name,
                0,
                near,
                len(rigid) - 1,
                place,
                body.tip_radius,
                friction=scene.frictions[name],
            )
            contacts.append(tip)
            continue
        mesh = part_of_sphere(name, body, size, order, side)
        numbers[name] = len(elastic)
        elastic.append(ElasticBody(mesh, body.material, _symmetry(mesh), (0.0, 0.0, speed)))
        contact, area = _sphere_on_plate(
            name, mesh, numbers[name], plate, face, body, side, gap, zone, scene.frictions[name]
        )
        contacts.append(contact)
        patches[name, name] = (contact.nodes, area)
    return PlateModel(
        model=Model(tuple(elastic), tuple(rigid), tuple(contacts)),
        size=outer_size.least,
        zone=zone,
        elastic=numbers,
        rigid=rigid_numbers,
        watched=of_both(watched),
        patches=patches,
    )


def of_both(faces: list[tuple[Ints, Floats]]) -> tuple[Ints, Floats]:
    """Nodes and their shares in the mean of two faces."""
    return (
        np.concatenate([nodes for nodes, _ in faces]),
        np.concatenate([0.5 * shares for _, shares in faces]),
    )


def watched_nodes(areas: Floats, distance: Floats, circle: float) -> tuple[Ints, Floats]:
    """The nodes of a face within a circle and their shares of a unit Hertz pressure on it.

    Args:
        areas: of the nodes on the face, 0 of all others, m^2.
        distance: of the nodes from the axis, m.
        circle: its radius, m.
    """
    shares = areas * np.sqrt(np.maximum(1.0 - (distance / circle) ** 2, 0.0))
    if not shares.any():
        shares[np.argmin(np.where(areas > 0.0, distance, np.inf))] = 1.0
    nodes = np.flatnonzero(shares)
    return nodes, shares[nodes] / shares.sum()


def _sphere_on_plate(
    name: str,
    mesh: TetMesh,
    number: int,
    plate: TetMesh,
    face: Ints,
    sphere: Sphere,
    side: float,
    gap: float,
    zone: float,
    friction: float,
) -> tuple[SurfaceContact, Floats]:
    """The sphere's surface nodes against the plate's face, with the gap of the exact sphere."""
    areas = nodal_areas(mesh, _outer_surface(mesh, surface(mesh)))
    distance = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    below = side * mesh.points[:, 2] < 0.5 * sphere.radius
    nodes = np.flatnonzero((areas > 0.0) & (distance <= zone) & below)
    nodes = nodes[np.argsort(distance[nodes], kind="stable")]
    places = mesh.points[nodes].copy()
    places[:, 2] = side * math.fabs(plate.points[face[0, 0], 2])
    facets, weights, _ = project(places, plate, face)
    normals = np.zeros((nodes.size, 3))
    normals[:, 2] = side
    gaps = gap + sphere_profile(sphere.radius, distance[nodes])
    contact = SurfaceContact(
        name, number, nodes, 0, facets, weights, normals, gaps, friction=friction
    )
    return contact, areas[nodes]
