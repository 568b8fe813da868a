"""Everything that decides an axisymmetric mesh: element sizes and where they are needed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..common.arrays import Floats

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
    factor: float = 1.0
    """On the number of elements requested."""
    sphere_elements: tuple[int | None, int | None] = (None, None)
    """Elements of the zone that outer and inner sphere share with the plate; None: all."""
    sphere_refinement: tuple[float, float] = (1.0, 1.0)
    """On the number of elements of outer and inner sphere along the waves that leave the contact.
    """

    @property
    def contact_zone(self) -> float:
        """Radius of the zone of matching nodes, m."""
        return self.contact_element * self.contact_elements

    def of_sphere(self, number: int) -> tuple[MeshSettings, Floats]:
        """Settings for the zone of the outer (0) or inner (1) sphere, and its matching radii, m."""
        count, radii = self.sphere_elements[number], self.zone_radii()
        if count is None or count >= self.contact_elements:
            return self, radii
        radii = radii[: count + 1]
        return replace(
            self, contact_element=float(radii[-1]) / count, contact_elements=count
        ), radii

    def zone_radii(self) -> Floats:
        """(n,) radii of the matching nodes, m.

        While the edge of contact moves from node to node the force follows a chord of Hertz's
        curve, which is off by up to 3/8 (element / contact radius)^2; where the edge stands at the
        peak decides about the peak's error. There the elements are `EDGE_REFINEMENT` times as fine.
        """
        even: Floats = self.contact_element * np.arange(self.contact_elements + 1.0)
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
