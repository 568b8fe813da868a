"""Both equations of motion by LSODA (SciPy), a multistep method; the reduced model's is not."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from ..common.arrays import Floats
from ..common.errors import SolverError
from ..common.hertz import hertz_approach
from ..explicit.records import ContactRecord
from ..impact.history import Force, Level
from ..impact.result import Details, ImpactSolver
from ..impact.run import ImpactRun
from ..impact.series import Target
from .scene import SpringScene

SAMPLES, STEPS = 2000, 100
"""In the contact with a free mass; steps: at least, at `paper` resolution."""
PERIODS = 1000.0
"""Of the mass on its spring, after which a run is given up."""
CURVES = (
    Level("sphere_displacement", 0, rate=1),
    Level("sphere_velocity", 1),
    Level("mass_displacement", 2),
    Level("mass_velocity", 3),
    Force("sphere_force", (4,)),
)
"""Of displacement and velocity of the sphere and of the mass, and the impulse of the contact."""


@dataclass(frozen=True)
class Solution:
    """A run."""

    run: ImpactRun
    values: dict[str, float]
    dofs: int = 4
    """Of two nodes with two components each; those along the radius are fixed."""


def _duration(scene: SpringScene) -> float:
    """Of the contact with a free mass (Hertz), s."""
    sphere, mass = scene.sphere, scene.mass
    effective = sphere.mass * mass.mass / (sphere.mass + mass.mass)
    return 2.9432 * hertz_approach(effective, sphere.speed, scene.contact_stiffness) / sphere.speed


def compute(scene: SpringScene, factor: float) -> Solution:
    """Solve with ``factor`` times the steps asked for."""
    sphere, mass, k = scene.sphere, scene.mass, scene.contact_stiffness
    omega, duration = math.sqrt(mass.stiffness / mass.mass), _duration(scene)

    def rate(_: float, state: Floats) -> list[float]:
        x, v, y, w, _ = state
        force = k * max(x - y, 0.0) ** 1.5
        spring = mass.stiffness * y
        return [v, -force / sphere.mass, w, (force - spring) / mass.mass, spring]

    def clear(_: float, state: Floats) -> float:
        """Falls through zero where the sphere leaves all that the mass can reach."""
        return float(state[0] + math.hypot(state[2], state[3] / omega))

    clear.terminal, clear.direction = scene.end_time is None, -1.0  # type: ignore[attr-defined]
    begun, scale = (time.perf_counter(), time.process_time()), sphere.speed * duration
    size = [scale, sphere.speed, scale, sphere.speed, sphere.mass * sphere.speed]
    found = solve_ivp(
        rate,
        (0.0, scene.end_time or 2.0 * math.pi * PERIODS / omega),
        [0.0, sphere.speed, 0.0, 0.0, 0.0],
        method="LSODA",
        dense_output=True,
        events=clear,
        max_step=duration / (STEPS * factor),
        rtol=1e-10,
        atol=1e-10 * np.array(size),
    )
    if not found.success or (scene.end_time is None and found.status != 1):
        raise SolverError(f"the impact has not ended after {found.t[-1]:.3g} s: {found.message}")
    spent = (time.perf_counter() - begun[0], time.process_time() - begun[1])
    times = np.linspace(0.0, found.t[-1], 1 + math.ceil(found.t[-1] / duration * SAMPLES))
    x, v, y, w, impulse = found.sol(times)
    approach, lost = np.maximum(x - y, 0.0), sphere.mass * (sphere.speed - v)
    contact = _contact(times, x - y, k * approach**1.5, float(lost[-1]))
    initial, cut = 0.5 * sphere.mass * sphere.speed**2, bool(approach[-1] > 0.0)
    given = 0.5 * (mass.mass * w[-1] ** 2 + mass.stiffness * y[-1] ** 2)
    after = given + 0.5 * sphere.mass * v[-1] ** 2 + 0.4 * k * approach[-1] ** 2.5
    run = ImpactRun(
        times=times,
        rows=np.column_stack([x, v, y, w, lost]),
        contacts=(contact,),
        in_contact_at_end=cut,
        time_step=float(np.diff(found.t).max()),
        steps=found.t.size - 1,
        loop_seconds=spent[0],
        processor_seconds=spent[1],
        initial_energy=initial,
        energy_residual=float(abs(after / initial - 1.0)),
        momentum_residual=float(
            abs(mass.mass * w[-1] + impulse[-1] - lost[-1]) / (sphere.mass * sphere.speed)
        ),
        support_impulse=float(impulse[-1]),
    )
    values = {
        "efficiency": float(given / initial),
        "sphere_velocity_final": float(v[-1]),
        "sphere_force_peak": contact.force_peak,
        "sphere_contact_end": contact.end or 0.0,
    }
    return Solution(run, values)


def _contact(times: Floats, approach: Floats, force: Floats, impulse: float) -> ContactRecord:
    """From samples, between which the approach is taken as straight."""
    change = np.flatnonzero(np.diff(approach > 0.0))
    share = approach[change] / (approach[change] - approach[change + 1])
    ends = [*(times[change] + share * (times[change + 1] - times[change]))]
    if approach[-1] > 0.0:
        ends.append(times[-1])
    spans = tuple((float(a), float(b)) for a, b in zip(ends[::2], ends[1::2], strict=True))
    return ContactRecord(len(spans), spans[-1][1], spans, float(force.max()), impulse, 0.0)


def solver(scene: SpringScene) -> ImpactSolver[Solution]:
    """How the scene is solved."""

    def details(*_: Any) -> Details:
        return Details(contacts=("sphere",), duration=_duration(scene))

    return ImpactSolver(
        scene=scene,
        method=[1, scene.raw],
        end_time=scene.end_time,
        ratio=0.8,
        targeted=(Target("efficiency"), Target("sphere_force_peak")),
        compute=lambda factor, *_: compute(scene, factor),
        quantities=lambda solution: solution.values,
        curves=CURVES,
        details=details,
    )
