"""The seal-seat scene: what is read from ``scene.json``, checked once, and where its parts lie.

Axes: z = 0 is the flat underside, z points up; seats and tips lie in the plane of symmetry y = 0,
the seats at x = -+ half their distance; the sphere rests in the one at x < 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.bodies import Material, read_material
from ..common.errors import SceneError
from ..common.reader import Reader
from ..solid.sphere_pairs import Ball

KIND = "seal-seat"

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


@dataclass(frozen=True)
class SeatScene:
    """A sphere in a seal seat that an actuator strikes from below."""

    name: str
    scene_hash: str
    settings_hash: str
    geometry_hash: str | None
    """Identity of what the mesh depends on; None if the document has none."""
    seat: Seat
    sphere_radius: float
    """m"""
    sphere_material: Material
    sphere_mass: float
    """kg"""
    sphere_elastic: bool
    actuator: Actuator
    friction: float
    """Coulomb's coefficient, of all contacts."""
    intended_angle: float
    """rad"""
    end_time: float | None
    """s; None: until no further contact is possible."""
    elements_per_ring_radius: float
    element_order: int
    raw: dict[str, Any]
    """The document as given, for the provenance."""

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


def _seat(reader: Reader) -> Seat:
    reader.allow("material", "tilt", "aperture_angle", "notch", *SEAT_LENGTHS)
    notch = None
    if reader.node.get("notch") is not None:
        child = reader.child("notch")
        child.allow("width", "floor")
        notch = Notch(child.number("width", "m"), child.number("floor", "m"))
    return Seat(
        material=read_material(reader.child("material")),
        tilt=reader.number("tilt", "rad", below=0.5 * math.pi, inclusive=True),
        aperture_angle=reader.number("aperture_angle", "rad", below=math.pi),
        notch=notch,
        **{name: reader.number(name, "m") for name in SEAT_LENGTHS},
    )


def _actuator(reader: Reader) -> Actuator:
    reader.allow("mass", "speed", "tip_radius", "tip_positions")
    positions = reader.get("tip_positions")
    sound = isinstance(positions, list) and positions and all(_finite(x) for x in positions)
    if not sound:
        raise SceneError(
            f"actuator.tip_positions is {positions!r}; it must be a list of numbers in m"
        )
    return Actuator(
        mass=reader.number("mass", "kg"),
        speed=reader.number("speed", "m/s"),
        tip_radius=reader.number("tip_radius", "m"),
        tip_positions=tuple(float(x) for x in positions),
    )


def _finite(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def parse_seat_scene(document: Any) -> SeatScene:
    """Check a decoded ``scene.json``.

    Collisions of features are the program's affair: it refuses them before it calls this solver;
    what slips through fails in gmsh.

    Raises:
        SceneError: naming the field, its value and what would be valid.
    """
    root = Reader(document, "")
    root.choice("kind", (KIND,))
    root.allow(
        "name",
        "description",
        "kind",
        "scene_hash",
        "settings_hash",
        "geometry_hash",
        "seat",
        "sphere",
        "actuator",
        "friction",
        "intended_angle",
        "run",
        "reference",
    )
    reference = root.child("reference")
    reference.allow("geometry", "elements_per_ring_radius", "element_order")
    order = 2.0
    if reference.node.get("element_order") is not None:
        order = reference.number("element_order", "(no unit)")
        if order not in (1.0, 2.0):
            raise SceneError(f"reference.element_order is {order:g}; it must be 1 or 2")
    end_time = None
    if root.node.get("run") is not None:
        run = root.child("run")
        run.allow("end_time")
        if run.node.get("end_time") is not None:
            end_time = run.number("end_time", "s")
    seat, sphere = _seat(root.child("seat")), root.child("sphere")
    sphere.allow("radius", "material", "mass", "body")
    if "relaxation" in sphere.child("material").node:
        raise SceneError(
            "sphere.material.relaxation is given; of a seal seat the seat alone relaxes"
        )
    return SeatScene(
        name=root.text("name"),
        scene_hash=root.text("scene_hash"),
        settings_hash=root.text("settings_hash"),
        geometry_hash=root.text("geometry_hash") if "geometry_hash" in root.node else None,
        seat=seat,
        sphere_radius=sphere.number("radius", "m"),
        sphere_material=read_material(sphere.child("material")),
        sphere_mass=sphere.number("mass", "kg"),
        sphere_elastic=sphere.choice("body", ("rigid", "elastic")) == "elastic",
        actuator=_actuator(root.child("actuator")),
        friction=root.number_or("friction", 0.0, "(no unit)", inclusive=True),
        intended_angle=root.number("intended_angle", "rad", above=-math.pi, inclusive=True),
        end_time=end_time,
        elements_per_ring_radius=reference.number(
            "elements_per_ring_radius", "(no unit)", above=0.5, below=100.0, inclusive=True
        ),
        element_order=int(order),
        raw=document,
    )
