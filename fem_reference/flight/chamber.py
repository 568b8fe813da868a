"""The walls of a chamber in section: two conical seats in an island, or a floor over a rocker."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

Point = tuple[float, float]
Wall = tuple[Point, Point]
"""From one point (x, z) to another in mm, the free space to the left."""


@dataclass(frozen=True)
class Seat:
    """A seal seat in section; lengths in mm, angles in rad, names as in scenes."""

    membrane_radius: float
    membrane_thickness: float
    island_length: float
    island_height: float
    seat_distance: float
    seated_height: float
    tilt: float
    aperture_angle: float
    bore_radius: float
    notch_width: float
    notch_floor: float
    sphere_radius: float
    chamber_height: float

    def walls(self) -> list[Wall]:
        """The walls that a sphere can meet."""
        left = self._flanks()
        mirrored = [((-b[0], b[1]), (-a[0], a[1])) for a, b in left]
        rim, top = self.membrane_radius, self.chamber_height
        corners = [(rim, self.membrane_thickness), (rim, top), (-rim, top)]
        corners.append((-rim, self.membrane_thickness))
        return [*left, *mirrored, *pairwise(corners)]

    def _flanks(self) -> list[Wall]:
        """Walls at x < 0: by the angles at which the flanks rise from the cone's tip."""
        half, edge = self.aperture_angle / 2, self.notch_width / 2
        # the sphere touches both flanks: its centre is this far from the tip
        far = self.sphere_radius / math.sin(half)
        tip = (
            -self.seat_distance / 2 - far * math.sin(self.tilt),
            self.seated_height - far * math.cos(self.tilt),
        )
        # slope of each flank over the horizontal
        inner, outer = math.pi / 2 - half - self.tilt, math.pi / 2 - half + self.tilt

        def inwards(x: float) -> Point:
            return x, tip[1] + (x - tip[0]) * math.tan(inner)

        start = self.bore_radius / math.sin(half)
        mouth = inwards(tip[0] + start * math.cos(inner))
        ends = [mouth, inwards(-edge)]
        if ends[1][1] > self.island_height:
            at_top = tip[0] + (self.island_height - tip[1]) / math.tan(inner)
            ends = [mouth, (at_top, self.island_height), (-edge, self.island_height)]
        low = (tip[0] - start * math.cos(outer), tip[1] + start * math.sin(outer))
        reach = (self.island_height - tip[1]) / math.tan(outer)
        high = (tip[0] - reach, self.island_height)
        side = -self.island_length / 2
        steps = [(-self.membrane_radius, self.membrane_thickness), (side, self.membrane_thickness)]
        steps += [(side, self.island_height), high, low]
        return [*pairwise(steps), *pairwise(ends)]

    def seats(self) -> tuple[Point, Point]:
        """Centres of a sphere in the seat it starts from and in the other one."""
        x = self.seat_distance / 2
        return (-x, self.seated_height), (x, self.seated_height)

    def saddle(self) -> Point:
        """Centre of a sphere that stands on the inner edge of its seat, the highest on its way."""
        # the flanks' last wall ends there
        x, z = self._flanks()[-1][1]
        return x, z + self.sphere_radius
