"""Another mesh of a body that came as a mesh: coarser, or finer."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import Floats, Ints, Mask
from ..common.errors import SceneError, SolverError
from .body import Body, check_one_part, check_quality
from .cells import GMSH_NODES
from .contact import described
from .curvature import Curvature
from .files import gmsh_session
from .halved import halved
from .sizing import GROWTH, grid_field
from .skin import FEATURE_ANGLE, Skin
from .source import Group
from .tets import lengths, volume

TETRAHEDRON10 = 11
VOLUME_ERROR = 0.05
"""Largest relative difference of the coarser mesh's volume from the mesh's own."""
CANDIDATES = 8
LAYERS = 2.0
"""Elements through the wall of a contact below which a coarser mesh does not show the error: one
layer is the least that both have."""
MOST_HALVED = 8_000
"""Elements that are still halved: eight times as many have some 270 000 degrees of freedom."""


def neighbour(
    body: Body, fixed: Mask, contacts: dict[str, Any], factor: float, name: str
) -> tuple[Body, Mask, dict[str, Any], float]:
    """Another mesh of the body, by whose results the error of its own is estimated.

    It is coarser by ``factor``, or finer by 2 where the wall of a contact has one layer of
    elements; with its fixed nodes, its contacts, and the size of its elements over the body's own.

    Raises:
        SolverError: as `remeshed`.
    """
    layers = [each["layers"] for each in contacts.values() if each and each["layers"] is not None]
    if min(layers, default=LAYERS) < LAYERS and body.cells.shape[0] <= MOST_HALVED:
        return *_refined(body, fixed, contacts), 0.5
    return *remeshed(body, fixed, contacts, factor, name), factor


def _refined(
    body: Body, fixed: Mask, contacts: dict[str, Any]
) -> tuple[Body, Mask, dict[str, Any]]:
    points, cells = halved(body.points, body.cells)

    def parts(elements: Ints) -> Ints:
        return np.asarray((8 * elements[:, None] + np.arange(8)).ravel())

    groups = [
        Group(group.name, group.kind, elements=parts(group.elements))
        for group in body.groups
        if group.elements.size
    ]
    made = Body(points, cells, groups)
    return made, moved_nodes(body, fixed, made), _moved_contacts(made, contacts)


def remeshed(
    body: Body, fixed: Mask, contacts: dict[str, Any], factor: float, name: str
) -> tuple[Body, Mask, dict[str, Any]]:
    """The body with ``factor`` times as large elements, the fixed nodes and contacts carried over.

    Raises:
        SolverError: gmsh fails, or the volume is another.
    """
    scale = 1.0 / float(np.ptp(body.points, axis=0).max())
    try:
        with gmsh_session():
            points, cells = _generated(body, factor, scale)
        made = Body(points / scale, cells, _moved_groups(body, points / scale, cells))
        check_quality(made, name)
        check_one_part(made, name)
    except Exception as error:
        raise SolverError(f"{name} cannot be meshed with larger elements: {error}") from error
    found, own = volume(made.points, made.cells), volume(body.points, body.cells)
    if abs(found - own) > VOLUME_ERROR * own:
        raise SolverError(
            f"{name} with elements {factor:g} times as large has the volume {found:.6g} m^3 "
            f"instead of {own:.6g}: it is too coarse for that"
        )
    return made, moved_nodes(body, fixed, made), _moved_contacts(made, contacts)


def _generated(body: Body, factor: float, scale: float) -> tuple[Floats, Ints]:
    """Points, in units of the body's longest side, and tetrahedra."""
    classify(body.skin, scale)
    for key, value in (("Algorithm3D", 1), ("ElementOrder", 2), ("HighOrderOptimize", 1)):
        gmsh.option.setNumber(f"Mesh.{key}", value)
    for source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
    corners = np.unique(body.cells[:, :4])
    sizes = factor * scale * _local_sizes(body)[corners]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sizes.txt"
        field = grid_field(
            path, scale * body.points[corners], _nearest(body, corners, sizes, scale)
        )
        gmsh.model.mesh.field.setAsBackgroundMesh(field)
        gmsh.model.mesh.generate(3)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, flat = gmsh.model.mesh.getElementsByType(TETRAHEDRON10)
    if flat.size == 0:
        raise SceneError("gmsh made no tetrahedra")
    at = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    at[tags.astype(np.int64)] = np.arange(tags.size)
    cells = at[flat.astype(np.int64)].reshape(-1, 10)[:, list(GMSH_NODES["tetra10"])]
    used, number = np.unique(cells, return_inverse=True)
    return coordinates.reshape(-1, 3)[used], number.reshape(cells.shape)


def classify(skin: Skin, scale: float) -> None:
    """Make a solid of gmsh's of a surface: smooth faces between sharp edges.

    Args:
        skin: the surface.
        scale: of gmsh's unit on that of the surface.
    """
    triangles = _flat(skin) * scale
    places, nodes = np.unique(np.round(triangles.reshape(-1, 3), 12), axis=0, return_inverse=True)
    surface = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, surface, np.arange(1, len(places) + 1), places.ravel())
    gmsh.model.mesh.addElementsByType(surface, 2, [], nodes.ravel() + 1)
    gmsh.model.mesh.classifySurfaces(FEATURE_ANGLE, True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(faces)])
    gmsh.model.geo.synchronize()


def _flat(skin: Skin) -> Floats:
    """Flat triangles (k, 3, 3): of curved faces four each."""
    return skin.sub if skin.curved.any() else skin.points[skin.faces[:, :3]]


def _local_sizes(body: Body) -> Floats:
    """(n,) mean length of the edges at each corner node."""
    edges = lengths(body.points, body.cells)
    count = np.zeros(body.points.shape[0])
    total = np.zeros(body.points.shape[0])
    for corner in range(4):
        np.add.at(total, body.cells[:, corner], edges.mean(axis=1))
        np.add.at(count, body.cells[:, corner], 1.0)
    return np.asarray(total / np.maximum(count, 1.0))


def _nearest(body: Body, corners: Ints, sizes: Floats, scale: float) -> Any:
    tree = cKDTree(scale * body.points[corners])

    def at(places: Floats) -> Floats:
        distance, index = tree.query(places, k=min(4, corners.size))
        return np.asarray((sizes[index] + GROWTH * distance).min(axis=1))

    return at


def _moved_groups(body: Body, points: Floats, cells: Ints) -> list[Group]:
    """Groups of volumes: each new element belongs to those of the nearest old one."""
    tree = cKDTree(body.points[body.cells[:, :4]].mean(axis=1))
    _, old = tree.query(points[cells[:, :4]].mean(axis=1))
    return [
        Group(group.name, group.kind, elements=np.flatnonzero(np.isin(old, group.elements)))
        for group in body.groups
        if group.elements.size
    ]


def moved_nodes(body: Body, fixed: Mask, made: Body) -> Mask:
    """Nodes of the triangles whose nearest old triangle is fixed, or next to single fixed nodes."""
    moved = np.zeros(made.points.shape[0], dtype=bool)
    if not fixed.any():
        return moved
    old = fixed[body.skin.faces].all(axis=1)
    if not old.any():
        corners = np.unique(made.cells[:, :4])
        single = np.intersect1d(np.flatnonzero(fixed), body.cells[:, :4])
        _, near = cKDTree(made.points[corners]).query(body.points[single])
        moved[corners[near]] = True
        return moved
    _, near = cKDTree(body.skin.centres).query(made.skin.centres, k=CANDIDATES)
    for face, (centre, candidates) in enumerate(zip(made.skin.centres, near, strict=True)):
        among = np.zeros(old.size, dtype=bool)
        among[candidates[candidates < old.size]] = True
        if old[among].all() or (old[among].any() and old[body.skin.nearest(centre, among).face]):
            moved[made.skin.faces[face]] = True
    return moved


def _moved_contacts(made: Body, contacts: dict[str, Any]) -> dict[str, Any]:
    """The contacts on the other mesh, with the curvature of the mesh's own surface."""
    moved: dict[str, Any] = {}
    for name, contact in contacts.items():
        moved[name] = None
        if contact is not None:
            known = Curvature(
                tuple(contact["curvatures"]),
                np.array(contact["directions"]),
                np.array(contact["normal"]),
                contact["curvature_source"],
            )
            point = made.skin.nearest(np.array(contact["point"]))
            moved[name] = described(made, point, contact["distance"], known)
    return moved
