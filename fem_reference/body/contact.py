"""What is stated of a contact: place, normal, curvature, wall and elements there."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SceneError
from .body import Body, require_near
from .curvature import Curvature, fitted
from .scene import Place
from .skin import SurfacePoint
from .source import Group, named

STRIKABLE = ("point", "surface", "nodes", "curve", "elements", "volume")
EDGE_ELEMENTS = 2.0
"""Least distance of a contact from an edge, over the size of the elements there."""


def located(body: Body, at: Place, path: str) -> tuple[SurfacePoint, float]:
    """The point of a mesh's surface that a contact is at, and its distance from the one meant.

    Raises:
        SceneError: the name is missing, or the point is too far from the surface.
    """
    if isinstance(at, str):
        place, among = _middle(body, named(body.groups, at, path, STRIKABLE))
        point = body.skin.nearest(place, among)
        return point, float(np.linalg.norm(point.place - place))
    point = body.skin.nearest(at)
    distance = float(np.linalg.norm(point.place - at))
    require_near(path, at, distance, 0.5 * body.skin.mean_edge(body.skin.around(point)))
    return point, distance


def _middle(body: Body, group: Group) -> tuple[Floats, Any]:
    """The centre of a group's faces and these faces; without faces that of its nodes."""
    faces = body.faces_of(group)
    if faces.any():
        weights = body.skin.areas[faces]
        return np.average(body.skin.centres[faces], axis=0, weights=weights), faces
    nodes = body.fixed_nodes(group)
    if nodes.size == 0:
        raise SceneError(f"the group {group.name!r} has no nodes on the body")
    return body.points[nodes].mean(axis=0), None


def described(
    body: Body, point: SurfacePoint, distance: float, known: Curvature | None
) -> dict[str, Any]:
    """The contact as the description of the mesh has it.

    Args:
        body: the mesh.
        point: on its surface.
        distance: from the point or the centre of the face that was named, m.
        known: curvature, where CAD states it; else it is fitted.
    """
    skin = body.skin
    size = skin.mean_edge(skin.around(point))
    curvature = known or fitted(skin, point, size)
    through = skin.exit(point.place, -curvature.normal)
    return {
        "point": point.place.tolist(),
        "distance": distance,
        "normal": curvature.normal.tolist(),
        "curvatures": list(curvature.values),
        "directions": curvature.directions.tolist(),
        "curvature_source": curvature.source,
        "element_size": size,
        "wall": through[0] if through else None,
        "layers": _layers(body, point.face, through[1]) if through else None,
        "edge_distance": skin.border_distance(point),
    }


def _layers(body: Body, start: int, end: int) -> int:
    """Elements one after the other from one triangle of the surface to another."""
    skin, corners = body.skin, body.cells[:, :4]
    target = skin.faces[end, :3]
    reached = np.zeros(body.points.shape[0], dtype=bool)
    reached[skin.faces[start, :3]] = True
    layers = 0
    while not reached[target].any():
        before = int(reached.sum())
        reached[corners[reached[corners].any(axis=1)]] = True
        layers += 1
        if int(reached.sum()) == before:
            break
    return layers


def require_inside_face(path: str, contact: dict[str, Any]) -> None:
    """Refuse a contact whose circles of pressure would leave its face.

    Raises:
        SceneError: an edge is nearer than two elements.
    """
    edge, size = contact["edge_distance"], contact["element_size"]
    if edge is not None and edge < EDGE_ELEMENTS * size:
        raise SceneError(
            f"{path} is {edge:.3g} m away from the edge of its face; at least "
            f"{EDGE_ELEMENTS:g} elements ({EDGE_ELEMENTS * size:.3g} m) are needed for the circle "
            "of pressure: move it, or refine the mesh there"
        )
