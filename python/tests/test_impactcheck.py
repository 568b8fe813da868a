"""The package as a user of a notebook meets it."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import impactcheck as ic
import numpy as np
import pytest

STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "density": 7780.0}
SPHERE = {"kind": "sphere", "radius": "10 mm", "material": "steel"}
TABLE_1 = {
    "name": "scaled-plate-r10",
    "kind": "plate-impact",
    "materials": {"steel": STEEL},
    "plate": {"radius": 0.033, "thickness": "2 mm", "edge": "clamped", "material": "steel"},
    "outer": {**SPHERE, "speed": "550 mm/s"},
    "inner": SPHERE,
}


# what runs beside: a program that was built apart, else the package's own command
PROGRAM = [os.environ["IMPACTCHECK_PROGRAM"]] if "IMPACTCHECK_PROGRAM" in os.environ else []
PROGRAM = PROGRAM or [sys.executable, "-m", "impactcheck"]


def test_a_result_is_the_programs_bit_by_bit(tmp_path: Path) -> None:
    file = tmp_path / "history.csv"
    for name, model in [("scaled-plate-r10", "B"), ("scaled-plate-r6.35", "C")]:
        command = [*PROGRAM, "reduced", name, f"--model={model}", "--json", f"--history={file}"]
        printed = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
        result = ic.reduced(ic.Scene.read(name), model=model)
        printed.pop("solve_seconds")
        assert printed == {k: v for k, v in result.summary.items() if k != "solve_seconds"}
        heading, *rows = file.read_text().splitlines()
        table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
        assert heading.split(",") == list(result.curves)
        assert np.array_equal(table.T, np.array(list(result.curves.values())))


def test_curves_are_not_copied_and_outlive_their_result() -> None:
    curves = ic.reduced(ic.Scene(TABLE_1), model="B").curves
    force = curves.pop("outer_force")
    del curves
    assert type(force.base).__name__ == "Samples" and force.flags.writeable
    assert force.max() == pytest.approx(433.7, rel=1e-3)


def test_curves_are_arrays_and_belong_to_the_summary() -> None:
    result = ic.reduced(ic.Scene(TABLE_1), model="C")
    assert result.efficiency == result.summary["efficiency"]
    assert abs(result.efficiency - 0.6947) < 0.001
    time, force = result.curves["time"], result.curves["outer_force"]
    assert time.shape == force.shape and time.dtype == np.float64 and np.all(np.diff(time) > 0)
    assert force.max() == pytest.approx(result.outer_force_peak, rel=2e-3)
    with pytest.raises(AttributeError, match="efficency"):
        _ = result.efficency
    shown = result._repr_html_()
    assert "0.694" in shown and "<svg" in shown and "outer" in shown


def test_a_dictionary_is_the_scene_of_the_file() -> None:
    scenes = (ic.Scene(TABLE_1), ic.Scene.read("scaled-plate-r10"))
    assert scenes[0].hash == scenes[1].hash == ic.reduced(scenes[0], "A").scene_hash
    # what NumPy counts and measures with is a number too
    numbers = {"radius": np.float32(0.033), "thickness": np.float64(0.002)}
    assert ic.Scene({**TABLE_1, "plate": {**TABLE_1["plate"], **numbers}}).name == scenes[0].name
    settings = {**TABLE_1, "reduced": {"modes": np.int64(3), "model": "B"}}
    assert ic.reduced(ic.Scene(settings)).modes == 3


def test_models_beside_the_reference() -> None:
    comparison = ic.compare(ic.Scene.read("scaled-plate-r10"))
    assert comparison.verdict == "pass"
    rows = {row["quantity"]: row for row in comparison.discrepancies("B")}
    assert rows["efficiency"]["relative"] == pytest.approx(0.0019, abs=2e-4)
    shown = comparison._repr_html_()
    assert "<svg" in shown and "outer_force_peak" in shown


def test_the_reference_has_bands() -> None:
    reference = ic.reference(ic.Scene.read("scaled-plate-r10"))
    assert reference.source == "reference" and 0 < reference.uncertainty["efficiency"] < 1e-3
    assert reference.curves["outer_force"].max() == pytest.approx(
        reference.outer_force_peak, rel=0.01
    )


@pytest.mark.skipif("IMPACTCHECK_LIVE" not in os.environ, reason="needs FEniCSx, and some seconds")
def test_a_reference_is_computed_where_the_package_is_installed(tmp_path: Path) -> None:
    script = """
import impactcheck as ic
from test_impactcheck import SPHERE, TABLE_1
small = {**SPHERE, "radius": "5 mm"}
plate = {**TABLE_1["plate"], "radius": "20 mm"}
outer = {**small, "speed": "400 mm/s"}
scene = ic.Scene({**TABLE_1, "name": "mine", "plate": plate, "outer": outer, "inner": small})
reference = ic.reference(scene, "coarse", compute=True)
found = ic.compare(scene, models=["C"], resolution="coarse").model("C")
print(abs(found.efficiency - reference.efficiency), reference.uncertainty["efficiency"])
"""
    paths = {"XDG_DATA_HOME": str(tmp_path / "data"), "PYTHONPATH": str(Path(__file__).parent)}
    command = [sys.executable, "-c", script]
    ended = subprocess.run(
        command, cwd=tmp_path, env={**os.environ, **paths}, capture_output=True, text=True
    )
    assert ended.returncode == 0, ended.stderr
    difference, band = map(float, ended.stdout.split())
    assert difference < 2 * band < 0.01
    assert (tmp_path / "data/impactcheck/solutions/mine/coarse/summary.json").is_file()


def test_a_program_that_fails_stops_nothing(tmp_path: Path) -> None:
    programs = [{"name": "gone", "command": ["no-such-program"]}]
    scene = ic.Scene({**TABLE_1, "external": programs})
    with pytest.raises(ic.Error, match="allow-external") as caught:
        ic.compare(scene)
    assert caught.value.exit_status == 2
    comparison = ic.compare(scene, allow_external=True, out=tmp_path / "report")
    assert comparison.verdict == "fail" and "failure" not in comparison.model("C").summary
    assert "no-such-program" in comparison.model("gone").failure
    assert "no-such-program" in comparison._repr_html_()
    assert (tmp_path / "report" / "index.html").is_file()


def test_errors_have_the_programs_sentence_and_status() -> None:
    broken = {**TABLE_1, "plate": {**TABLE_1["plate"], "thickness": "-2 mm"}}
    with pytest.raises(ic.Error, match=r"plate\.thickness") as caught:
        ic.Scene(broken)
    assert caught.value.exit_status == 3 and "\x1b" not in str(caught.value)
    for content, word in [
        ({"plate": {"radius": float("nan")}}, "nan"),
        ({"plate": {"radius": None}}, r"plate\.radius.*NoneType"),
        ({}, "no content"),
    ]:
        with pytest.raises(ic.Error, match=word) as caught:
            ic.Scene(content)
        assert caught.value.exit_status == 3
    for arguments, word in [
        ({"model": "D"}, "`D` is not a model"),
        ({"model": "B", "modes": 0}, "at least one mode"),
        ({"tolerance": float("nan")}, "within 1e-12"),
        ({"tolerance": 0.1}, "time integration"),
    ]:
        with pytest.raises(ic.Error, match=word) as caught:
            ic.reduced(ic.Scene(TABLE_1), **arguments)
        assert caught.value.exit_status == 2
    with pytest.raises(ic.Error, match="missing") as caught:
        ic.compare(ic.Scene({**TABLE_1, "outer": {**SPHERE, "speed": "551 mm/s"}, "name": "other"}))
    assert caught.value.exit_status == 11


def test_a_sweep_keeps_the_order_and_tells_its_first_error() -> None:
    radii = ("6 mm", "8 mm", "10 mm", "12 mm")
    scenes = [ic.Scene({**TABLE_1, "inner": {**SPHERE, "radius": r}}) for r in radii]
    together = [result.efficiency for result in ic.sweep(scenes, model="B")]
    assert together == [ic.reduced(scene, model="B").efficiency for scene in scenes]
    assert [r.efficiency for r in ic.sweep(scenes, model="B", threads=1)] == together
    too_thin = ic.Scene({**TABLE_1, "plate": {**TABLE_1["plate"], "thickness": "10 um"}})
    with pytest.raises(ic.Error, match="too thin") as caught:
        ic.sweep([*scenes, too_thin], model="C")
    assert caught.value.exit_status == 12


def test_other_threads_go_on_meanwhile() -> None:
    scene, moments, done = ic.Scene(TABLE_1), [], threading.Event()

    def watch() -> None:
        while not done.wait(1e-3):
            moments.append(time.monotonic())

    watcher = threading.Thread(target=watch)
    watcher.start()
    start = time.monotonic()
    ic.sweep([scene] * 1000, model="C", threads=1)
    end = time.monotonic()
    done.set()
    watcher.join()
    assert [t for t in moments if abs(t - (start + end) / 2) < (end - start) / 4]


def test_an_interruption_ends_a_sweep() -> None:
    script = """
import impactcheck as ic
scenes = [ic.Scene.read("scaled-plate-r10")] * 20000
print("begins", flush=True)
try:
    ic.sweep(scenes, model="C")
except KeyboardInterrupt:
    print("interrupted")
print(ic.reduced(scenes[0], model="B").efficiency)
"""
    running = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert running.stdout is not None and running.stdout.readline() == "begins\n"
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    said, _ = running.communicate(timeout=60)
    assert running.returncode == 0 and said.startswith("interrupted\n0.69")


def test_curves_over_time_as_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    data = ic.reduced(ic.Scene(TABLE_1), model="B").to_xarray()
    assert isinstance(data, xarray.Dataset) and data.attrs["model"] == "B"
    last, final = data["inner_velocity"][-1], data.attrs["inner_velocity_final"]
    assert float(last) == pytest.approx(final, rel=1e-3)


def test_the_program_comes_along(tmp_path: Path) -> None:
    for command in (
        [sys.executable, "-m", "impactcheck"],
        [str(Path(sys.executable).with_name("impactcheck"))],
    ):
        ended = subprocess.run([*command, "--version"], capture_output=True)
        assert ended.returncode == 0 and ended.stdout.startswith(b"impactcheck ")
        refused = subprocess.run([*command, "reduced", "none"], capture_output=True, text=True)
        assert refused.returncode == 2 and "no scene `none`" in refused.stderr


def test_the_package_brings_its_files_along(tmp_path: Path) -> None:
    script = """
import impactcheck as ic
print(ic.compare(ic.Scene.read("scaled-plate-r6.35"), models=["C"]).verdict)
from impactcheck.fem_reference.common import settings
print(settings.__name__, settings.__file__)
"""
    home = {**os.environ, "XDG_DATA_HOME": str(tmp_path / "data"), "HOME": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, env=home, capture_output=True, text=True
    )
    verdict, module = ended.stdout.splitlines()
    assert verdict == "pass" and str(tmp_path / "data" / "impactcheck") in module
