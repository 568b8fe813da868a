"""What every kind of impact has, on the smallest one: a mass strikes a spring."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pytest

from fem_reference.common.decode import At, decode
from fem_reference.common.errors import SceneError
from fem_reference.common.progress import Report
from fem_reference.common.settings import Options, Settings
from fem_reference.explicit.records import ContactRecord, peak_force
from fem_reference.impact.history import Force, Level
from fem_reference.impact.result import Details, ImpactSolver, solve
from fem_reference.impact.run import ImpactRun, Losses
from fem_reference.impact.scene import ImpactScene
from fem_reference.impact.series import Target

from .test_series import Alone

MASS, STIFFNESS, SPEED = 2.0, 8.0, 3.0
CURVES = (Level("place", 0, rate=1), Level("speed", 1), Force("force", (2,)))


@dataclass(frozen=True, kw_only=True)
class SpringScene(ImpactScene):
    """A mass strikes a spring that is fixed at its other end."""

    kind: Literal["spring"]
    mass: float
    stiffness: Annotated[float, At("spring.stiffness")]
    speed: float


@dataclass(frozen=True)
class Solution:
    """A run on one mesh."""

    run: ImpactRun
    dofs: int = 1


def compute(
    scene: SpringScene, factor: float, settings: Settings, report: Report, lead: Any
) -> Solution:
    """Central differences with 600 steps in the contact on the mesh requested."""
    period = math.sqrt(scene.mass / scene.stiffness)
    end = scene.end_time or 1.2 * math.pi * period
    step = end / round(end / (math.pi * period) * 600 * factor)
    place, speed, impulse, rows = 0.0, scene.speed, 0.0, []
    for _ in range(round(end / step) + 1):
        rows.append((place, speed, impulse))
        force = scene.stiffness * max(place + 0.5 * step * speed, 0.0)
        speed, before = speed - step * force / scene.mass, speed
        place += 0.5 * step * (before + speed)
        impulse += step * force
    table = np.array(rows)
    times = step * np.arange(len(rows), dtype=np.float64)
    last = float(times[np.flatnonzero(np.diff(table[:, 2]))[-1] + 1])
    peak = peak_force(table[:, 2], 1, step)
    contact = ContactRecord(1, last, ((0.0, last),), peak, impulse, 0.0)
    return Solution(
        ImpactRun(
            times=times,
            rows=table,
            contacts=(contact,),
            in_contact_at_end=bool(place > 0.0),
            time_step=step,
            steps=len(rows) - 1,
            loop_seconds=0.0,
            processor_seconds=0.0,
            initial_energy=0.5 * scene.mass * scene.speed**2,
            energy_residual=0.0,
            momentum_residual=0.0,
            losses=Losses(drag=0.25),
        )
    )


def quantities(solution: Solution) -> dict[str, float]:
    contact = solution.run.contacts[0]
    return {
        "speed_final": float(solution.run.rows[-1, 1]),
        "force_peak": contact.force_peak,
        "first_frequency": math.sqrt(STIFFNESS / MASS) / (2.0 * math.pi),
        "1/force_peak": contact.force_peak,
    }


def document(**changes: Any) -> dict[str, Any]:
    names = {"name": "spring", "kind": "spring", "scene_hash": "0", "settings_hash": "1"}
    bodies = {"mass": MASS, "speed": SPEED, "spring": {"stiffness": STIFFNESS}}
    return {**names, **bodies, **changes}


def solved(folder: Path, **changes: Any) -> dict[str, Any]:
    """The documents of a result, and its history."""
    scene = decode(SpringScene, document(**changes))

    def details(folder: Path, solution: Solution, meshes: Any, bands: Any) -> Details:
        return Details(
            contacts=("spring",), duration=1.0, summary={"impacts": 1}, warnings=("beware",)
        )

    solver: ImpactSolver[Solution] = ImpactSolver(
        scene=scene,
        method=[scene.raw],
        end_time=scene.end_time,
        ratio=0.8,
        targeted=(Target("force_peak"),),
        compute=partial(compute, scene),
        quantities=quantities,
        curves=CURVES,
        details=details,
    )
    solve(solver, folder / "out", "paper", Alone(), Options())
    names = ("summary", "provenance")
    found = {name: json.loads((folder / "out" / f"{name}.json").read_text()) for name in names}
    lines = (folder / "out" / "history.csv").read_text().splitlines()
    table = np.loadtxt(lines, delimiter=",", skiprows=1)
    return {**found, "history": dict(zip(lines[0].split(","), table.T, strict=True))}


def test_the_result_is_that_of_the_closed_form(tmp_path: Path) -> None:
    found = solved(tmp_path)
    summary, curves = found["summary"], found["history"]
    peak, end = SPEED * math.sqrt(STIFFNESS * MASS), math.pi * math.sqrt(MASS / STIFFNESS)
    assert abs(summary["force_peak"] - peak) <= summary["uncertainty"]["force_peak"] < 1e-4 * peak
    assert summary["speed_final"] == pytest.approx(-SPEED, rel=1e-4)
    ((start, last),) = found["provenance"]["contacts"]["spring"]
    assert (start, last) == (0.0, pytest.approx(end, rel=3e-3))
    assert list(curves)[:4] == ["time", "place", "speed", "force"]
    inside = (curves["time"] > 0.1 * end) & (curves["time"] < 0.9 * end)
    wave = peak * np.sin(math.pi * curves["time"] / end)
    assert np.abs(curves["force"] - wave)[inside].max() < 1e-3 * peak
    assert summary["losses"] == {
        "plate_damping": 0.0, "squeeze_film": 0.0, "drag": 0.25, "contacts": [0.0, 0.0],
    }  # fmt: skip
    assert summary["impacts"] == 1 and summary["warnings"] == ["beware"]
    # Quantities of a part are for the kind of scene to state.
    assert not {name for name in summary["uncertainty"] if "/" in name}
    assert found["provenance"]["scene"] == document()


def test_a_run_cut_during_its_contact_determines_what_is_the_bodys_own(tmp_path: Path) -> None:
    summary = solved(tmp_path, run={"end_time": 0.5})["summary"]
    assert summary["force_peak"] is None and summary["speed_final"] is None
    assert set(summary["uncertainty"]) == {"first_frequency"}
    expected = SPEED * math.sqrt(STIFFNESS * MASS) * math.sin(0.5 * math.sqrt(STIFFNESS / MASS))
    assert summary["at_end"]["force_peak"]["value"] == pytest.approx(expected, rel=1e-2)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"spring": None}, "spring must be an object, not null"),
        ({"spring": {}}, "spring.stiffness is missing"),
        ({"mass": "2 kg"}, 'mass is "2 kg"; it must be a finite number in SI units'),
        ({"spring": {"stiffness": 1.0, "length": 1.0}}, "spring.length is not a known field; "),
        ({"kind": "rope"}, 'kind is "rope", which this solver does not support; supported: spring'),
        ({"run": {"end_time": True}}, "run.end_time is true; it must be a finite number"),
    ],
)
def test_a_scene_that_is_not_understood_ends_in_a_sentence(
    changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(SceneError) as refused:
        decode(SpringScene, document(**changes))
    assert str(refused.value).startswith(sentence)
