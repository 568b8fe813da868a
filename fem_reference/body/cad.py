"""The mesh of a CAD part: curved quadratic tetrahedra, fine at contacts and singular edges."""

from __future__ import annotations

import math
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SceneError
from .body import Body, check_one_part, check_quality, require_near
from .cells import GMSH_NODES
from .contact import EDGE_ELEMENTS, described
from .curvature import Curvature, of_face
from .part import TRIANGLE6, UNIT, Part, coarse_skin, disc_part, load, on_face, unmeshable
from .scene import BodyScene, Place, place
from .sizing import (
    CIRCLES,
    CONTACT_SHARE,
    EDGE_SHARE,
    LEAST_CONTACT_SHARE,
    SINGULAR_EDGE_SHARE,
    ContactSize,
    Sizes,
    Walls,
    chosen_sizes,
    set_sizes,
    wall_at,
    walls,
)
from .skin import Skin, SurfacePoint
from .tets import qualities

FRONTAL, PLANE_DELAUNAY, DELAUNAY, HXT = 6, 5, 1, 10
"""gmsh's numbers of its algorithms, the first two in two dimensions. Delaunay on its own triangles
left flat tetrahedra in a thin plate, but frontal triangles overlap at the tip of a cone."""
SHARPEST = 25.0
"""Least half angle of a cone's tip, degrees: gmsh's meshes of sharper ones overlap or never end."""
POOR = 0.01
"""Quality below which the next algorithm is tried."""
TETRAHEDRON10 = 11
VOLUME_ERROR = 0.01
"""Largest relative difference of the mesh's volume from the part's."""
PLACES = (0.5, 0.2, 0.8)
"""Along a curve, where it may be sharp: where a pipe joins another it is so at the sides alone."""
MOST_INNER_CORNERS = 24
"""That get smaller elements: a part may have a thousand."""
SHARP = math.cos(math.radians(40.0))
"""Largest cosine between the normals on both sides of a sharp curve."""
AT_CURVE = 0.25
"""A contact nearer to a smooth curve than this share of its elements is moved onto it."""


@dataclass(frozen=True)
class Strike:
    """A contact on the part, in gmsh's unit."""

    face: int
    place: Floats
    distance: float
    normal: Floats
    curvature: Curvature | None
    size: float


@dataclass(frozen=True)
class CadMesh:
    """The mesh of a part and what is known of it from CAD."""

    body: Body
    part: Part
    fixed: np.ndarray[Any, Any]
    contacts: dict[str, dict[str, Any]]
    volume: float
    """Of the part, m^3."""
    scale: float
    """Factor on all sizes that keeps the number of unknowns within bounds."""


def mesh_part(scene: BodyScene, path: Path, factor: float) -> CadMesh:
    """Mesh a CAD part; gmsh runs (`files.gmsh_session`).

    Raises:
        SceneError: the file, a name, a point or a size is not sound, or gmsh cannot mesh it.
    """
    made = struck_part(scene, path)
    part, strikes = made.part, made.strikes
    contacts = [
        ContactSize(made.points[name], each.place, each.size, CIRCLES * each.size)
        for name, each in strikes.items()
    ]
    sizes = chosen_sizes(made.walls, contacts, largest_element(scene))
    faces = made.fixed_faces(scene, sizes)
    edges = made.singular_edges(faces, sizes)
    for pair in made.algorithms:
        _generate(part, sizes, factor, edges, pair)
        body, number = _body(part)
        if qualities(body.points, body.cells).min() > POOR:
            break
    check_quality(body, part.name)
    check_one_part(body, part.name)
    return CadMesh(
        body,
        part,
        _fixed_nodes(body, faces, number),
        {name: _stated(body, each) for name, each in strikes.items()},
        part.volume(),
        sizes.scale,
    )


def largest_element(scene: BodyScene) -> float | None:
    """That the scene asks for, in gmsh's unit."""
    return scene.body.element_size / UNIT if scene.body.element_size else None


@dataclass(frozen=True)
class StruckPart:
    """A CAD part in gmsh with points at its contacts, ready to be meshed."""

    part: Part
    algorithms: list[tuple[int, int]]
    """Of surface and volume, in the order in which they are tried."""
    skin: Skin
    """First, coarse mesh of the surface, in gmsh's unit."""
    owner: Ints
    """Face of each of its triangles."""
    walls: Walls
    strikes: dict[str, Strike]
    points: dict[str, int]
    """Tag of gmsh's point at each contact."""

    def fixed_faces(self, scene: BodyScene, sizes: Sizes) -> list[int]:
        """Tags of the faces that are fixed.

        Raises:
            SceneError: a name is missing, or a point is off the surface.
        """
        return _fixed_faces(scene, self.part, self.skin, self.owner, sizes)

    def singular_edges(self, fixed: list[int], sizes: Sizes) -> list[tuple[int, float]]:
        """Curves along which the stress is singular, and the size along each.

        Args:
            fixed: tags of fixed faces.
            sizes: away from the contacts.
        """
        return _singular_edges(fixed, list(self.strikes.values()), self.skin, self.owner, sizes)


def struck_part(scene: BodyScene, path: Path) -> StruckPart:
    """Read a CAD part and find its contacts; gmsh runs.

    Raises:
        SceneError: the file, a name or a point is not sound.
    """
    part = disc_part(scene.body.disc) if scene.body.disc else load(path, scene.body.unit)
    algorithms = _algorithms(part)
    skin, owner = coarse_skin(part)
    found = walls(skin)
    strikes = {
        name: _strike(part, skin, owner, found, place(contact.at, f"{name}.at"), f"{name}.at")
        for name, contact in scene.contacts().items()
    }
    points = {name: _point(strike) for name, strike in strikes.items()}
    return StruckPart(part, algorithms, skin, owner, found, strikes, points)


def _strike(part: Part, skin: Skin, owner: Ints, found: Walls, at: Place, path: str) -> Strike:
    face, snapped, meant = on_face(part, skin, owner, at, path)
    near = skin.nearest(snapped, owner == face)
    curvature = of_face(face, snapped, near.normal, UNIT)
    normal = curvature.normal if curvature else near.normal
    through = skin.exit(near.place, -normal)
    wall = wall_at(found, snapped, through[0] if through else np.inf)
    distance = float(np.linalg.norm(snapped - meant))
    if not isinstance(at, str):
        require_near(path, at, distance * UNIT, 0.5 * CONTACT_SHARE * wall * UNIT)
    edge = skin.border_distance(SurfacePoint(snapped, normal, near.face))
    size = CONTACT_SHARE * wall
    if edge is not None:
        size = max(min(size, EDGE_SHARE * edge), LEAST_CONTACT_SHARE * wall)
        if edge < EDGE_ELEMENTS * size:
            raise SceneError(
                f"{path} is {edge * UNIT:.3g} m away from the edge of its face, whose circle of "
                f"pressure needs at least {EDGE_ELEMENTS * size * UNIT:.3g} m (wall "
                f"{wall * UNIT:.3g} m): move it away from the edge"
            )
    moved = _at_curve(face, snapped, size)
    return Strike(face, moved, float(np.linalg.norm(moved - meant)), normal, curvature, size)


def _at_curve(face: int, snapped: Floats, size: float) -> Floats:
    """The point, or that of a smooth border of its face so near that elements would be flat."""
    for _, curve in gmsh.model.getBoundary([(2, face)], combined=False, oriented=False):
        if gmsh.model.getType(1, curve) == "Unknown":
            continue
        on_curve = np.array(gmsh.model.getClosestPoint(1, curve, snapped.tolist())[0])
        if np.linalg.norm(on_curve - snapped) < AT_CURVE * size:
            return on_curve
    return snapped


def _point(strike: Strike) -> int:
    """Tag of a point of gmsh's model at a contact, where a node will be."""
    tolerance = 1e-6 * strike.size
    for _, point in gmsh.model.getEntities(0):
        there = np.array(gmsh.model.getValue(0, point, []))
        if np.linalg.norm(there - strike.place) <= tolerance:
            return int(point)
    point = int(gmsh.model.occ.addPoint(*strike.place))
    gmsh.model.occ.synchronize()
    borders = gmsh.model.getBoundary([(2, strike.face)], combined=False, oriented=False)
    for _, curve in borders:
        if gmsh.model.getType(1, curve) == "Unknown":
            continue
        near = np.array(gmsh.model.getClosestPoint(1, curve, strike.place.tolist())[0])
        if np.linalg.norm(near - strike.place) <= tolerance:
            gmsh.model.mesh.embed(0, [point], 1, curve)
            return point
    gmsh.model.mesh.embed(0, [point], 2, strike.face)
    return point


def _fixed_faces(scene: BodyScene, part: Part, skin: Skin, owner: Ints, sizes: Sizes) -> list[int]:
    faces: list[int] = []
    for k, each in enumerate(scene.body.fixed):
        path = f"body.fixed[{k}]"
        at = place(each, path)
        if isinstance(at, str):
            faces += part.faces_of(at, path).tolist()
            continue
        face, snapped, meant = on_face(part, skin, owner, at, path)
        size = float(sizes.at(snapped[None])[0])
        require_near(path, at, float(np.linalg.norm(snapped - meant)) * UNIT, 0.5 * size * UNIT)
        faces.append(face)
    return sorted(set(faces))


def _singular_edges(
    fixed: list[int], strikes: list[Strike], skin: Skin, owner: Ints, sizes: Sizes
) -> list[tuple[int, float]]:
    """Sharp curves around fixed faces, and sharp inner corners, of many those near contacts."""
    borders = [gmsh.model.getBoundary([(2, face)], False, False) for face in fixed]
    times = Counter(curve for border in borders for _, curve in border)
    contacts = np.array([strike.place for strike in strikes])

    def away(curve: int) -> float:
        return float(np.linalg.norm(contacts - _along(curve, 0.5), axis=1).min())

    found, inner_corners = [], 0
    for curve in sorted((curve for _, curve in gmsh.model.getEntities(1)), key=away):
        held = times[curve] == 1
        between = [each for each in gmsh.model.getAdjacencies(1, curve)[0] if each in owner]
        if len(between) != 2 or not (held or inner_corners < MOST_INNER_CORNERS):
            continue
        for at in (_along(curve, share) for share in PLACES):
            one, other = (skin.nearest(at, owner == face) for face in between)
            inner = (skin.centres[other.face] - at) @ one.normal > 0.0
            if one.normal @ other.normal <= SHARP and (held or inner):
                size = SINGULAR_EDGE_SHARE * float(sizes.at(at[None])[0])
                found.append((curve, size))
                inner_corners += not held
                break
    return found


def _along(curve: int, share: float) -> Floats:
    """The place at a share of a curve's parameter."""
    least, most = (float(end[0]) for end in gmsh.model.getParametrizationBounds(1, curve))
    return np.array(gmsh.model.getValue(1, curve, [least + share * (most - least)]))


def _algorithms(part: Part) -> list[tuple[int, int]]:
    """Algorithms for surface and volume, in the order they are tried.

    Raises:
        SceneError: the tip of a cone is too sharp for all of them.
    """
    sharpest = min(_tips(), default=None)
    if sharpest is not None and sharpest < SHARPEST:
        raise SceneError(
            f"{part.name} has a cone with a sharp tip, whose half angle is {sharpest:.3g} degrees; "
            f"tips from {SHARPEST:g} degrees on can be meshed: cut the tip off or round it"
        )
    plane = FRONTAL if sharpest is None else PLANE_DELAUNAY
    return [(plane, DELAUNAY), (plane, HXT)]


def _tips() -> Iterator[float]:
    """Half angles in degrees of the tips of cones."""
    for _, face in gmsh.model.getEntities(2):
        if gmsh.model.getType(2, face) != "Cone":
            continue
        borders = gmsh.model.getBoundary([(2, face)], combined=False, oriented=False)
        for curve in (each for _, each in borders if gmsh.model.getType(1, each) == "Unknown"):
            # a curve without length
            point = gmsh.model.getBoundary([(1, curve)], combined=False, oriented=False)[0][1]
            tip = np.array(gmsh.model.getValue(0, point, []))
            (u, v), (_, w) = gmsh.model.getParametrizationBounds(2, face)
            at = [gmsh.model.getValue(2, face, [u + turn, 0.5 * (v + w)]) for turn in (0.0, np.pi)]
            one, other = (np.array(each) - tip for each in at)
            cosine = one @ other / (np.linalg.norm(one) * np.linalg.norm(other))
            yield float(0.5 * np.degrees(np.arccos(cosine)))


def _generate(
    part: Part,
    sizes: Sizes,
    factor: float,
    edges: list[tuple[int, float]],
    algorithms: tuple[int, int],
) -> None:
    """Mesh the part in gmsh."""
    gmsh.model.mesh.clear()
    for key, value in (
        ("Mesh.Algorithm", algorithms[0]),
        ("Mesh.Algorithm3D", algorithms[1]),
        ("Mesh.Optimize", 1),
        ("Mesh.ElementOrder", 2),
        ("Mesh.HighOrderOptimize", 1),
    ):
        gmsh.option.setNumber(key, value)
    with tempfile.TemporaryDirectory() as folder:
        set_sizes(sizes, factor, edges, Path(folder))
        try:
            gmsh.model.mesh.generate(3)
        except Exception as error:
            raise unmeshable(part.name, error) from error


def _body(part: Part) -> tuple[Body, Ints]:
    """The mesh in m, and the number of the node of each of gmsh's tags (-1: no element has it)."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, flat = gmsh.model.mesh.getElementsByType(TETRAHEDRON10, part.solid)
    if flat.size == 0:
        raise unmeshable(part.name, "gmsh made no tetrahedra")
    cells = flat.astype(np.int64).reshape(-1, 10)[:, list(GMSH_NODES["tetra10"])]
    used = np.unique(cells)
    number = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    number[used] = np.arange(used.size)
    points = np.empty((used.size, 3))
    at = number[tags.astype(np.int64)]
    points[at[at >= 0]] = UNIT * coordinates.reshape(-1, 3)[at >= 0]
    groups = [
        replace(each, nodes=number[_nodes(each.elements)]) if each.kind == "surface" else each
        for each in part.groups
    ]
    return Body(points, number[cells], groups), number


def _nodes(faces: Ints) -> Ints:
    """Tags, gmsh's, of the nodes of faces, their borders included."""
    found = [gmsh.model.mesh.getElementsByType(TRIANGLE6, int(face))[1] for face in faces]
    return np.unique(np.concatenate(found).astype(np.int64))


def _fixed_nodes(body: Body, faces: list[int], number: Ints) -> np.ndarray[Any, Any]:
    fixed = np.zeros(body.points.shape[0], dtype=bool)
    if faces:
        fixed[number[_nodes(np.array(faces))]] = True
    return fixed


def _stated(body: Body, strike: Strike) -> dict[str, Any]:
    """The contact as the description of the mesh has it, at the node made for it."""
    found = body.skin.nearest(strike.place * UNIT)
    node = body.skin.faces[found.face, :3]
    away = np.linalg.norm(body.points[node] - strike.place * UNIT, axis=1)
    corner = int(np.argmin(away))
    if away[corner] < 0.1 * strike.size * UNIT:
        found = replace(found, place=body.points[node[corner]])
    point = replace(found, normal=strike.normal)
    return described(body, point, strike.distance * UNIT, strike.curvature)
