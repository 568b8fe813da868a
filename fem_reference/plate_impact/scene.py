"""The scene of a plate impact, decoded from ``scene.json`` (SI units)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from ..common.bodies import Bender, Body, Compact, Material, Plate, Sphere, Stack
from ..common.decode import At, decode, read_document
from ..common.fluid import Fluid
from ..impact.scene import TwoBodyScene
from .limits import require_solvable


@dataclass(frozen=True)
class Series:
    """The same impact several times, each with the dents of those before."""

    impacts: int
    """At most; they end earlier once nothing yields any more."""
    sphere_spot: Literal["same", "fresh"]
    """Whether the spheres are hit each time on the same spot, or where they have not yielded."""


@dataclass(frozen=True, kw_only=True)
class Scene(TwoBodyScene):
    """A body (outer) strikes a plate that a second one (inner) touches from below."""

    kind: Literal["plate-impact"]
    dry_plate: Annotated[Plate, At("plate")]
    fluid: Fluid | None
    """Behind the plate."""
    outer: Body
    inner: Sphere | Compact
    speed: Annotated[float, At("outer.speed")]
    """Speed of the outer body, m/s, positive."""
    offset: Annotated[float, At("outer.offset")] = 0.0
    """Distance of the point of impact from the axis, along x, m."""
    angle: Annotated[float, At("outer.angle")] = 0.0
    """Of the outer body's velocity against the plate's normal, rad; positive: towards +x."""
    gap: Annotated[float, At("inner.gap")]
    """Initial distance of the inner body from the plate, m."""
    inner_speed: Annotated[float, At("inner.speed")] = 0.0
    """Speed of the inner body towards the plate at the start, m/s; negative: away from it."""
    friction: float = 0.0
    """Coulomb's coefficient of contacts whose body states none."""
    outer_friction: Annotated[float | None, At("outer.friction")] = None
    inner_friction: Annotated[float | None, At("inner.friction")] = None
    outer_spin: Annotated[float, At("outer.spin")] = 0.0
    inner_spin: Annotated[float, At("inner.spin")] = 0.0
    """rad/s; 0: nothing else is solved."""
    series: Series | None
    """None: a single impact."""
    elements_per_contact_radius: Annotated[float, At("reference.elements_per_contact_radius")]
    elements_per_thickness: Annotated[float, At("reference.elements_per_thickness")] = 2.0
    """Quadratic ones, of the plate far from the contacts; of solid geometry only."""
    geometry: Annotated[Literal["axisymmetric", "solid"], At("reference.geometry")]
    element_order: Annotated[Literal[1, 2], At("reference.element_order")] = 2
    """1 linear, 2 quadratic; of solid geometry only."""

    @cached_property
    def plate(self) -> Plate:
        """As it moves: in a fluid with its added mass and damping."""
        return self.dry_plate if self.fluid is None else self.fluid.wet(self.dry_plate)

    @property
    def frictions(self) -> dict[str, float]:
        """Coulomb's coefficient by the body that touches the plate."""
        own = {"outer": self.outer_friction, "inner": self.inner_friction}
        return {name: self.friction if mu is None else mu for name, mu in own.items()}

    @property
    def rubs(self) -> bool:
        """Whether any contact has friction."""
        return any(friction > 0.0 for friction in self.frictions.values())

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


def parse_scene(document: Any) -> Scene:
    """The scene in a decoded ``scene.json``.

    Raises:
        SceneError: a field is missing, unknown or of another type, or this solver does not cover
            the scene.
    """
    scene = decode(Scene, document)
    require_solvable(scene)
    return scene


def read_scene(path: Path) -> Scene:
    """The scene in a file of kind plate-impact.

    Raises:
        SceneError: the file cannot be read, is not JSON, or see `parse_scene`.
    """
    return parse_scene(read_document(path))
