"""A CAD part in gmsh: one solid, its faces by name, points on them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SceneError
from .body import check_size
from .files import checked
from .scene import Disc, Place
from .sizing import SMALLEST_SHARE
from .skin import Skin
from .source import Group, named
from .step_text import read_step

UNIT = 1e-3
"""Metres per unit of gmsh's model: OpenCASCADE's tolerances are made for millimetres."""
COARSE_ELEMENTS = 24
"""Elements of the first mesh of the surface along the body's longest side."""
PER_CIRCLE = 16
"""Its elements around a circle."""
TRIANGLE6 = 9
SEWN = 1e-4
"""Largest gap between the faces of an IGES file, in `UNIT`."""
NEAR = 0.05
"""Distance of a face from the first mesh, over its elements, that is possible."""


@dataclass(frozen=True)
class Part:
    """The only solid of gmsh's model."""

    name: str
    """Of the file."""
    solid: int
    unit: float
    """Metres per number of the file."""
    groups: list[Group]
    """Faces and the solid; a face's tags are in `elements`."""

    def box(self) -> list[list[float]]:
        """The bounding box, m."""
        six = gmsh.model.occ.getBoundingBox(3, self.solid)
        return [[UNIT * x for x in six[:3]], [UNIT * x for x in six[3:]]]

    def volume(self) -> float:
        """Of the solid, m^3."""
        return float(gmsh.model.occ.getMass(3, self.solid)) * UNIT**3

    def faces_of(self, name: str, path: str) -> Ints:
        """Tags of the faces of a name.

        Raises:
            SceneError: there are none.
        """
        return named(self.groups, name, path, ("surface",)).elements


def load(path: Path, unit: float | None) -> Part:
    """Read a CAD part into gmsh's model, which counts in `UNIT`.

    Args:
        path: its file.
        unit: metres per number of the file; None: the one it states, or 1 where it states none.

    Raises:
        SceneError: it cannot be read, or is not one solid.
    """
    suffix = checked(path)
    text = read_step(path) if suffix in (".step", ".stp") else None
    own = text.unit if text else None
    replaced = unit
    if suffix == ".brep":
        own, unit = UNIT, unit or 1.0
        replaced = unit
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.option.setNumber("Geometry.OCCScaling", replaced / own if replaced and own else 1.0)
    try:
        gmsh.model.occ.importShapes(str(path), highestDimOnly=False)
        if suffix in (".iges", ".igs"):
            # it has faces alone, which are sewn
            gmsh.model.occ.healShapes(tolerance=SEWN)
        gmsh.model.occ.synchronize()
    except Exception as error:
        raise SceneError(f"body.file {path} cannot be read as {suffix}: {error}") from error
    if replaced and not own:
        raise SceneError(
            f"body.unit is {replaced:g} m, but {path.name} states a unit that cannot be replaced; "
            "leave body.unit out"
        )
    unit = unit or own or UNIT
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    if len(solids) != 1:
        raise SceneError(
            f"{path.name} has {len(solids) or 'no'} solids; one is needed: "
            + ("join them or export one part" if solids else "export a solid, not surfaces")
        )
    groups = _groups(solids[0], text.faces if text else [])
    return Part(path.name, solids[0], unit, groups)


def disc_part(disc: Disc) -> Part:
    """A circular plate in gmsh's model."""
    thickness, radius = disc.thickness / UNIT, disc.radius / UNIT
    solid = gmsh.model.occ.addCylinder(0.0, 0.0, 0.0, 0.0, 0.0, thickness, radius)
    gmsh.model.occ.synchronize()
    return Part("the plate", solid, UNIT, _groups(solid, []))


def _groups(solid: int, labels: list[tuple[str, str]]) -> list[Group]:
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    by_name: dict[str, list[int]] = {}
    for face, name in zip(faces, _names(faces, labels), strict=True):
        by_name.setdefault(name, []).append(face)
    groups = [_face_group(name, tags) for name, tags in by_name.items()]
    title = gmsh.model.getEntityName(3, solid).rpartition("/")[2] or "solid"
    return [*groups, Group(title, "volume", elements=np.array([solid]))]


def _names(faces: list[int], labels: list[tuple[str, str]]) -> list[str]:
    """The file's names of the faces, else "face 1", ...

    The file's order is gmsh's; if number or kinds of surfaces do not agree no name is taken.
    """
    kinds = [gmsh.model.getType(2, face) for face in faces]
    agree = len(labels) == len(faces) and all(
        label in ("", kind) for (_, label), kind in zip(labels, kinds, strict=True)
    )
    names = [name for name, _ in labels] if agree else [""] * len(faces)
    return [name or f"face {face}" for name, face in zip(names, faces, strict=True)]


def _face_group(name: str, faces: list[int]) -> Group:
    areas = [gmsh.model.occ.getMass(2, face) * UNIT**2 for face in faces]
    centres = [gmsh.model.occ.getCenterOfMass(2, face) for face in faces]
    about = {
        "centre": (np.average(centres, axis=0, weights=areas) * UNIT).tolist(),
        "area": float(sum(areas)),
        "shape": gmsh.model.getType(2, faces[0]).lower() if len(faces) == 1 else None,
    }
    return Group(name, "surface", elements=np.array(faces), about=about)


def coarse_skin(part: Part) -> tuple[Skin, Ints]:
    """A first mesh of the surface, in gmsh's unit, and the face of each triangle.

    Raises:
        SceneError: gmsh fails, or the surface is not closed.
    """
    check_size(part.box())
    least, most = (np.array(each) for each in part.box())
    side = float((most - least).max()) / UNIT
    gmsh.option.setNumber("Mesh.MeshSizeMax", side / COARSE_ELEMENTS)
    gmsh.option.setNumber("Mesh.MeshSizeMin", SMALLEST_SHARE * side)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", PER_CIRCLE)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 0)
    try:
        gmsh.model.mesh.setOutwardOrientation(part.solid)
        gmsh.model.mesh.generate(2)
    except Exception as error:
        raise unmeshable(part.name, error) from error
    skin, faces = _skin(part.solid)
    gmsh.model.mesh.clear()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1e22)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.0)
    return skin, faces


def unmeshable(name: str, error: object) -> SceneError:
    """The error for a CAD part that gmsh cannot mesh."""
    reason = str(error).strip().splitlines()
    return SceneError(
        f"{name} cannot be meshed ({reason[0] if reason else 'gmsh gives no reason'}); repair or "
        "simplify the CAD part, or give a mesh"
    )


def _skin(solid: int) -> tuple[Skin, Ints]:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    at = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    at[tags.astype(np.int64)] = np.arange(tags.size)
    found, owner = [], []
    for _, face in gmsh.model.getBoundary([(3, solid)], oriented=False):
        _, nodes = gmsh.model.mesh.getElementsByType(TRIANGLE6, face)
        found.append(at[nodes.astype(np.int64)].reshape(-1, 6))
        owner.append(np.full(found[-1].shape[0], face))
    return Skin(coordinates.reshape(-1, 3), np.concatenate(found)), np.concatenate(owner)


def on_face(
    part: Part, skin: Skin, owner: Ints, at: Place, path: str
) -> tuple[int, Floats, Floats]:
    """The face that a name or a point means.

    Returns:
        The face's tag, the point of it nearest to the one meant (the centre of a face's area), and
        the one meant; in gmsh's unit.
    """
    among = None
    if isinstance(at, str):
        tags = part.faces_of(at, path)
        areas = [gmsh.model.occ.getMass(2, int(tag)) for tag in tags]
        centres = [gmsh.model.occ.getCenterOfMass(2, int(tag)) for tag in tags]
        place = np.average(centres, axis=0, weights=areas)
        among = np.isin(owner, tags)
    else:
        place = at / UNIT
    near = skin.nearest(place, among)
    face = int(owner[near.face])
    size = skin.mean_edge(np.array([near.face]))
    snapped = np.array(gmsh.model.getClosestPoint(2, face, place.tolist())[0])
    # the surface goes on beyond the face's border, and a centre may be far from it
    if np.linalg.norm(snapped - near.place) > NEAR * size:
        snapped = np.array(gmsh.model.getClosestPoint(2, face, near.place.tolist())[0])
    return face, snapped, place
