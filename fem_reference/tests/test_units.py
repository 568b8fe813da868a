"""Units that the program writes, run by FMPy, against the program's own results."""

from __future__ import annotations

import csv
import json
import random
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from .program import ROOT

pytest.importorskip("fmpy")
from fmpy import extract, fmi3, read_model_description
from fmpy.validation import validate_fmu

from .unit_simulation import DISCARD, ERROR, Instance, plate_units, program, refused

PARAMETERS = ("plate.thickness", "outer.speed", "inner.radius", "materials.steel.youngs_modulus")
"""What the random launches vary, by up to a fifth."""
CURVES = ("outer_displacement", "inner_displacement", "outer_velocity", "inner_velocity")


@dataclass
class Launch:
    """Numbers of a scene, with what the command says of them."""

    numbers: dict[str, float]
    result: dict[str, Any]
    time: np.ndarray
    curves: np.ndarray


@pytest.fixture(scope="module")
def units(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return plate_units(tmp_path_factory.mktemp("units"))


@pytest.fixture(scope="module")
def folders(units: dict[str, Path]) -> dict[str, Path]:
    return {version: Path(extract(str(file))) for version, file in units.items()}


@pytest.fixture
def unit(units: dict[str, Path], folders: dict[str, Path]) -> Iterator[Instance]:
    instance = Instance(units["3"], folders["3"])
    yield instance
    instance.close()


@pytest.fixture(scope="module")
def launches(tmp_path_factory: pytest.TempPathFactory) -> list[Launch]:
    """Scenes with random numbers, solved by the command."""
    folder = tmp_path_factory.mktemp("scenes")
    draw = random.Random(5)
    text = (ROOT / "scenes/scaled-plate-r10.toml").read_text()
    scene = tomllib.loads(text)
    found = []
    for number in range(8):
        numbers = {}
        for name in PARAMETERS:
            *tables, key = name.split(".")
            value = SI[name] * (1.0 + (0.2 * draw.uniform(-1.0, 1.0) if number else 0.0))
            table = scene
            for part in tables:
                table = table[part]
            table[key] = numbers[name] = value
        file = folder / f"scene-{number}.toml"
        file.write_text(as_toml(scene))
        history = folder / f"history-{number}.csv"
        result = json.loads(program("reduced", file, "--json", "--history", history))
        with history.open() as stream:
            rows = list(csv.DictReader(stream))
        time = np.array([float(row["time"]) for row in rows])
        curves = np.array([[float(row[name]) for name in CURVES] for row in rows])
        found.append(Launch(numbers, result, time, curves))
    return found


SI = {
    "plate.thickness": 2e-3,
    "outer.speed": 0.55,
    "inner.radius": 10e-3,
    "materials.steel.youngs_modulus": 210e9,
}


def as_toml(table: dict[str, Any], path: str = "") -> str:
    """A scene file of texts, numbers and tables, without its tolerances."""
    lines = [f"{key} = {json.dumps(v)}" for key, v in table.items() if not isinstance(v, dict)]
    for key, value in table.items():
        if isinstance(value, dict) and key not in ("tolerances", "uncertainty"):
            inner = f"{path}.{key}".lstrip(".")
            lines += [f"[{inner}]", as_toml(value, inner)]
    return "\n".join(lines)


@pytest.mark.parametrize("version", ["2", "3"])
def test_a_unit_is_valid(units: dict[str, Path], version: str) -> None:
    """By the standard's schema and FMPy's rules; small enough to be passed on."""
    assert validate_fmu(str(units[version])) == []
    assert units[version].stat().st_size < 5e6


@pytest.mark.parametrize("count", [20, pytest.param(500, marks=pytest.mark.evidence)])
@pytest.mark.parametrize("version", ["2", "3"])
def test_any_steps_give_the_results_of_the_command(
    units: dict[str, Path],
    folders: dict[str, Path],
    launches: list[Launch],
    version: str,
    count: int,
) -> None:
    """Simulations with random steps, steps taken back, parameters: results and curves."""
    instance = Instance(units[version], folders[version])
    draw = random.Random(int(version))
    for _ in range(count):
        launch = draw.choice(launches)
        simulate(instance, launch, draw)
        instance.fmu.reset()
        instance.ready()
    instance.close()


def simulate(instance: Instance, launch: Launch, draw: random.Random) -> None:
    for name, value in launch.numbers.items():
        instance.set(name, value)
    start = draw.choice([0.0, 10.0 ** draw.uniform(-6.0, 0.0)])
    now = 0.0
    if start > 0.0:
        instance.step(now, start)
        now = start
    instance.set("launch", True)
    # where the command has samples too
    places = sorted(draw.sample(range(1, len(launch.time)), draw.randint(1, 12)))
    speed = launch.numbers["outer.speed"]
    for place in places:
        end = start + launch.time[place]
        if draw.random() < 0.3:
            back_and_again(instance, now, end - now)
        # masters add up steps
        rounded = now * (1.0 + draw.choice([0.0, 1e-16, -1e-16]))
        instance.step(rounded, end - now)
        now = end
        found, expected = np.array(instance.get(*CURVES)), launch.curves[place]
        # the simulation's clock rounds the time since the launch
        clock = speed * 4e-16 * max(end, launch.time[-1])
        assert found[:2] == pytest.approx(expected[:2], rel=1e-9, abs=1e-9 * 1e-5 + clock)
        force = launch.result["outer_force_peak"] / 0.03
        assert found[2:] == pytest.approx(
            expected[2:], rel=1e-9, abs=1e-9 * speed + 4e-16 * force * end
        )
    if not instance.get("impact_over")[0]:
        instance.step(now, 1e-3)
    assert instance.get("impact_over") == [True]
    outputs = [n for n in instance.references if n in launch.result and n != "warnings"]
    assert "efficiency" in outputs and "inner_contacts" in outputs
    for name, value in zip(outputs, instance.get(*outputs), strict=True):
        assert value == pytest.approx(launch.result[name], rel=1e-9), name
    low, high = instance.get("efficiency_low", "efficiency_high")
    prediction = launch.result["prediction"]
    assert instance.get("predicted") == [prediction is not None]
    if prediction:
        assert [low, high] == pytest.approx(
            [prediction["efficiency"]["low"], prediction["efficiency"]["high"]], rel=1e-9
        )


def back_and_again(instance: Instance, now: float, length: float) -> None:
    """A step that is taken back leaves nothing behind, wherever its state has been."""
    fmu = instance.fmu
    get, put, free = (
        (fmu.getFMUState, fmu.setFMUState, fmu.freeFMUState)
        if instance.is_3
        else (fmu.getFMUstate, fmu.setFMUstate, fmu.freeFMUstate)
    )
    state = get()
    instance.step(now, 0.7 * length)
    values = instance.get(*CURVES, "impact_over")
    # a state holds all of an instance
    fmu.reset()
    put(state)
    instance.step(now, 0.7 * length)
    assert instance.get(*CURVES, "impact_over") == values
    if instance.is_3:
        again = fmu.deserializeFMUState(fmu.serializeFMUState(state))
    else:
        again = fmu.deSerializeFMUstate(fmu.serializeFMUstate(state))
    put(again)
    free(again)
    free(state)


def test_bad_calls_give_the_status_of_the_standard_and_a_line(
    unit: Instance, units: dict[str, Path], folders: dict[str, Path]
) -> None:
    fmu = unit.fmu
    thickness = unit.references["plate.thickness"]
    other = Instance(units["3"], folders["3"])
    foreign = other.fmu.getFMUState()
    unit.step(0.0, 1e-5)
    for status, word, call in [
        (ERROR, "-1e-6 s, but it must be greater than 0 s", lambda: unit.step(1e-5, -1e-6)),
        (ERROR, "the unit is at 1e-5 s", lambda: unit.step(2e-5, 1e-6)),
        (ERROR, "no variable with the value reference 9999", lambda: fmu.getFloat64([9999])),
        (ERROR, "`plate.thickness`", lambda: fmu.getInt32([thickness])),
        (DISCARD, "`plate.thickness` is -1 m", lambda: unit.set("plate.thickness", -1.0)),
        (DISCARD, "less than 0.5", lambda: unit.set("materials.steel.poisson_ratio", 0.7)),
        (DISCARD, "NaN", lambda: unit.set("outer.speed", float("nan"))),
        (ERROR, "is an output", lambda: unit.set("efficiency", 0.5)),
        (ERROR, "`time` can't be set", lambda: unit.set("time", 0.5)),
        (ERROR, "none that this instance has given", lambda: fmu.setFMUState(foreign)),
        (ERROR, "no state of a unit", lambda: fmu.deserializeFMUState(b"nonsense")),
        (ERROR, "not allowed in the phase Step", fmu.exitInitializationMode),
        (ERROR, "does not have this", lambda: fmu.getFloat32([1], 1)),
    ]:
        unit.log.clear()
        refused(status, call)
        assert len(unit.log) == 1 and word in unit.log[0][1], (word, unit.log)
    # as before, all the same
    assert unit.get("plate.thickness", "time") == [2e-3, 1e-5]
    unit.step(1e-5, 1e-6)
    other.fmu.freeFMUState(foreign)
    other.close()


def test_a_unit_without_its_binary_or_token_does_not_begin(
    units: dict[str, Path], folders: dict[str, Path]
) -> None:
    described = read_model_description(str(units["3"]))
    identifier = described.coSimulation.modelIdentifier
    with pytest.raises(Exception, match=r"Cannot find|not found|cannot open"):
        fmi3.FMU3Slave(
            guid=described.guid,
            unzipDirectory=str(folders["3"] / "resources"),
            modelIdentifier=identifier,
            instanceName="none",
        )
    said: list[str] = []
    strange = fmi3.FMU3Slave(
        guid="another",
        unzipDirectory=str(folders["3"]),
        modelIdentifier=identifier,
        instanceName="strange",
    )
    with pytest.raises(Exception, match="Failed to instantiate"):
        strange.instantiate(logMessage=lambda _e, _s, _c, message: said.append(message.decode()))
    assert len(said) == 1 and 'the instantiation token is "another"' in said[0]


def test_steps_may_end_at_the_last_release(
    units: dict[str, Path], folders: dict[str, Path], launches: list[Launch]
) -> None:
    """At once over there, wherever the simulation's clock stands."""
    instance = Instance(units["3"], folders["3"], early=True)
    draw = random.Random(1)
    for _ in range(50):
        start = 10.0 ** draw.uniform(-6.0, 1.0)
        instance.step(0.0, start)
        instance.set("launch", True)
        _, _, early, reached = instance.step(start, 1e-3)
        assert early and instance.get("impact_over") == [True]
        assert instance.get("last_release") == [reached]
        expected = start + launches[0].result["outer_contact_end"]
        assert reached == pytest.approx(expected, rel=1e-15, abs=1e-13)
        assert instance.step(reached, 1e-3)[2] is False
        instance.fmu.reset()
        instance.ready()
    instance.close()


@pytest.mark.parametrize(
    ("scene", "strikes_later"),
    [
        ("scenes/examples/rocker-bender.toml", True),
        ("scenes/validation/stack.toml", False),
        ("scenes/seal-seat-improved.toml", False),
        ("scenes/validation/friction.toml", False),
    ],
)
def test_every_kind_gives_the_results_of_the_command(
    scene: str, strikes_later: bool, tmp_path: Path
) -> None:
    """Launched in the initialization, over in one step or after some."""
    file = tmp_path / "unit.fmu"
    program("fmu", scene, "-q", "-o", file)
    expected = json.loads(program("reduced", scene, "--json", "-q"))
    instance = Instance(file, Path(extract(str(file), str(tmp_path / "mit ü und %"))))
    for steps in (1, 7):
        instance.fmu.reset()
        instance.fmu.enterInitializationMode(startTime=0.0)
        instance.set("launch", True)
        instance.fmu.exitInitializationMode()
        length = expected.get("strike_delay", 0.0) + 2e-3
        for step in range(steps):
            instance.step(step * length / steps, length / steps)
        assert instance.get("impact_over") == [True]
        outputs = [
            n for n in instance.references if expected.get(n) is not None and n != "warnings"
        ]
        assert "first_frequency" in outputs
        for name, value in zip(outputs, instance.get(*outputs), strict=True):
            if name in CURVES or name.startswith(("sphere_velocity_", "actuator_velocity")):
                name = f"{name}_final" if f"{name}_final" in expected else name
            assert value == pytest.approx(expected[name], rel=1e-9), name
        valid = [not expected["warnings"]]
        assert instance.get("valid") == valid
        assert instance.get("warnings") == [len(expected["warnings"])]
        [contact] = instance.get("first_contact")
        assert (contact > 1e-4) is strikes_later
    instance.close()


def test_a_drive_may_stand_at_no_voltage(tmp_path: Path) -> None:
    """An input passes through 0; only a launch needs more."""
    file = tmp_path / "stack.fmu"
    program("fmu", "scenes/validation/stack.toml", "-q", "-o", file)
    instance = Instance(file, Path(extract(str(file), str(tmp_path / "unit"))))
    instance.set("outer.voltage", 0.0)
    instance.step(0.0, 1e-4)
    instance.set("launch", True)
    refused(ERROR, lambda: instance.step(1e-4, 1e-4))
    assert "`outer.voltage`" in instance.log[-1][1] or "`outer.stroke`" in instance.log[-1][1]
    peaks = []
    for voltage in (45.0, 90.0):
        instance.fmu.reset()
        instance.ready()
        instance.set("outer.voltage", voltage)
        instance.set("launch", True)
        instance.step(0.0, 1e-3)
        peaks += instance.get("outer_force_peak")
    assert 0.2 < peaks[0] / peaks[1] < 0.6
    instance.close()


def test_launches_follow_one_another(unit: Instance, launches: list[Launch]) -> None:
    """A second launch needs an edge of both inputs; parameters of an impact under way stay."""
    unit.set("launch", True)
    unit.step(0.0, 2e-5)
    unit.set("outer.speed", launches[1].numbers["outer.speed"])
    unit.step(2e-5, 1e-3)
    first = launches[0].result["efficiency"]
    assert unit.get("efficiency") == pytest.approx([first], rel=1e-9)
    unit.set("launch", False)
    unit.step(1.02e-3, 1e-3)
    unit.set("launch", True)
    unit.step(2.02e-3, 1e-3)
    assert "ignored" in unit.log[-1][1] and unit.get("efficiency") == pytest.approx([first])
    for name in PARAMETERS:
        unit.set(name, launches[1].numbers[name])
    for value in (False, True):
        unit.set("arm", value)
        unit.set("launch", value)
        unit.step(3.02e-3 + value * 1e-3, 1e-3)
    second = launches[1].result["efficiency"]
    assert unit.get("efficiency") == pytest.approx([second], rel=1e-9)
    assert unit.get("first_contact") == [4.02e-3]


@pytest.mark.evidence
def test_the_system_example_gives_the_guides_table(tmp_path: Path) -> None:
    unit = tmp_path / "valve.fmu"
    program("fmu", "scenes/examples/rocker-flight.toml", "--modes", "24", "-o", unit)
    command = [sys.executable, "examples/fmu/valve.py", str(unit)]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    page = (ROOT / "guide/src/how-to/system-simulation.md").read_text()
    rows = re.findall(r"^\| (\d+) V \| ([\d.]+) ms \| (\d+) mm/s \| (yes|no) \|$", page, flags=re.M)
    printed = re.findall(r"^ *(\d+) V +([\d.]+) ms +(\d+) mm/s +(yes|no) ", run.stdout, flags=re.M)
    assert len(rows) == 5 and rows == printed
