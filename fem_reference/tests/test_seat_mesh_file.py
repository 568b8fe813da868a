"""The file of a seal seat's mesh: what others read in it, and what it does not replace."""

from __future__ import annotations

import json
from argparse import Namespace
from pathlib import Path

import meshio
import numpy as np
import pytest

from fem_reference.common.errors import SceneError, SolverError
from fem_reference.seal_seat.command import COMMANDS
from fem_reference.tests.program import run_program
from fem_reference.tests.seal_seat_scenes import seat_document


def test_the_mesh_file_is_what_others_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(seat_document(True)), encoding="utf-8")
    out = tmp_path / "seat.vtu"
    done = run_program("mesh", "--scene", path, "--out", out, "--size-factor", "3")
    assert done.returncode == 0, done.stderr
    described = json.loads(out.with_suffix(".json").read_text(encoding="utf-8"))
    assert described["geometry_hash"] == "geometry" and described["element_order"] == 2
    grid = meshio.read(out)
    cells = grid.cells_dict["tetra10"]
    assert cells.shape[0] == described["elements"]
    # VTK's order of a quadratic tetrahedron's midside nodes.
    for node, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), start=4):
        middle = 0.5 * (grid.points[cells[:, a]] + grid.points[cells[:, b]])
        assert np.allclose(grid.points[cells[:, node]], middle, atol=1e-12)
    assert not list(tmp_path.glob("*partial*"))
    # it says which geometry it is one of, and whoever has another one is told
    modes = Namespace(count=1, mesh=out)
    COMMANDS["modes"](seat_document(True), modes)
    assert json.loads(capsys.readouterr().out)["modes"][0]["frequency"] > 0.0
    with pytest.raises(SolverError, match="made for another geometry"):
        COMMANDS["modes"](seat_document(True) | {"geometry_hash": "other"}, modes)
    mesh = Namespace(out=out, resolution="paper", size_factor=0.01)
    with pytest.raises(SceneError, match=r"--size-factor is 0\.01"):
        COMMANDS["mesh"](seat_document(True), mesh)


@pytest.mark.parametrize("name", ["seat.json", "seat.vtu"])
def test_a_mesh_replaces_no_file_of_the_users(tmp_path: Path, name: str) -> None:
    scene, text = tmp_path / "seat.json", json.dumps(seat_document(True))
    if name != scene.name:
        scene = tmp_path / "scene.json"
    scene.write_text(text, encoding="utf-8")
    (tmp_path / name).write_text(text, encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    mesh = Namespace(out=tmp_path / "seat.vtu", resolution="paper", size_factor=1.0)
    with pytest.raises(SolverError, match=f"{name} exists and is no mesh"):
        COMMANDS["mesh"](seat_document(True), mesh)
    assert (tmp_path / name).read_text(encoding="utf-8") == text
    assert sorted(tmp_path.iterdir()) == before
