"""Random flights and shocks, solved and stored with what made them."""

from __future__ import annotations

import json
import math
import random
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import mujoco
import numpy

from ..common.progress import Progress
from .chamber import Seat
from .model import STEP, Case, Sphere

IMPROVED = Seat(
    membrane_radius=8,
    membrane_thickness=0.5,
    island_length=10,
    island_height=2.95,
    seat_distance=5,
    seated_height=3.3,
    tilt=math.radians(15),
    aperture_angle=math.radians(120),
    bore_radius=0.6,
    notch_width=1.4,
    notch_floor=0.5,
    sphere_radius=1.5,
    chamber_height=20,
)
"""The improved seal seat of section 4.4, as shipped."""
MASS = 7.78e-3 * 4 / 3 * math.pi * 1.5**3
"""g"""
GRAVITY = 9.80665e-3
"""mm/ms^2"""
END = 200.0
"""ms"""
Document = dict[str, Any]


def draw(seed: int) -> Document:
    """A random flight: seat, spring, walls and launch, in mm, ms, g, N."""
    dice = random.Random(seed)
    seat = {
        "tilt": math.radians(dice.uniform(8, 22)),
        "aperture_angle": math.radians(dice.uniform(105, 125)),
        "notch_width": dice.uniform(0.8, 1.8),
    }
    stiffness = dice.choice([0.0, dice.uniform(1e-3, 2e-2)])
    return {
        "seed": seed,
        "seat": seat,
        "mass": MASS,
        "gravity": GRAVITY,
        "force": dice.uniform(0.015, 0.12),
        "stiffness": stiffness,
        "restitution": dice.uniform(0.2, 0.85),
        "friction": dice.uniform(0.0, 0.6),
        "speed": dice.uniform(0.4, 2.5),
        "angle": math.radians(dice.uniform(-10, 50)),
        "spin": dice.choice([0.0, dice.uniform(-0.5, 0.5)]),
    }


def case_of(flight: Document) -> tuple[Case, Seat]:
    """The model's case of a document of :func:`draw`."""
    seat = replace(IMPROVED, **flight["seat"])
    stiffness, down = flight["stiffness"], flight["force"] / flight["mass"]
    spring = (0.0, 0.0)
    gravity = flight["gravity"] + down
    if stiffness > 0:
        spring, gravity = (
            (stiffness, seat.seated_height - flight["force"] / stiffness),
            flight["gravity"],
        )
    case = Case(
        tuple(seat.walls()),
        seat.sphere_radius,
        flight["mass"],
        (0.0, -gravity),
        spring,
        flight["restitution"],
        flight["friction"],
    )
    return case, seat


def solve(flight: Document) -> Document:
    """The flight with what MuJoCo says of it."""
    case, seat = case_of(flight)
    sphere = Sphere(case)
    seats = seat.seats()
    along = (math.sin(flight["angle"]), math.cos(flight["angle"]))
    speed = flight["speed"]
    sphere.start(seats[0], (speed * along[0], speed * along[1]), flight["spin"])
    flown = sphere.fly(END)
    near = [math.dist(flown.place, centre) < 0.1 for centre in seats]
    name = "same" if near[0] else "other" if near[1] else "none"
    return {
        **flight,
        "found": {"seat": name, "place": flown.place, "time": flown.time, "rests": flown.rests}
        | {"first_touch": flown.first_contact},
    }


SHOCKS = [
    {"kind": kind, "length": length, "friction": friction}
    for kind, lengths in (("half-sine", (1.0, 2.0, 5.0)), ("sine", (2.0, 5.0, 20.0)))
    for length, friction in zip((*lengths, *lengths), (0.0,) * 3 + (0.3,) * 3, strict=True)
]
"""Length of a shock, or of a period of three, in ms; acceleration towards -x."""


AFTERWARDS = 20.0
"""How long a sphere may take over the saddle once a shock is over, ms: eight times the square root
of its radius over its fall, and a threshold is missed by a millionth."""


def threshold(shock: Document) -> Document:
    """The shock with the least amplitude in m/s^2 at which the sphere passes the middle.

    ``halved`` is that with half the time step: where the sphere bounces often between its flanks
    and friction turns it, the threshold is not sharper than they differ.
    """
    amplitude = _least(partial(_passes, shock, STEP), 60.0, 1.1)
    # the search begins where it does not pass
    halved = _least(partial(_passes, shock, STEP / 2), amplitude / 1.05, 1.02)
    return {**shock, "amplitude": amplitude, "halved": halved}


def _least(passes: Callable[[float], bool], start: float, ratio: float) -> float:
    """Least amplitude from ``start`` on that passes, found in steps of ``ratio``, to 1e-5."""
    low = high = start
    while not passes(high):
        low, high = high, ratio * high
    while high - low > 1e-5 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if passes(middle) else (middle, high)
    return high


def _passes(shock: Document, step: float, amplitude: float) -> bool:
    """Whether the sphere passes the middle, shaken with this amplitude in m/s^2."""
    flight = {**draw(0), "seat": {}, "force": 0.037, "stiffness": 0.0}
    flight |= {"restitution": 0.5, "friction": shock["friction"]}
    case, seat = case_of(flight)
    length = shock["length"]
    duration = length if shock["kind"] == "half-sine" else 3 * length
    rate = math.pi / length if shock["kind"] == "half-sine" else 2 * math.pi / length

    def shaken(time: float) -> tuple[float, float]:
        wave = math.sin(rate * time) if time < duration else 0.0
        # m/s^2 are 1e-3 mm/ms^2
        return -1e-3 * amplitude * wave, 0.0

    sphere = Sphere(replace(case, step=step))
    sphere.start(seat.seats()[0], (0.0, 0.0), 0.0)
    return sphere.passes(seat.saddle(), duration, duration + AFTERWARDS, shaken)


def _lines(document: Document) -> str:
    """JSON with a line for every flight and shock."""
    parts = []
    for key, value in document.items():
        listed = isinstance(value, list)
        text = ",\n".join(map(json.dumps, value)) if listed else json.dumps(value)
        parts.append(f"{json.dumps(key)}: [\n{text}\n]" if listed else f"{json.dumps(key)}: {text}")
    return "{" + ",\n".join(parts) + "}\n"


def report_flights(out: Path, number: int, progress: Progress) -> None:
    """Solve ``number`` random flights and the shocks, and store them in ``out`` (JSON)."""
    solved = []
    with ProcessPoolExecutor() as pool:
        shocks = pool.map(threshold, SHOCKS)
        for flight in pool.map(solve, map(draw, range(1, number + 1)), chunksize=4):
            solved.append(flight)
            progress.report("stepping", len(solved) / number, f"flight {len(solved)}")
        document = {
            "made_by": f"python -m fem_reference flights --number {number}",
            "units": "mm, ms, g, N; amplitudes m/s^2",
            "versions": {
                "mujoco": mujoco.__version__,
                "numpy": numpy.__version__,
            },
            "step": STEP,
            "flights": solved,
            "shocks": list(shocks),
        }
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(_lines(document), encoding="utf-8")
    progress.report("writing", 1.0, str(out))
