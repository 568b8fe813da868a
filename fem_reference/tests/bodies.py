"""Bodies made with gmsh's CAD kernel, as STEP and as meshes."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
import pytest

from fem_reference.common.mesher import start_gmsh
from fem_reference.general_impact.command import LEAST_GMSH, release_of
from fem_reference.tests.program import run_program

if release_of(gmsh.__version__) < LEAST_GMSH:
    pytest.skip("bodies from files need a later gmsh", allow_module_level=True)


def write_cad(path: Path, build: Callable[[], object]) -> Path:
    """Write what ``build`` adds to gmsh's OCC model as STEP, BREP or IGES (mm)."""
    start_gmsh()
    try:
        build()
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


def name_faces(path: Path, names: Sequence[str]) -> Path:
    """Give the faces of a STEP file names, in the file's order."""
    given = iter(names)
    text = path.read_text(encoding="utf-8")
    text = re.sub(r"ADVANCED_FACE\(''", lambda _: f"ADVANCED_FACE('{next(given, '')}'", text)
    path.write_text(text, encoding="utf-8")
    return path


def plate(radius: float = 33.0, thickness: float = 2.0) -> None:
    """A circular plate; faces: rim, top, bottom."""
    gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, thickness, radius)


def bracket() -> None:
    """An L of 2 and 3 mm walls with a fillet of 4 mm; its foot at z = 0."""
    occ = gmsh.model.occ
    foot = occ.addBox(0, 0, 0, 30, 20, 3)
    back = occ.addBox(0, 0, 0, 2, 20, 25)
    (body,), _ = occ.fuse([(3, foot)], [(3, back)])
    occ.synchronize()
    inner = next(
        tag
        for _, tag in gmsh.model.getEntities(1)
        if np.allclose(occ.getCenterOfMass(1, tag), (2, 10, 3), atol=1e-6)
    )
    occ.fillet([body[1]], [inner], [4.0])


def write_mesh(
    path: Path,
    build: Callable[[], object],
    size: float,
    order: int = 2,
    surfaces: dict[str, list[int]] | None = None,
) -> Path:
    """Mesh what ``build`` adds to gmsh's OCC model (mm): the volume "all", named surfaces."""
    start_gmsh()
    try:
        build()
        gmsh.model.occ.synchronize()
        volumes = [tag for _, tag in gmsh.model.getEntities(3)]
        gmsh.model.addPhysicalGroup(3, volumes, name="all")
        for name, faces in (surfaces or {}).items():
            gmsh.model.addPhysicalGroup(2, faces, name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return path


PLATE_FACES = {"rim": [1], "top": [2], "bottom": [3]}


def document(path: Path, outer: object, **changes: Any) -> dict[str, Any]:
    """The scene of a body; a change is a key of `body`, or ``inner``."""
    inner = changes.pop("inner", None)
    body: dict[str, Any] = {
        "path": str(path),
        "unit": None,
        "fixed": [],
        "element_size": None,
        "materials": None,
    }
    return {
        "kind": "impact",
        "body": body | changes,
        "outer": {"at": outer, "tip_radius": 0.004},
        "inner": None if inner is None else {"at": inner, "tip_radius": 0.004},
    }


def run_mesh(
    folder: Path, scene: dict[str, Any], factor: float = 1.0
) -> subprocess.CompletedProcess[str]:
    """Run the command ``mesh``; it writes ``body.vtu`` into the folder."""
    (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    out = folder / "body.vtu"
    return run_program(
        "mesh", "--scene", folder / "scene.json", "--out", out, "--size-factor", str(factor)
    )
