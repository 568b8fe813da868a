"""Axisymmetric solutions: mesh, assemble, step, check, and repeat if need be."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..axisymmetric.elasticity import fields
from ..axisymmetric.modal import first_frequency
from ..axisymmetric.system import AxisymmetricSystem
from ..common.arrays import Floats
from ..common.errors import SolverError
from ..common.fenicsx import alone
from ..common.memory import AXISYMMETRIC, require_memory
from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.frames import Recorder
from ..explicit.supervision import stable_run
from .axisymmetric_motion import AxisymmetricMotion, integrate_axisymmetric
from .dents import Memory
from .estimate import (
    FIELD_DURATIONS,
    MOST_MESHES,
    WAVE_FREQUENCY,
    ContactEstimate,
    estimate_contact,
)
from .meshing import (
    NOT_REFINED,
    YIELDING_REACH,
    ImpactMesh,
    build_system,
    mesh_impact,
    mesh_settings,
)
from .repeated import StoredRuns, strike
from .run import Run
from .scene import Scene
from .suitability import Resolution, Suitability, per_wavelength, resolution_of, within_zones

REVISION = 2
"""Counts changes of the method that make kept results useless."""

LEAST_ELEMENTS_PER_WAVELENGTH = 12.0
"""Elements with incompatible modes then miss the wave's frequency by 0.6 %, at a frequency that
carries 1 % of the pulse."""
REFINEMENTS = 8
"""Meshes, at most, on the way to elements that are small enough for the waves."""
REFINED_BY = 1.05
"""On what the largest element is too large by: numbers of elements are rounded."""
SECONDS_PER_DOF = 3e-9
"""Of a step with sub-cycling, on one core; see the package's README."""
Refinement = tuple[float, float, float]
"""See `mesh_settings`."""


@dataclass(frozen=True)
class Solution:
    """A verified run, or several."""

    program: ClassVar[str | None] = None
    runs: list[Run]
    """Of all impacts, one after the other."""
    mesh: ImpactMesh
    system: AxisymmetricSystem
    levels: tuple[int, ...]
    """Nodes whose elements of each level of sub-cycling act."""
    threads: int
    """Of the time loop."""
    resolution: Resolution
    estimate: ContactEstimate
    meshes_tried: int
    factor: float
    """On the number of elements requested."""
    radii: tuple[float, float]
    """Contact radii the mesh is made for, outer and inner, m."""
    reach: float
    """Radius and depth of the boxes that may yield over that of the matching nodes."""
    refinement: Refinement
    """Of the elements far from the contacts, for the waves."""
    recorder: Recorder
    plastic_strain: Floats | None
    """(elements,) accumulated, of all bodies one after the other; None if nothing can yield."""

    @property
    def run(self) -> Run:
        """The last impact's."""
        return self.runs[-1]

    @property
    def dofs(self) -> int:
        """Degrees of freedom, fixed ones included."""
        return 2 * int(self.system.mass.size)

    def first_frequency(self) -> float:
        """Lowest elastic eigenfrequency of the plate, Hz."""
        return first_frequency(self.system)

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``."""
        return {"nodes_per_level": list(self.levels), "threads": self.threads}

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        points = sum(body.points.shape[0] for body in self.mesh.bodies)
        # the rigid part of a compact body, whose tip yields, is one node of many points
        drawn = {"points": points} if points != self.system.mass.size else {}
        return {
            "nodes": int(self.system.mass.size),
            **drawn,
            "dofs": self.dofs,
            "elements": sum(body.quads.shape[0] for body in self.mesh.bodies),
            **self.resolution.report(),
            "min_quality": self.mesh.min_quality,
        }

    def settings(self) -> dict[str, Any]:
        """For the provenance."""
        settings = self.mesh.settings
        return {
            "resolution_factor": self.factor,
            "courant": self.recorder.settings.courant,
            "contact_element": settings.contact_element,
            "contact_elements": settings.contact_elements,
            "contact_zone": settings.contact_zone,
            "plate_element": settings.plate_element,
            "through_element": settings.through_element,
            "growth": settings.growth,
            "through_growth": settings.through_growth,
            "meshes_tried": self.meshes_tried,
            "refinement": list(self.refinement),
            "estimated_contact_radius": {
                "outer": self.estimate.outer_radius,
                "inner": self.estimate.inner_radius,
            },
            "wave_frequency": WAVE_FREQUENCY / self.estimate.duration,
        }

    def write_fields(self, folder: Path, scene: Scene) -> list[float]:
        """``mesh.vtu`` and the fields kept; their instants, s."""
        writer = fields(self.mesh.bodies, scene.materials)
        strain = {} if self.plastic_strain is None else {"plastic_strain": self.plastic_strain}
        writer.write_mesh(folder / "mesh.vtu", **strain)
        numbers = self.system.numbers
        frames = self.recorder.frames()
        return writer.write_frames(folder, [(t, [u[part] for part in numbers]) for t, u in frames])


def method(scene: Scene) -> list[Any]:
    """What kept results depend on, meshes and step apart."""
    return [REVISION, scene.raw]


class _Stepper:
    """Makes the impacts of a scene, with sub-cycling where that can be.

    An impact that the scene cuts short has one level: it may end in the middle of a contact, where
    the energy of a run with levels cannot be read.
    """

    def __init__(
        self,
        scene: Scene,
        system: AxisymmetricSystem,
        duration: float,
        settings: Settings,
        report: Report,
        like: Solution | None,
    ) -> None:
        self.scene, self.system, self.duration = scene, system, duration
        self.settings, self.report, self.like = settings, report, like
        self.recorder = Recorder(settings)

    def __call__(self, number: int, memory: Memory | None) -> tuple[Run, AxisymmetricMotion]:
        """Impact ``number``, from 0 on."""
        named = "" if self.scene.series is None else f"impact {number + 1}: "
        end = self.scene.end_time if self.like is None else self.like.runs[number].times[-1]

        def attempt(most_levels: int) -> tuple[Run, AxisymmetricMotion]:
            self.recorder = Recorder(self.settings, f"-{most_levels}")
            return integrate_axisymmetric(
                self.system,
                self.scene,
                self.duration,
                memory,
                end_time=None if end is None else float(end),
                most_levels=most_levels,
                courant=self.settings.courant,
                threads=self.settings.threads,
                fields=self.recorder,
                on_progress=lambda done, message: self.report("stepping", done, named + message),
            )

        if self.scene.end_time is not None:
            return attempt(1)
        return stable_run(attempt, lambda made: made[0].account(len(made[1].loop.levels)))


def refined(
    scene: Scene, radii: tuple[float, float], factor: float, duration: float
) -> tuple[ImpactMesh, Refinement]:
    """A mesh whose elements are small enough for the waves in every body.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing failed, or elements stayed too large.
    """
    refinement = NOT_REFINED
    for _ in range(REFINEMENTS):
        mesh = mesh_impact(scene, mesh_settings(scene, *radii, factor, refinement))
        found = per_wavelength(scene, mesh, duration)
        outer, plate, inner = (LEAST_ELEMENTS_PER_WAVELENGTH / count for count, _ in found)
        if max(outer, plate, inner) <= 1.0:
            return mesh, refinement
        refinement = (
            refinement[0] * (REFINED_BY * outer if outer > 1.0 else 1.0),
            refinement[1] * (REFINED_BY * plate if plate > 1.0 else 1.0),
            refinement[2] * (REFINED_BY * inner if inner > 1.0 else 1.0),
        )
    least, wavelength = min(found)
    raise SolverError(
        f"after {REFINEMENTS} meshes there are still only {least:.3g} elements per wavelength of "
        f"{wavelength:.3g} m, at least {LEAST_ELEMENTS_PER_WAVELENGTH:g} are required"
    )


def _cost(scene: Scene, system: AxisymmetricSystem, estimate: ContactEstimate) -> str:
    """What a run on the finest mesh takes, about; the coarser ones follow."""
    end = scene.end_time or FIELD_DURATIONS * estimate.longest
    steps = end / (0.9 * float(system.element_steps.min()))
    seconds = SECONDS_PER_DOF * system.inverse_mass.size * steps
    return (
        f"{system.mass.size} nodes, about {steps:.1g} steps, about {seconds:.1g} s on one core "
        "for the finest of the meshes"
    )


def _note(refinement: Refinement) -> str:
    """Why a mesh has more elements than requested."""
    bodies = ("outer body", "plate", "inner body")
    finer = [
        f"{n:.2g} times in the {b}" for n, b in zip(refinement, bodies, strict=True) if n > 1.0
    ]
    return (
        "far from the contacts the waves need smaller elements than "
        f"reference.elements_per_contact_radius gives: {', '.join(finer)}"
    )


def compute(
    scene: Scene,
    factor: float,
    settings: Settings,
    report: Report,
    like: Solution | None = None,
) -> Solution:
    """Solve a scene with ``factor`` (see `settings.RESOLUTIONS`) times the asked elements.

    The mesh is made for estimated contact radii. If the radii found from the peak forces leave
    fewer than `ACCEPTED_SHARE` of the elements requested, or contact reached the last pair of
    matching nodes, it is made again with the radii found.

    Args:
        scene: what to solve.
        factor: on the number of elements.
        settings: time step and fields.
        report: where to report.
        like: a solution with more elements, for which this one's mesh is the same but for
            ``factor``, and its run as long; it serves to estimate the error and is not verified.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, or the mesh stayed too coarse.
    """
    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius) if like is None else like.radii
    reach = YIELDING_REACH if like is None else like.reach
    requested = scene.elements_per_contact_radius * factor
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        if like is None:
            mesh, refinement = refined(scene, radii, factor, estimate.duration)
        else:
            refinement = like.refinement
            mesh = mesh_impact(scene, mesh_settings(scene, *radii, factor, refinement))
        nodes = sum(body.points.shape[0] for body in mesh.bodies)
        report("assembly", 0.0, require_memory(nodes, AXISYMMETRIC, alone()))
        system = build_system(scene, mesh, reach)
        if like is None and refinement != NOT_REFINED:
            report("note", 1.0, f"{_note(refinement)}; {_cost(scene, system, estimate)}")
        stepper = _Stepper(scene, system, estimate.duration, settings, report, like)

        def suits(run: Run, motion: AxisymmetricMotion, mesh: ImpactMesh = mesh) -> Suitability:
            resolution = resolution_of(scene, mesh, run, estimate.duration)
            return Suitability(
                resolution,
                requested,
                within_zones(mesh, run, 0.999),
                motion.dents is None or not motion.dents.reach_the_edge(),
            )

        struck = strike(
            scene.series,
            stepper,
            StoredRuns(settings, attempt, [*method(scene), reach], system),
            lambda run, motion: like is not None or suits(run, motion).accepted,
            None if like is None else len(like.runs),
        )
        found = suits(struck.runs[-1], struck.motion)
        if like is not None or found.accepted:
            loop, dents = struck.motion.loop, struck.motion.dents
            quads = zip(system.numbers, mesh.bodies, strict=True)
            cells = np.vstack([number[body.quads] for number, body in quads if body.quads.size])
            return Solution(
                *(
                    struck.runs,
                    mesh,
                    system,
                    loop.divided.acting,
                    loop.threads,
                    found.resolution,
                    estimate,
                ),
                *(attempt, factor, radii, reach, refinement, stepper.recorder),
                dents.plastic_strain(cells) if dents else None,
            )
        radii = found.radii(mesh.settings.contact_element, radii)
        reach = reach if found.reach_left else 1.4 * reach
        print(f"mesh {attempt}: {found}; meshing again with what was found", file=sys.stderr)
    raise SolverError(f"after {MOST_MESHES} meshes there are still {found}")
