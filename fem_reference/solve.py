"""From a scene to a verified solution: mesh, assemble, step, check, and repeat if need be."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from .contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from .errors import SceneError, SolverError
from .estimate import ContactEstimate, effective_modulus, estimate_contact, hertz_contact_radius
from .explicit import Run, integrate
from .mesh import edge_lengths
from .meshing import RESOLUTIONS, ImpactMesh, mesh_impact, mesh_settings
from .modal import first_frequency
from .output import (
    history,
    result_folder,
    write_history,
    write_json,
    write_mesh,
    write_stress,
)
from .progress import Progress
from .scene import Material, Scene
from .system import System, build_system
from .uncertainty import two_grid_uncertainty
from .versions import versions

SCHEMA_VERSION = 1
ACCEPTED_SHARE = 0.9
"""Least share of the requested elements per contact radius that is accepted."""
MOST_MESHES = 3
LEAST_ELEMENTS_PER_WAVELENGTH = 20.0
COMPANION_RATIO = 1.5
"""Element size of the mesh that gives the uncertainty over that of the main one."""
WAVE_FREQUENCY = 3.0
"""Highest frequency resolved, times the shorter Hertz contact duration.

The spectrum of Hertz's pulse (about a half sine to the power 3/2) is below 1 % of its value at
zero from there on.
"""


@dataclass(frozen=True)
class Resolution:
    """What the mesh resolves, found after the run."""

    outer: float
    """Elements per contact radius at the outer sphere's peak force."""
    inner: float
    """The same for the inner sphere; infinite if it was never touched."""
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


def shortest_wavelengths(scene: Scene, duration: float) -> tuple[float, float, float]:
    """Shortest wavelength that matters in outer sphere, plate and inner sphere, m.

    At the frequency f = `WAVE_FREQUENCY` / duration: shear sqrt(G/rho)/f, in the plate also
    bending sqrt(2 pi/f) (D/(rho h))^(1/4) (Kirchhoff).
    """
    frequency = WAVE_FREQUENCY / duration
    plate = scene.plate
    bending = math.sqrt(2.0 * math.pi / frequency) * (
        plate.bending_stiffness / plate.surface_density
    ) ** 0.25

    def shear(material: Material) -> float:
        return math.sqrt(material.shear_modulus / material.density) / frequency

    return (
        shear(scene.outer.material), min(bending, shear(plate.material)),
        shear(scene.inner.material),
    )


def _resolution(scene: Scene, mesh: ImpactMesh, run: Run, duration: float) -> Resolution:
    found = [
        hertz_contact_radius(
            contact.force_peak, effective_modulus(sphere.material, scene.plate.material),
            sphere.radius,
        )
        for contact, sphere in zip(run.contacts, (scene.outer, scene.inner), strict=True)
    ]
    edges = [edge_lengths(body.points, body.quads) for body in (mesh.outer, mesh.plate, mesh.inner)]
    largest = [float(lengths.max()) for lengths in edges]
    per_wavelength, wavelength = min(
        (wave / size, wave)
        for wave, size in zip(shortest_wavelengths(scene, duration), largest, strict=True)
    )
    size = mesh.settings.contact_element
    return Resolution(
        outer=found[0] / size,
        inner=found[1] / size if run.contacts[1].count else math.inf,
        wavelength=wavelength,
        per_wavelength=per_wavelength,
        smallest=min(float(lengths.min()) for lengths in edges),
        largest=max(largest),
    )


def compute(
    scene: Scene, factor: float, *, courant: float = 0.9,
    snapshot_times: tuple[float, ...] = (), progress: Progress | None = None, label: str = "",
) -> Solution:
    """Solve a scene with ``factor`` (see `meshing.RESOLUTIONS`) times the asked elements.

    The mesh is made for estimated contact radii. If the radii found from the peak forces leave
    fewer than `ACCEPTED_SHARE` of the elements asked for, or contact reached the last pair of
    matching nodes, it is made again with the radii found.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: meshing or the run failed, or the mesh stayed too coarse.
    """

    def report(phase: str, done: float, message: str) -> None:
        if progress is not None:
            progress.report(phase, done, f"{label}{message}")

    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius)
    asked = scene.elements_per_contact_radius * factor
    for attempt in range(1, MOST_MESHES + 1):
        report("mesh", 0.0, "meshing")
        settings = mesh_settings(scene, *radii, factor)
        mesh = mesh_impact(scene, settings)
        nodes = sum(body.points.shape[0] for body in (mesh.outer, mesh.plate, mesh.inner))
        report("assembly", 0.0, f"{nodes} nodes")
        system = build_system(scene, mesh)
        run = integrate(
            system, scene.speed, estimate.duration, end_time=scene.end_time, courant=courant,
            snapshot_times=snapshot_times,
            on_progress=lambda done, message: report("stepping", done, message),
        )
        resolution = _resolution(scene, mesh, run, estimate.duration)
        if resolution.per_wavelength < LEAST_ELEMENTS_PER_WAVELENGTH:
            raise SolverError(
                f"only {resolution.per_wavelength:.3g} elements per wavelength of "
                f"{resolution.wavelength:.3g} m, at least {LEAST_ELEMENTS_PER_WAVELENGTH:g} are required; "
                "raise reference.elements_per_contact_radius"
            )
        zone_left = all(
            contact.outermost_radius < 0.999 * settings.contact_zone for contact in run.contacts
        )
        if min(resolution.outer, resolution.inner) >= ACCEPTED_SHARE * asked and zone_left:
            return Solution(run, mesh, system, resolution, estimate, attempt)
        size = settings.contact_element
        grow = 1.0 if zone_left else 1.3
        radii = (
            grow * size * resolution.outer,
            grow * size * resolution.inner if math.isfinite(resolution.inner) else radii[1],
        )
        print(
            f"mesh {attempt}: {min(resolution.outer, resolution.inner):.3g} elements per contact "
            f"radius, {asked:.3g} asked; meshing again with the radii found", file=sys.stderr,
        )
    raise SolverError(
        f"after {MOST_MESHES} meshes there are still only "
        f"{min(resolution.outer, resolution.inner):.3g} elements per contact radius, "
        f"{asked:.3g} are asked for"
    )


QUANTITIES = (
    "efficiency", "outer_velocity_final", "inner_velocity_final", "outer_force_peak",
    "inner_force_peak", "outer_contact_end", "inner_contact_end", "first_frequency",
)


def quantities(scene: Scene, solution: Solution) -> dict[str, float | None]:
    """The summary's physical quantities, SI."""
    run = solution.run
    return {
        "efficiency": scene.inner.mass * run.inner_velocity**2
        / (scene.outer.mass * scene.speed**2),
        "outer_velocity_final": run.outer_velocity,
        "inner_velocity_final": run.inner_velocity,
        "outer_force_peak": run.contacts[0].force_peak,
        "inner_force_peak": run.contacts[1].force_peak,
        "outer_contact_end": run.contacts[0].end,
        "inner_contact_end": run.contacts[1].end,
        "first_frequency": first_frequency(solution.system),
    }


def _summary(
    scene: Scene, solution: Solution, resolution_name: str, uncertainty: dict[str, float | None],
    found: dict[str, str | None],
) -> dict[str, Any]:
    run, mesh, resolution = solution.run, solution.mesh, solution.resolution
    nodes = int(solution.system.mass.size)
    bodies = (mesh.outer, mesh.plate, mesh.inner)
    values = quantities(scene, solution)
    return {
        "schema_version": SCHEMA_VERSION,
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "source": "reference",
        "model": None,
        "modes": None,
        "resolution": resolution_name,
        **{key: values[key] for key in QUANTITIES if key != "first_frequency"},
        "outer_contacts": run.contacts[0].count,
        "inner_contacts": run.contacts[1].count,
        "first_frequency": values["first_frequency"],
        "energy_residual": run.energy_residual,
        "momentum_residual": run.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": uncertainty,
        "mesh": {
            "nodes": nodes,
            "dofs": 2 * nodes,
            "elements": sum(body.quads.shape[0] for body in bodies),
            "elements_per_contact_radius": {
                "outer": resolution.outer,
                "inner": resolution.inner if math.isfinite(resolution.inner) else None,
            },
            "elements_per_wavelength": resolution.per_wavelength,
            "wavelength": resolution.wavelength,
            "smallest_element": resolution.smallest,
            "largest_element": resolution.largest,
            "min_quality": mesh.min_quality,
        },
        "solver": {
            "versions": found,
            "time_step": run.time_step,
            "critical_time_step": run.critical_time_step,
            "courant": run.time_step / run.critical_time_step,
        },
        "residuals": {
            "energy": run.energy_residual,
            "momentum": run.momentum_residual,
            "contact_energy_loss": run.contact_loss,
            "support_impulse": run.support_impulse,
        },
    }


def solve(
    scene: Scene, target: Path, resolution_name: str, *, courant: float = 0.9,
    stress_times: tuple[float, ...] = (), progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``; see the package's README.

    A second run on a mesh with 2/3 of the elements in each direction gives the uncertainty.

    Raises:
        RunError: see `compute` and `output.result_folder`.
    """
    progress = progress if progress is not None else Progress()
    factor = RESOLUTIONS[resolution_name]
    for instant in stress_times:
        if not 0.0 <= instant < math.inf or (scene.end_time and instant > scene.end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")
    with result_folder(target) as folder:
        coarser = compute(
            scene, factor / COMPANION_RATIO, courant=courant, progress=progress,
            label="coarser mesh for the uncertainty: ",
        )
        solution = compute(
            scene, factor, courant=courant, snapshot_times=stress_times, progress=progress
        )
        progress.report("writing", 0.0, "writing the results")
        fine, coarse = quantities(scene, solution), quantities(scene, coarser)
        uncertainty: dict[str, float | None] = {}
        for name in QUANTITIES:
            a, b = fine[name], coarse[name]
            uncertainty[name] = (
                None if a is None or b is None else two_grid_uncertainty(a, b, COMPANION_RATIO)
            )
        found = versions()
        summary = _summary(scene, solution, resolution_name, uncertainty, found)
        table, interval = history(solution.run)
        summary["samples"] = table.shape[0]
        summary["sample_interval"] = interval
        write_history(folder / "history.csv", table)
        write_mesh(folder / "mesh.vtu", solution.mesh)
        for number, snapshot in enumerate(solution.run.snapshots):
            write_stress(
                folder / f"stress_{number:03d}.vtu", scene, solution.mesh, solution.system, snapshot
            )
        summary["stress_times"] = [snapshot.time for snapshot in solution.run.snapshots]
        write_json(folder / "summary.json", summary)
        write_json(
            folder / "provenance.json", _provenance(scene, solution, resolution_name, courant, found)
        )
        progress.report("writing", 1.0, "done")


def _provenance(
    scene: Scene, solution: Solution, resolution_name: str, courant: float,
    found: dict[str, str | None],
) -> dict[str, Any]:
    settings = solution.mesh.settings
    return {
        "schema_version": SCHEMA_VERSION,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "scene": scene.raw,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "settings": {
            "resolution": resolution_name,
            "resolution_factor": RESOLUTIONS[resolution_name],
            "courant": courant,
            "contact_element": settings.contact_element,
            "contact_elements": settings.contact_elements,
            "contact_zone": settings.contact_zone,
            "plate_element": settings.plate_element,
            "growth": settings.growth,
            "meshes_tried": solution.meshes_tried,
            "estimated_contact_radius": {
                "outer": solution.estimate.outer_radius, "inner": solution.estimate.inner_radius,
            },
            "wave_frequency": WAVE_FREQUENCY / solution.estimate.duration,
            "peak_window": PEAK_WINDOW_FRACTION * solution.estimate.duration,
            "chatter_limit": CHATTER_FRACTION * solution.estimate.duration,
            "uncertainty_companion_ratio": COMPANION_RATIO,
        },
        "versions": found,
        "residuals": {
            "energy": solution.run.energy_residual,
            "momentum": solution.run.momentum_residual,
            "contact_energy_loss": solution.run.contact_loss,
        },
        "contacts": {
            name: [list(interval) for interval in record.intervals]
            for name, record in zip(("outer", "inner"), solution.run.contacts, strict=True)
        },
    }
