"""The process: folder complete or absent, JSON lines, exit status."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from fem_reference.common.errors import SolverError
from fem_reference.common.output import PARTIAL_PREFIX, require_replaceable, result_folder
from fem_reference.plate_impact.result import CURVES

from .conftest import document

ROOT = Path(__file__).parents[2]


def environment(**changes: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), **changes}


def call(*arguments: object, **changes: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "fem_reference", *(str(x) for x in arguments)],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment(**changes),
        check=False,
    )


def scene_file(folder: Path, **changes: Any) -> Path:
    path = folder / "scene.json"
    small = {"reference__elements_per_contact_radius": 3}
    path.write_text(json.dumps(document(**{**small, **changes})))
    return path


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    folder = tmp_path_factory.mktemp("solved")
    result = call(
        "solve",
        "--scene",
        scene_file(folder),
        "--out",
        folder / "out",
        "--resolution",
        "paper",
        "--stress-at",
        "2e-5,4e-5,9",
    )
    assert result.returncode == 0, result.stderr
    return folder / "out", result.stdout, result.stderr


def test_output_is_progress_lines_only(solved: tuple[Path, str, str]) -> None:
    lines = [json.loads(line) for line in solved[1].splitlines()]
    assert {line["phase"] for line in lines} == {"mesh", "assembly", "stepping", "writing"}
    assert all(set(line) == {"phase", "done", "message", "series"} for line in lines)
    shares = [line["series"] for line in lines]
    assert shares[0] == 0.0 and shares[-1] == 1.0 and shares == sorted(shares)
    named = [line["message"].split(": ")[0] for line in lines if line["phase"] == "mesh"]
    assert named == [f"mesh {k} of 5" for k in range(1, 6)]
    assert all(0.0 <= line["done"] <= 1.0 for line in lines)
    assert lines[-1]["done"] == 1.0
    assert "FFCx" not in solved[2]


def test_folder_is_complete_and_checksums_hold(solved: tuple[Path, str, str]) -> None:
    folder = solved[0]
    expected = {
        "summary.json",
        "history.csv",
        "mesh.vtu",
        "stress_000.vtu",
        "stress_001.vtu",
        "paraview_state.py",
        "stress.pvd",
        "provenance.json",
        "checksums.sha256",
    }
    assert {path.name for path in folder.iterdir()} == expected
    assert not list(folder.parent.glob(f"{PARTIAL_PREFIX}*"))
    check = ["sha256sum", "-c", "--strict", "checksums.sha256"]
    result = subprocess.run(check, cwd=folder, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout
    assert len(result.stdout.splitlines()) == len(expected) - 1


def test_an_instant_behind_the_end_is_named(solved: tuple[Path, str, str]) -> None:
    summary = json.loads((solved[0] / "summary.json").read_text())
    (warning,) = summary["warnings"]
    assert warning.startswith("there are no fields at 9 s: the run ended at 0.000")
    assert len(summary["stress_times"]) == 2


def test_memory_that_is_not_there_is_named_before_the_run(tmp_path: Path) -> None:
    scene = scene_file(tmp_path, plate__thickness=0.3)
    arguments = ("solve", "--scene", scene, "--out", tmp_path / "out", "--threads", "1")
    limit = (
        f"ulimit -v 650000; exec {sys.executable} -m fem_reference {' '.join(map(str, arguments))}"
    )
    done = subprocess.run(
        ["sh", "-c", limit],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment(),
        check=False,
    )
    assert done.returncode == 12, done.stderr
    assert "GB more memory" in done.stderr and "Traceback" not in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["scene.json"]


def test_damage_is_detected(solved: tuple[Path, str, str], tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(solved[0], copy)
    text = (copy / "history.csv").read_bytes()
    (copy / "history.csv").write_bytes(text.replace(b"7", b"8", 1))
    check = ["sha256sum", "-c", "checksums.sha256"]
    assert subprocess.run(check, cwd=copy, capture_output=True, check=False).returncode != 0


def test_summary_has_the_fixed_fields(solved: tuple[Path, str, str]) -> None:
    summary = json.loads((solved[0] / "summary.json").read_text())
    quantities = {
        "efficiency",
        "outer_velocity_final",
        "inner_velocity_final",
        "outer_force_peak",
        "inner_force_peak",
        "outer_contact_end",
        "inner_contact_end",
        "first_frequency",
    }
    fixed = quantities | {
        "schema_version",
        "scene",
        "scene_hash",
        "source",
        "model",
        "modes",
        "outer_contacts",
        "inner_contacts",
        "energy_residual",
        "momentum_residual",
        "steps",
        "solve_seconds",
        "uncertainty",
        "mesh",
        "solver",
        "residuals",
        "samples",
        "sample_interval",
    }
    assert fixed <= set(summary)
    assert summary["source"] == "reference"
    assert summary["model"] is None
    curves = {f"{curve.name}_{kind}" for curve in CURVES for kind in ("rms", "max")}
    assert set(summary["uncertainty"]) == quantities | curves
    assert all(value >= 0.0 for value in summary["uncertainty"].values())
    assert summary["solver"]["time_step"] == pytest.approx(
        0.9 * summary["solver"]["critical_time_step"]
    )
    assert summary["mesh"]["elements_per_wavelength"] >= 20.0
    assert summary["efficiency"] == pytest.approx(
        (summary["inner_velocity_final"] / 0.55) ** 2, rel=1e-9
    )


def test_history_agrees_with_the_summary(solved: tuple[Path, str, str]) -> None:
    summary = json.loads((solved[0] / "summary.json").read_text())
    with (solved[0] / "history.csv").open(newline="") as stream:
        rows = list(csv.reader(stream))
    assert rows[0][:9] == [
        "time",
        "outer_displacement",
        "outer_velocity",
        "outer_force",
        "plate_displacement",
        "plate_velocity",
        "inner_displacement",
        "inner_velocity",
        "inner_force",
    ]
    assert rows[0][9:] == [f"{name}_band" for name in rows[0][1:9]]
    table = np.array(rows[1:], dtype=float)
    assert np.all(table[:, 9:] >= 0.0)
    assert table.shape == (summary["samples"], 17)
    assert 1200 <= table.shape[0] <= 3000
    interval = summary["sample_interval"]
    assert np.allclose(np.diff(table[:, 0]), interval, rtol=1e-6)
    assert table[0, 0] == 0.0
    assert table[0, 2] == pytest.approx(-0.55, rel=1e-6)
    for velocity, force, sign, name in ((2, 3, 1.0, "outer"), (7, 8, -1.0, "inner")):
        assert table[-1, velocity] == pytest.approx(summary[f"{name}_velocity_final"], rel=1e-6)
        # Impulse equals change of momentum; the first sample stands for half an interval.
        impulse = (table[1:, force].sum() + 0.5 * table[0, force]) * interval
        mass = 7780.0 * 4.0 / 3.0 * np.pi * 0.01**3
        change = sign * mass * (table[-1, velocity] - table[0, velocity])
        assert impulse == pytest.approx(change, rel=1e-3)
        peak = summary[f"{name}_force_peak"]
        assert table[:, force].max() == pytest.approx(peak, rel=0.01)
        assert table[table[:, 0] > summary[f"{name}_contact_end"] + interval, force].max() == 0.0


def test_mesh_and_stress_can_be_read(solved: tuple[Path, str, str]) -> None:
    summary = json.loads((solved[0] / "summary.json").read_text())
    mesh = meshio.read(solved[0] / "mesh.vtu")
    assert mesh.points.shape[0] == summary["mesh"]["nodes"]
    body = mesh.cell_data["body"][0]
    assert body.size == summary["mesh"]["elements"]
    assert set(body) == {0, 1, 2}
    stress = meshio.read(solved[0] / "stress_000.vtu")
    axial = stress.cell_data["stress_zz"][0]
    centre = stress.points[stress.cells[0].data].mean(axis=1)
    # The largest pressure lies at the contacts: at the axis, at one of the faces.
    worst = centre[np.argmin(axial)]
    assert worst[0] < 3e-4
    assert abs(abs(worst[1]) - 0.001) < 3e-4
    assert axial.min() < -1e8
    assert np.all(stress.cell_data["von_mises"][0] >= 0.0)


def test_provenance_holds_scene_settings_and_versions(solved: tuple[Path, str, str]) -> None:
    provenance = json.loads((solved[0] / "provenance.json").read_text())
    assert provenance["scene"] == json.loads((solved[0].parent / "scene.json").read_text())
    assert provenance["settings"]["resolution"] == "paper"
    for name in ("dolfinx", "petsc", "gmsh", "numpy", "python", "compiler"):
        assert provenance["versions"][name]


@pytest.mark.parametrize(
    ("changes", "options", "status", "words"),
    [
        ({"outer__kind": "wedge"}, (), 3, "outer.kind"),
        pytest.param(
            {"reference__geometry": "shell"},
            (),
            3,
            "reference.geometry",
            marks=pytest.mark.evidence,
        ),
        ({}, ("--courant", "1.01"), 12, "critical time step"),
        ({}, ("--stress-at", "-1"), 3, "--stress-at"),
    ],
)
def test_failure_has_status_sentence_and_no_folder(
    tmp_path: Path, changes: dict[str, Any], options: tuple[str, ...], status: int, words: str
) -> None:
    out = tmp_path / "out"
    result = call("solve", "--scene", scene_file(tmp_path, **changes), "--out", out, *options)
    assert result.returncode == status, result.stderr
    last = json.loads(result.stdout.splitlines()[-1])
    assert last["phase"] == "error"
    assert words in last["message"]
    assert "Traceback" not in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["scene.json"]


def test_convergence_lists_all_meshes_and_explains_the_bands(
    solved: tuple[Path, str, str],
) -> None:
    summary = json.loads((solved[0] / "summary.json").read_text())
    convergence = summary["convergence"]
    dofs = [mesh["dofs"] for mesh in convergence["meshes"]]
    assert len(dofs) == 5
    assert dofs == sorted(dofs, reverse=True)
    for name, entry in convergence["quantities"].items():
        assert entry["values"][0] == pytest.approx(summary[name], rel=1e-12)
        assert entry["band"] == summary["uncertainty"][name]


@pytest.mark.parametrize(
    "deadly",
    [
        signal.SIGTERM,
        signal.SIGINT,
        signal.SIGKILL,
        pytest.param(signal.SIGHUP, marks=pytest.mark.evidence),
    ],
)
def test_killed_run_leaves_no_result(tmp_path: Path, deadly: signal.Signals) -> None:
    # much longer than the test waits for it
    scene = scene_file(tmp_path, run__end_time=0.1)
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "fem_reference",
            "solve",
            "--scene",
            str(scene),
            "--out",
            str(tmp_path / "out"),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        cwd=ROOT,
        env=environment(),
        # a program started in the background inherits that some are ignored
        preexec_fn=lambda: (
            signal.signal(deadly, signal.SIG_DFL) if deadly != signal.SIGKILL else None
        ),
    )
    assert process.stdout is not None
    try:
        for line in process.stdout:
            if json.loads(line)["phase"] == "stepping":
                break
        assert list(tmp_path.glob(f"{PARTIAL_PREFIX}*"))
        process.send_signal(deadly)
        assert process.wait(timeout=300) == -deadly
    finally:
        process.kill()
        process.stdout.close()
        process.wait()
    left = {path.name for path in tmp_path.iterdir()} - {"scene.json"}
    assert all(name.startswith(PARTIAL_PREFIX) for name in left)
    assert not left or deadly == signal.SIGKILL


def test_failure_while_writing_keeps_the_old_result(tmp_path: Path) -> None:
    target = tmp_path / "out"
    with result_folder(target) as folder:
        (folder / "a").write_text("old")
    with pytest.raises(RuntimeError), result_folder(target) as folder:
        (folder / "a").write_text("new")
        raise RuntimeError
    assert (target / "a").read_text() == "old"
    with result_folder(target) as folder:
        (folder / "a").write_text("new")
    assert (target / "a").read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_solution_of_another_scene_is_not_replaced_unasked(
    solved: tuple[Path, str, str], tmp_path: Path
) -> None:
    target = tmp_path / "out"
    shutil.copytree(solved[0], target)
    before = (target / "checksums.sha256").read_text()
    other = scene_file(tmp_path, scene_hash="1", outer__speed=0.6)
    refused = call("solve", "--scene", other, "--out", target, "--resolution", "coarse")
    assert refused.returncode == 12
    message = json.loads(refused.stdout.splitlines()[-1])["message"]
    assert "another scene" in message and "--replace" in message and str(target) in message
    assert (target / "checksums.sha256").read_text() == before
    # What is no result is not touched, asked or not.
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "a.txt").write_text("dear")
    refused = call("solve", "--scene", other, "--out", tmp_path / "letters", "--replace")
    assert refused.returncode == 12
    assert "is no result folder" in json.loads(refused.stdout.splitlines()[-1])["message"]
    assert (tmp_path / "letters" / "a.txt").read_text() == "dear"


def test_what_may_be_replaced(solved: tuple[Path, str, str], tmp_path: Path) -> None:
    same = json.loads((solved[0] / "provenance.json").read_text())["scene"]
    require_replaceable(solved[0], same, replace=False)
    require_replaceable(tmp_path / "new", same, replace=False)
    require_replaceable(tmp_path, same, replace=False)
    for key in ("scene_hash", "settings_hash"):
        other = {**same, key: "f" * 64}
        with pytest.raises(SolverError, match="other settings"):
            require_replaceable(solved[0], other, replace=False)
        require_replaceable(solved[0], other, replace=True)
    damaged = tmp_path / "damaged"
    damaged.mkdir()
    (damaged / "provenance.json").write_text("{")
    with pytest.raises(SolverError, match="cannot be read"):
        require_replaceable(damaged, same, replace=False)


def test_versions_without_dolfinx(tmp_path: Path) -> None:
    broken = tmp_path / "dolfinx"
    broken.mkdir()
    (broken / "__init__.py").write_text("raise ImportError('not here')")
    path = f"{tmp_path}{os.pathsep}{ROOT}"
    result = call("versions", PYTHONPATH=path)
    assert result.returncode == 0
    found = json.loads(result.stdout)
    assert found["dolfinx"] is None
    assert found["numpy"] == np.__version__
    failed = call(
        "solve", "--scene", scene_file(tmp_path), "--out", tmp_path / "out", PYTHONPATH=path
    )
    assert failed.returncode == 12
    assert "module is missing" in json.loads(failed.stdout.splitlines()[-1])["message"]


def test_versions_of_some_modules_import_no_others(tmp_path: Path) -> None:
    (tmp_path / "dolfinx.py").write_text("raise SystemExit('imported')")
    path = f"{tmp_path}{os.pathsep}{ROOT}"
    result = call("versions", "numpy", "no_such_module", PYTHONPATH=path)
    assert result.returncode == 0
    found = json.loads(result.stdout)
    assert found["numpy"] == np.__version__ and found["no_such_module"] is None
    assert set(found) == {"python", "numpy", "no_such_module"}
    assert call("versions", "dolfinx", PYTHONPATH=path).returncode != 0


def test_missing_compiler_is_named(tmp_path: Path) -> None:
    result = call(
        "solve", "--scene", scene_file(tmp_path), "--out", tmp_path / "out", CC="no-such-compiler"
    )
    assert result.returncode == 12
    assert "no-such-compiler" in json.loads(result.stdout.splitlines()[-1])["message"]
