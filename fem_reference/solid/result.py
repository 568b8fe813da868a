"""The result of a three-dimensional reference: the same folder as the axisymmetric one's."""

from __future__ import annotations

import json
import math
import shutil
from contextlib import nullcontext
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from ..convergence import QUANTITIES
from ..errors import SceneError
from ..output import history, result_folder, write_history, write_json
from ..progress import Progress
from ..result import SCHEMA_VERSION
from ..scene import Scene
from ..settings import RESOLUTIONS
from ..versions import versions
from .band import band
from .checkpoint import exclusive
from .fields import write_frames, write_mesh
from .solve import (
    REVISION,
    Report,
    Settings,
    Solution,
    compute,
    mesh_report,
    peak_memory,
    quantities,
)

RATIO = 1.4
"""Ratio of the element sizes of neighbouring meshes."""
MESHES = 3


def solve(
    scene: Scene,
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

    Two further runs, on meshes coarser by `RATIO` and its square, give the uncertainty. States
    and the coarser runs' results are kept in the folder ``checkpoint`` until the end.

    Args:
        scene: with ``geometry`` solid.
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
            scale = factor / RATIO**level
            coarser.append(
                _finished(scene, scale, settings, comm, f"coarser-{level}", reporter(label))
            )
        main = Settings(courant, folder, checkpoint_interval, frames, stress_times)
        solution = compute(scene, factor, main, comm, "main", reporter(""))
        values = quantities(scene, solution)
        memory = peak_memory(comm)
        if comm.rank == 0:
            progress.report("writing", 0.0, "writing the results")
            coarse, medium = coarser
            uncertainty = {
                name: band(values[name], medium[name], coarse[name], RATIO) for name in QUANTITIES
            }
            _write(partial, scene, solution, resolution_name, values, uncertainty, memory, comm)
            progress.report("writing", 1.0, "done")
            shutil.rmtree(folder, ignore_errors=True)
        comm.barrier()


def _finished(
    scene: Scene, factor: float, settings: Settings, comm: Any, label: str, report: Report
) -> dict[str, float]:
    """Quantities of a coarser run, from its file if an earlier start has come that far."""
    path = settings.checkpoint_folder / f"{label}.json"
    identity = {"revision": REVISION, "scene": scene.raw, "courant": settings.courant}
    identity["factor"] = factor
    saved = None
    if comm.rank == 0:
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            saved = document["quantities"] if document["identity"] == identity else None
        except (OSError, ValueError, KeyError):
            saved = None
    saved = comm.bcast(saved)
    if saved is not None:
        return dict(saved)
    values = quantities(scene, compute(scene, factor, settings, comm, label, report))
    if comm.rank == 0:
        settings.checkpoint_folder.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".partial-{path.name}")
        write_json(temporary, {"identity": identity, "quantities": values})
        temporary.replace(path)
    return values


def _write(
    folder: Path,
    scene: Scene,
    solution: Solution,
    resolution_name: str,
    values: dict[str, float],
    uncertainty: dict[str, float],
    memory: float,
    comm: Any,
) -> None:
    from ..fenicsx import alone

    run, model = solution.run, solution.plate.model
    found = versions()
    table, interval = history(run)
    write_history(folder / "history.csv", table)
    write_mesh(folder / "mesh.vtu", model)
    kept = solution.frames.frames() if solution.frames else []
    times = write_frames(folder, model, kept, alone())
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
        **{name: values[name] for name in QUANTITIES if name != "first_frequency"},
        "outer_contacts": run.contacts[0].count,
        "inner_contacts": run.contacts[1].count,
        "first_frequency": values["first_frequency"],
        "energy_residual": run.energy_residual,
        "momentum_residual": run.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": uncertainty,
        "mesh": mesh_report(solution),
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
        "samples": table.shape[0],
        "sample_interval": interval,
        "stress_times": times,
    }
    write_json(folder / "summary.json", summary)
    write_json(
        folder / "provenance.json",
        {
            "schema_version": SCHEMA_VERSION,
            "created": datetime.now(UTC).isoformat(timespec="seconds"),
            "scene": scene.raw,
            "scene_hash": scene.scene_hash,
            "settings_hash": scene.settings_hash,
            "settings": {
                "resolution": resolution_name,
                "resolution_factor": RESOLUTIONS[resolution_name],
                "courant": run.time_step / run.critical_time_step,
                "element_order": scene.element_order,
                "rigid": list(scene.rigid),
                "contact_element": solution.plate.size,
                "contact_zone": solution.plate.zone,
                "meshes_tried": solution.meshes_tried,
                "estimate": asdict(solution.estimate),
                "peak_window": PEAK_WINDOW_FRACTION * solution.estimate.duration,
                "chatter_limit": CHATTER_FRACTION * solution.estimate.duration,
                "uncertainty_companion_ratio": RATIO,
            },
            "versions": found,
            "residuals": residuals,
            "contacts": {
                name: [list(interval) for interval in record.intervals]
                for name, record in zip(("outer", "inner"), run.contacts, strict=True)
            },
        },
    )
