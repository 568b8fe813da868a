"""The file of a body's mesh and its description, for the program's reduced models."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gmsh
import meshio
import numpy as np

from ..common.arrays import Floats, Ints, Mask
from ..common.errors import SceneError, SolverError
from ..common.mesh_files import require_replaceable
from ..common.output import write_json
from .body import Body, body_of, bounding_box, fixed_mask
from .cad import VOLUME_ERROR, mesh_part
from .contact import EDGE_ELEMENTS, described, located, require_inside_face
from .files import CAD, checked, gmsh_session, read_mesh
from .part import load
from .remesh import neighbour
from .scene import BodyScene, no_such_name, place
from .source import Group
from .tets import lengths, qualities, volume


@dataclass(frozen=True)
class Meshed:
    """A mesh, ready to be written."""

    body: Body
    fixed: Mask
    contacts: dict[str, dict[str, Any] | None]
    groups: dict[str, Any]
    """As the command `groups` states them."""
    about: dict[str, Any]
    """More for the description."""


def groups_of(path: Path, unit: float | None) -> dict[str, Any]:
    """What a file has, as the command `groups` prints it.

    Raises:
        SceneError: the file cannot be read.
    """
    if checked(path) in CAD:
        with gmsh_session():
            part = load(path, unit)
            return _listed("cad", part.unit, part.box(), {}, part.groups)
    source = read_mesh(path)
    unit = unit or 1.0
    box = bounding_box(unit * source.points) if source.points.size else [[0.0] * 3] * 2
    return _listed("mesh", unit, box, source.counts, source.groups)


def _listed(
    source: str, unit: float, box: list[list[float]], counts: dict[str, int], groups: Any
) -> dict[str, Any]:
    return {
        "source": source,
        "unit": unit,
        "bounding_box": box,
        "elements": counts,
        "groups": [group.described() for group in groups],
    }


def meshed(scene: BodyScene, factor: float) -> Meshed:
    """The mesh of a scene's body.

    Raises:
        SceneError: the file or what the scene says of it is not sound.
        SolverError: a mesh could not be made coarser.
    """
    path = Path(scene.body.path)
    if scene.body.disc:
        return _from_cad(scene, path, factor)
    return (_from_cad if checked(path) in CAD else _from_mesh)(scene, path, factor)


def _from_cad(scene: BodyScene, path: Path, factor: float) -> Meshed:
    with gmsh_session():
        made = mesh_part(scene, path, factor)
        groups = _listed("cad", made.part.unit, made.part.box(), {}, made.part.groups)
    found = volume(made.body.points, made.body.cells)
    if abs(found - made.volume) > VOLUME_ERROR * made.volume:
        raise SolverError(
            f"the mesh of {made.part.name} has the volume {found:.6g} m^3, the part "
            f"{made.volume:.6g} m^3: more than {100 * VOLUME_ERROR:g} % apart; set "
            "body.element_size to a smaller one"
        )
    contacts = {name: made.contacts.get(name) for name in ("outer", "inner")}
    about = {"cad_volume": made.volume, "size_scale": made.scale, "size_factor": factor}
    return Meshed(made.body, made.fixed, contacts, groups, about)


def _from_mesh(scene: BodyScene, path: Path, factor: float) -> Meshed:
    source, unit = read_mesh(path), scene.body.unit or 1.0
    body = body_of(source, scene.body.unit, path.name)
    fixed = fixed_mask(
        body, [place(each, f"body.fixed[{k}]") for k, each in enumerate(scene.body.fixed)]
    )
    box = bounding_box(unit * source.points)
    groups = _listed("mesh", unit, box, source.counts, source.groups)
    contacts: dict[str, dict[str, Any] | None] = {"outer": None, "inner": None}
    for name, contact in scene.contacts().items():
        point, distance = located(body, place(contact.at, f"{name}.at"), f"{name}.at")
        stated = described(body, point, distance, None)
        require_inside_face(f"{name}.at", stated)
        contacts[name] = stated
    if factor > 1.0:
        body, fixed, contacts, factor = neighbour(body, fixed, contacts, factor, path.name)
    about = {"cad_volume": None, "size_scale": 1.0, "size_factor": factor}
    return Meshed(body, fixed, contacts, groups, about)


def material_index(body: Body, materials: dict[str, str]) -> tuple[Ints, list[str]]:
    """The material of each element, as an index into the list of them.

    Raises:
        SceneError: a group is missing, or an element has no material or two.
    """
    count = body.cells.shape[0]
    if not materials:
        return np.zeros(count, dtype=np.int64), []
    names = list(dict.fromkeys(materials.values()))
    index = np.full(count, -1, dtype=np.int64)
    for name, material in materials.items():
        elements = _elements_of(body, name)
        new = names.index(material)
        taken = np.count_nonzero((index[elements] >= 0) & (index[elements] != new))
        if taken:
            raise SceneError(
                f"body.materials: {taken} elements of the group {name!r} are also in a group of "
                "another material; give groups that do not overlap"
            )
        index[elements] = new
    if (index < 0).any():
        raise SceneError(
            f"body.materials leaves {np.count_nonzero(index < 0)} of {count} elements without a "
            f"material; give one to every group of {_volumes(body)}"
        )
    return index, names


def material_at(
    body: Body, name: str, contact: dict[str, Any], index: Ints, names: list[str]
) -> dict[str, Any]:
    """The material of the element at a contact, and the distance in m to the nearest other one.

    Raises:
        SceneError: the circle of pressure does not fit into the one material.
    """
    if len(names) < 2:
        return {"material": names[0] if names else None, "material_distance": None}
    point, size = np.array(contact["point"]), contact["element_size"]
    face = body.skin.faces[body.skin.nearest(point).face, :3]
    own = index[np.isin(body.cells[:, :4], face).sum(axis=1) == 3][0]
    others = body.points[np.unique(body.cells[index != own])]
    distance = float(np.linalg.norm(others - point, axis=1).min())
    if distance < EDGE_ELEMENTS * size:
        raise SceneError(
            f"{name}.at is {distance:.3g} m away from another material; at least "
            f"{EDGE_ELEMENTS:g} elements ({EDGE_ELEMENTS * size:.3g} m) are needed for the circle "
            "of pressure: move it, or refine the mesh there"
        )
    return {"material": names[own], "material_distance": distance}


def _volumes(body: Body) -> list[str]:
    return [group.name for group in body.groups if group.kind in ("volume", "elements")]


def _elements_of(body: Body, name: str) -> Ints:
    found: list[Group] = [
        group
        for group in body.groups
        if group.kind in ("volume", "elements") and group.name.casefold() == name.casefold()
    ]
    if not found:
        raise no_such_name(name, "body.materials", _volumes(body))
    return found[0].elements


def write_body_mesh(path: Path, scene: BodyScene, factor: float) -> None:
    """Mesh a scene's body; write it as an uncompressed .vtu, then its description as .json.

    Raises:
        SceneError: the file, the scene or the size factor is not sound.
        SolverError: meshing failed, the files cannot be written, or others would be lost.
    """
    require_replaceable(path)
    if not (math.isfinite(factor) and 0.25 <= factor <= 10.0):
        raise SceneError(f"--size-factor is {factor:g}; it must lie between 0.25 and 10")
    made = meshed(scene, factor)
    material, materials = material_index(made.body, scene.body.material_names())
    for name, contact in made.contacts.items():
        if contact:
            contact |= material_at(made.body, name, contact, material, materials)
    grid = meshio.Mesh(
        made.body.points,
        [("tetra10", made.body.cells.astype(np.int32))],
        point_data={"fixed": made.fixed.astype(np.int32)},
        cell_data={"material": [material.astype(np.int32)]},
    )
    temporary = path.with_name(f".partial-{path.name}")
    described_path = path.with_suffix(".json")
    partial = described_path.with_name(f".partial-{described_path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        meshio.vtu.write(temporary, grid, binary=True, compression=None)
        digest = hashlib.sha256(temporary.read_bytes()).hexdigest()
        write_json(partial, _description(made, digest, materials))
        temporary.replace(path)
        # last: whoever finds it finds the mesh
        partial.replace(described_path)
    except OSError as error:
        raise SolverError(f"the mesh {path} cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
        partial.unlink(missing_ok=True)


def _description(made: Meshed, digest: str, materials: list[str]) -> dict[str, Any]:
    body = made.body
    quality, edges = qualities(body.points, body.cells), lengths(body.points, body.cells)
    points: Floats = body.points
    return {
        "schema_version": 1,
        "sha256": digest,
        "nodes": points.shape[0],
        "dofs": 3 * points.shape[0],
        "elements": body.cells.shape[0],
        "element_order": 2,
        "min_quality": float(quality.min()),
        "mean_quality": float(quality.mean()),
        "volume": volume(points, body.cells),
        **made.about,
        "bounding_box": bounding_box(points),
        "smallest_element": float(edges.min()),
        "largest_element": float(edges.max()),
        "fixed_nodes": int(made.fixed.sum()),
        "materials": materials,
        "groups": made.groups["groups"],
        "source": made.groups["source"],
        "unit": made.groups["unit"],
        "contacts": made.contacts,
        "versions": {"gmsh": gmsh.__version__, "meshio": meshio.__version__},
    }
