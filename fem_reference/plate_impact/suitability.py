"""What a mesh resolves of a run on it, and whether that is enough."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..axisymmetric.mesh import edge_lengths
from ..common.bodies import Body
from ..common.hertz import effective_modulus, hertz_contact_radius
from ..explicit.records import ContactRecord
from .estimate import ACCEPTED_SHARE, MINOR_FORCE, shortest_wavelengths
from .meshing import ImpactMesh
from .run import Run
from .scene import Scene


@dataclass(frozen=True)
class Resolution:
    """What the mesh resolves, found after the run."""

    outer: float
    """Elements per contact radius at the outer body's peak force."""
    inner: float
    """The same for the inner body; infinite for a contact that never closed.

    A contact of less than `MINOR_FORCE` counts as one of just that much.
    """
    wavelength: float
    """Shortest wavelength that matters, m."""
    per_wavelength: float
    """Elements per this wavelength, at the largest element of the body it is in (the least of all
    bodies)."""
    smallest: float
    """Shortest edge, m."""
    largest: float
    """Longest edge, m."""

    def report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        return {
            "elements_per_contact_radius": {
                "outer": self.outer if math.isfinite(self.outer) else None,
                "inner": self.inner if math.isfinite(self.inner) else None,
            },
            "elements_per_wavelength": self.per_wavelength,
            "wavelength": self.wavelength,
            "smallest_element": self.smallest,
            "largest_element": self.largest,
        }


def per_wavelength(
    scene: Scene, mesh: ImpactMesh, duration: float
) -> tuple[tuple[float, float], ...]:
    """Elements per shortest wavelength, and that wavelength (m), of outer body, plate, inner body.

    Infinite of a body without elements.
    """
    return tuple(
        (
            wavelength / float(edge_lengths(body.points, body.quads).max())
            if body.quads.size
            else math.inf,
            wavelength,
        )
        for wavelength, body in zip(shortest_wavelengths(scene, duration), mesh.bodies, strict=True)
    )


def within_zones(mesh: ImpactMesh, run: Run, share: float) -> bool:
    """Whether each contact stayed within a share of the radius of its matching nodes."""
    surfaces = (mesh.outer_contact, mesh.inner_contact)
    return all(
        contact.outermost_radius < share * surface.radii[-1]
        for contact, surface in zip(run.contacts, surfaces, strict=True)
    )


def _contact_radius(scene: Scene, contact: ContactRecord, body: Body) -> float:
    """Largest radius of a contact, m: Hertz's, which no discretisation rounds, where he holds."""
    if scene.yields:
        return contact.outermost_radius
    modulus = effective_modulus(body.material, scene.plate.material)
    hertz = hertz_contact_radius(contact.force_peak, modulus, body.tip_radius)
    # What relaxes is pressed wider by the same force.
    return max(hertz, contact.outermost_radius) if scene.relaxing else hertz


def resolution_of(scene: Scene, mesh: ImpactMesh, run: Run, duration: float) -> Resolution:
    """What a mesh resolves of a run, by the contact radii found."""
    edges = np.concatenate([edge_lengths(body.points, body.quads) for body in mesh.bodies])
    least, wavelength = min(per_wavelength(scene, mesh, duration))
    size = mesh.settings.contact_element
    most = max(contact.force_peak for contact in run.contacts)

    def elements(contact: ContactRecord, body: Body) -> float:
        peak = contact.force_peak
        if peak <= 0.0:
            return math.inf
        at_least = math.cbrt(max(1.0, MINOR_FORCE * most / peak))
        return at_least * _contact_radius(scene, contact, body) / size

    outer, inner = map(elements, run.contacts, (scene.outer, scene.inner))
    return Resolution(
        outer=outer,
        inner=inner,
        wavelength=wavelength,
        per_wavelength=least,
        smallest=float(edges.min()),
        largest=float(edges.max()),
    )


@dataclass(frozen=True)
class Suitability:
    """Whether a mesh suits what happened on it."""

    resolution: Resolution
    requested: float
    """Elements per contact radius."""
    zone_left: bool
    """Whether nodes of the contact zone were never touched."""
    reach_left: bool
    """Whether nothing yielded at the edge of what may."""

    @property
    def least(self) -> float:
        """Elements per contact radius, of both contacts."""
        return min(self.resolution.outer, self.resolution.inner)

    @property
    def accepted(self) -> bool:
        """Whether it does."""
        return self.least >= ACCEPTED_SHARE * self.requested and self.zone_left and self.reach_left

    def radii(self, size: float, before: tuple[float, float]) -> tuple[float, float]:
        """Contact radii for the next mesh, after one with elements of ``size`` (m)."""
        grow = 1.0 if self.zone_left else 1.3
        outer, inner = (
            grow * size * found if math.isfinite(found) else radius
            for found, radius in zip(
                (self.resolution.outer, self.resolution.inner), before, strict=True
            )
        )
        return outer, inner

    def __str__(self) -> str:
        """What a message says."""
        beyond = "" if self.reach_left else " and yielding beyond its zone"
        return (
            f"{self.least:.3g} elements per contact radius, {self.requested:.3g} requested{beyond}"
        )
