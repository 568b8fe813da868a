"""What is drawn is what was meant, and stays."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import gmsh
import pytest

from fem_reference.body.files import gmsh_session
from fem_reference.common.hertz import hertz_approach, hertz_contact_radius, hertz_stiffness

sys.path.insert(0, str(Path(__file__).resolve().parent))
import bodies
from check import moved
from draw import DRAWN, ELEMENTS, STEEPEST, scenes, write
from models import PROGRAM
from points import points


def volume(path: Path) -> float:
    """Of the solid in a STEP file, mm^3."""
    with gmsh_session():
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        return float(sum(gmsh.model.occ.getMass(3, tag) for _, tag in gmsh.model.getEntities(3)))


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


def test_bodies_and_seats_fill_their_ranges() -> None:
    """Speeds of spheres on bodies; actuators over the sphere's mass, and one tip or two."""
    speeds = [scene["outer"]["speed"] for scene in scenes("body", 60)]
    assert max(speeds) > 30.0 * min(speeds)
    masses, tips = [], set()
    for scene in scenes("seat", 60):
        density = scene["materials"][scene["sphere"]["material"]]["density"]
        mass = 4.0 / 3.0 * math.pi * scene["sphere"]["radius"] ** 3 * density
        masses.append(scene["actuator"]["mass"] / mass)
        tips.add(len(scene["actuator"]["tip_positions"]))
    assert 2.0 <= min(masses) < 3.0 and 20.0 < max(masses) <= 30.0
    assert tips == {1, 2}


def test_a_part_has_the_same_file_every_time_and_the_volume_stated(tmp_path: Path) -> None:
    """The content of the file identifies the scene."""
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        write("body", 3, tmp_path / folder)
    files = sorted((tmp_path / "first").glob("*.step"))
    assert len(files) == 3
    for path, point in zip(files, points("body", 3), strict=True):
        assert path.read_bytes() == (tmp_path / "second" / path.name).read_bytes()
        assert volume(path) == pytest.approx(bodies.part(point).volume, rel=1e-6)


@pytest.mark.parametrize(("stratum", "count"), [("body", 6), ("seat", 60)])
def test_scenes_are_valid(stratum: str, count: int, tmp_path: Path) -> None:
    """The program reads them and refuses only model A, which they do not have (status 2, not 3)."""
    write(stratum, count, tmp_path)
    for path in tmp_path.glob("*.toml"):
        command: list[str | Path] = [PROGRAM, "reduced", path, "--model", "A"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        assert ran.returncode == 2, ran.stderr
        assert "model C only" in ran.stderr or "model A" in ran.stderr


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
