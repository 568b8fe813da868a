"""The result of a run: summary, uncertainty and provenance, written as one folder."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from .contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from .errors import SceneError
from .meshing import RESOLUTIONS
from .modal import first_frequency
from .output import (
    history,
    result_folder,
    write_history,
    write_json,
    write_mesh,
    write_series,
    write_stress,
)
from .progress import Progress
from .scene import Scene
from .solve import WAVE_FREQUENCY, Solution, compute
from .uncertainty import two_grid_uncertainty
from .versions import versions

SCHEMA_VERSION = 1
COMPANION_RATIO = 1.5
"""Element size of the mesh that gives the uncertainty over that of the main one."""

QUANTITIES = (
    "efficiency",
    "outer_velocity_final",
    "inner_velocity_final",
    "outer_force_peak",
    "inner_force_peak",
    "outer_contact_end",
    "inner_contact_end",
    "first_frequency",
)


def quantities(scene: Scene, solution: Solution) -> dict[str, float]:
    """The summary's physical quantities, SI; a contact that never closed ends at 0."""
    run = solution.run
    return {
        "efficiency": scene.inner.mass
        * run.inner_velocity**2
        / (scene.outer.mass * scene.speed**2),
        "outer_velocity_final": run.outer_velocity,
        "inner_velocity_final": run.inner_velocity,
        "outer_force_peak": run.contacts[0].force_peak,
        "inner_force_peak": run.contacts[1].force_peak,
        "outer_contact_end": run.contacts[0].end or 0.0,
        "inner_contact_end": run.contacts[1].end or 0.0,
        "first_frequency": first_frequency(solution.system),
    }


def _summary(
    scene: Scene,
    solution: Solution,
    resolution_name: str,
    uncertainty: dict[str, float],
    found: dict[str, str | None],
) -> dict[str, Any]:
    run, mesh, resolution = solution.run, solution.mesh, solution.resolution
    nodes = int(solution.system.mass.size)
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    values = quantities(scene, solution)
    return {
        "schema_version": SCHEMA_VERSION,
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "source": "reference",
        "model": None,
        "modes": None,
        "resolution": resolution_name,
        **{key: values[key] for key in QUANTITIES if key != "first_frequency"},
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
        "mesh": {
            "nodes": nodes,
            "dofs": 2 * nodes,
            "elements": sum(body.quads.shape[0] for body in bodies),
            "elements_per_contact_radius": {
                "outer": resolution.outer if math.isfinite(resolution.outer) else None,
                "inner": resolution.inner if math.isfinite(resolution.inner) else None,
            },
            "elements_per_wavelength": resolution.per_wavelength,
            "wavelength": resolution.wavelength,
            "smallest_element": resolution.smallest,
            "largest_element": resolution.largest,
            "min_quality": mesh.min_quality,
        },
        "solver": {
            "versions": found,
            "time_step": run.time_step,
            "critical_time_step": run.critical_time_step,
            "courant": run.time_step / run.critical_time_step,
        },
        "residuals": {
            "energy": run.energy_residual,
            "momentum": run.momentum_residual,
            "contact_energy_loss": run.contact_loss,
            "support_impulse": run.support_impulse,
        },
    }


def solve(
    scene: Scene,
    target: Path,
    resolution_name: str,
    *,
    courant: float = 0.9,
    stress_times: tuple[float, ...] = (),
    progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``; see the package's README.

    A second run on a mesh with 2/3 of the elements in each direction gives the uncertainty.

    Raises:
        RunError: see `compute` and `output.result_folder`.
    """
    progress = progress if progress is not None else Progress()
    factor = RESOLUTIONS[resolution_name]
    for instant in stress_times:
        if not 0.0 <= instant < math.inf or (scene.end_time and instant > scene.end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")
    with result_folder(target) as folder:
        coarser = compute(
            scene,
            factor / COMPANION_RATIO,
            courant=courant,
            progress=progress,
            label="coarser mesh for the uncertainty: ",
            verify_waves=False,
        )
        solution = compute(
            scene, factor, courant=courant, snapshot_times=stress_times, progress=progress
        )
        progress.report("writing", 0.0, "writing the results")
        fine, coarse = quantities(scene, solution), quantities(scene, coarser)
        uncertainty = {
            name: two_grid_uncertainty(fine[name], coarse[name], COMPANION_RATIO)
            for name in QUANTITIES
        }
        found = versions()
        summary = _summary(scene, solution, resolution_name, uncertainty, found)
        table, interval = history(solution.run)
        summary["samples"] = table.shape[0]
        summary["sample_interval"] = interval
        write_history(folder / "history.csv", table)
        write_mesh(folder / "mesh.vtu", solution.mesh)
        for number, snapshot in enumerate(solution.run.snapshots):
            write_stress(
                folder / f"stress_{number:03d}.vtu", scene, solution.mesh, solution.system, snapshot
            )
        instants = [snapshot.time for snapshot in solution.run.snapshots]
        if instants:
            names = [f"stress_{number:03d}.vtu" for number in range(len(instants))]
            write_series(folder / "stress.pvd", instants, names)
        summary["stress_times"] = instants
        write_json(folder / "summary.json", summary)
        write_json(
            folder / "provenance.json",
            _provenance(scene, solution, resolution_name, courant, found),
        )
        progress.report("writing", 1.0, "done")


def _provenance(
    scene: Scene,
    solution: Solution,
    resolution_name: str,
    courant: float,
    found: dict[str, str | None],
) -> dict[str, Any]:
    settings = solution.mesh.settings
    return {
        "schema_version": SCHEMA_VERSION,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "scene": scene.raw,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "settings": {
            "resolution": resolution_name,
            "resolution_factor": RESOLUTIONS[resolution_name],
            "courant": courant,
            "contact_element": settings.contact_element,
            "contact_elements": settings.contact_elements,
            "contact_zone": settings.contact_zone,
            "plate_element": settings.plate_element,
            "through_element": settings.through_element,
            "growth": settings.growth,
            "through_growth": settings.through_growth,
            "meshes_tried": solution.meshes_tried,
            "estimated_contact_radius": {
                "outer": solution.estimate.outer_radius,
                "inner": solution.estimate.inner_radius,
            },
            "wave_frequency": WAVE_FREQUENCY / solution.estimate.duration,
            "peak_window": PEAK_WINDOW_FRACTION * solution.estimate.duration,
            "chatter_limit": CHATTER_FRACTION * solution.estimate.duration,
            "uncertainty_companion_ratio": COMPANION_RATIO,
        },
        "versions": found,
        "residuals": {
            "energy": solution.run.energy_residual,
            "momentum": solution.run.momentum_residual,
            "contact_energy_loss": solution.run.contact_loss,
        },
        "contacts": {
            name: [list(interval) for interval in record.intervals]
            for name, record in zip(("outer", "inner"), solution.run.contacts, strict=True)
        },
    }
