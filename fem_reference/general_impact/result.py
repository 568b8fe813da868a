"""How an impact is solved on a series of meshes, and what only its result states."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from ..common.arrays import Floats
from ..common.settings import Options
from ..impact.history import Force, Level, curve_uncertainty
from ..impact.result import Details, ImpactSolver
from ..impact.series import MeshResult, Solved, Target
from . import solve as explicit
from .estimate import Sizes
from .model import ImpactModel
from .run import Run
from .scene import Scene
from .struck import first_echo

RATIO = 0.88
"""Elements of a mesh over those of the next finer one, in every direction."""
MINOR = 0.05
"""Of the impact: what passes on less needs not be known to more digits than the impact itself."""
KEPT = 0.1
"""Share of a body's volume on one and the same elements from which on a band says too little."""
CURVES = (
    Level("outer_displacement", 0),
    Level("inner_displacement", 3),
    Level("outer_velocity", 1),
    Level("inner_velocity", 4),
    Force("outer_force", (2,)),
    Force("inner_force", (5,)),
)
"""Of the rows of `Motion.sample`."""
TARGETED = (
    Target("efficiency", small=MINOR),
    Target("outer_restitution", small=1.0),
    Target("outer_force_peak"),
    Target("inner_force_peak", small=MINOR, of="outer_force_peak"),
)


OF_SOME_SCENES = (
    *("efficiency", "inner_velocity_final", "inner_force_peak", "inner_contact_end"),
    *("inner_contacts", "inner_restitution", "inner_impulse", "first_frequency"),
)
"""Quantities that a scene may lack; its summary has them as null."""


def curves(scene: Scene) -> tuple[Level | Force, ...]:
    """Those that the scene has."""
    return tuple(curve for curve in CURVES if scene.has(curve.name))


class Solution(Solved, Protocol):
    """A verified run on one mesh, by this package or by another program."""

    @property
    def run(self) -> Run:
        """The run."""

    @property
    def made(self) -> ImpactModel:
        """The model."""

    @property
    def sizes(self) -> Sizes:
        """Of the mesh."""

    def program(self) -> str | None:
        """That made it; None: this package."""

    def first_frequency(self) -> float:
        """Lowest frequency of what is struck that the contacts excite, Hz."""

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``."""

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""

    def settings(self) -> dict[str, Any]:
        """For the provenance."""

    def write_fields(self, folder: Path) -> list[float]:
        """Mesh and fields kept; their instants, s."""


def solver(scene: Scene, file: Path | None, comm: Any, options: Options) -> ImpactSolver[Solution]:
    """How the scene is solved; ``file`` has the shape of its body.

    Raises:
        SceneError: CalculiX does not cover the scene.
    """
    by: Any = explicit
    if options.solver == "calculix":
        from . import calculix as by
        from .calculix_model import require_supported

        require_supported(scene, options, comm.size)
    return ImpactSolver(
        scene=scene,
        method=by.method(scene),
        end_time=scene.end_time,
        ratio=RATIO,
        targeted=tuple(target for target in TARGETED if scene.has(target.name)),
        compute=lambda factor, settings, report, _: by.compute(
            scene, file, factor, settings, comm, report
        ),
        quantities=partial(quantities, scene),
        curves=curves(scene),
        details=partial(_details, scene),
    )


def quantities(scene: Scene, solution: Solution) -> dict[str, float]:
    """The summary's physical quantities, SI; a contact that never closed ends at 0."""
    run, inner = solution.run, scene.inner
    found = {
        "outer_velocity_final": run.outer_velocity,
        "outer_restitution": (run.outer_velocity - run.struck_velocities[0]) / scene.closing_speed,
    }
    if inner is not None and run.inner_velocity is not None:
        transmitted = inner.mass * run.inner_velocity**2
        found["efficiency"] = transmitted / (scene.outer.mass * scene.speed**2)
        found["inner_velocity_final"] = run.inner_velocity
        if scene.has("inner_restitution"):
            parted = run.struck_velocities[1] - run.inner_velocity
            found["inner_restitution"] = parted / scene.inner_speed
    for name, contact in zip(scene.partners(), run.contacts, strict=True):
        found[f"{name}_force_peak"] = contact.force_peak
        found[f"{name}_contact_end"] = contact.end or 0.0
        found[f"{name}_impulse"] = contact.impulse
    if scene.has("first_frequency"):
        found["first_frequency"] = solution.first_frequency()
    return found


def _details(
    scene: Scene, folder: Path, solution: Solution, meshes: list[MeshResult], bands: Floats
) -> Details:
    """See `ImpactSolver.details`."""
    run, program = solution.run, solution.program()
    return Details(
        contacts=tuple(scene.partners()),
        duration=solution.sizes.duration,
        mesh=solution.mesh_report(),
        solver=solution.machine(),
        settings=solution.settings(),
        stress_times=solution.write_fields(folder),
        summary={name: None for name in OF_SOME_SCENES if not scene.has(name)}
        | {
            f"{name}_contacts": None if run.in_contact_at_end else contact.count
            for name, contact in zip(scene.partners(), run.contacts, strict=True)
        }
        | ({"source": "external", "model": program} if program else {}),
        uncertainty=curve_uncertainty(curves(scene), bands),
        warnings=tuple(beyond_bands(scene, solution)),
    )


def beyond_bands(scene: Scene, solution: Solution) -> Iterator[str]:
    """A sentence for each error that the 95 % bands do not hold."""
    run, kept = solution.run, solution.made.kept
    if kept > KEPT:
        yield (
            f"{100.0 * kept:.0f} % of the body's volume keeps the elements of its file on every "
            "mesh: the 95 % bands do not include their error; give a CAD part or a coarser mesh"
        )
    if scene.struck_material is not None and scene.wall is not None:
        echo = first_echo(solution.sizes.duration)
        ends = [float(run.times[-1])] if run.in_contact_at_end else []
        last = max([*ends, *(contact.end or 0.0 for contact in run.contacts)])
        if last > echo:
            yield (
                f"the last contact ends at {1e6 * last:.4g} us, but the modelled part of the wall "
                f"sends an echo back after {1e6 * echo:.4g} us: what comes after that is wrong"
            )
