"""The package as a user of a notebook meets it."""

import copy
import json
import os
import pickle
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
        assert printed["prediction"]["efficiency"]["level"] == 0.95
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


def test_scenes_are_copied_and_pickled(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    shipped = subprocess.run([*PROGRAM, "new", "mine"], cwd=tmp_path, capture_output=True)
    assert shipped.returncode == 0
    # what a scene names lies beside its file, wherever it is copied to
    example = Path(__file__).parents[2] / "scenes" / "examples" / "rocker-flight.toml"
    sine, record = 'kind      = "sine"', 'kind = "record"\nfile = "shock.csv"'
    text = example.read_text()
    assert sine in text
    shaken = tmp_path / "shaken.toml"
    shaken.write_text(text.replace('frequency = "100 Hz"', "").replace(sine, record))
    (tmp_path / "shock.csv").write_text("time,acceleration\n0,0\n1e-3,3\n")
    read = [ic.Scene.read(name) for name in (file, shaken, "scaled-plate-r10")]
    for scene in (ic.Scene(TABLE_1), *read):
        restored = pickle.loads(pickle.dumps(scene))
        for other in (restored, copy.copy(scene), copy.deepcopy([scene])[0]):
            assert (other.name, other.hash) == (scene.name, scene.hash)
        assert restored.__getnewargs__() == scene.__getnewargs__()
    # in another process, which finds the scene's file again
    script = "import pickle, sys; print(pickle.load(sys.stdin.buffer).__getnewargs__()[1])"
    given = pickle.dumps(ic.Scene.read(file))
    ended = subprocess.run([sys.executable, "-c", script], input=given, capture_output=True)
    assert ended.stdout.decode().strip() == str(file), ended.stderr
    with pytest.raises(ic.Error, match="not valid TOML") as caught:
        ic.Scene("nonsense")
    assert caught.value.exit_status == 3
    with pytest.raises(ic.Error, match=r"use Scene\.read"):
        ic.Scene("my-impact.toml")


def test_models_are_compared_with_the_reference() -> None:
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


def record(file: Path, seed: int) -> Path:
    """What a vibrometer would make of the reference of the larger spheres."""
    curves = ic.reference(ic.Scene.read("scaled-plate-r10")).curves
    time, noise = 1e6 * curves["time"], np.random.default_rng(seed)
    before = np.arange(-60.0, 0.0, 0.5)
    columns = [np.concatenate([before, time])]
    for name, first in [("outer_velocity", -550.0), ("inner_velocity", 0.0)]:
        signal_ = np.concatenate([np.full(before.shape, first), 1e3 * curves[name]])
        columns.append(signal_ + noise.normal(0.0, 1.0, signal_.shape))
    heading = "time [us],outer_velocity [mm/s],inner_velocity [mm/s]"
    np.savetxt(file, np.transpose(columns), delimiter=",", header=heading, comments="")
    return file


def test_measured_records_are_compared_with_the_models(tmp_path: Path) -> None:
    scene = ic.Scene.read("scaled-plate-r10")
    records = [record(tmp_path / f"run{seed}.csv", seed) for seed in (1, 2)]
    comparison = ic.compare(scene, models=["B", "C"], measured=records, bandwidth="150 kHz")
    measured = comparison.measured()
    assert measured is not None and measured["bandwidth"] == 150e3
    comparators = {row["partner"]: row for row in measured["partners"]}
    assert set(comparators) == {"reference", "B", "C"} and measured["efficiency"]["count"] == 2
    assert abs(measured["efficiency"]["mean"] - 0.695) < 0.02
    assert abs(comparators["reference"]["efficiency_difference"]) < 0.02
    assert ic.compare(scene, models=["C"]).measured() is None
    for arguments, word in [
        ({"measured": records, "bandwidth": "1 Hz"}, "100 MHz"),
        ({"measured": [tmp_path / "none.csv"]}, "none.csv"),
        ({"measured": records, "speed": "guess"}, "guess"),
    ]:
        with pytest.raises(ic.Error, match=word):
            ic.compare(scene, **arguments)


def test_an_optimum_is_the_programs(tmp_path: Path) -> None:
    over = {"plate.thickness": ("1 mm", 0.003)}
    heard: list[tuple[int, float | None]] = []
    optimum = ic.optimise(
        ic.Scene.read("scaled-plate-r10"),
        over,
        model="B",
        out=tmp_path / "out",
        progress=lambda tried, best: heard.append((tried, best)),
    )
    command = ["optimise", "scaled-plate-r10", "--over=plate.thickness=1mm..3mm", "--model=B"]
    printed = subprocess.run([*PROGRAM, *command, "--json"], capture_output=True, check=True)
    expected, found = json.loads(printed.stdout), dict(optimum.document)
    for document in (expected, found):
        document["summary"].pop("solve_seconds")
        # threads finish in any order
        document["history"].sort(key=lambda tried: (tried["climb"], tried["values"]))
    assert found == expected
    assert optimum.values == {"plate.thickness": expected["variables"][0]["optimum"]}
    assert ic.reduced(optimum.scene, model="B").efficiency == optimum.objective
    assert "<svg" in optimum._repr_html_() and (tmp_path / "out" / "optimum.toml").is_file()
    assert all(best is None or best <= optimum.objective + 1e-3 for _, best in heard)


def test_an_optimum_reports_its_progress_and_errors() -> None:
    scene, heard = ic.Scene(TABLE_1), []
    over = {"plate.thickness": ("1 mm", "3 mm"), "plate.radius": ("25 mm", "40 mm")}

    def enough(tried: int, best: float | None) -> None:
        heard.append(tried)
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        ic.optimise(scene, over, model="C", samples=2000, progress=enough)
    # some were on their way
    assert 1 <= len(heard) <= 8
    for bounds, arguments, word in [
        ({"plate.thicknes": (1e-3, 2e-3)}, {}, r"did you mean `plate\.thickness`"),
        ({"plate.thickness": (2e-3, 1e-3)}, {}, "not below the high end"),
        ({}, {}, "--over"),
        ({"plate.radius": (0.02, 0.03)}, {"samples": 2}, "samples"),
        ({"plate.radius": (0.02, 0.03)}, {"mesh": "seat.vtu"}, "no seal seat"),
    ]:
        with pytest.raises(ic.Error, match=word) as caught:
            ic.optimise(scene, bounds, **arguments)
        assert caught.value.exit_status == 2


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


def test_a_sweep_keeps_the_order_and_raises_its_first_error() -> None:
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

    def watched_in_the_middle() -> bool:
        moments.clear()
        start = time.monotonic()
        ic.sweep([scene] * 1000, model="C", threads=1)
        end = time.monotonic()
        return any(abs(t - (start + end) / 2) < (end - start) / 4 for t in moments)

    watcher = threading.Thread(target=watch)
    watcher.start()
    # a busy machine may not run the watcher in each sweep's middle
    watched = any(watched_in_the_middle() for _ in range(100))
    done.set()
    watcher.join()
    assert watched


def test_an_interruption_ends_a_sweep() -> None:
    script = """
import signal, threading
import impactcheck as ic
# a program started in the background ignores interruptions
signal.signal(signal.SIGINT, signal.default_int_handler)
scenes = [ic.Scene.read("scaled-plate-r10")] * 100000
try:
    threading.Timer(0.3, lambda: print("runs", flush=True)).start()
    ic.sweep(scenes, model="C")
except KeyboardInterrupt:
    print("interrupted")
print(ic.reduced(scenes[0], model="B").efficiency)
"""
    running = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert running.stdout is not None and running.stdout.readline() == "runs\n"
    running.send_signal(signal.SIGINT)
    said, _ = running.communicate(timeout=600)
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
