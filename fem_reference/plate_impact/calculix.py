"""Plate impacts by CalculiX: the same scene and mesh generator, otherwise another program.

Quadratic elements with consistent mass, implicit steps and penalty contact stand against bilinear
ones with incompatible modes, lumped mass, explicit steps and kinematic contact. Element size, time
step and the penalty's compliance shrink together along a series of meshes, so that its bands are
of all three.
"""

from __future__ import annotations

import math
import sys
import tempfile
import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..axisymmetric.statics import patch_flexibility
from ..axisymmetric.system import INNER, OUTER, PLATE, hertz_weights
from ..calculix import program
from ..calculix.contacts import DAMPING
from ..calculix.deck import FREE_MODES, MILLI, Deck, Steps
from ..calculix.printed import Printed, frequencies
from ..common.errors import SolverError
from ..common.progress import Report
from ..common.settings import Settings
from ..impact.ending import Approach
from .axisymmetric_motion import WINDOW
from .calculix_model import PENALTY, SLAVES, Model, model
from .calculix_observed import Observed, run_of
from .estimate import MOST_MESHES, WAVE_FREQUENCY, ContactEstimate, estimate_contact
from .meshing import ImpactMesh, build_system, mesh_impact, mesh_settings
from .motion import SIDES
from .run import LONGEST_RUN, Run
from .scene import Scene
from .suitability import Resolution, Suitability, resolution_of, within_zones

NAME = "CalculiX"
REVISION = 1
"""Counts changes of the method that make kept results useless."""
QUADRATIC = 0.2
"""Quadratic elements in every direction for one bilinear element requested."""
STEPS = 150.0
"""Time steps in the shorter Hertz contact duration at `paper` resolution."""


class _Course:
    """Watches a run: reads, reports, and says when no further contact is possible."""

    def __init__(
        self, scene: Scene, made: Model, mesh: ImpactMesh, duration: float, report: Report
    ) -> None:
        self.scene, self.made, self.mesh = scene, made, mesh
        self.duration, self.report = duration, report
        self.end: float | None = None
        """Of the run where it is known, s."""
        self.seen: Observed | None = None
        self._printed: Printed | None = None
        self._done = 0

    def __call__(self, path: Path) -> bool:
        """See `program.run`."""
        self._printed = self._printed or Printed(path)
        count = self._printed.advance()
        if count == self._done:
            return False
        self._done = count
        seen = self.seen = Observed.of(self._printed, self.scene, count)
        now = float(seen.times[-1])
        expected = self.end or max(2.5 * self.duration, 1.2 * now)
        self.report("stepping", now / expected, f"{1e6 * now:.4g} us")
        return self.end is None and count >= _needed(seen) and self._is_over(seen)

    def finish(self, path: Path) -> Observed:
        """All curves, as far as they are compared.

        Raises:
            SolverError: nothing was printed.
        """
        self._printed = self._printed or Printed(path)
        count = self._printed.advance(to_the_end=True)
        if count < 2:
            raise SolverError("CalculiX ended without printing any increment")
        seen = Observed.of(self._printed, self.scene, count)
        return seen if self.end is not None else seen.until(_needed(seen) + 1)

    def _is_over(self, seen: Observed) -> bool:
        if seen.pressed[-1].any():
            return False
        place, speed, energy = seen.displacements[-1], seen.velocities[-1], seen.energies[-1].copy()
        moves = np.array([1.0, self.scene.plate.edge == "free", 1.0])
        energy -= 0.5 * np.array(self.made.masses) * moves * speed[:3] ** 2
        gaps = (0.0, self.scene.gap)
        return all(
            Approach(
                gaps[k] + side * (place[body] - moves[1] * place[1]),
                side * (speed[body] - moves[1] * speed[1]),
                tuple(zip(energy[[1, body]], self._flexibilities[k], strict=True)),
            ).is_over()
            for k, (side, body) in enumerate(zip(SIDES, (0, 2), strict=True))
        )

    @cached_property
    def _flexibilities(self) -> list[tuple[float, float]]:
        """Of plate and body over the patch of each contact, m/N."""
        system, found = build_system(self.scene, self.mesh), []
        for pairs, body in zip(system.matched, (OUTER, INNER), strict=True):
            weights = hertz_weights(pairs.radii)
            plate = patch_flexibility(system, PLATE, pairs.opposite, weights)
            found.append((plate, patch_flexibility(system, body, pairs.candidates, weights)))
        return found


def _needed(seen: Observed) -> int:
    """Increments up to the end of the window in which curves are compared."""
    return math.ceil(WINDOW * (seen.last_pressed + 1))


@dataclass(frozen=True)
class Solution:
    """See `result.Solution`."""

    run: Run
    mesh: ImpactMesh
    model: Model
    resolution: Resolution
    estimate: ContactEstimate
    meshes_tried: int
    factor: float
    radii: tuple[float, float]
    frequency: float
    version: str
    program: ClassVar[str | None] = NAME

    @property
    def runs(self) -> list[Run]:
        """The one."""
        return [self.run]

    @property
    def dofs(self) -> int:
        """Displacements of the planes, fixed ones included."""
        return self.model.dofs

    def first_frequency(self) -> float:
        """Lowest elastic eigenfrequency of the plate, Hz."""
        return self.frequency

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``."""
        return {"program": NAME, "version": self.version, "damping": DAMPING, "penalty": PENALTY}

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        return {
            "nodes": self.dofs // 2,
            "dofs": self.dofs,
            "elements": sum(len(plane.quads) for plane in self.model.planes),
            "element": "C3D20R, at the axis C3D15: wedges of 2 degrees",
            **self.resolution.report(),
            "min_quality": self.mesh.min_quality,
        }

    def settings(self) -> dict[str, Any]:
        """For the provenance."""
        return {
            "resolution_factor": self.factor,
            "program": f"{NAME} {self.version}",
            "quadratic_elements": QUADRATIC,
            "steps_per_contact": STEPS,
            "damping": DAMPING,
            "penalty": PENALTY,
            "contact_element": self.mesh.settings.contact_element,
            "meshes_tried": self.meshes_tried,
            "wave_frequency": WAVE_FREQUENCY / self.estimate.duration,
        }

    def write_fields(self, folder: Path, scene: Scene) -> list[float]:
        """None."""
        return []


def method(scene: Scene) -> list[Any]:
    """What kept results depend on, meshes and step apart."""
    return [NAME, REVISION, scene.raw]


def first_frequency(made: Model, free: bool, folder: Path) -> float:
    """Lowest elastic eigenfrequency of the plate by CalculiX, Hz."""
    plate = Deck([made.deck.parts[1]])
    found = MILLI * frequencies(program.run(plate.modes(FREE_MODES), folder, lambda _: False))
    return float(found[1 if free else 0])


def _impact(
    scene: Scene,
    mesh: ImpactMesh,
    factor: float,
    duration: float,
    settings: Settings,
    report: Report,
    end_time: float | None,
) -> tuple[Model, Run, float]:
    """Deck, run and the plate's first frequency on one mesh."""
    made = model(scene, mesh)
    course = _Course(scene, made, mesh, duration, report)
    course.end = end_time
    longest = LONGEST_RUN * duration if end_time is None else end_time
    step = duration / (STEPS * factor)
    steps = Steps(longest / max(1, round(longest / step)), longest, DAMPING)
    started = time.monotonic()
    settings.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=settings.folder, prefix="calculix-") as name:
        folder = Path(name)
        report("assembly", 0.0, f"{made.dofs // 2} nodes")
        frequency = first_frequency(made, scene.plate.edge == "free", folder / "modes")
        printed = program.run(made.deck.impact(steps), folder / "impact", course, settings.threads)
        seen = course.finish(printed)
    if end_time is None and seen.pressed[-1].any():
        raise SolverError(
            f"no end of the contacts was found within {longest:.3g} s; set run.end_time"
        )
    seconds = time.monotonic() - started
    return made, run_of(scene, seen, made.masses, duration, seconds), frequency


def compute(
    scene: Scene,
    factor: float,
    settings: Settings,
    report: Report,
    like: Solution | None = None,
) -> Solution:
    """Solve a scene with ``factor`` times the elements and steps; see `axisymmetric.compute`.

    Raises:
        SceneError: the contact is too large for the mesh.
        SolverError: CalculiX is missing or failed, or the mesh stayed too coarse.
    """
    version = program.version()
    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius) if like is None else like.radii
    end = scene.end_time if like is None else float(like.run.times[-1])
    requested = scene.elements_per_contact_radius * QUADRATIC * factor
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        sizes = mesh_settings(scene, *radii, QUADRATIC * factor)
        mesh = mesh_impact(scene, sizes)
        made, run, frequency = _impact(
            scene, mesh, factor, estimate.duration, settings, report, end
        )
        resolution = resolution_of(scene, mesh, run, estimate.duration)
        inside = within_zones(mesh, run, SLAVES)
        found = Suitability(resolution, requested, inside, True)
        if like is not None or found.accepted:
            return Solution(
                *(run, mesh, made, resolution, estimate, attempt, factor, radii, frequency),
                version,
            )
        radii = found.radii(sizes.contact_element, radii)
        print(f"mesh {attempt}: {found}; meshing again with what was found", file=sys.stderr)
    raise SolverError(f"after {MOST_MESHES} meshes there are still {found}")
