"""From a scene to a verified solution: mesh, assemble, step, check, and repeat if need be."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..axisymmetric.mesh import edge_lengths
from ..axisymmetric.system import System
from ..common.errors import SolverError
from ..common.progress import Progress
from ..explicit.resonance import stable_run
from .axisymmetric_run import Run, integrate
from .estimate import (
    ACCEPTED_SHARE,
    MINOR_FORCE,
    MOST_MESHES,
    ContactEstimate,
    effective_modulus,
    estimate_contact,
    hertz_contact_radius,
    shortest_wavelengths,
)
from .meshing import ImpactMesh, build_system, mesh_impact, mesh_settings
from .scene import Scene

LEAST_ELEMENTS_PER_WAVELENGTH = 12.0
"""Elements with incompatible modes then miss the wave's frequency by 0.6 %, at a frequency that
carries 1 % of the pulse."""


@dataclass(frozen=True)
class Resolution:
    """What the mesh resolves, found after the run."""

    outer: float
    """Elements per contact radius at the outer sphere's peak force."""
    inner: float
    """The same for the inner sphere; infinite for a contact of less than `MINOR_FORCE`."""
    wavelength: float
    """Shortest wavelength that matters, m."""
    per_wavelength: float
    """Elements per this wavelength, at the largest element of the body it is in (the least of all
    bodies)."""
    smallest: float
    """Shortest edge, m."""
    largest: float
    """Longest edge, m."""


@dataclass(frozen=True)
class Solution:
    """A verified run."""

    run: Run
    mesh: ImpactMesh
    system: System
    resolution: Resolution
    estimate: ContactEstimate
    meshes_tried: int
    factor: float
    """On the number of elements asked for."""
    radii: tuple[float, float]
    """Contact radii the mesh is made for, outer and inner, m."""


def elements_per_wavelength(scene: Scene, mesh: ImpactMesh, duration: float) -> tuple[float, float]:
    """Least number of elements per wavelength in any body, and that wavelength, m."""
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    return min(
        (wavelength / float(edge_lengths(body.points, body.quads).max()), wavelength)
        for wavelength, body in zip(shortest_wavelengths(scene, duration), bodies, strict=True)
    )


def _resolution(scene: Scene, mesh: ImpactMesh, run: Run, duration: float) -> Resolution:
    found = [
        hertz_contact_radius(
            contact.force_peak,
            effective_modulus(sphere.material, scene.plate.material),
            sphere.radius,
        )
        for contact, sphere in zip(run.contacts, (scene.outer, scene.inner), strict=True)
    ]
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    edges = np.concatenate([edge_lengths(body.points, body.quads) for body in bodies])
    per_wavelength, wavelength = elements_per_wavelength(scene, mesh, duration)
    size = mesh.settings.contact_element
    peaks = [contact.force_peak for contact in run.contacts]
    outer, inner = (
        radius / size if peak >= MINOR_FORCE * max(peaks) else math.inf
        for radius, peak in zip(found, peaks, strict=True)
    )
    return Resolution(
        outer=outer,
        inner=inner,
        wavelength=wavelength,
        per_wavelength=per_wavelength,
        smallest=float(edges.min()),
        largest=float(edges.max()),
    )


def _stepped(scene: Scene, system: System, duration: float, **options: Any) -> Run:
    """Step with sub-cycling where that can be; a run that the scene cuts short has one level.

    It may end in the middle of a contact, where the energy of a run with levels cannot be read.
    """

    def attempt(most_levels: int) -> Run:
        return integrate(system, scene.speed, duration, most_levels=most_levels, **options)

    if scene.end_time is not None:
        return attempt(1)
    return stable_run(attempt, lambda run: (len(run.levels), run.balance.energy_residual))


def compute(
    scene: Scene,
    factor: float,
    *,
    courant: float = 0.9,
    snapshot_times: tuple[float, ...] = (),
    progress: Progress | None = None,
    label: str = "",
    like: Solution | None = None,
) -> Solution:
    """Solve a scene with ``factor`` (see `settings.RESOLUTIONS`) times the asked elements.

    The mesh is made for estimated contact radii. If the radii found from the peak forces leave
    fewer than `ACCEPTED_SHARE` of the elements asked for, or contact reached the last pair of
    matching nodes, it is made again with the radii found.

    Args:
        scene: what to solve.
        factor: on the number of elements.
        courant: time step over the critical one.
        snapshot_times: instants at which to keep all displacements, s.
        progress: where to report.
        label: put before the messages.
        like: a solution with more elements, for which this one's mesh is the same but for
            ``factor``, and its run as long; it serves to estimate the error and is not verified.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, or the mesh stayed too coarse.
    """

    def report(phase: str, done: float, message: str) -> None:
        if progress is not None:
            progress.report(phase, done, f"{label}{message}")

    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius) if like is None else like.radii
    end_time = scene.end_time if like is None else float(like.run.times[-1])
    asked = scene.elements_per_contact_radius * factor
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        settings = mesh_settings(scene, *radii, factor)
        mesh = mesh_impact(scene, settings)
        per_wavelength, wavelength = elements_per_wavelength(scene, mesh, estimate.duration)
        if like is None and per_wavelength < LEAST_ELEMENTS_PER_WAVELENGTH:
            raise SolverError(
                f"only {per_wavelength:.3g} elements per wavelength of {wavelength:.3g} m, "
                f"at least {LEAST_ELEMENTS_PER_WAVELENGTH:g} are required; raise "
                "reference.elements_per_contact_radius"
            )
        nodes = sum(body.points.shape[0] for body in (mesh.outer, mesh.plate, mesh.inner))
        report("assembly", 0.0, f"{nodes} nodes")
        system = build_system(scene, mesh)
        run = _stepped(
            scene,
            system,
            estimate.duration,
            end_time=end_time,
            courant=courant,
            snapshot_times=snapshot_times,
            on_progress=lambda done, message: report("stepping", done, message),
        )
        resolution = _resolution(scene, mesh, run, estimate.duration)
        zone_left = all(
            contact.outermost_radius < 0.999 * settings.contact_zone for contact in run.contacts
        )
        enough = min(resolution.outer, resolution.inner) >= ACCEPTED_SHARE * asked
        if like is not None or (enough and zone_left):
            return Solution(run, mesh, system, resolution, estimate, attempt, factor, radii)
        size = settings.contact_element
        grow = 1.0 if zone_left else 1.3
        radii = (
            grow * size * resolution.outer if math.isfinite(resolution.outer) else radii[0],
            grow * size * resolution.inner if math.isfinite(resolution.inner) else radii[1],
        )
        print(
            f"mesh {attempt}: {min(resolution.outer, resolution.inner):.3g} elements per contact "
            f"radius, {asked:.3g} asked; meshing again with the radii found",
            file=sys.stderr,
        )
    raise SolverError(
        f"after {MOST_MESHES} meshes there are still only "
        f"{min(resolution.outer, resolution.inner):.3g} elements per contact radius, "
        f"{asked:.3g} are asked for"
    )
