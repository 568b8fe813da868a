"""Three-dimensional solutions: mesh, assemble, step, check, and repeat if need be."""

from __future__ import annotations

import dataclasses
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..common.errors import SolverError
from ..common.hertz import effective_modulus, hertz_contact_radius
from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.loop import Loop
from ..explicit.spectrum import body_translation, first_frequency
from ..solid.elasticity import write_fields
from ..solid.mesh import edge_lengths, mesh_report
from ..solid.meshing import rounded
from ..solid.stepping import Stepped, stepped
from .estimate import (
    ACCEPTED_SHARE,
    MINOR_FORCE,
    MOST_MESHES,
    ContactEstimate,
    estimate_contact,
    shortest_wavelengths,
)
from .half_model import half_model
from .half_motion import HalfMotion
from .motion import PLATE
from .run import Run
from .scene import Scene
from .solid_model import PlateModel, plate_model
from .solid_motion import SolidMotion, integrate_solid

REVISION = 6
"""Counts changes of the method that make older checkpoints useless."""


@dataclass(frozen=True, kw_only=True)
class Solution(Stepped[Run]):
    """A verified run."""

    program: ClassVar[str | None] = None
    plate: PlateModel
    estimate: ContactEstimate
    meshes_tried: int
    elements_per_radius: tuple[float, float]
    """Found at the peak forces, outer and inner; infinite for a contact of hardly any force."""
    wavelength: float
    """Shortest that matters, m."""
    elements_per_wavelength: float

    @property
    def runs(self) -> list[Run]:
        """The one run."""
        return [self.run]

    def first_frequency(self) -> float:
        """Lowest elastic eigenfrequency of the plate, Hz."""
        loop, body = self.loop, self.plate.elastic[PLATE]
        if not self.plate.off_axis:
            return first_frequency(loop, body)
        # A shape that is no rigid motion and has nodal diameters, too.
        x = loop.system.points[loop.system.owned][:, 0]
        bent = body_translation(loop, body, 2) * np.repeat(1.0 + (x / x.max()) ** 2, 3)
        return first_frequency(loop, body, start=bent)

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        outer, inner = self.elements_per_radius
        return {
            **mesh_report([body.mesh for body in self.plate.model.elastic]),
            "elements_per_contact_radius": {
                "outer": outer if math.isfinite(outer) else None,
                "inner": inner if math.isfinite(inner) else None,
            },
            "elements_per_wavelength": self.elements_per_wavelength,
            "wavelength": self.wavelength,
        }

    def settings(self) -> dict[str, Any]:
        """For the provenance."""
        return {
            "element_order": self.plate.model.elastic[0].mesh.order,
            "rigid": list(self.plate.rigid),
            "contact_element": self.plate.size,
            "contact_zone": self.plate.zone,
            "meshes_tried": self.meshes_tried,
            "estimate": dataclasses.asdict(self.estimate),
        }

    def write_fields(self, folder: Path, scene: Scene) -> list[float]:
        """``mesh.vtu`` and the fields kept; their instants, s."""
        return write_fields(folder, self.plate.model, self.recorder)


def _per_wavelength(
    plate: PlateModel, wavelengths: tuple[float, float, float]
) -> tuple[float, float]:
    """Least number of elements per wavelength in any elastic body, and that wavelength, m."""
    found = []
    for name, wavelength in zip(("outer", PLATE, "inner"), wavelengths, strict=True):
        if name in plate.elastic:
            mesh = plate.model.elastic[plate.elastic[name]].mesh
            longest = float(edge_lengths(mesh.points, mesh.corners).max())
            found.append((wavelength / longest, wavelength))
    return min(found)


def _elements_per_radius(scene: Scene, plate: PlateModel, run: Run) -> tuple[float, float]:
    peaks = [contact.force_peak for contact in run.contacts]
    found = []
    for peak, body, name in zip(peaks, (scene.outer, scene.inner), ("outer", "inner"), strict=True):
        effective = effective_modulus(body.material, scene.plate.material)
        if name in scene.rigid:
            effective = scene.plate.material.plane_strain_modulus
        radius = hertz_contact_radius(peak, effective, body.tip_radius)
        found.append(radius / plate.size if peak >= MINOR_FORCE * max(peaks) else math.inf)
    return found[0], found[1]


def method(scene: Scene) -> list[Any]:
    """What kept states and results depend on, meshes and step apart."""
    return [REVISION, scene.raw]


def compute(scene: Scene, factor: float, settings: Settings, comm: Any, report: Report) -> Solution:
    """Solve a scene with ``factor`` times the elements requested, in every direction.

    The mesh is made for estimated contact radii, and again if those found in the run leave less
    than `ACCEPTED_SHARE` of the elements, or contact left the zone of candidates.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, too little memory, or the mesh stayed too coarse.
    """
    estimate = estimate_contact(scene)
    wavelengths = shortest_wavelengths(scene, estimate.duration)
    model, motion = (plate_model, SolidMotion) if scene.centred else (half_model, HalfMotion)
    requested = scene.elements_per_contact_radius * factor
    radii = (estimate.outer_radius, estimate.inner_radius)
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        expected = dataclasses.replace(estimate, outer_radius=radii[0], inner_radius=radii[1])
        # gmsh runs in one process; the others wait.
        made = model(scene, expected, wavelengths, factor) if comm.rank == 0 else None
        plate: PlateModel = comm.bcast(made)

        def step(loop: Loop, plate: PlateModel = plate, **options: Any) -> Run:
            return integrate_solid(loop, plate, scene, estimate.duration, motion, **options)

        done = stepped(
            plate.model, method(scene), settings, comm, report, step, suffix=f"-{attempt}"
        )
        run = done.run
        found = _elements_per_radius(scene, plate, run)
        reach = max(contact.outermost_radius for contact in run.contacts)
        inside = reach < 0.95 * plate.zone
        if min(found) >= ACCEPTED_SHARE * requested and inside:
            per_wave, wavelength = _per_wavelength(plate, wavelengths)
            return Solution(
                **vars(done),
                plate=plate,
                estimate=estimate,
                meshes_tried=attempt,
                elements_per_radius=found,
                wavelength=wavelength,
                elements_per_wavelength=per_wave,
            )
        grow = 1.0 if inside else 1.3
        radii = (
            rounded(grow * plate.size * found[0]) if math.isfinite(found[0]) else radii[0],
            rounded(grow * plate.size * found[1]) if math.isfinite(found[1]) else radii[1],
        )
        if comm.rank == 0:
            print(
                f"mesh {attempt}: {min(found):.3g} elements per contact radius, {requested:.3g} "
                "asked; meshing again with the radii found",
                file=sys.stderr,
            )
    if not inside:
        raise SolverError(
            f"after {MOST_MESHES} meshes there still is contact outside of what can touch, "
            f"{plate.zone:.3g} m around the points of impact: a body that touches again elsewhere "
            "is beyond this solver"
        )
    raise SolverError(
        f"after {MOST_MESHES} meshes there are still only {min(found):.3g} elements per contact "
        f"radius, {requested:.3g} are requested"
    )
