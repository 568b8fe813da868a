"""A body for its explicit reference: straight quadratic tetrahedra, fine around the contacts."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SceneError, SolverError
from ..solid.bisection import bisected
from ..solid.mesh import (
    MINIMUM_QUALITY,
    TetMesh,
    check_elements,
    edge_lengths,
    qualities,
    surface,
    tetrahedra,
    volumes,
)
from .body import Body, body_of, fixed_mask
from .cad import DELAUNAY, FRONTAL, HXT, StruckPart, largest_element, struck_part
from .contact import described, located
from .files import CAD, checked, gmsh_session, read_mesh
from .part import UNIT
from .remesh import moved_nodes
from .scene import BodyScene, place
from .sizing import (
    WALL_SHARE,
    ContactSize,
    Sizes,
    Walls,
    grid_field,
    requested_sizes,
    set_fields,
    walls,
)
from .tets import volume

LONGEST = 1.4
"""Longest edge of a tetrahedron over its size."""
TRIANGLE3, TETRAHEDRON4 = 2, 4
"""gmsh's numbers of elements."""
EXACT_ZONES = 3.0
"""Distance from a contact up to which nodes are put on the exact body, over the fine zone."""
TANGENT = 0.1
"""Directions in which the facets at a node have less than this share of their normals are left."""
COARSER = 1.7
"""Largest mean edge of the elements at a contact over the size requested."""
SMALLER = (1.0, 0.98, 0.96)
"""Factors on the sizes away from the contacts that are tried until no element is flat."""


@dataclass(frozen=True)
class Fineness:
    """Elements of a body, m."""

    contacts: dict[str, tuple[float, float]]
    """Size at a contact, and radius of the zone where it holds, by the contact's name."""
    growth: float
    """Of the size per distance from them."""
    walls: float
    """Largest element over the thickness of the wall."""
    largest: float
    """m"""
    per_circle: float
    """Elements around a circle, at least."""


@dataclass(frozen=True)
class Strike:
    """A contact on a body."""

    point: Floats
    """(3,) m"""
    normal: Floats
    """(3,) outward."""
    curvature: float
    """Mean of the two principal ones, positive where the body is convex, 1/m."""


@dataclass(frozen=True)
class FineBody:
    """A mesh with its contacts."""

    mesh: TetMesh
    fixed: Ints
    """Nodes that do not move."""
    volume: float
    """Of the exact body, m^3."""
    strikes: dict[str, Strike]
    places: Floats
    """(n, 3) of the nodes, those of the surface around the contacts on the exact body, m."""
    kept: float = 0.0
    """Share of the volume whose elements are those of the file."""


def fine_body(scene: BodyScene, order: int, fineness: Fineness) -> FineBody:
    """Mesh a body.

    Args:
        scene: the body and its contacts.
        order: of the elements.
        fineness: how large they are.

    Raises:
        SceneError: the file, a name or a point is not sound.
        SolverError: it cannot be meshed.
    """
    path = Path(scene.body.path)
    make = _of_cad if checked(path) in CAD else _of_mesh
    found = make(scene, path, order, fineness)
    _require_held(found)
    return found


def _require_held(body: FineBody) -> None:
    """Refuse a body whose supports lie on a line, about which it can turn.

    Raises:
        SceneError: they do.
    """
    if body.fixed.size == 0:
        return
    places = body.mesh.points[body.fixed]
    spread = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)
    if spread[1] <= 1e-6 * np.ptp(body.mesh.points, axis=0).max():
        raise SceneError("body.fixed holds points on one line, about which the body can turn")


def _of_cad(scene: BodyScene, path: Path, order: int, fineness: Fineness) -> FineBody:
    with gmsh_session():
        made = struck_part(scene, path)
        strikes = {
            name: Strike(
                UNIT * each.place,
                each.normal,
                0.5 * sum(each.curvature.values) if each.curvature else 0.0,
            )
            for name, each in made.strikes.items()
        }
        sizes = _far(made.walls, fineness, UNIT, largest_element(scene))
        faces = made.fixed_faces(scene, sizes)
        edges = made.singular_edges(faces, sizes)
        contacts = _at_contacts(fineness, made.points, strikes, UNIT)
        mesh, number = _unflat(path.name, order, UNIT, sizes, contacts, edges, fineness)
        facets = _facets_of_faces(mesh, number)
        mesh = _levelled(mesh, facets)
        fixed = np.unique(np.concatenate([_NONE, *(facets[face].ravel() for face in faces)]))
        places = _on_faces(made, mesh, facets, fineness)
        return FineBody(mesh, fixed, made.part.volume(), strikes, places)


def _of_mesh(scene: BodyScene, path: Path, order: int, fineness: Fineness) -> FineBody:
    source = read_mesh(path)
    body = body_of(source, scene.body.unit or 1.0, path.name)
    held = [place(each, f"body.fixed[{k}]") for k, each in enumerate(scene.body.fixed)]
    fixed = fixed_mask(body, held)
    strikes = {}
    for name, contact in scene.contacts().items():
        point, distance = located(body, place(contact.at, f"{name}.at"), f"{name}.at")
        stated = described(body, point, distance, None)
        curvature = 0.5 * sum(stated["curvatures"])
        strikes[name] = Strike(np.array(stated["point"]), np.array(stated["normal"]), curvature)
    mesh, kept = _refined(body, strikes, fineness, order)
    exact = volume(body.points, body.cells)
    made = Body(mesh.points, tetrahedra("body", *_corners(mesh), 2).cells, body.groups)
    nodes = np.flatnonzero(moved_nodes(body, fixed, made)[: mesh.points.shape[0]])
    places = _on_skin(body, mesh, strikes, fineness)
    return FineBody(mesh, nodes, exact, strikes, places, kept)


_NONE = np.zeros(0, dtype=np.int64)


def _refined(
    body: Body, strikes: dict[str, Strike], fineness: Fineness, order: int
) -> tuple[TetMesh, float]:
    """The mesh that was given, with straight edges, cut where its elements are too large.

    Returns:
        The mesh, and the share of the volume whose elements were not cut.
    """
    found = walls(body.skin)
    far = _far(found, fineness, 1.0, None)

    def longest(places: Floats) -> Floats:
        sizes = far.at(places)
        for name, (size, zone) in fineness.contacts.items():
            away = np.linalg.norm(places - strikes[name].point, axis=1)
            sizes = np.minimum(sizes, size + fineness.growth * np.maximum(away - zone, 0.0))
        return LONGEST * sizes

    def on_skin(places: Floats) -> Floats:
        if not body.skin.curved.any():
            return places
        return np.array([body.skin.nearest(place).place for place in places])

    used, number = np.unique(body.cells[:, :4], return_inverse=True)
    points, corners = bisected(body.points[used], number.reshape(-1, 4), longest, on_skin)
    mesh = tetrahedra("body", points, corners, order)
    check_elements(mesh)
    # each cut leaves elements with a new node alone
    uncut = np.all(mesh.corners < used.size, axis=1)
    each = volumes(mesh.points, mesh.corners)
    return mesh, float(each[uncut].sum() / each.sum())


def _corners(mesh: TetMesh) -> tuple[Floats, Ints]:
    return mesh.points[: int(mesh.corners.max()) + 1], mesh.corners


def _far(found: Walls, fineness: Fineness, unit: float, largest: float | None) -> Sizes:
    """Sizes away from the contacts, in gmsh's unit."""
    share = fineness.walls / WALL_SHARE
    far = np.minimum(requested_sizes(found, largest), fineness.largest / unit / share)
    return Sizes(found.places, found.radii(), far, (), share, 0.0)


def _at_contacts(
    fineness: Fineness, points: dict[str, int], strikes: dict[str, Strike], unit: float
) -> list[ContactSize]:
    """Elements at the contacts, in gmsh's unit."""
    return [
        ContactSize(points[name], strikes[name].point / unit, size / unit, zone / unit)
        for name, (size, zone) in fineness.contacts.items()
    ]


def _unflat(
    name: str,
    order: int,
    unit: float,
    sizes: Sizes,
    contacts: list[ContactSize],
    edges: list[tuple[int, float]],
    fineness: Fineness,
) -> tuple[TetMesh, Ints]:
    """The mesh of gmsh's solid without flat elements, and the node of each of gmsh's tags.

    Raises:
        SolverError: some stay with another algorithm and smaller elements, or gmsh fails.
    """
    reason, best = "", 0.0
    for smaller, algorithm in product(SMALLER, (DELAUNAY, HXT)):
        gmsh.model.mesh.clear()
        for key, value in (("Algorithm", FRONTAL), ("Algorithm3D", algorithm), ("Optimize", 1)):
            gmsh.option.setNumber(f"Mesh.{key}", value)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        with tempfile.TemporaryDirectory() as folder:
            path, scaled = Path(folder) / "sizes.txt", replace(sizes, scale=smaller * sizes.scale)
            fields = [grid_field(path, sizes.places, scaled.at)]
            set_fields(fields, contacts, edges, fineness.per_circle, fineness.growth)
            try:
                gmsh.model.mesh.generate(3)
                points, corners, number = _linear(unit)
            except Exception as error:
                reason = str(error).strip()
                continue
        coarse = [c for c in contacts if not _is_fine(points, corners, c, unit)]
        if coarse:
            reason = "gmsh made larger elements at a contact"
            continue
        quality = float(qualities(points, corners).min())
        if quality > MINIMUM_QUALITY:
            return tetrahedra("body", points, corners, order), number
        best = max(best, quality)
        reason = f"the best mesh has an element of quality {best:.2g}"
    raise SolverError(f"{name} cannot be meshed as finely as its reference needs: {reason}")


def _is_fine(points: Floats, corners: Ints, contact: ContactSize, unit: float) -> bool:
    """Whether the elements at a contact are about as small as they should be."""
    node = int(np.argmin(np.linalg.norm(points - unit * contact.place, axis=1)))
    edges = edge_lengths(points, corners[(corners == node).any(axis=1)])
    return float(edges.mean()) <= COARSER * unit * contact.size


def _linear(unit: float) -> tuple[Floats, Ints, Ints]:
    """Points (m), corners of the tetrahedra, and the point of each of gmsh's tags (-1: none)."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, flat = gmsh.model.mesh.getElementsByType(TETRAHEDRON4)
    if flat.size == 0:
        raise SolverError("gmsh made no tetrahedra")
    used = np.unique(flat.astype(np.int64))
    number = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    number[used] = np.arange(used.size)
    points = np.empty((used.size, 3))
    at = number[tags.astype(np.int64)]
    points[at[at >= 0]] = unit * coordinates.reshape(-1, 3)[at >= 0]
    return points, number[flat.astype(np.int64)].reshape(-1, 4), number


def _facets_of_faces(mesh: TetMesh, number: Ints) -> dict[int, Ints]:
    """The mesh's facets on each face of gmsh's solid."""
    facets = surface(mesh)
    rows = np.sort(facets[:, :3], axis=1)
    place_of = {tuple(row): k for k, row in enumerate(rows.tolist())}
    found: dict[int, Ints] = {}
    for _, face in gmsh.model.getEntities(2):
        _, nodes = gmsh.model.mesh.getElementsByType(TRIANGLE3, face)
        own = np.sort(number[nodes.astype(np.int64)].reshape(-1, 3), axis=1).tolist()
        found[face] = facets[[place_of[tuple(row)] for row in own]]
    return found


def _levelled(mesh: TetMesh, facets: dict[int, Ints]) -> TetMesh:
    """The mesh with flat facets that lie on the mean on the part's curved faces.

    With corners on them they cut off what is convex and fill what is concave, so that a fillet
    stiffens a wall. Facets of corners on the face are on the mean a third of the three distances
    at the middles of their sides away from it; each corner is moved by what its facets want.
    """
    count = int(mesh.corners.max()) + 1
    matrix, wanted = np.zeros((count, 3, 3)), np.zeros((count, 3))
    for face, own in facets.items():
        corners = own[:, :3]
        a, b, c = (mesh.points[corners[:, k]] for k in range(3))
        middles = 0.5 * np.stack([a + b, b + c, c + a], axis=1)
        away = np.zeros_like(a)
        if gmsh.model.getType(2, face) != "Plane":
            flat = (middles / UNIT).ravel().tolist()
            closest, _ = gmsh.model.getClosestPoint(2, face, flat)
            away = (UNIT * np.array(closest).reshape(-1, 3, 3) - middles).mean(axis=1)
        # of the length of twice the area: large facets count more
        normal = np.cross(b - a, c - a)
        unit = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        for k in range(3):
            np.add.at(matrix, corners[:, k], normal[:, :, None] * unit[:, None, :])
            np.add.at(wanted, corners[:, k], normal * (unit * away).sum(axis=1, keepdims=True))
    on_surface = np.flatnonzero(matrix.any(axis=(1, 2)))
    inverse = np.linalg.pinv(matrix[on_surface], rcond=TANGENT, hermitian=True)
    points = mesh.points[:count].copy()
    points[on_surface] += np.einsum("nij,nj->ni", inverse, wanted[on_surface])
    if qualities(points, mesh.corners).min() <= MINIMUM_QUALITY:
        return mesh
    return tetrahedra(mesh.name, points, mesh.corners, mesh.order)


def _near(mesh: TetMesh, nodes: Ints, point: Floats, fineness: Fineness, name: str) -> Ints:
    """Those of the nodes around a contact."""
    away = np.linalg.norm(mesh.points[nodes] - point, axis=1)
    return nodes[away <= EXACT_ZONES * fineness.contacts[name][1]]


def _on_faces(
    made: StruckPart, mesh: TetMesh, facets: dict[int, Ints], fineness: Fineness
) -> Floats:
    """Places of the nodes, those around the contacts on the faces of the part."""
    places = mesh.points.copy()
    for name, strike in made.strikes.items():
        for face, own in facets.items():
            near = _near(mesh, np.unique(own), UNIT * strike.place, fineness, name)
            if near.size:
                flat = (places[near] / UNIT).ravel().tolist()
                closest, _ = gmsh.model.getClosestPoint(2, face, flat)
                places[near] = UNIT * np.array(closest).reshape(-1, 3)
    return places


def _on_skin(body: Body, mesh: TetMesh, strikes: dict[str, Strike], fineness: Fineness) -> Floats:
    """Places of the nodes, those around the contacts on the surface of the mesh that was given."""
    places, nodes = mesh.points.copy(), np.unique(surface(mesh))
    for name, strike in strikes.items():
        for node in _near(mesh, nodes, strike.point, fineness, name):
            places[node] = body.skin.nearest(mesh.points[node]).place
    return places
