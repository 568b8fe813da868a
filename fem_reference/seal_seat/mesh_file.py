"""The mesh of a seal seat as a file that other programs read, and what it was made from."""

from __future__ import annotations

import hashlib
import math
import re
from pathlib import Path

import meshio
import numpy as np

from ..common.errors import SceneError, SolverError
from ..common.mesh_files import require_replaceable
from ..common.output import write_json
from ..common.settings import RESOLUTIONS
from ..common.versions import versions
from ..solid.mesh import mesh_report
from .meshing import seat_mesh
from .scene import SeatScene

GEOMETRY = re.compile(rb"<!--geometry_hash ([^ ]+)-->")


def record_geometry(path: Path, scene: SeatScene) -> None:
    """Note in a .vtu file, as an XML comment, which geometry its mesh is one of."""
    if scene.geometry_hash is not None:
        head, newline, rest = path.read_bytes().partition(b"\n")
        comment = f"<!--geometry_hash {scene.geometry_hash}-->".encode()
        path.write_bytes(head + newline + comment + newline + rest)


def check_geometry(path: Path, scene: SeatScene) -> None:
    """Refuse the mesh of another geometry.

    Raises:
        SolverError: the file says that it is one.
    """
    noted = GEOMETRY.search(path.read_bytes())
    if noted and scene.geometry_hash and noted[1].decode() != scene.geometry_hash:
        raise SolverError(f"mesh {path} is not one of this seat: it was made for another geometry")


def write_seat_mesh(path: Path, scene: SeatScene, resolution: str, size_factor: float) -> None:
    """Mesh the seat, write it as an uncompressed .vtu and what it was made from as .json beside it.

    Raises:
        SceneError: the size factor is not sound.
        SolverError: meshing failed, the files cannot be written, or others would be lost.
    """
    require_replaceable(path)
    if not (math.isfinite(size_factor) and 0.1 <= size_factor <= 10.0):
        raise SceneError(f"--size-factor is {size_factor:g}; it must lie between 0.1 and 10")
    mesh = seat_mesh(scene, RESOLUTIONS[resolution] / size_factor)
    kind = {1: "tetra", 2: "tetra10"}[mesh.order]
    grid = meshio.Mesh(mesh.points, [(kind, mesh.cells.astype(np.int32))])
    temporary = path.with_name(f".partial-{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        meshio.vtu.write(temporary, grid, binary=True, compression=None)
        record_geometry(temporary, scene)
        document = {
            "schema_version": 1,
            "scene": scene.name,
            "geometry_hash": scene.geometry_hash,
            "sha256": hashlib.sha256(temporary.read_bytes()).hexdigest(),
            "resolution": resolution,
            "size_factor": size_factor,
            "elements_per_ring_radius": scene.elements_per_ring_radius,
            **mesh_report([mesh]),
            "volume": mesh.volume(),
            "versions": {name: versions()[name] for name in ("gmsh", "meshio")},
        }
        # The description goes first: a mesh without one is taken for one of something else.
        write_json(path.with_suffix(".json.partial"), document)
        path.with_suffix(".json.partial").replace(path.with_suffix(".json"))
        temporary.replace(path)
    except OSError as error:
        raise SolverError(f"the mesh {path} cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
