"""The package as a user of a notebook meets it."""

import subprocess
import sys

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


def test_curves_are_arrays_and_belong_to_the_summary() -> None:
    result = ic.reduced(ic.Scene(TABLE_1), model="C")
    assert result.efficiency == result.summary["efficiency"]
    assert abs(result.efficiency - 0.6947) < 0.001
    time, force = result.curves["time"], result.curves["outer_force"]
    assert time.shape == force.shape and time.dtype == np.float64 and np.all(np.diff(time) > 0)
    assert force.max() == pytest.approx(result.outer_force_peak, rel=2e-3)
    with pytest.raises(AttributeError, match="efficency"):
        _ = result.efficency
    assert "0.694" in result._repr_html_()


def test_a_dictionary_is_the_scene_of_the_file() -> None:
    scenes = (ic.Scene(TABLE_1), ic.Scene.read("scaled-plate-r10"))
    hashes = [ic.reduced(scene, "A").scene_hash for scene in scenes]
    assert hashes[0] == hashes[1]


def test_models_beside_the_reference() -> None:
    comparison = ic.compare(ic.Scene.read("scaled-plate-r10"))
    assert comparison.verdict == "pass"
    rows = {row["quantity"]: row for row in comparison.discrepancies("B")}
    assert rows["efficiency"]["relative"] == pytest.approx(0.0019, abs=2e-4)
    shown = comparison._repr_html_()
    assert "<svg" in shown and "outer_force_peak" in shown


def test_errors_have_the_programs_sentence_and_status() -> None:
    broken = {**TABLE_1, "plate": {**TABLE_1["plate"], "thickness": "-2 mm"}}
    with pytest.raises(ic.Error, match=r"plate\.thickness") as caught:
        ic.reduced(ic.Scene(broken))
    assert caught.value.exit_status == 3
    with pytest.raises(ic.Error, match="missing") as caught:
        ic.compare(ic.Scene({**TABLE_1, "outer": {**SPHERE, "speed": "551 mm/s"}, "name": "other"}))
    assert caught.value.exit_status == 11


def test_a_sweep_keeps_the_order_and_tells_its_first_error() -> None:
    radii = ("6 mm", "8 mm", "10 mm", "12 mm")
    scenes = [ic.Scene({**TABLE_1, "inner": {**SPHERE, "radius": r}}) for r in radii]
    together = [result.efficiency for result in ic.sweep(scenes, model="B")]
    assert together == [ic.reduced(scene, model="B").efficiency for scene in scenes]
    with pytest.raises(ic.Error):
        ic.sweep([*scenes, ic.Scene({"name": "empty"})])


def test_curves_over_time_as_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    data = ic.reduced(ic.Scene(TABLE_1), model="B").to_xarray()
    assert isinstance(data, xarray.Dataset) and data.attrs["model"] == "B"
    last, final = data["inner_velocity"][-1], data.attrs["inner_velocity_final"]
    assert float(last) == pytest.approx(final, rel=1e-3)


def test_the_program_comes_along() -> None:
    ended = subprocess.run([sys.executable, "-m", "impactcheck", "--version"], capture_output=True)
    assert ended.returncode == 0 and ended.stdout.startswith(b"impactcheck ")
