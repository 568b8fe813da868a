"""The study of the bands: random scenes, and trials whose errors are known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.plate_impact.result import QUANTITIES
from fem_reference.plate_impact.studies.bands import FACTORS, TRUTH, table, trials
from fem_reference.plate_impact.studies.random_scenes import draw


def test_a_seed_is_a_scene() -> None:
    assert draw(7).raw == draw(7).raw != draw(8).raw
    scenes = [draw(seed) for seed in range(40)]
    assert {scene.plate.edge for scene in scenes} == {"clamped", "simply-supported", "free"}
    assert {scene.gap > 0.0 for scene in scenes} == {False, True}


def test_errors_of_the_order_fitted_are_their_bands(tmp_path: Path) -> None:
    """Also where the truth itself is off: its error is added."""
    times = np.linspace(0.0, 1e-4, 400)
    curves: dict[str, Any] = {}
    values = {}
    for factor in [*FACTORS, TRUTH]:
        share = 1.0 + 0.01 * factor**-1.5
        key = f"{factor:.6f}"
        values[key] = dict.fromkeys(QUANTITIES, 3.0 * share)
        # Contacts that never close: impulses, and their last instant, are zero.
        values[key]["inner_contact_end"] = 0.0
        curves[f"t{key}"] = times
        curves[f"r{key}"] = share * np.outer(np.sin(1e5 * times), [1, 1, 0, 1, 1, 1, 1, 0])
    np.savez(tmp_path / "known.npz", **curves)
    (tmp_path / "known.json").write_text(json.dumps({"values": values}))
    found = trials(tmp_path, "known")
    assert sorted({t.factor for t in found}) == pytest.approx(FACTORS[2::-1], abs=1e-6)
    assert all(trial.error == pytest.approx(trial.band, rel=1e-4) for trial in found)
    names = {trial.quantity for trial in found}
    assert {"efficiency", "outer_velocity_rms", "plate_displacement_max"} <= names
    assert not names & {"inner_contact_end", "outer_force_rms"}
    assert "| all quantities | 21 |" in table(found)
