"""The solid path as a program: folder, fields, refusals, killed and resumed, several processes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

from fem_reference.common.processes import INHERITED, launcher
from fem_reference.tests.conftest import document

ROOT = Path(__file__).resolve().parents[2]
END = 2e-6


def scene(folder: Path, **changes: Any) -> Path:
    """A small plate, small spheres, linear elements, a short run."""
    values: dict[str, Any] = {
        "plate__radius": 0.012,
        "outer__radius": 0.005,
        "inner__radius": 0.005,
        "outer__speed": 2.0,
        "run": {"end_time": END},
        "reference": {
            "geometry": "solid",
            "elements_per_contact_radius": 2,
            "element_order": 1,
        },
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(document(**{**values, **changes})), encoding="utf-8")
    return path


def command(path: Path, out: Path, *extra: str) -> list[str]:
    base = [sys.executable, "-m", "fem_reference", "solve", "--resolution", "coarse"]
    return [*base, "--scene", str(path), "--out", str(out), *extra]


def solve(path: Path, out: Path, *extra: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(path, out, *extra), cwd=ROOT, capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("solid")


@pytest.fixture(scope="module")
def whole(folder: Path) -> Path:
    """The result of an uninterrupted run of one process."""
    out = folder / "whole"
    done = solve(scene(folder), out, "--fields", "2")
    assert done.returncode == 0, done.stderr
    return out


def summary(out: Path) -> dict[str, Any]:
    return dict(json.loads((out / "summary.json").read_text(encoding="utf-8")))


def at_end(out: Path) -> dict[str, float]:
    """What the run, cut during the contact, had come to."""
    return {name: entry["value"] for name, entry in summary(out)["at_end"].items()}


PHYSICAL = (
    "efficiency",
    "outer_velocity_final",
    "inner_velocity_final",
    "outer_force_peak",
    "inner_force_peak",
    "outer_contact_end",
    "first_frequency",
)


def test_balances_close_and_the_folder_is_complete(whole: Path) -> None:
    found = summary(whole)
    assert found["energy_residual"] < 1e-11
    assert found["momentum_residual"] < 1e-11
    assert found["mesh"]["min_quality"] > 0.05
    assert found["solver"]["contact_unconverged_steps"] == 0
    assert set(found["at_end"]) >= set(PHYSICAL)
    assert all((found[name] is None) == (name != "first_frequency") for name in PHYSICAL)
    assert "efficiency" not in found["uncertainty"] and found["outer_contacts"] is None
    assert found["solver"]["peak_memory"] < found["solver"]["memory_stated"]
    reached = at_end(whole)
    assert reached["outer_velocity_final"] < 0.0 < reached["outer_force_peak"]
    history = np.loadtxt(whole / "history.csv", delimiter=",", skiprows=1)
    force, interval = history[:, 3], history[1, 0] - history[0, 0]
    impulse = (force.sum() - 0.5 * (force[0] + force[-1])) * interval
    mass = 7780.0 * 4.0 / 3.0 * np.pi * 0.005**3
    assert mass * (history[-1, 2] - history[0, 2]) == pytest.approx(impulse, rel=1e-2)
    assert not list(whole.parent.glob(".checkpoint*"))


def test_fields_are_a_series_that_meshio_reads(whole: Path) -> None:
    entries = ElementTree.parse(whole / "stress.pvd").getroot().findall(".//DataSet")
    times = [float(entry.attrib["timestep"]) for entry in entries]
    assert 2 <= len(times) <= 5
    assert times == sorted(times)
    assert times[-1] > 0.5 * END
    fields = meshio.read(whole / entries[-1].attrib["file"])
    body = fields.cell_data["body"][0]
    assert set(np.unique(body)) == {0, 1, 2}
    history = np.loadtxt(whole / "history.csv", delimiter=",", skiprows=1)
    at = np.interp(times[-1], history[:, 0], history[:, 1])
    # Body 1 is the outer sphere; nodes far from the contact move with it.
    top = fields.cells[0].data[body == 1].ravel()
    top = top[fields.points[top, 2] > 0.005]
    assert fields.point_data["displacement"][top, 2].mean() == pytest.approx(at, rel=0.02)
    zz, mises = fields.cell_data["stress_zz"][0], fields.cell_data["von_mises"][0]
    # Below the contact the plate is compressed, far more than anywhere else.
    hardest = int(np.argmax(mises))
    assert zz[hardest] < 0.0
    place = fields.points[fields.cells[0].data[hardest]].mean(axis=0)
    assert np.hypot(place[0], place[1]) < 1e-3


def test_a_killed_run_goes_on_to_the_same_result(folder: Path, whole: Path) -> None:
    out, states_folder = folder / "resumed", folder / "kept"
    provenance = json.loads((whole / "provenance.json").read_text(encoding="utf-8"))
    tried = provenance["settings"]["meshes_tried"]
    start = command(
        scene(folder), out, "--checkpoint", str(states_folder), "--checkpoint-interval", "0"
    )
    with subprocess.Popen(
        start, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        deadline = time.monotonic() + 600.0
        # The last mesh is the one whose run gives the result.
        while not (states_folder / f"mesh+0-{tried}.npz").exists() and time.monotonic() < deadline:
            assert process.poll() is None, "ended before its first checkpoint"
            time.sleep(0.005)
        os.kill(process.pid, signal.SIGKILL)
    assert not out.exists()
    states = sorted(file.name for file in states_folder.glob("*.npz"))
    assert f"mesh+0-{tried}.npz" in states
    with np.load(states_folder / f"mesh+0-{tried}.npz") as state:
        # In the middle of the impact.
        assert state["rows"][-1, 2] > 0.0
        assert state["rows"].shape[0] > 10
    again = solve(scene(folder), out, "--checkpoint", str(states_folder))
    assert again.returncode == 0, again.stderr
    # The coarser meshes are not run again, and the main one not from its start.
    assert "mesh 5 of 5" in again.stdout
    assert "mesh 4 of 5" not in again.stdout
    a, b = ({**summary(folder), **at_end(folder)} for folder in (whole, out))
    for name in (*PHYSICAL, "momentum_residual", "steps"):
        assert b[name] == pytest.approx(a[name], rel=1e-12, abs=1e-25), name
    assert (out / "history.csv").read_bytes() == (whole / "history.csv").read_bytes()
    assert not states_folder.exists()


def test_a_checkpoint_of_another_scene_is_not_used(folder: Path) -> None:
    from fem_reference.explicit.checkpoint import Checkpoint

    path = folder / "state.npz"
    path.write_bytes(b"not a state")
    assert Checkpoint(path, "a").load() is None
    scalars = np.array(json.dumps({"identity": "a", "problem": {}}))
    np.savez(path, scalars=scalars, u=np.zeros(3))
    assert Checkpoint(path, "b").load() is None
    loaded = Checkpoint(path, "a").load()
    assert loaded is not None
    assert loaded["problem"] == {}


@pytest.fixture(scope="module")
def one_process(folder: Path) -> dict[str, Any]:
    return steps(folder, 1, 1)


def steps(folder: Path, processes: int, threads: int) -> dict[str, Any]:
    """The state after some steps in contact."""
    out = folder / f"steps-{processes}-{threads}.npz"
    several = [str(launcher()), "-n", str(processes)] if processes > 1 else []
    module = [sys.executable, "-m", "fem_reference.tests.parallel_steps", str(scene(folder))]
    clean = {k: v for k, v in os.environ.items() if not k.startswith(INHERITED)}
    settings = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    settings |= {"OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    # Few steps: where processors are scarce, every exchange waits for the other process' turn.
    start = [*several, *module, "160", str(threads), str(out)]
    subprocess.run(start, cwd=ROOT, env={**clean, **settings}, check=True, capture_output=True)
    with np.load(out) as values:
        return dict(values)


@pytest.mark.parametrize(
    ("processes", "threads"), [pytest.param(3, 1, marks=pytest.mark.evidence), (2, 2)]
)
def test_several_processes_step_as_one(
    folder: Path, one_process: dict[str, Any], processes: int, threads: int
) -> None:
    several = steps(folder, processes, threads)
    assert (several["processes"], several["threads"]) == (processes, threads)
    assert one_process["force"][0][2] > 0.0
    assert one_process["levels"].size > 2
    for name, values in one_process.items():
        if name not in ("processes", "threads"):
            assert np.abs(several[name] - values).max() <= 1e-12 * np.abs(values).max(), name


def test_several_processes_fail_together_with_the_right_status(folder: Path) -> None:
    out = folder / "unstable-2"
    done = solve(scene(folder), out, "--np", "2", "--courant", "1.01")
    assert done.returncode == 12
    assert "critical time step" in done.stdout
    assert not out.exists()


@pytest.mark.evidence
def test_rigid_spheres_are_harder(folder: Path, whole: Path) -> None:
    out = folder / "rigid"
    reference = {"geometry": "solid", "elements_per_contact_radius": 2, "element_order": 1}
    done = solve(scene(folder, reference={**reference, "rigid": "both"}), out)
    assert done.returncode == 0, done.stderr
    rigid, elastic = summary(out), summary(whole)
    assert rigid["mesh"]["nodes"] < elastic["mesh"]["nodes"]
    assert rigid["momentum_residual"] < 1e-11
    assert rigid["energy_residual"] < 1e-11
    # As long as the plate hardly moves, E* twice as large makes Hertz's force rise to twice.
    ratio = at_end(out)["outer_force_peak"] / at_end(whole)["outer_force_peak"]
    assert 1.2 < ratio < 2.1
