"""The result of a seal-seat reference: the same folder as those of plates."""

from __future__ import annotations

import json
import math
import shutil
from contextlib import nullcontext
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, cast

import numpy as np

from ..contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from ..errors import SceneError
from ..mesh import Floats
from ..output import result_folder, write_json
from ..progress import Progress
from ..result import SCHEMA_VERSION
from ..settings import RESOLUTIONS
from ..solid.checkpoint import exclusive
from ..solid.fields import write_frames, write_mesh
from ..solid.solve import Report, Settings, peak_memory
from ..uncertainty import Estimate, curve_band, least_squares
from ..versions import versions
from .mesh_file import mesh_report
from .run import contact_duration
from .scene import SeatScene
from .solve import (
    HISTORY_COLUMNS,
    QUANTITIES,
    REVISION,
    Solution,
    compute,
    history,
    quantities,
    sampling,
)

RATIO = 0.8
"""Elements of neighbouring meshes, in every direction."""
MESHES = 5
BAND_REACH = 0.02
"""Reach of a curve's band over the estimated duration of the actuator's contact."""


@dataclass(frozen=True)
class Mesh:
    """What a run on one mesh leaves for the bands."""

    factor: float
    values: dict[str, float]
    times: Floats
    rows: Floats
    numbers: dict[str, Any]
    """For the summary: dofs, steps, seconds, energy residual."""


def solve(
    scene: SeatScene,
    target: Path,
    resolution_name: str,
    comm: Any,
    *,
    courant: float = 0.9,
    stress_times: tuple[float, ...] = (),
    frames: int = 0,
    checkpoint: Path | None = None,
    checkpoint_interval: float = 60.0,
    progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``.

    `MESHES` - 1 further runs on coarser meshes give the uncertainty. States and the coarser runs'
    results are kept in the folder ``checkpoint`` until the end.

    Args:
        scene: what to solve.
        target: result folder.
        resolution_name: a key of `RESOLUTIONS`.
        comm: the processes' communicator.
        courant: time step over the critical one.
        stress_times: instants at which fields are written, s.
        frames: fields are written at least so many times, evenly over the run; 0: not.
        checkpoint: folder; by default ``.checkpoint-<name>`` beside ``target``.
        checkpoint_interval: wall-clock time between checkpoints, s.
        progress: where to report.

    Raises:
        RunError: see `compute` and `output.result_folder`.
    """
    progress = progress if progress is not None else Progress()
    for instant in stress_times:
        if not 0.0 <= instant < math.inf or (scene.end_time and instant > scene.end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")
    folder = checkpoint or target.absolute().parent / f".checkpoint-{target.name}"
    settings = Settings(courant, folder, checkpoint_interval)
    factor = RESOLUTIONS[resolution_name]

    def reporter(label: str) -> Report:
        def report(phase: str, done: float, message: str) -> None:
            if comm.rank == 0:
                progress.report(phase, done, label + message)

        return report

    def waiting() -> None:
        progress.report("waiting", 0.0, "another run of this solution is under way")

    with (
        exclusive(folder, comm, waiting),
        result_folder(target) if comm.rank == 0 else nullcontext(target) as partial,
    ):
        coarser = []
        for level in range(MESHES - 1, 0, -1):
            label = f"mesh {MESHES - level} of {MESHES}, for the uncertainty: "
            scale = factor * RATIO**level
            coarser.append(
                _finished(scene, scale, settings, comm, f"coarser-{level}", reporter(label))
            )
        main = Settings(courant, folder, checkpoint_interval, frames, stress_times)
        solution = compute(scene, factor, main, comm, "main", reporter(""))
        finest = _kept(scene, solution, factor)
        memory = peak_memory(comm)
        if comm.rank == 0:
            progress.report("writing", 0.0, "writing the results")
            meshes = [finest, *reversed(coarser)]
            _write(partial, scene, solution, resolution_name, meshes, memory, comm)
            progress.report("writing", 1.0, "done")
            shutil.rmtree(folder, ignore_errors=True)
        comm.barrier()


def _kept(scene: SeatScene, solution: Solution, factor: float) -> Mesh:
    run = solution.run
    numbers = {
        "factor": factor,
        "dofs": 3 * int(solution.seat.mesh.points.shape[0]),
        "steps": run.steps,
        "seconds": run.loop_seconds,
        "energy_residual": run.energy_residual,
    }
    return Mesh(factor, quantities(scene, solution), run.times, run.rows, numbers)


def _finished(
    scene: SeatScene, factor: float, settings: Settings, comm: Any, label: str, report: Report
) -> Mesh:
    """A coarser run, from its files if an earlier start has come that far."""
    path = settings.checkpoint_folder / f"{label}.json"
    identity = {"revision": REVISION, "scene": scene.raw, "courant": settings.courant}
    identity["factor"] = factor
    found = _load(path, identity) if comm.rank == 0 else None
    found = cast("Mesh | None", comm.bcast(found))
    if found is not None:
        return found
    made = _kept(scene, compute(scene, factor, settings, comm, label, report), factor)
    if comm.rank == 0:
        settings.checkpoint_folder.mkdir(parents=True, exist_ok=True)
        curves = path.with_name(f"{label}-curves.npz")
        np.savez(curves, times=made.times, rows=made.rows)
        # The description is written last: without it the curves are not used.
        temporary = path.with_name(f".partial-{path.name}")
        document = {"identity": identity, "quantities": made.values, "numbers": made.numbers}
        write_json(temporary, document)
        temporary.replace(path)
    return made


def _load(path: Path, identity: dict[str, Any]) -> Mesh | None:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if document["identity"] != identity:
            return None
        with np.load(path.with_name(f"{path.stem}-curves.npz"), allow_pickle=False) as file:
            times, rows = file["times"], file["rows"]
        factor = float(identity["factor"])
        return Mesh(factor, document["quantities"], times, rows, document["numbers"])
    except (OSError, ValueError, KeyError):
        return None


def _estimates(meshes: list[Mesh]) -> dict[str, Estimate]:
    """Per quantity; finest mesh first."""
    sizes = np.array([1.0 / mesh.factor for mesh in meshes])
    return {
        name: least_squares(np.array([mesh.values[name] for mesh in meshes]), sizes)
        for name in QUANTITIES
    }


def _write_history(path: Path, scene: SeatScene, meshes: list[Mesh]) -> tuple[int, float]:
    """Curves and their bands; number of samples and their distance, s."""
    finest = meshes[0]
    at = sampling(finest.times)
    tables = [history(mesh.times, mesh.rows, at) for mesh in meshes]
    sizes = np.array([1.0 / mesh.factor for mesh in meshes])
    reach = max(1, round(BAND_REACH * contact_duration(scene) / float(at[1])))
    bands = np.column_stack(
        [
            curve_band(np.stack([table[:, column] for table in tables]), sizes, reach)
            for column in range(1, len(HISTORY_COLUMNS))
        ]
    )
    names = [*HISTORY_COLUMNS, *(f"{name}_band" for name in HISTORY_COLUMNS[1:])]
    formats = ["%.9g"] * len(HISTORY_COLUMNS) + ["%.3g"] * bands.shape[1]
    table = np.column_stack([tables[0], bands])
    np.savetxt(path, table, fmt=formats, delimiter=",", header=",".join(names), comments="")
    return int(at.size), float(at[1])


def _write(
    folder: Path,
    scene: SeatScene,
    solution: Solution,
    resolution_name: str,
    meshes: list[Mesh],
    memory: float,
    comm: Any,
) -> None:
    from ..fenicsx import alone

    run, model = solution.run, solution.seat.model
    found = versions()
    samples, interval = _write_history(folder / "history.csv", scene, meshes)
    write_mesh(folder / "mesh.vtu", model)
    kept = solution.frames.frames() if solution.frames else []
    times = write_frames(folder, model, kept, alone())
    estimates = _estimates(meshes)
    residuals = {
        "energy": run.energy_residual,
        "momentum": run.momentum_residual,
        "contact_energy_loss": run.contact_loss,
        "support_impulse": run.support_impulse,
    }
    summary = {
        "schema_version": SCHEMA_VERSION,
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "source": "reference",
        "model": None,
        "modes": None,
        "resolution": resolution_name,
        **meshes[0].values,
        "intended_angle": scene.intended_angle,
        "energy_residual": run.energy_residual,
        "momentum_residual": run.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": {name: estimates[name].band for name in QUANTITIES},
        "convergence": {
            "rule": "least squares after Eca & Hoekstra 2014",
            "meshes": [mesh.numbers for mesh in meshes],
            "quantities": {
                name: {
                    "values": [mesh.values[name] for mesh in meshes],
                    "order": estimate.order,
                    "extrapolated": estimate.extrapolated,
                    "scatter": estimate.scatter,
                    "band": estimate.band,
                }
                for name, estimate in estimates.items()
            },
        },
        "mesh": {
            **mesh_report(solution.seat.mesh),
            "elements_per_ring_radius": scene.elements_per_ring_radius * meshes[0].factor,
        },
        "solver": {
            "versions": found,
            "time_step": run.time_step,
            "critical_time_step": run.critical_time_step,
            "courant": run.time_step / run.critical_time_step,
            "processes": comm.size,
            "peak_memory": memory,
            "memory_stated": solution.needed_memory,
            "contact_sweeps_per_step": run.sweeps_per_step,
            "contact_unconverged_steps": run.unconverged,
        },
        "residuals": residuals,
        "samples": samples,
        "sample_interval": interval,
        "stress_times": times,
    }
    write_json(folder / "summary.json", summary)
    duration = contact_duration(scene)
    write_json(
        folder / "provenance.json",
        {
            "schema_version": SCHEMA_VERSION,
            "created": datetime.now(UTC).isoformat(timespec="seconds"),
            "scene": scene.raw,
            "scene_hash": scene.scene_hash,
            "settings_hash": scene.settings_hash,
            "geometry_hash": scene.geometry_hash,
            "settings": {
                "resolution": resolution_name,
                "resolution_factor": RESOLUTIONS[resolution_name],
                "courant": run.time_step / run.critical_time_step,
                "element_order": scene.element_order,
                "peak_window": PEAK_WINDOW_FRACTION * duration,
                "chatter_limit": CHATTER_FRACTION * duration,
                "uncertainty_companion_ratio": 1.0 / RATIO,
            },
            "versions": found,
            "residuals": residuals,
            "contacts": {
                "sphere": [list(interval) for interval in run.sphere_contacts],
                "actuator": [list(interval) for interval in run.actuator_contacts],
            },
        },
    )
