"""From a seal-seat scene to a solution on one mesh: mesh, assemble, step, and what it says."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.memory import SOLID, memory_needed, peak_memory, require_memory
from ..common.output import SAMPLES
from ..common.series import Report
from ..common.settings import Settings
from ..explicit.checkpoint import checkpoint_of
from ..explicit.frames import Recorder
from ..explicit.loop import Loop
from ..explicit.spectrum import first_frequency
from ..explicit.supervision import stable_run
from ..solid.system import make_loop
from .meshing import seat_mesh, sphere_mesh
from .model import SEAT, SeatModel, seat_model
from .run import SeatRun, account, integrate
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

HISTORY_COLUMNS = (
    "time",
    "sphere_displacement_x",
    "sphere_displacement_z",
    "sphere_velocity_x",
    "sphere_velocity_z",
    "sphere_force",
    "sphere_force_x",
    "sphere_force_z",
    "actuator_displacement",
    "actuator_velocity",
    "actuator_force",
)


@dataclass(frozen=True)
class Solution:
    """A run on one mesh."""

    run: SeatRun
    seat: SeatModel
    loop: Loop
    recorder: Recorder
    memory_stated: float
    """Before the run, bytes."""
    memory_used: float
    """At most so far, bytes."""

    @property
    def dofs(self) -> int:
        """Degrees of freedom, fixed ones included."""
        return 3 * int(self.loop.system.mass.size)


def method(scene: SeatScene) -> list[Any]:
    """What kept states and results depend on, mesh and step apart."""
    return [REVISION, scene.raw, scene.end_time]


def compute(
    scene: SeatScene, factor: float, settings: Settings, comm: Any, report: Report
) -> Solution:
    """Solve a scene with ``factor`` times the elements asked for, in every direction.

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
    nodes = int(seat.model.first[-1])
    report(
        "assembly",
        0.0,
        require_memory(nodes, SOLID[scene.element_order], comm, refinement=settings.refinement),
    )

    def attempt(most_levels: int) -> tuple[Loop, SeatRun, Recorder]:
        loop = make_loop(seat.model, comm, settings.threads)
        recorder = Recorder(settings, f"-{most_levels}")
        run = integrate(
            loop,
            seat,
            scene,
            courant=settings.courant,
            most_levels=most_levels,
            fields=recorder,
            checkpoint=checkpoint_of(settings, [*method(scene), most_levels], seat.model.meshes),
            on_progress=lambda done, message: report("stepping", done, message),
        )
        return loop, run, recorder

    loop, run, recorder = stable_run(
        attempt, lambda made: account(made[1], scene, len(made[0].levels))
    )
    needed = memory_needed(nodes, SOLID[scene.element_order], comm.size)
    return Solution(run, seat, loop, recorder, needed, peak_memory(comm))


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

    def end(contacts: tuple[tuple[float, float], ...]) -> float:
        return contacts[-1][1] if contacts else 0.0

    return {
        "efficiency": 0.5 * scene.sphere_mass * (x * x + z * z) / scene.initial_energy,
        "sphere_velocity_x": x,
        "sphere_velocity_z": z,
        "sphere_speed": math.hypot(x, z),
        "sphere_angle": math.atan2(x, z),
        "sphere_force_peak": run.sphere_force_peak,
        "actuator_force_peak": run.actuator_force_peak,
        "actuator_velocity_final": run.actuator_velocity,
        "sphere_contact_end": end(run.sphere_contacts),
        "actuator_contact_end": end(run.actuator_contacts),
        "left_flank_impulse": run.flank_impulses[0],
        "right_flank_impulse": run.flank_impulses[1],
        "first_frequency": seat_frequency(solution.loop, solution.seat),
    }


def sampling(times: Floats) -> Floats:
    """(samples,) evenly spaced instants of a history, from those of a run's raw samples, s."""
    stride = max(2, 2 * round((times.size - 1) / SAMPLES / 2))
    return np.asarray(times[::stride])


def history(times: Floats, rows: Floats, at: Floats) -> Floats:
    """Table (samples, 11) of `HISTORY_COLUMNS` at evenly spaced instants ``at``, s.

    Forces are impulse over interval, the interval centred on the sample; at both ends only its
    half inside the run counts. Beyond the run's end bodies fly on, and no force acts.

    Args:
        times: (m,) instants of the raw samples, s.
        rows: (m, 9) `run.COLUMNS`.
        at: instants wanted, s.
    """
    half = 0.5 * (at[1] - at[0])
    low, high = np.maximum(at - half, 0.0), np.minimum(at + half, at[-1])
    late = np.maximum(at - times[-1], 0.0)

    def sampled(column: int) -> Floats:
        return np.asarray(np.interp(at, times, rows[:, column]))

    def force(column: int) -> Floats:
        impulse = rows[:, column]
        change = np.interp(high, times, impulse) - np.interp(low, times, impulse)
        return np.asarray(change / (high - low))

    vx, vz, va = sampled(2), sampled(3), sampled(7)
    fx, fz = force(4), force(5)
    return np.column_stack(
        [
            at,
            sampled(0) + vx * late,
            sampled(1) + vz * late,
            vx,
            vz,
            np.hypot(fx, fz),
            fx,
            fz,
            sampled(6) + va * late,
            va,
            force(8),
        ]
    )
