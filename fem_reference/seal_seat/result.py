"""How a seal seat is solved on a series of meshes, and what only its result states."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from ..common.arrays import Floats
from ..impact.history import Sampling
from ..impact.result import Details, ImpactSolver
from ..impact.series import MeshResult, Target
from ..solid.elasticity import write_fields
from ..solid.mesh import mesh_report
from .mesh_file import record_geometry
from .run import contact_duration
from .scene import SeatScene
from .solve import CURVES, Solution, compute, method, quantities

RATIO = 0.8
"""Elements of neighbouring meshes, in every direction."""
TARGETED = tuple(map(Target, ("efficiency", "sphere_force_peak", "actuator_force_peak")))
DIGITS = 9
"""Of the history."""


def solver(scene: SeatScene, comm: Any) -> ImpactSolver[Solution]:
    """How the scene is solved."""
    return ImpactSolver(
        scene=scene,
        method=method(scene),
        end_time=scene.end_time,
        ratio=RATIO,
        targeted=TARGETED,
        compute=lambda factor, settings, report, _: compute(scene, factor, settings, comm, report),
        quantities=partial(quantities, scene),
        curves=CURVES,
        digits=DIGITS,
        sampling=lambda times: Sampling.on(times).of_others(),
        details=partial(_details, scene),
    )


def _details(
    scene: SeatScene, folder: Path, solution: Solution, meshes: list[MeshResult], bands: Floats
) -> Details:
    """See `ImpactSolver.details`."""
    seat = solution.seat
    stress_times = write_fields(folder, seat.model, solution.recorder)
    record_geometry(folder / "mesh.vtu", scene)
    return Details(
        contacts=("sphere", "actuator"),
        duration=contact_duration(scene),
        mesh={
            **mesh_report([seat.mesh]),
            "volume": seat.mesh.volume(),
            "elements_per_ring_radius": scene.elements_per_ring_radius * meshes[0].factor,
        },
        solver=solution.machine(),
        settings={"element_order": scene.element_order},
        stress_times=stress_times,
        summary={"intended_angle": scene.intended_angle},
        provenance={"geometry_hash": scene.geometry_hash},
    )
