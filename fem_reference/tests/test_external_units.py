"""Units as models of a scene: ``[[external]] fmu``."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

from ..common.errors import SceneError
from .program import ROOT

pytest.importorskip("fmpy")
from ..units.simulate import answer
from .unit_simulation import PROGRAM, plate_units, program


@pytest.fixture(scope="module")
def units(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return plate_units(tmp_path_factory.mktemp("units"))


@pytest.fixture(scope="module")
def expected() -> dict[str, Any]:
    """What the command finds."""
    found: dict[str, Any] = json.loads(program("reduced", "scaled-plate-r10", "--json", "-q"))
    return found


def question(file: Path, variables: dict[str, str], start: dict[str, Any]) -> dict[str, Any]:
    """A question of the program about a unit of its own."""
    speed = ("m/s", {"m": 1, "s": -1})
    units = {"outer_velocity": speed, "inner_velocity": speed, "efficiency": ("1", {})}
    unit = {"file": str(file), "variables": variables, "start": start, "units": units}
    scene = {"run": {"end_time": None}, "outer": {"speed": 0.55}}
    return {
        "schema_version": 1,
        "sample_interval": 1e-6,
        "scene": scene,
        "unit": unit | {"curves": ["outer_velocity", "inner_velocity"], "interface": None},
    }


def test_a_unit_is_a_model_of_a_scene(units: dict[str, Path], expected: dict[str, Any]) -> None:
    """As ``[[external]] fmu`` has it."""
    variables = {"outer_velocity": "outer_velocity", "efficiency": "efficiency"}
    start = {"launch": True, "outer.speed": "outer.speed"}
    for version in ("2", "3"):
        found = answer(question(units[version], variables, start))
        assert found["efficiency"] == pytest.approx(expected["efficiency"], rel=1e-9)
        velocity = found["history"]["outer_velocity"]
        assert velocity[0] == -0.55
        assert velocity[-1] == pytest.approx(expected["outer_velocity_final"], rel=1e-9)


@pytest.mark.parametrize(
    ("variables", "start", "part"),
    [
        ({"outer_velocity": "v"}, {}, "no variable 'v'; it has time, arm"),
        ({"outer_velocity": "outer_displacement"}, {}, "is in m, but outer_velocity is in m/s"),
        ({"outer_speed": "outer_velocity"}, {}, "no curve and no quantity 'outer_speed'"),
        ({"efficiency": "efficiency"}, {"go": True}, "external.start.go: the unit has no variable"),
        ({"efficiency": "efficiency"}, {"launch": "outer.mass"}, "no number at 'outer.mass'"),
    ],
)
def test_what_a_unit_does_not_have_is_named(
    units: dict[str, Path], variables: dict[str, str], start: dict[str, Any], part: str
) -> None:
    with pytest.raises(SceneError, match=re.escape(part)):
        answer(question(units["3"], variables, start))


def test_what_is_no_unit_is_named(tmp_path: Path) -> None:
    file = tmp_path / "plain.fmu"
    file.write_text("no archive")
    with pytest.raises(SceneError, match="is no Functional Mock-up Unit"):
        answer(question(file, {"efficiency": "efficiency"}, {}))
    with pytest.raises(SceneError, match="is no Functional Mock-up Unit"):
        answer(question(tmp_path / "none.fmu", {"efficiency": "efficiency"}, {}))


MILLI = (
    b'<Unit name="m/s"><BaseUnit m="1" s="-1"/>',
    b'<Unit name="m/s"><BaseUnit m="1" s="-1" factor="0.001"/>',
)
BY_TYPE = (
    (
        b"<LogCategories>",
        b'<TypeDefinitions><Float64Type name="V" unit="m/s"/></TypeDefinitions><LogCategories>',
    ),
    (b'continuous" unit="m/s"/>', b'continuous" declaredType="V"/>'),
)


@pytest.mark.parametrize("changes", [(MILLI,), (MILLI, *BY_TYPE)])
def test_units_of_other_prefixes_are_converted(
    units: dict[str, Path], tmp_path: Path, changes: tuple[tuple[bytes, bytes], ...]
) -> None:
    """The same unit whose "m/s" is 1 mm/s, by its description; stated by variable or by type."""
    file = tmp_path / "milli.fmu"
    with zipfile.ZipFile(units["3"]) as source, zipfile.ZipFile(file, "w") as target:
        for entry in source.infolist():
            content = source.read(entry)
            if entry.filename == "modelDescription.xml":
                for old, new in changes:
                    assert old in content
                    content = content.replace(old, new)
            target.writestr(entry, content)
    found = answer(question(file, {"outer_velocity": "outer_velocity"}, {"launch": True}))
    assert found["history"]["outer_velocity"][0] == pytest.approx(-0.55e-3)


def test_what_a_unit_prints_is_no_part_of_the_answer() -> None:
    script = """
import os
from fem_reference.units import simulate
from fem_reference.units.command import UNIT
simulate.answer = lambda _: {"printed": os.write(1, b"hello from the unit")}
UNIT.run(None)
"""
    command = [sys.executable, "-c", script]
    run = subprocess.run(command, cwd=ROOT, input="{}", capture_output=True, text=True, check=True)
    assert json.loads(run.stdout) == {"printed": 19} and "hello from the unit" in run.stderr


def test_a_unit_takes_part_in_a_comparison(
    units: dict[str, Path], expected: dict[str, Any], tmp_path: Path
) -> None:
    """The gate passes on it, and refuses to run it without leave."""
    scene = (ROOT / "scenes/scaled-plate-r10.toml").read_text()
    names = [
        "outer_velocity",
        "inner_velocity",
        *(n for n in expected if "force_peak" in n),
    ]
    variables = "\n".join(f'{name} = "{name}"' for name in ["efficiency", *names])
    own = f'[[external]]\nname = "unit"\nfmu = "{units["3"]}"\nstart = {{ launch = true }}\n'
    gated = f"[external.variables]\n{variables}\n[tolerances.unit]\nefficiency.absolute = 0.01\n"
    file = tmp_path / "scaled-plate-r10.toml"
    file.write_text(f"{scene}\n{own}\n{gated}")
    out = ["--out", tmp_path / "report", "--models", "external"]
    environment = os.environ | {"IMPACTCHECK_PYTHON": sys.executable}
    command = [str(part) for part in (PROGRAM, "gate", file, *out)]
    for leave, status, part in [
        ([], 2, "wants to run the unit"),
        (["--allow-external"], 0, "pass"),
    ]:
        run = subprocess.run(
            [*command, *leave], env=environment, capture_output=True, text=True, check=False
        )
        assert run.returncode == status and part in run.stdout + run.stderr, run.stdout + run.stderr
