"""What is drawn is what was meant, and stays."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest

from fem_reference.common.hertz import hertz_approach, hertz_contact_radius, hertz_stiffness

sys.path.insert(0, str(Path(__file__).resolve().parent))
from check import moved
from draw import DRAWN, ELEMENTS, STEEPEST, scenes


@pytest.mark.parametrize("stratum", DRAWN)
def test_more_scenes_leave_the_first_ones_as_they_are(stratum: str) -> None:
    """A Sobol sequence does not depend on its length."""
    assert scenes(stratum, 20)[:5] == scenes(stratum, 5)


def test_patches_and_contact_times_are_those_drawn() -> None:
    """Hertz's impact on a half-space fills the ranges that `dry` names."""
    patches, times = [], []
    for scene in scenes("dry", 64):
        outer, materials = scene["outer"], scene["materials"]
        density = materials["bodies"]["density"]
        tip = outer.get("tip_radius", outer.get("radius"))
        mass = outer.get("mass", 4.0 / 3.0 * math.pi * tip**3 * density)
        moduli = [(1.0 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in materials.values()]
        modulus = 1.0 / sum(moduli)
        stiffness = hertz_stiffness(modulus, tip)
        approach = hertz_approach(mass, outer["speed"], stiffness)
        patch = hertz_contact_radius(stiffness * approach**1.5, modulus, tip)
        # 3 times blunter tips at most, of the same mass
        assert patch / tip <= STEEPEST / 0.3 * (1.0 + 1e-6)
        patches.append(patch / scene["plate"]["thickness"])
        times.append(2.9433 * approach / outer["speed"])
        assert scene["reference"]["elements_per_contact_radius"] == ELEMENTS
    assert 0.0 < min(patches) < 0.02 and 0.4 < max(patches) <= 0.6 * (1.0 + 1e-6)
    assert max(times) / min(times) > 100.0


def test_what_moves_by_more_than_a_twentieth_of_its_band_is_listed() -> None:
    """Of the reference and of the models; and a scene that is refused now."""
    values: dict[str, list[Any]] = {"efficiency": [0.5, 0.01, None, None, 0.501]}
    before = {"scene": "dry-000", "values": values}
    assert moved(before, before) == []
    for place, name in ((0, "reference"), (4, "C")):
        for change, count in ((4e-4, 0), (6e-4, 1)):
            other = list(values["efficiency"])
            other[place] += change
            found = moved(before, {"scene": "dry-000", "values": {"efficiency": other}})
            assert len(found) == count
            assert all(name in sentence for sentence in found)
    assert len(moved(before, {"scene": "dry-000", "values": {}})) == 2
    assert moved(before, {"scene": "dry-000", "refused": "why"}) == ["dry-000: solved -> why"]
