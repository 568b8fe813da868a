"""The result of a three-dimensional reference: the same folder as the axisymmetric one's."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..common import document
from ..common.output import write_json
from ..common.progress import Progress
from ..common.series import MeshResult, Options, Problem, solve_series
from ..common.settings import RESOLUTIONS
from ..common.versions import versions
from ..solid.fields import write_frames, write_mesh
from .axisymmetric_result import curve_uncertainty
from .convergence import TARGETED, curve_bands
from .history import history, write_history
from .scene import Scene
from .solid import Solution, compute, mesh_report, method, quantities

RATIO = 0.84
"""Elements of neighbouring meshes in every direction, as for axisymmetric references."""


def solve(
    scene: Scene,
    target: Path,
    resolution: str,
    comm: Any,
    options: Options,
    progress: Progress | None = None,
) -> None:
    """Solve a scene with solid geometry and write the result folder ``target``.

    Raises:
        RunError: see `compute` and `solve_series`.
    """
    problem: Problem[Solution] = Problem(
        method=method(scene),
        end_time=scene.end_time,
        ratio=RATIO,
        targeted=TARGETED,
        compute=lambda factor, settings, report: compute(scene, factor, settings, comm, report),
        quantities=lambda solution: quantities(scene, solution),
        write=lambda folder, solution, meshes: _write(
            folder, scene, solution, resolution, meshes, comm
        ),
    )
    solve_series(problem, target, RESOLUTIONS[resolution], comm, options, progress)


def _write(
    folder: Path,
    scene: Scene,
    solution: Solution,
    resolution: str,
    meshes: list[MeshResult],
    comm: Any,
) -> None:
    from ..common.fenicsx import alone

    run, model, duration = solution.run, solution.plate.model, solution.estimate.duration
    found = versions()
    table, interval = history(run)
    bands = curve_bands(meshes, [mesh.factor for mesh in meshes], duration)
    write_history(folder / "history.csv", table, bands)
    write_mesh(folder / "mesh.vtu", model)
    summary = document.summary(
        scene,
        resolution,
        run,
        meshes,
        document.machine(found, comm, solution),
        outer_contacts=run.contacts[0].count,
        inner_contacts=run.contacts[1].count,
        mesh=mesh_report(solution),
        samples=table.shape[0],
        sample_interval=interval,
        stress_times=write_frames(folder, model, solution.recorder.frames(), alone()),
    )
    summary["uncertainty"].update(curve_uncertainty(bands))
    write_json(folder / "summary.json", summary)
    provenance = document.provenance(
        scene,
        resolution,
        run,
        duration,
        found,
        {
            "element_order": scene.element_order,
            "rigid": list(scene.rigid),
            "contact_element": solution.plate.size,
            "contact_zone": solution.plate.zone,
            "meshes_tried": solution.meshes_tried,
            "estimate": asdict(solution.estimate),
            "uncertainty_companion_ratio": 1.0 / RATIO,
        },
        contacts={
            name: [list(interval) for interval in record.intervals]
            for name, record in zip(("outer", "inner"), run.contacts, strict=True)
        },
    )
    write_json(folder / "provenance.json", provenance)
