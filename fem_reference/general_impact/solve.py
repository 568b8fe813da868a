"""From a scene to a solution on one mesh: contact radii, mesh, step, check, repeat if need be."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeVar

from ..common.errors import SolverError
from ..common.output import write_json
from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.loop import Loop
from ..solid.elasticity import write_fields
from ..solid.mesh import mesh_report
from ..solid.meshing import rounded
from ..solid.stepping import Stepped, stepped
from .ending import Bodies
from .estimate import MINOR_FORCE, STEEPEST, Sizes, contact_radius, estimate
from .model import ImpactModel, impact_model
from .run import Run, integrate
from .scene import Scene

REVISION = 5
"""Counts changes of the method that make older checkpoints useless."""
MOST_MESHES = 4
LEAST_SHARE, LARGEST_SHARE = 0.95, 1.1
"""Of the elements per contact radius requested, that the first mesh of a series has to have."""
ACCEPTED_SHARE = 0.8
"""That any mesh has to have."""


class Solved(Protocol):
    """What is asked of a solution on one mesh."""

    @property
    def run(self) -> Run:
        """The run."""


S = TypeVar("S", bound=Solved)


@dataclass(frozen=True, kw_only=True)
class Meshed:
    """On a mesh that was made for the contact radii found."""

    made: ImpactModel
    sizes: Sizes
    meshes_tried: int
    elements_per_radius: dict[str, float]
    """Found at the peak forces, by contact."""

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        return {
            **mesh_report([body.mesh for body in self.made.model.elastic]),
            "elements_per_contact_radius": self.elements_per_radius,
        }

    def settings(self) -> dict[str, Any]:
        """For the provenance."""
        return {
            "element_order": self.made.model.elastic[0].mesh.order,
            "rigid": list(self.sizes.scene.rigid),
            "contact_radii": self.sizes.radii,
            "contact_duration": self.sizes.duration,
            "meshes_tried": self.meshes_tried,
        }


@dataclass(frozen=True, kw_only=True)
class Solution(Stepped[Run], Meshed):
    """A verified run."""

    def first_frequency(self) -> float:
        """Lowest frequency of what is struck that the contacts excite, Hz."""
        return Bodies(self.loop, self.made).first_frequency()

    def program(self) -> str | None:
        """That made it; None: this package."""
        return None

    def write_fields(self, folder: Path) -> list[float]:
        """Mesh and fields kept; their instants, s."""
        return write_fields(folder, self.made.model, self.recorder)


def method(scene: Scene) -> list[Any]:
    """What kept states and results depend on, meshes and step apart."""
    return [REVISION, scene.raw]


def compute(
    scene: Scene, file: Path | None, factor: float, settings: Settings, comm: Any, report: Report
) -> Solution:
    """Solve a scene with ``factor`` times the elements requested, in every direction.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, too little memory, or the mesh stayed too coarse.
    """

    def solved(made: ImpactModel, sizes: Sizes, attempt: int) -> Stepped[Run]:
        def step(loop: Loop, **options: Any) -> Run:
            return integrate(loop, made, scene, sizes.duration, **options)

        return stepped(
            made.model, method(scene), settings, comm, report, step, suffix=f"-{attempt}"
        )

    done, meshed = on_fitting_mesh(
        scene, file, factor, settings, comm, report, method(scene), solved
    )
    return Solution(**vars(done), **vars(meshed))


def on_fitting_mesh(
    scene: Scene,
    file: Path | None,
    factor: float,
    settings: Settings,
    comm: Any,
    report: Report,
    method: list[Any],
    solved: Callable[[ImpactModel, Sizes, int], S],
    steepest: float = STEEPEST,
) -> tuple[S, Meshed]:
    """Solve with ``solved``, which gets model, sizes and the number of the attempt.

    The first mesh of a series is made again until its contact radii are those for which it was
    made. They are kept for this ``method``, and all other meshes are made for them. Elements
    grow by ``steepest`` per distance at most.

    Raises:
        SceneError, SolverError: see `compute`.
    """
    first = estimate(scene)
    kept = comm.bcast(_kept(method, settings) if comm.rank == 0 else None)
    radii = kept or {name: rounded(radius) for name, radius in first.radii.items()}
    requested = scene.elements_per_contact_radius * factor
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        sizes = Sizes(scene, radii, first.duration, factor, steepest)
        # gmsh runs in one process; the others wait
        made: ImpactModel = comm.bcast(impact_model(scene, sizes, file) if comm.rank == 0 else None)
        done = solved(made, sizes, attempt)
        found, inside = _elements_per_radius(scene, made, done.run), _is_inside(made, done.run)
        shares = [each / requested for each in found.values()]
        right = min(shares) >= LEAST_SHARE and max(shares) <= LARGEST_SHARE
        last = attempt == MOST_MESHES or kept is not None
        if inside and (right or (last and min(shares) >= ACCEPTED_SHARE)):
            if comm.rank == 0 and kept is None:
                _keep(method, settings, radii)
            meshed = Meshed(made=made, sizes=sizes, meshes_tried=attempt, elements_per_radius=found)
            return done, meshed
        radii = {
            side.name: rounded((1.0 if inside else 1.3) * radius)
            for side, radius in zip(made.sides, _radii(scene, made, done.run), strict=True)
        }
        if comm.rank == 0:
            print(
                f"mesh {attempt}: {min(shares):.3g} to {max(shares):.3g} times the elements per "
                "contact radius requested; meshing again with the radii found",
                file=sys.stderr,
            )
    if not inside:
        raise SolverError(
            f"after {MOST_MESHES} meshes there still is contact outside of what can touch: a body "
            "that slides away or touches elsewhere is beyond this solver"
        )
    raise SolverError(
        f"after {MOST_MESHES} meshes there are still only {min(shares):.3g} of the elements per "
        "contact radius requested"
    )


def _radii(scene: Scene, made: ImpactModel, run: Run) -> list[float]:
    """Contact radii at the peak forces, m; of a minor contact for its least share of the other."""
    peaks = [contact.force_peak for contact in run.contacts]
    return [
        contact_radius(scene, side.name, max(peak, MINOR_FORCE * max(peaks)), side.strike.curvature)
        for side, peak in zip(made.sides, peaks, strict=True)
    ]


def _elements_per_radius(scene: Scene, made: ImpactModel, run: Run) -> dict[str, float]:
    radii = _radii(scene, made, run)
    return {side.name: radius / side.size for side, radius in zip(made.sides, radii, strict=True)}


def _is_inside(made: ImpactModel, run: Run) -> bool:
    """Whether all contact stayed well within the zone of candidates."""
    return all(
        contact.outermost_radius < 0.95 * side.patch.reach
        for side, contact in zip(made.sides, run.contacts, strict=True)
    )


def _file(settings: Settings) -> Path:
    return settings.folder / "contact-radii.json"


def _kept(method: list[Any], settings: Settings) -> dict[str, float] | None:
    """The contact radii that the first mesh of the series has found."""
    try:
        document = json.loads(_file(settings).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    same = document.get("method") == json.loads(json.dumps(method))
    return dict(document["radii"]) if same else None


def _keep(method: list[Any], settings: Settings, radii: dict[str, float]) -> None:
    settings.folder.mkdir(parents=True, exist_ok=True)
    partial = settings.folder / ".partial-contact-radii.json"
    write_json(partial, {"method": method, "radii": radii})
    partial.replace(_file(settings))
