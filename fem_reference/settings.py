"""Everything that decides the mesh: element sizes and where they are needed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .errors import SceneError
from .mesh import Floats
from .scene import Scene

RESOLUTIONS = {"coarse": 2.0 / 3.0, "paper": 1.0, "fine": 1.5}
"""Factor on the number of elements, in every direction and place."""


def require_instants(instants: tuple[float, ...], end_time: float | None) -> None:
    """Instants for fields, s.

    Raises:
        SceneError: one lies outside the run.
    """
    for instant in instants:
        if not 0.0 <= instant < math.inf or (end_time and instant > end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")


def require_share(target_error: float | None) -> None:
    """A relative error to be reached.

    Raises:
        SceneError: it is not between 0 and 1.
    """
    if target_error is not None and not 0.0 < target_error < 1.0:
        raise SceneError(f"--target-error is {target_error:g}; it must lie between 0 and 1")


CONTACT_ZONE = 1.3
"""Radius with matching nodes over the largest contact radius expected."""


EDGE_REFINEMENT = 2.0
INSIDE_COARSENING = 0.7
"""Density of elements at the edge of contact over that inside: the quotient of both."""

EDGE_MARGINS = (0.85, 1.1)
"""Where the finest elements begin and end, over smallest and largest peak contact radius."""


@dataclass(frozen=True)
class MeshSettings:
    """Everything that decides the mesh."""

    contact_element: float
    """Element size in the contact zone, m."""
    contact_elements: int
    """Elements across the zone of matching nodes."""
    plate_element: float
    """Largest element of the plate in radial direction, m."""
    through_element: float
    """Largest element of the plate through the thickness, m."""
    growth: float
    """Ratio of neighbouring elements away from the contact, along the plate."""
    through_growth: float
    """The same through the thickness, where every layer runs along the whole plate."""
    edge: tuple[float, float] | None = None
    """Smallest and largest peak contact radius, m: between them the zone's elements are finest."""
    rim_element: float | None = None
    """Element length at the plate's rim, m; None: the rim is not refined."""

    @property
    def contact_zone(self) -> float:
        """Radius of the zone of matching nodes, m."""
        return self.contact_element * self.contact_elements

    def zone_radii(self) -> Floats:
        """(n,) radii of the matching nodes, m.

        While the edge of contact moves from node to node the force follows a chord of Hertz's
        curve, which is off by up to 3/8 (element / contact radius)^2; where the edge stands at the
        peak decides about the peak's error. There the elements are `EDGE_REFINEMENT` times as fine.
        """
        even = self.contact_element * np.arange(self.contact_elements + 1)
        if self.edge is None:
            return even
        low, high = EDGE_MARGINS[0] * self.edge[0], EDGE_MARGINS[1] * self.edge[1]
        zone = self.contact_zone
        r = np.linspace(0.0, zone, 2001)
        # Elements per length: even, times a bump with smooth flanks.
        flank = 0.35 * low
        bump = np.clip((r - low) / flank + 1.0, 0.0, 1.0) * np.clip(
            (high - r) / flank + 1.0, 0.0, 1.0
        )
        density = 1.0 + (EDGE_REFINEMENT / INSIDE_COARSENING - 1.0) * bump
        count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        radii = np.interp(even / zone, count / count[-1], r)
        radii[0], radii[-1] = 0.0, zone
        return np.asarray(radii)


def mesh_settings(
    scene: Scene, outer_radius: float, inner_radius: float, factor: float
) -> MeshSettings:
    """Settings for the contact radii (m) expected, with ``factor`` from `RESOLUTIONS`.

    Raises:
        SceneError: the contact is too large for plate or spheres, or the mesh too large.
    """
    plate = scene.plate
    per_radius = scene.elements_per_contact_radius * factor
    # Along the plate four elements per thickness carry the waves: the incompatible modes bend. The
    # stress at a clamped rim's corners is singular and would make the plate too stiff by the
    # length of the elements there: fine elements at the rim hold the first frequency to 0.01 %.
    along = min(plate.thickness / 4.0, plate.radius / 48.0) / factor
    through = min(plate.thickness / 8.0, plate.radius / 48.0) / factor
    rim = (
        None if plate.edge == "free" else min(plate.thickness / 32.0, plate.radius / 96.0) / factor
    )
    per_contact = min(outer_radius, inner_radius) / per_radius
    size = min(per_contact, along / 2.0, through)
    zone = CONTACT_ZONE * max(outer_radius, inner_radius)
    for name, radius in (
        ("outer.radius", scene.outer.radius),
        ("inner.radius", scene.inner.radius),
        ("plate.radius", plate.radius),
    ):
        if 4.0 * zone > radius:
            raise SceneError(
                f"{name} is {radius:g} m, but a contact radius of {zone / CONTACT_ZONE:.3g} m "
                f"is expected; {4.0 * CONTACT_ZONE:g} times as much is the least"
            )
    # An even count at factor 1: then the zone is the same at 2/3 and 3/2 of it, up to rounding.
    count = max(4, round(2.0 * math.ceil(zone / (2.0 * size * factor) - 1e-9) * factor))
    if count > 400:
        raise SceneError(
            f"the scene needs {count} elements across the contact zone, more than 400: its two "
            "contacts or contact and plate differ too much in size"
        )
    growth, through_growth = (ratio ** (1.0 / factor) for ratio in (1.2, 1.35))
    edge = (min(outer_radius, inner_radius), max(outer_radius, inner_radius))
    return MeshSettings(size, count, along, through, growth, through_growth, edge, rim)
