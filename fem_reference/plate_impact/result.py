"""The result of a plate impact: quantities, curves, and what only it states."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ..common.arrays import Floats
from ..common.bodies import Bender, Stack
from ..common.errors import SceneError
from ..common.output import write_history
from ..common.progress import Report
from ..common.settings import Options, Settings
from ..impact.history import Force, Level, Sampling, columns, curve_uncertainty, history
from ..impact.result import DIGITS, Details, ImpactSolver
from ..impact.series import MeshResult, Solved, Target, estimates
from .estimate import MINOR_FORCE, ContactEstimate
from .motion import SPHERES, Yielded
from .run import Run
from .scene import Scene

RATIO = 0.84
"""Elements of a mesh over those of the next finer one: four steps halve them."""

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
CURVES = (
    Level("outer_displacement", 0),
    Level("outer_velocity", 1),
    Force("outer_force", (2,)),
    Level("plate_displacement", 3),
    Level("plate_velocity", 4),
    Level("inner_displacement", 5),
    Level("inner_velocity", 6),
    Force("inner_force", (7,)),
)
"""Of the rows of `Motion.sample`."""
DENTED_SURFACES = ("outer_body", "plate_outer_face", "plate_inner_face", "inner_body")
MINOR = 0.05
"""Of the impact: what passes on less needs not be known to more digits than the impact itself."""
TARGETED = (
    Target("efficiency", small=MINOR),
    Target("outer_force_peak"),
    Target("inner_force_peak", small=MINOR, of="outer_force_peak"),
)

OF_NO_STACK = ("efficiency", "outer_velocity_final")
"""Eq. (1) relates to a kinetic energy before the impact; the tip of a stack vibrates on."""


def targeted(scene: Scene) -> tuple[Target, ...]:
    """The quantities whose relative band counts."""
    if isinstance(scene.outer, Stack):
        return (Target("inner_velocity_final"), *TARGETED[1:])
    return TARGETED


class Solution(Solved, Protocol):
    """A verified run on one mesh, of either geometry."""

    @property
    def program(self) -> str | None:
        """That made it; None: this package."""

    @property
    def run(self) -> Run:
        """The run; of a series the last one."""

    @property
    def runs(self) -> list[Run]:
        """Of all impacts."""

    @property
    def estimate(self) -> ContactEstimate:
        """Made before any mesh."""

    def first_frequency(self) -> float:
        """Lowest elastic eigenfrequency of the plate with its instantaneous modulus, Hz."""

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``."""

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""

    def settings(self) -> dict[str, Any]:
        """For the provenance."""

    def write_fields(self, folder: Path, scene: Scene) -> list[float]:
        """``mesh.vtu`` and the fields kept; their instants, s."""


def of_run(scene: Scene, run: Run) -> dict[str, float]:
    """Those of `QUANTITIES` that a run gives, SI; a contact that never closed ends at 0."""
    along = run.sideways.velocities if run.sideways else (0.0, 0.0)
    transmitted = scene.inner.mass * (run.inner_velocity**2 + along[1] ** 2)
    return {
        "efficiency": transmitted / (scene.outer.mass * scene.speed**2),
        "outer_velocity_final": run.outer_velocity,
        "inner_velocity_final": run.inner_velocity,
        "outer_force_peak": run.contacts[0].force_peak,
        "inner_force_peak": run.contacts[1].force_peak,
        "outer_contact_end": run.contacts[0].end or 0.0,
        "inner_contact_end": run.contacts[1].end or 0.0,
        **_sideways(run),
    }


def _sideways(run: Run) -> dict[str, float]:
    """Velocities (m/s) and spins (rad/s) that bodies struck beside the axis or obliquely have."""
    if run.sideways is None:
        return {}
    found = {}
    for row, name in enumerate(SPHERES):
        found[f"{name}_tangential_velocity_final"] = run.sideways.velocities[row]
        found[f"{name}_spin_final"] = run.sideways.spins[row]
    return found


def quantities(scene: Scene, solution: Solution) -> dict[str, float]:
    """`QUANTITIES`, SI, and of a series those `of_run` of each impact as "NUMBER/NAME"."""
    frequency = scene.plate.material.vibrating(solution.first_frequency())
    found = {**of_run(scene, solution.run), "first_frequency": frequency}
    if scene.series is not None:
        for number, run in enumerate(solution.runs, 1):
            impact = {**of_run(scene, run), **_of_yielding(run)}
            found |= {f"{number}/{name}": value for name, value in impact.items()}
    return found


def _of_yielding(run: Run) -> dict[str, float]:
    """Energy that went into yielding, J."""
    yielded = run.yielded or Yielded()
    return {"plastic_work": sum(yielded.work), "locked_in_energy": sum(yielded.locked_in)}


def _impacts(runs: list[Run], meshes: list[MeshResult]) -> list[dict[str, Any]]:
    """Rows of the summary's ``impacts``; what one that is cut leaves open is null."""
    found, rows = estimates(meshes), []
    for number, run in enumerate(runs, 1):
        names = [name for name in meshes[0].values if name.startswith(f"{number}/")]
        cut = run.in_contact_at_end
        rows.append(
            {
                "number": number,
                **{n.split("/")[1]: None if cut else meshes[0].values[n] for n in names},
                "first_frequency": meshes[0].values["first_frequency"],
                "outer_contacts": None if cut else run.contacts[0].count,
                "inner_contacts": None if cut else run.contacts[1].count,
                "energy_residual": run.energy_residual,
                "momentum_residual": run.momentum_residual,
                "uncertainty": {} if cut else {n.split("/")[1]: found[n].band for n in names},
            }
        )
    return rows


def solver(scene: Scene, comm: Any, options: Options) -> ImpactSolver[Any]:
    """How the scene is solved, by its geometry.

    Raises:
        SceneError: fields are requested of what yields, or CalculiX does not cover the scene.
    """
    if scene.yields and (options.stress_times or options.frame_times):
        raise SceneError(
            "fields are requested, but a material yields: the stress they show is the elastic one"
        )
    compute: Callable[[float, Settings, Report, Any], Any]
    leads: Callable[[Any], list[Any]] | None = None
    if options.solver == "calculix":
        from . import calculix
        from .calculix_model import require_supported

        require_supported(scene, options)
        compute, method = partial(calculix.compute, scene), calculix.method(scene)

        def leads(solution: Any) -> list[Any]:
            return [*solution.radii]

    elif scene.geometry == "solid":
        from . import solid

        def compute(factor: float, settings: Settings, report: Report, lead: Any) -> Any:
            return solid.compute(scene, factor, settings, comm, report)

        method = solid.method(scene)
    else:
        from . import axisymmetric

        compute, method = partial(axisymmetric.compute, scene), axisymmetric.method(scene)

        def leads(solution: Any) -> list[Any]:
            impacts = [len(solution.runs), solution.reach] if scene.yields else []
            return [*solution.radii, *solution.refinement, *impacts]

    return ImpactSolver(
        scene=scene,
        method=method,
        end_time=scene.end_time,
        ratio=RATIO,
        targeted=targeted(scene),
        compute=compute,
        quantities=partial(quantities, scene),
        curves=CURVES,
        details=partial(_details, scene),
        dimension=3 if scene.geometry == "solid" else 2,
        leads=leads,
        resumes=scene.geometry == "solid" or scene.series is not None,
    )


def _bender(bender: Bender, efficiency: float | None) -> dict[str, Any]:
    """How a bender was driven, and its strain energy's efficiency."""
    strike, beam = bender.strike, bender.beam
    return {
        "strain_energy_efficiency": None
        if efficiency is None
        else efficiency * strike.kinetic_energy / strike.strain_energy,
        "torque": strike.moment,
        "tip_deflection": strike.moment * beam.tip_deflection,
        "strain_energy": strike.strain_energy,
        "kinetic_energy": strike.kinetic_energy,
        "strike_delay": strike.time,
    }


def _stack(scene: Scene, solution: Solution) -> dict[str, Any]:
    """What a stack took and gave."""
    run = solution.run
    taken, given = run.stack or (0.0, 0.0)
    cut = run.in_contact_at_end
    transmitted = 0.5 * scene.inner.mass * run.inner_velocity**2
    return {
        "electrical_energy": taken,
        "mechanical_energy": given,
        "share": None if cut else transmitted / taken,
    }


def write_dents(path: Path, runs: list[Run]) -> None:
    """The surfaces at rest after each impact, comma-separated; see `Dents.profiles`."""
    columns = ("impact", "radius", *DENTED_SURFACES)
    profiles = [run.dents for run in runs if run.dents is not None]
    rows = [np.insert(profile, 0, k, axis=1) for k, profile in enumerate(profiles, 1)]
    write_history(path, columns, np.vstack(rows), np.zeros((sum(map(len, rows)), 0)), digits=6)


def _minor_contacts(run: Run, meshes: list[MeshResult]) -> list[str]:
    """A sentence about a contact with less force than any for which a mesh is made."""
    most = max(contact.force_peak for contact in run.contacts)
    found = estimates(meshes)
    return [
        f"the peak force of the {name} contact is only {100.0 * contact.force_peak / most:.2g} % "
        f"of the other contact's; meshes are made for {100.0 * MINOR_FORCE:g} % at least: its "
        f"95 % band is {100.0 * found[f'{name}_force_peak'].band / contact.force_peak:.2g} % wide"
        for name, contact in zip(SPHERES, run.contacts, strict=True)
        if 0.0 < contact.force_peak < MINOR_FORCE * most
    ]


def _details(
    scene: Scene, folder: Path, solution: Solution, meshes: list[MeshResult], bands: Floats
) -> Details:
    """See `ImpactSolver.details`."""
    return Details(
        contacts=SPHERES,
        duration=solution.estimate.duration,
        mesh=solution.mesh_report(),
        solver=solution.machine(),
        settings=solution.settings(),
        stress_times=solution.write_fields(folder, scene),
        summary=_special(scene, folder, solution, meshes),
        uncertainty=curve_uncertainty(CURVES, bands),
        undetermined=OF_NO_STACK if isinstance(scene.outer, Stack) else (),
        warnings=tuple(_minor_contacts(solution.run, meshes)),
    )


def _special(
    scene: Scene, folder: Path, solution: Solution, meshes: list[MeshResult]
) -> dict[str, Any]:
    """What a summary has besides, by the scene; writes dents and the histories of a series."""
    run, bodies = solution.run, zip(SPHERES, solution.run.contacts, strict=True)
    found: dict[str, Any] = {
        f"{name}_contacts": None if run.in_contact_at_end else contact.count
        for name, contact in bodies
    }
    if run.yielded is not None:
        found |= _of_yielding(run)
        write_dents(folder / "dents.csv", solution.runs)
    if scene.series is not None:
        found["impacts"] = _impacts(solution.runs, meshes)
        for number, impact in enumerate(solution.runs, 1):
            table = history(CURVES, impact, Sampling.on(impact.times))
            path, nothing = folder / f"impact-{number}.csv", np.zeros((table.shape[0], 0))
            write_history(path, columns(CURVES), table, nothing, DIGITS)
    if solution.program is not None:
        found |= {"source": "external", "model": solution.program}
    if isinstance(scene.outer, Bender):
        efficiency = None if run.in_contact_at_end else meshes[0].values["efficiency"]
        found["bender"] = _bender(scene.outer, efficiency)
    if isinstance(scene.outer, Stack):
        found["stack"] = _stack(scene, solution)
    return found
