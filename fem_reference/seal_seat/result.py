"""The result of a seal-seat reference: the same folder as those of plates."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..common import document
from ..common.output import write_history, write_json
from ..common.progress import Progress
from ..common.series import MeshResult, MeshSolver, Target, solve_series
from ..common.settings import RESOLUTIONS, Options, missed_instants
from ..common.uncertainty import bands
from ..common.versions import versions
from ..solid.elasticity import write_fields
from ..solid.machine import machine
from ..solid.mesh import mesh_report
from .mesh_file import record_geometry
from .run import contact_duration
from .scene import SeatScene
from .solve import HISTORY_COLUMNS, Solution, compute, history, method, quantities, sampling

RATIO = 0.8
"""Elements of neighbouring meshes, in every direction."""

TARGETED = tuple(map(Target, ("efficiency", "sphere_force_peak", "actuator_force_peak")))


def solve(
    scene: SeatScene,
    target: Path,
    resolution: str,
    comm: Any,
    options: Options,
    progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``.

    Raises:
        RunError: see `compute` and `solve_series`.
    """
    solver: MeshSolver[Solution] = MeshSolver(
        method=method(scene),
        end_time=scene.end_time,
        ratio=RATIO,
        targeted=TARGETED,
        compute=lambda factor, settings, report, _: compute(scene, factor, settings, comm, report),
        quantities=lambda solution: quantities(scene, solution),
        write=lambda folder, solution, meshes: _write(
            folder, scene, solution, resolution, meshes, options
        ),
    )
    solve_series(solver, target, RESOLUTIONS[resolution], comm, options, progress)


def _write_history(path: Path, meshes: list[MeshResult]) -> tuple[int, float]:
    """Curves and their bands; number of samples and their distance, s."""
    at = sampling(meshes[0].times)
    tables = np.stack([history(mesh.times, mesh.rows, at) for mesh in meshes])
    sizes = np.array([1.0 / mesh.factor for mesh in meshes])
    write_history(path, HISTORY_COLUMNS, tables[0], bands(tables[:, :, 1:], sizes)[2], digits=9)
    return int(at.size), float(at[1])


def _write(
    folder: Path,
    scene: SeatScene,
    solution: Solution,
    resolution: str,
    meshes: list[MeshResult],
    options: Options,
) -> None:
    run, model = solution.run, solution.seat.model
    found = versions()
    samples, interval = _write_history(folder / "history.csv", meshes)
    summary = document.summary(
        scene,
        resolution,
        run,
        meshes,
        TARGETED,
        {
            "versions": found,
            **machine(solution.loop, solution.memory_stated, solution.memory_used),
        },
        warnings=tuple(missed_instants(options.stress_times, float(run.times[-1]))),
        intended_angle=scene.intended_angle,
        mesh={
            **mesh_report([solution.seat.mesh]),
            "volume": solution.seat.mesh.volume(),
            "elements_per_ring_radius": scene.elements_per_ring_radius * meshes[0].factor,
        },
        samples=samples,
        sample_interval=interval,
        stress_times=write_fields(folder, model, solution.recorder),
    )
    losses: dict[str, Any] = {}
    if scene.friction > 0.0:
        losses["contacts"] = run.rubbed
    if run.relaxed is not None:
        # Of actuator, seat and sphere.
        losses["bodies"] = (0.0, run.relaxed, 0.0)
    if losses:
        none = {"plate_damping": 0.0, "squeeze_film": 0.0, "drag": 0.0}
        summary["losses"] = {**none, **losses}
    record_geometry(folder / "mesh.vtu", scene)
    write_json(folder / "summary.json", summary)
    provenance = document.provenance(
        scene,
        resolution,
        run,
        contact_duration(scene),
        found,
        {
            "element_order": scene.element_order,
            "uncertainty_companion_ratio": 1.0 / RATIO,
            "target_error": options.target_error,
        },
        geometry_hash=scene.geometry_hash,
        contacts={
            "sphere": [list(interval) for interval in run.sphere_contacts],
            "actuator": [list(interval) for interval in run.actuator_contacts],
        },
    )
    write_json(folder / "provenance.json", provenance)
