"""The result of a run: summary, uncertainty and provenance, written as one folder."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.output import result_folder, write_json, write_series
from ..common.progress import Progress
from ..common.settings import RESOLUTIONS, require_instants, require_share
from ..common.uncertainty import Estimate
from ..common.versions import versions
from ..explicit.contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from .axisymmetric import Solution
from .axisymmetric_fields import write_mesh, write_stress
from .convergence import QUANTITIES, Sequence, refine, solve_sequence
from .estimate import WAVE_FREQUENCY
from .history import HISTORY_COLUMNS, history, write_history
from .scene import Scene

SCHEMA_VERSION = 1


def convergence_part(
    meshes: list[dict[str, Any]], values: dict[str, Floats], estimates: dict[str, Estimate]
) -> dict[str, Any]:
    """What the meshes say together, per quantity; finest mesh first."""
    return {
        "rule": "least squares after Eca & Hoekstra 2014",
        "meshes": meshes,
        "quantities": {
            name: {
                "values": [float(value) for value in values[name]],
                "order": estimate.order,
                "extrapolated": estimate.extrapolated,
                "scatter": estimate.scatter,
                "band": estimate.band,
            }
            for name, estimate in estimates.items()
        },
    }


def _convergence(sequence: Sequence) -> dict[str, Any]:
    meshes = [
        {
            "factor": solution.factor,
            "dofs": 2 * int(solution.system.mass.size),
            "steps": solution.run.steps,
            "seconds": solution.run.loop_seconds,
            "energy_residual": solution.run.balance.energy_residual,
        }
        for solution in sequence.solutions
    ]
    part = convergence_part(meshes, sequence.values, sequence.estimates)
    return {**part, "relative_error": sequence.relative_error()}


def curve_uncertainty(bands: Floats) -> dict[str, float]:
    """Root mean square and largest half width of the bands (samples, 8) of the history's curves."""
    found = {}
    for name, band in zip(HISTORY_COLUMNS[1:], bands.T, strict=True):
        found[f"{name}_rms"] = float(np.sqrt(np.mean(band**2)))
        found[f"{name}_max"] = float(band.max())
    return found


def _summary(
    scene: Scene, sequence: Sequence, resolution_name: str, found: dict[str, str | None]
) -> dict[str, Any]:
    solution = sequence.finest
    run, mesh, resolution = solution.run, solution.mesh, solution.resolution
    nodes = int(solution.system.mass.size)
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    values = {name: float(sequence.values[name][0]) for name in QUANTITIES}
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
        "energy_residual": run.balance.energy_residual,
        "momentum_residual": run.balance.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": {name: sequence.estimates[name].band for name in QUANTITIES},
        "convergence": _convergence(sequence),
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
            "nodes_per_level": list(run.levels),
        },
        "residuals": {
            "energy": run.balance.energy_residual,
            "momentum": run.balance.momentum_residual,
            "contact_energy_loss": run.balance.contact_loss,
            "support_impulse": run.balance.support_impulse,
        },
    }


def solve(
    scene: Scene,
    target: Path,
    resolution_name: str,
    *,
    courant: float = 0.9,
    stress_times: tuple[float, ...] = (),
    target_error: float | None = None,
    progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``; see the package's README.

    Coarser meshes give the uncertainty. With ``target_error`` the mesh is refined from
    ``resolution_name`` on until the relative band of efficiency and force peaks is that small.

    Raises:
        RunError: see `compute`, `refine` and `output.result_folder`.
    """
    progress = progress if progress is not None else Progress()
    factor = RESOLUTIONS[resolution_name]
    require_instants(stress_times, scene.end_time)
    require_share(target_error)
    with result_folder(target) as folder:
        options: dict[str, Any] = {
            "courant": courant,
            "snapshot_times": stress_times,
            "progress": progress,
        }
        if target_error is None:
            sequence = solve_sequence(scene, factor, **options)
        else:
            sequence = refine(scene, factor, target_error, **options)
        solution = sequence.finest
        progress.report("writing", 0.0, "writing the results", series=1.0)
        found = versions()
        summary = _summary(scene, sequence, resolution_name, found)
        table, interval = history(solution.run)
        summary["samples"] = table.shape[0]
        summary["sample_interval"] = interval
        bands = sequence.curve_bands()
        summary["uncertainty"].update(curve_uncertainty(bands))
        write_history(folder / "history.csv", table, bands)
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
        provenance = _provenance(scene, solution, resolution_name, courant, found)
        provenance["settings"]["target_error"] = target_error
        write_json(folder / "provenance.json", provenance)
        progress.report("writing", 1.0, "done", series=1.0)


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
            "resolution_factor": solution.factor,
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
        },
        "versions": found,
        "residuals": {
            "energy": solution.run.balance.energy_residual,
            "momentum": solution.run.balance.momentum_residual,
            "contact_energy_loss": solution.run.balance.contact_loss,
        },
        "contacts": {
            name: [list(interval) for interval in record.intervals]
            for name, record in zip(("outer", "inner"), solution.run.contacts, strict=True)
        },
    }
