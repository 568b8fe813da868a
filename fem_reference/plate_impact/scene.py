"""The scene: what is read from ``scene.json``, checked once and then immutable (SI units)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..common.beam import Beam
from ..common.bodies import (
    EDGES,
    Bender,
    Body,
    Compact,
    Material,
    Plate,
    Sphere,
    Stack,
    Supply,
    read_material,
)
from ..common.errors import SceneError
from ..common.fluid import Fluid, read_fluid
from ..common.reader import Reader, read_document

MOMENT_LEFT = 1e-3
"""Largest share of a bender's moment at the strike."""
GEOMETRIES = ("axisymmetric", "solid")
RIGID: dict[str, tuple[str, ...]] = {
    "none": (),
    "outer": ("outer",),
    "inner": ("inner",),
    "both": ("outer", "inner"),
}


@dataclass(frozen=True)
class Series:
    """The same impact several times, each with the dents of those before."""

    impacts: int
    """At most; they end earlier once nothing yields any more."""
    fresh: bool
    """Whether the spheres are hit where they have not yielded each time."""


@dataclass(frozen=True)
class Scene:
    """A body (outer) strikes a plate that a second one (inner) touches from below."""

    name: str
    scene_hash: str
    settings_hash: str
    plate: Plate
    """As it moves: in a fluid with its added mass and damping."""
    dry_plate: Plate
    fluid: Fluid | None
    """Behind the plate."""
    outer: Body
    inner: Body
    speed: float
    """Speed of the outer body, m/s, positive."""
    offset: float
    """Distance of the point of impact from the axis, along x, m."""
    angle: float
    """Of the outer body's velocity against the plate's normal, rad; positive: towards +x."""
    gap: float
    """Initial distance of the inner body from the plate, m."""
    inner_speed: float
    """Speed of the inner body towards the plate at the start, m/s; negative: away from it."""
    friction: float
    """Coulomb's coefficient of both contacts."""
    series: Series | None
    """None: a single impact."""
    end_time: float | None
    """s; None: until no further contact is possible."""
    elements_per_contact_radius: float
    geometry: str
    """One of `GEOMETRIES`."""
    element_order: int
    """1 linear, 2 quadratic; of solid geometry only."""
    rigid: tuple[str, ...]
    """Bodies ("outer", "inner") that are rigid, tip included; of solid geometry only."""
    raw: dict[str, Any]
    """The document as given, for the provenance."""

    @property
    def centred(self) -> bool:
        """Whether the outer body strikes the centre of the plate along the axis."""
        return self.offset == 0.0 and self.angle == 0.0

    @property
    def normal_speed(self) -> float:
        """Of the outer body towards the plate, m/s."""
        return self.speed * math.cos(self.angle)

    @property
    def tangential_velocity(self) -> float:
        """Of the outer body along x, m/s."""
        return self.speed * math.sin(self.angle)

    @property
    def initial_energy(self) -> float:
        """Of both bodies at the start, J: kinetic, and the strain energy of a bender.

        Of a stack, which is given energy as it goes, the measure of it.
        """
        if isinstance(self.outer, Bender | Stack):
            own = self.outer.strike.energy if isinstance(self.outer, Bender) else self.outer.energy
            return own + 0.5 * self.inner.mass * self.inner_speed**2
        return 0.5 * (self.outer.mass * self.speed**2 + self.inner.mass * self.inner_speed**2)

    @property
    def initial_momenta(self) -> tuple[float, float]:
        """Of outer and inner body along z, kg m/s."""
        if isinstance(self.outer, Bender):
            return self.outer.strike.momentum, self.inner.mass * self.inner_speed
        return -self.outer.mass * self.normal_speed, self.inner.mass * self.inner_speed

    @property
    def materials(self) -> tuple[Material, Material, Material]:
        """Of outer body, plate and inner body."""
        return self.outer.material, self.plate.material, self.inner.material

    @property
    def yields(self) -> bool:
        """Whether any material may."""
        return any(material.yielding is not None for material in self.materials)

    @property
    def relaxing(self) -> list[str]:
        """Bodies whose material relaxes."""
        named = zip(("outer", "plate", "inner"), self.materials, strict=True)
        return [name for name, material in named if material.relaxation]

    @property
    def drag(self) -> float:
        """Resistance of the inner body over the square of its velocity, N s^2/m^2.

        c_W rho/2 pi R^2; eq. (2) of the paper, as printed, is a force per length.
        """
        fluid, radius = self.fluid, self.inner.tip_radius
        if fluid is None:
            return 0.0
        return 0.5 * fluid.drag_coefficient * fluid.density * math.pi * radius**2


def _plate(reader: Reader) -> Plate:
    reader.allow("radius", "thickness", "edge", "material", "damping_ratio")
    damping = 0.0
    if reader.node.get("damping_ratio") is not None:
        # From 1 on modes creep instead of oscillating, and the end of the run has no proof.
        damping = reader.number("damping_ratio", "(no unit)", below=1.0, inclusive=True)
    return Plate(
        radius=reader.number("radius", "m"),
        thickness=reader.number("thickness", "m"),
        edge=reader.choice("edge", EDGES),
        material=read_material(reader.child("material"), may_yield=True),
        damping_ratio=damping,
    )


def _body(reader: Reader, *extra: str) -> Body:
    material = read_material(reader.child("material"), may_yield=True)
    if reader.choice("kind", ("sphere", "compact")) == "sphere":
        reader.allow("kind", "radius", "material", *extra)
        return Sphere(reader.number("radius", "m"), material)
    reader.allow("kind", "mass", "tip_radius", "material", *extra)
    return Compact(reader.number("mass", "kg"), reader.number("tip_radius", "m"), material)


def _bender(reader: Reader) -> Bender:
    reader.allow(
        *("kind", "length", "bending_stiffness", "line_mass", "tip_mass"),
        *("tip_radius", "discharge_time", "strike_at", "material", "speed"),
    )
    beam = Beam(
        length=reader.number("length", "m"),
        bending_stiffness=reader.number("bending_stiffness", "N m^2"),
        line_mass=reader.number("line_mass", "kg/m"),
        tip_mass=reader.number("tip_mass", "kg"),
    )
    bender = Bender(
        beam,
        tip_radius=reader.number("tip_radius", "m"),
        material=read_material(reader.child("material")),
        speed=reader.number("speed", "m/s"),
        discharge_time=reader.number("discharge_time", "s", inclusive=True),
        strike_at=reader.number_or("strike_at", 0.0, "(no unit)", above=-1.0, below=1.0),
    )
    if bender.strike.moment_left > MOMENT_LEFT:
        raise SceneError(
            f"outer.discharge_time is {bender.discharge_time:g} s: at the strike "
            f"{100.0 * bender.strike.moment_left:.2g} % of the drive's moment is left, which this "
            f"solver takes as gone; at most {100.0 * MOMENT_LEFT:g} % may be"
        )
    return bender


def _stack(reader: Reader) -> Stack:
    reader.allow(
        *("kind", "length", "area", "stroke", "blocked_force", "voltage", "capacitance"),
        *("density", "poisson_ratio", "tip_radius", "gap", "drive", "material", "speed"),
    )
    supply = None
    if reader.node.get("drive") is not None:
        drive = reader.child("drive")
        drive.allow("resistance", "buffer_capacitance")
        buffer = drive.node.get("buffer_capacitance")
        supply = Supply(
            drive.number("resistance", "Ohm"),
            None if buffer is None else drive.number("buffer_capacitance", "F"),
        )
    return Stack(
        length=reader.number("length", "m"),
        area=reader.number("area", "m^2"),
        stroke=reader.number("stroke", "m"),
        blocked_force=reader.number("blocked_force", "N"),
        voltage=reader.number("voltage", "V"),
        capacitance=reader.number("capacitance", "F"),
        density=reader.number("density", "kg/m^3"),
        poisson_ratio=reader.number("poisson_ratio", "(no unit)", above=-1.0, below=0.5),
        tip_radius=reader.number("tip_radius", "m"),
        gap=reader.number("gap", "m", inclusive=True),
        drive=supply,
        material=read_material(reader.child("material")),
    )


def _direction(outer: Reader, plate: Plate, geometry: str) -> tuple[float, float]:
    """Where the outer body strikes (m from the axis) and at what angle (rad)."""
    offset = angle = 0.0
    if outer.node.get("kind") not in ("bender", "stack"):
        offset = outer.number_or("offset", 0.0, "m", below=plate.radius, inclusive=True)
        quarter = 0.5 * math.pi
        angle = outer.number_or("angle", 0.0, "rad", above=-quarter, below=quarter)
    for name, value, unit in (("offset", offset, "m"), ("angle", angle, "rad")):
        if value != 0.0 and geometry != "solid":
            raise SceneError(
                f"outer.{name} is {value:g} {unit}, which has no axis of symmetry: take "
                "reference.geometry 'solid'"
            )
    return offset, angle


def _series(root: Reader, geometry: str) -> Series | None:
    if root.node.get("series") is None:
        return None
    if geometry == "solid":
        raise SceneError("series is given: take reference.geometry 'axisymmetric'")
    series = root.child("series")
    series.allow("impacts", "sphere_spot")
    impacts = series.number("impacts", "(no unit)", above=1.0, inclusive=True)
    if impacts != int(impacts):
        raise SceneError(f"series.impacts is {impacts:g}; it must be a whole number")
    return Series(int(impacts), series.choice("sphere_spot", ("same", "fresh")) == "fresh")


def _outer(reader: Reader) -> Body:
    if reader.node.get("kind") == "bender":
        return _bender(reader)
    if reader.node.get("kind") == "stack":
        return _stack(reader)
    return _body(reader, "speed", "offset", "angle")


def _geometry(reference: Reader) -> tuple[str, int, tuple[str, ...]]:
    """Geometry, element order and rigid bodies of the table ``reference``."""
    reference.allow("geometry", "elements_per_contact_radius", "element_order", "rigid")
    geometry = reference.choice("geometry", GEOMETRIES)
    order, rigid = 2, "none"
    for key in ("element_order", "rigid"):
        if reference.node.get(key) is not None and geometry != "solid":
            raise SceneError(f"reference.{key} belongs to reference.geometry 'solid' only")
    if reference.node.get("element_order") is not None:
        number = reference.number("element_order", "(no unit)")
        if number not in (1.0, 2.0):
            raise SceneError(f"reference.element_order is {number:g}; it must be 1 or 2")
        order = int(number)
    if reference.node.get("rigid") is not None:
        rigid = reference.choice("rigid", tuple(RIGID))
    return geometry, order, RIGID[rigid]


def _require_elastic(
    materials: dict[str, Material], geometry: str, may_yield: bool, wet: bool
) -> None:
    """Refuse what yields where this solver has no yielding, and beside what relaxes."""
    relaxing = [name for name, material in materials.items() if material.relaxation]
    for name, material in materials.items():
        if material.yielding is not None and not (may_yield and geometry != "solid" and not wet):
            raise SceneError(
                f"{name}.material yields (hardening {material.yielding.hardening:g} Pa); this "
                "solver has that between spheres, compact bodies and plate, axisymmetric and dry"
            )
        if material.yielding is not None and relaxing:
            raise SceneError(
                f"{name}.material yields and {relaxing[0]}.material relaxes; this solver has "
                "one of both in a scene"
            )


def _are_spheres(bodies: dict[str, Body]) -> bool:
    return all(isinstance(body, Sphere) for body in bodies.values())


def parse_scene(document: Any) -> Scene:
    """Check a decoded ``scene.json``.

    Raises:
        SceneError: naming the field, its value and what would be valid.
    """
    root = Reader(document, "")
    root.choice("kind", ("plate-impact",))
    root.allow(
        "name",
        "description",
        "kind",
        "scene_hash",
        "settings_hash",
        "plate",
        "outer",
        "inner",
        "friction",
        "fluid",
        "series",
        "run",
        "reference",
    )
    fluid = read_fluid(root.child("fluid")) if root.node.get("fluid") is not None else None
    reference = root.child("reference")
    geometry, element_order, rigid = _geometry(reference)
    if geometry == "solid" and fluid is not None:
        raise SceneError(
            "fluid is given; solid geometry is for dry impacts, it must be null: take "
            "reference.geometry 'axisymmetric'"
        )
    end_time = None
    if root.node.get("run") is not None:
        run = root.child("run")
        run.allow("end_time")
        if run.node.get("end_time") is not None:
            end_time = run.number("end_time", "s")
    plate = _plate(root.child("plate"))
    if geometry == "solid" and plate.damping_ratio > 0.0:
        raise SceneError(
            f"plate.damping_ratio is {plate.damping_ratio:g}; solid geometry has no damping, it "
            "must be 0: take reference.geometry 'axisymmetric'"
        )
    outer, inner = root.child("outer"), root.child("inner")
    bodies = {"outer": _outer(outer), "inner": _body(inner, "gap", "speed")}
    if isinstance(bodies["outer"], Bender | Stack):
        if geometry == "solid":
            kind = outer.node["kind"]
            raise SceneError(f"outer.kind is '{kind}': take reference.geometry 'axisymmetric'")
        if end_time is None:
            raise SceneError(
                "run.end_time is missing; a bender or a stack comes back to the plate for ever, so "
                "that it has to be given"
            )
    offset, angle = _direction(outer, plate, geometry)
    friction = root.number_or("friction", 0.0, "(no unit)", inclusive=True)
    if friction > 0.0 and not _are_spheres(bodies):
        raise SceneError(
            f"friction is {friction:g}; this solver has it between spheres and plate, elsewhere it "
            "must be 0"
        )
    materials = {"plate": plate.material, **{n: body.material for n, body in bodies.items()}}
    may_yield = all(isinstance(body, Sphere | Compact) for body in bodies.values())
    _require_elastic(materials, geometry, may_yield, fluid is not None)
    relaxing = [name for name, material in materials.items() if material.relaxation]
    if relaxing and (offset != 0.0 or angle != 0.0):
        raise SceneError(
            f"{relaxing[0]}.material.relaxation is given; beside the axis or at an angle this "
            "solver has elastic bodies only"
        )
    for name, body in bodies.items():
        if not isinstance(body, Sphere) and name not in rigid and body.material.relaxation:
            raise SceneError(
                f"{name}.material.relaxation is given; the tip of a compact body or a bender "
                "yields as an elastic half-space does: take a sphere"
            )
        if geometry == "solid" and isinstance(body, Compact) and name not in rigid:
            raise SceneError(
                f"{name}.kind is 'compact', whose tip has to yield; solid geometry has rigid tips "
                f"only: take reference.geometry 'axisymmetric', or name it in reference.rigid"
            )
    return Scene(
        name=root.text("name"),
        scene_hash=root.text("scene_hash"),
        settings_hash=root.text("settings_hash"),
        plate=plate if fluid is None else fluid.wet(plate),
        dry_plate=plate,
        fluid=fluid,
        outer=bodies["outer"],
        inner=bodies["inner"],
        speed=outer.number("speed", "m/s"),
        offset=offset,
        angle=angle,
        gap=inner.number("gap", "m", inclusive=True),
        inner_speed=inner.number_or("speed", 0.0, "m/s", above=-math.inf),
        friction=friction,
        series=_series(root, geometry),
        end_time=end_time,
        elements_per_contact_radius=reference.number(
            "elements_per_contact_radius", "(no unit)", above=2.0, below=65.0, inclusive=True
        ),
        geometry=geometry,
        element_order=element_order,
        rigid=rigid,
        raw=document,
    )


def read_scene(path: Path) -> Scene:
    """Read and check a scene file of kind plate-impact.

    Raises:
        SceneError: the file cannot be read, is not JSON, or its content is not valid.
    """
    return parse_scene(read_document(path))
