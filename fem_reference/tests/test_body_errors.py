"""What is wrong with a body's file or scene ends in one sentence, and leaves nothing behind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import gmsh
import meshio
import numpy as np
import pytest

from fem_reference.body.mesh_file import write_body_mesh
from fem_reference.body.scene import parse_body_scene
from fem_reference.common.errors import RunError, SceneError, SolverError
from fem_reference.general_impact.command import require_gmsh
from fem_reference.tests.bodies import (
    PLATE_FACES,
    document,
    name_faces,
    plate,
    run_mesh,
    write_cad,
    write_mesh,
)


def plate_mesh(folder: Path) -> Path:
    return write_mesh(folder / "plate.msh", plate, 5.0, 1, PLATE_FACES)


def changed(folder: Path, change: Callable[[meshio.Mesh], meshio.Mesh]) -> Path:
    """The plate's tetrahedra as .vtu, changed."""
    mesh = meshio.read(plate_mesh(folder))
    own = meshio.Mesh(mesh.points, [("tetra", mesh.cells_dict["tetra"])])
    meshio.vtu.write(folder / "plate.vtu", change(own))
    return folder / "plate.vtu"


def inverted(mesh: meshio.Mesh) -> meshio.Mesh:
    mesh.cells[0].data[7] = mesh.cells[0].data[7][[1, 0, 2, 3]]
    return mesh


def two_parts(mesh: meshio.Mesh) -> meshio.Mesh:
    cells = mesh.cells[0].data
    points = np.vstack([mesh.points, mesh.points + np.array([0.0, 0.0, 10.0])])
    return meshio.Mesh(points, [("tetra", np.vstack([cells, cells + len(mesh.points)]))])


def surface_only(folder: Path) -> Path:
    mesh = meshio.read(plate_mesh(folder))
    meshio.vtu.write(
        folder / "skin.vtu", meshio.Mesh(mesh.points, [("triangle", mesh.cells_dict["triangle"])])
    )
    return folder / "skin.vtu"


def written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def huge(folder: Path) -> Path:
    with (folder / "huge.msh").open("wb") as stream:
        stream.truncate(2_500_000_000)
    return folder / "huge.msh"


def two_solids() -> None:
    for x in (0, 30):
        gmsh.model.occ.addBox(x, 0, 0, 10, 10, 10)


def ball() -> None:
    gmsh.model.occ.addSphere(0, 0, 0, 5)


def sharp_cone() -> None:
    gmsh.model.occ.addCone(0, 0, 0, 0, 0, 30, 8, 0)


def shell() -> None:
    gmsh.model.occ.addDisk(0, 0, 0, 10, 10)


def named_plate(folder: Path) -> Path:
    return name_faces(write_cad(folder / "p.step", plate), ["rim", "top", "bottom"])


CENTRE = {"outer": [0.0, 0.0, 0.002]}
CAD = {"unit": None}
CASES: dict[str, tuple[Callable[[Path], Path], dict[str, Any], str]] = {
    "no volume elements": (surface_only, {}, "no volume elements .* triangle"),
    "inverted element": (
        lambda f: changed(f, inverted), CENTRE, r"1 inverted or flat .* number 7 at \(-?0\.0",
    ),
    "two parts": (lambda f: changed(f, two_parts), CENTRE, "2 parts that share no faces"),
    "millimetres": (plate_mesh, {"unit": None}, r"66 x 66 x 2 m \(millimetres .* set body.unit"),
    "a unit of metres nobody stated": (
        lambda f: write_mesh(f / "p.msh", lambda: plate(0.75, 0.2), 0.3, 1),
        {"unit": None, "outer": [0.0, 0.0, 0.2]},
        r"1\.5 x 1\.5 x 0\.2 m \(millimetres .* between 2e-05 and 1 m: set body.unit",
    ),
    "too small": (plate_mesh, {"unit": 1e-9}, "largest side must lie between 2e-05 and 2 m"),
    "missing name": (
        plate_mesh, {"outer": "tpo"}, "outer.at is 'tpo', .* does not have; it has 'top'",
    ),
    "missing set": (plate_mesh, {"fixed": ["rimm"]}, r"fixed\[0\] is 'rimm', .* it has 'rim'"),
    "point inside": (
        lambda f: write_mesh(f / "ball.msh", ball, 2.0, 1),
        {"outer": [0.0, 0.0, 0.002]},
        r"outer.at \(0, 0, 0.002\) m is 0.00\d+ m away .* at most half an element",
    ),
    "point outside": (plate_mesh, {"outer": [0, 0, 0.01]}, "0.008 m away .* at most half an elem"),
    "fixed outside": (plate_mesh, {"fixed": [[0.1, 0.0, 0.0]]}, r"body.fixed\[0\] \(0.1, 0, 0\)"),
    "missing file": (lambda f: f / "none.step", {}, "is no file; check the path"),
    "empty file": (lambda f: written(f, "a.step", ""), {}, "is empty"),
    "huge file": (huge, {}, r"has 2.50 GB; at most 2 GB are read"),
    "unknown extension": (lambda f: written(f, "a.sldprt", "x"), {}, "'.sldprt'; known are .step"),
    "damaged STEP": (lambda f: written(f, "a.step", "hello"), CAD, "cannot be read as .step"),
    "damaged msh": (lambda f: written(f, "a.msh", "hello"), {}, "cannot be read as .msh"),
    "damaged vtu": (lambda f: written(f, "a.vtu", "hello"), {}, "read as .vtu: it is damaged"),
    "no deck": (lambda f: written(f, "a.inp", "hello"), {}, r"no \*NODE"),
    "two solids": (lambda f: write_cad(f / "a.step", two_solids), CAD, "has 2 solids; one is need"),
    "no solid": (lambda f: write_cad(f / "a.step", shell), CAD, "has no solids; one is needed"),
    "sharp tip": (
        lambda f: write_cad(f / "a.step", sharp_cone), CAD | {"outer": [0.0, 0.0, 0.0]},
        "half angle is 14.9 degrees; tips from 25 degrees",
    ),
    "missing face": (named_plate, CAD | {"outer": "topp"}, "it has 'top', 'bottom', 'rim'"),
    "above CAD": (
        named_plate, CAD | {"outer": [0.0, 0.0, 0.003]}, "is 0.001 m away .* half an element",
    ),
    "on an edge": (plate_mesh, {"outer": [0.032, 0.0, 0.002]}, "away from the edge of its face"),
    "zero unit": (plate_mesh, {"unit": 0.0}, "body.unit is 0 m; it must be above 0"),
    "no place": (plate_mesh, {"outer": [1.0, 2.0]}, r"outer.at must be a name or a point \[x, y"),
    "materials": (plate_mesh, {"materials": ["a"]}, "body.materials must be an object"),
}  # fmt: skip


@pytest.mark.parametrize("case", list(CASES))
def test_one_sentence_and_nothing_else(tmp_path: Path, case: str) -> None:
    build, changes, message = CASES[case]
    source = tmp_path / "source"
    source.mkdir()
    given = {"outer": "top", "unit": 1e-3} | changes
    scene = document(build(source), given.pop("outer"), **given)
    out = tmp_path / "out"
    out.mkdir()
    with pytest.raises(SceneError, match=message) as caught:
        write_body_mesh(out / "body.vtu", parse_body_scene(scene), 1.0)
    assert "\n" not in str(caught.value) and not list(out.iterdir())


def test_the_program_ends_with_status_3(tmp_path: Path) -> None:
    done = run_mesh(tmp_path, document(tmp_path / "none.step", "top"))
    assert done.returncode == 3 and done.stderr.startswith("error: body.file")
    unknown = document(tmp_path / "none.step", "top", colour="red")
    assert "body.colour is not a known field" in run_mesh(tmp_path, unknown).stderr
    assert [path.name for path in tmp_path.iterdir()] == ["scene.json"]


def test_a_file_of_the_users_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "body.json").write_text("{}", encoding="utf-8")
    done = run_mesh(tmp_path, document(tmp_path / "none.step", "top"))
    assert done.returncode == 12 and "exists and is no mesh" in done.stderr


def test_elements_too_large_for_a_mesh_are_a_failure(tmp_path: Path) -> None:
    path = write_mesh(tmp_path / "ball.msh", ball, 2.0, 1)
    scene = parse_body_scene(document(path, [0.0, 0.0, 0.005], unit=1e-3))
    with pytest.raises(RunError) as caught:
        write_body_mesh(tmp_path / "body.vtu", scene, 10.0)
    assert isinstance(caught.value, SolverError) and caught.value.exit_status == 12
    assert not (tmp_path / "body.vtu").exists() and not (tmp_path / "body.json").exists()
    with pytest.raises(SceneError, match="--size-factor is 20; it must lie between"):
        write_body_mesh(tmp_path / "body.vtu", scene, 20.0)


def test_an_old_gmsh_is_refused_by_its_version(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gmsh, "__version__", "4.8.4")
    with pytest.raises(SolverError, match=r"gmsh is 4\.8\.4; .* 4\.12"):
        require_gmsh()
