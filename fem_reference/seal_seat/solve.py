"""From a seal-seat scene to a solution on one mesh: mesh, assemble, step, quantities, curves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.loop import Loop
from ..explicit.spectrum import first_frequency
from ..impact.history import Force, Level
from ..solid.stepping import Stepped, stepped
from .meshing import seat_mesh, sphere_mesh
from .model import SEAT, SeatModel, seat_model
from .run import SeatRun, integrate
from .scene import SeatScene

REVISION = 3
"""Counts changes of the method that make older checkpoints useless."""

QUANTITIES = (
    "efficiency",
    "sphere_velocity_x",
    "sphere_velocity_z",
    "sphere_speed",
    "sphere_angle",
    "sphere_force_peak",
    "actuator_force_peak",
    "actuator_velocity_final",
    "sphere_contact_end",
    "actuator_contact_end",
    "left_flank_impulse",
    "right_flank_impulse",
    "first_frequency",
)

CURVES = (
    Level("sphere_displacement_x", 0, rate=2),
    Level("sphere_displacement_z", 1, rate=3),
    Level("sphere_velocity_x", 2),
    Level("sphere_velocity_z", 3),
    Force("sphere_force", (4, 5)),
    Force("sphere_force_x", (4,)),
    Force("sphere_force_z", (5,)),
    Level("actuator_displacement", 6, rate=7),
    Level("actuator_velocity", 7),
    Force("actuator_force", (8,)),
)
"""Of the samples `run.COLUMNS`."""


@dataclass(frozen=True, kw_only=True)
class Solution(Stepped[SeatRun]):
    """A run on one mesh."""

    seat: SeatModel


def method(scene: SeatScene) -> list[Any]:
    """What kept states and results depend on, mesh and step apart."""
    return [REVISION, scene.raw, scene.end_time]


def compute(
    scene: SeatScene, factor: float, settings: Settings, comm: Any, report: Report
) -> Solution:
    """Solve a scene with ``factor`` times the elements requested, in every direction.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, or there is too little memory.
    """
    report("mesh", 0.0, "meshing")
    # gmsh runs in one process; the others wait.
    made = None
    if comm.rank == 0:
        sphere = sphere_mesh(scene, factor) if scene.sphere_elastic else None
        made = seat_model(scene, seat_mesh(scene, factor), sphere)
    seat: SeatModel = comm.bcast(made)

    def step(loop: Loop, **options: Any) -> SeatRun:
        return integrate(loop, seat, scene, **options)

    done = stepped(seat.model, method(scene), settings, comm, report, step)
    return Solution(**vars(done), seat=seat)


def seat_frequency(loop: Loop, seat: SeatModel) -> float:
    """First eigenfrequency of the seat with clamped rim, symmetric about y = 0, Hz.

    That of the storage modulus at it, where the seat relaxes.
    """
    # Lifting and rocking together: the lowest mode is one of both or a mixture.
    start = np.zeros((loop.system.mass.size, 3))
    x = seat.mesh.points[:, 0]
    start[: x.size, 2] = 1.0 + x / np.abs(x).max()
    instantaneous = first_frequency(loop, SEAT, start=loop.own(start))
    return seat.model.elastic[SEAT].material.vibrating(instantaneous)


def quantities(scene: SeatScene, solution: Solution) -> dict[str, float]:
    """The summary's physical quantities, SI; a contact that never closed ends at 0."""
    run = solution.run
    x, z = run.sphere_velocity
    sphere, actuator = run.contacts
    found = {
        "efficiency": 0.5 * scene.sphere_mass * (x * x + z * z) / scene.initial_energy,
        "sphere_velocity_x": x,
        "sphere_velocity_z": z,
        "sphere_speed": math.hypot(x, z),
        "sphere_angle": math.atan2(x, z),
        "sphere_force_peak": sphere.force_peak,
        "actuator_force_peak": actuator.force_peak,
        "actuator_velocity_final": run.actuator_velocity,
        "sphere_contact_end": sphere.end or 0.0,
        "actuator_contact_end": actuator.end or 0.0,
        "left_flank_impulse": run.flank_impulses[0],
        "right_flank_impulse": run.flank_impulses[1],
        "first_frequency": seat_frequency(solution.loop, solution.seat),
    }
    if scene.friction > 0.0 and run.sphere_spin is not None:
        found["sphere_spin"] = run.sphere_spin
    return found
