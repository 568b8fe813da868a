"""The seal-seat scene, decoded from ``scene.json``, and where its parts lie.

Axes: z = 0 is the flat underside, z points up; seats and tips lie in the plane of symmetry y = 0,
the seats at x = -+ half their distance; the sphere rests in the one at x < 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np

from ..common.arrays import Floats
from ..common.bodies import Material
from ..common.decode import At, decode
from ..impact.scene import ImpactScene
from ..solid.sphere_pairs import Ball

SEAT_LENGTHS = (
    "membrane_radius",
    "membrane_thickness",
    "island_length",
    "island_width",
    "island_height",
    "seat_distance",
    "seated_height",
    "bore_radius",
    "bore_depth",
)


@dataclass(frozen=True)
class Notch:
    """Slot across the island, between the seats."""

    width: float
    """Along x, m."""
    floor: float
    """z of its floor, m."""


@dataclass(frozen=True)
class Seat:
    """Membrane and island with both seats; lengths in m, angles in rad."""

    material: Material
    membrane_radius: float
    membrane_thickness: float
    island_length: float
    """Along x."""
    island_width: float
    """Along y."""
    island_height: float
    """z of its top."""
    seat_distance: float
    """Of the centres of spheres that rest in the two seats."""
    seated_height: float
    """z of these centres."""
    tilt: float
    """alpha: the seats' axes lean inwards by this."""
    aperture_angle: float
    """gamma: full angle of the cones."""
    bore_radius: float
    bore_depth: float
    """From the seated centre along the axis."""
    notch: Notch | None


@dataclass(frozen=True)
class Ring:
    """The circle along which a seat's cone touches its sphere.

    A place has the coordinates s along the axis, out of the seat, from the sphere's centre, and
    rho, its distance from the axis.
    """

    sphere_centre: tuple[float, float, float]
    """m"""
    axis: tuple[float, float, float]
    """Of length 1."""
    radius: float
    """rho of the ring, m: r cos(gamma / 2)."""
    offset: float
    """s of the ring, m: - r sin(gamma / 2)."""
    half_angle: float
    """Of the cone, rad."""

    def coordinates(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,) s and rho of points (n, 3), m."""
        away = points - np.array(self.sphere_centre)
        s = away @ np.array(self.axis)
        rho = np.sqrt(np.maximum((away**2).sum(axis=1) - s**2, 0.0))
        return s, rho

    def cone(self, s: Floats) -> Floats:
        """Radius rho of the cone at s, m."""
        return np.asarray(self.radius + (s - self.offset) * math.tan(self.half_angle))

    def on_cone(self, points: Floats) -> Floats:
        """Points (n, 3) moved along their radius onto the cone, m."""
        s, rho = self.coordinates(points)
        foot = np.array(self.sphere_centre) + s[:, None] * np.array(self.axis)
        return np.asarray(foot + (points - foot) * (self.cone(s) / rho)[:, None])

    def distance(self, points: Floats) -> Floats:
        """(n,) distance of points (n, 3) from the ring, m."""
        s, rho = self.coordinates(points)
        return np.hypot(s - self.offset, rho - self.radius)


@dataclass(frozen=True)
class Actuator:
    """Rigid, guided along z, with spherical tips that touch the underside at t = 0."""

    mass: float
    """kg"""
    speed: float
    """m/s"""
    tip_radius: float
    """m"""
    tip_positions: tuple[float, ...]
    """x of each tip, m."""


@dataclass(frozen=True, kw_only=True)
class SeatScene(ImpactScene):
    """A sphere in a seal seat that an actuator strikes from below."""

    kind: Literal["seal-seat"]
    geometry_hash: str | None = None
    """Identity of what the mesh depends on; None if the document has none."""
    seat: Seat
    sphere_radius: Annotated[float, At("sphere.radius")]
    """m"""
    sphere_material: Annotated[Material, At("sphere.material")]
    sphere_mass: Annotated[float, At("sphere.mass")]
    """kg"""
    sphere_body: Annotated[Literal["rigid", "elastic"], At("sphere.body")]
    actuator: Actuator
    friction: float = 0.0
    """Coulomb's coefficient, of all contacts."""
    intended_angle: float
    """rad"""
    elements_per_ring_radius: Annotated[float, At("reference.elements_per_ring_radius")]
    geometry: Annotated[Literal["solid"], At("reference.geometry")] = "solid"
    element_order: Annotated[Literal[1, 2], At("reference.element_order")] = 2

    @property
    def sphere_elastic(self) -> bool:
        """Whether the sphere deforms."""
        return self.sphere_body == "elastic"

    def ring(self, side: float = -1.0) -> Ring:
        """The ring of the seat at x < 0 (side -1, where the sphere rests) or x > 0 (side +1)."""
        seat, half = self.seat, 0.5 * self.seat.aperture_angle
        return Ring(
            (0.5 * side * seat.seat_distance, 0.0, seat.seated_height),
            (-side * math.sin(seat.tilt), 0.0, math.cos(seat.tilt)),
            self.sphere_radius * math.cos(half),
            -self.sphere_radius * math.sin(half),
            half,
        )

    @property
    def ball(self) -> Ball:
        """The sphere at rest in its seat."""
        return Ball(self.ring().sphere_centre, self.sphere_radius)

    def lengths_over(self, unit: float) -> SeatScene:
        """The same geometry with all lengths as multiples of ``unit`` (m)."""
        seat, notch, actuator = self.seat, self.seat.notch, self.actuator
        if notch is not None:
            notch = Notch(notch.width / unit, notch.floor / unit)
        lengths = {name: getattr(seat, name) / unit for name in SEAT_LENGTHS}
        return replace(
            self,
            seat=replace(seat, notch=notch, **lengths),
            sphere_radius=self.sphere_radius / unit,
            actuator=replace(
                actuator,
                tip_radius=actuator.tip_radius / unit,
                tip_positions=tuple(x / unit for x in actuator.tip_positions),
            ),
        )

    @property
    def initial_energy(self) -> float:
        """Kinetic energy of the actuator before the impact, J."""
        return 0.5 * self.actuator.mass * self.actuator.speed**2


def parse_seat_scene(document: Any) -> SeatScene:
    """The scene in a decoded ``scene.json``.

    Collisions of features are the program's to check; what slips through fails in gmsh.

    Raises:
        SceneError: a field is missing, unknown or of another type.
    """
    return decode(SeatScene, document)
