"""The scene of an impact on any elastic body, decoded from ``scene.json`` (SI units)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from ..body.scene import BodyFile, BodyScene, Contact
from ..common.bodies import Compact, Material, Plate, Sphere
from ..common.decode import At, decode
from ..common.errors import SceneError
from ..impact.scene import TwoBodyScene

OUTER, INNER = "outer", "inner"


@dataclass(frozen=True)
class Body:
    """An elastic body whose shape is in a file."""

    content: str
    """SHA-256 of the file."""
    unit: float | None
    """See `BodyFile`."""
    material: Material
    fixed: tuple[object, ...]
    """See `BodyFile`."""
    element_size: float | None
    """See `BodyFile`."""
    at: tuple[object, ...]
    """Where outer and inner body strike: a name or a point, see `Contact`."""
    damping_ratio: float = 0.0


@dataclass(frozen=True)
class Wall:
    """A half-space that does not move."""

    material: Material | None
    """None: rigid."""


@dataclass(frozen=True, kw_only=True)
class Scene(TwoBodyScene):
    """A body (outer) strikes what may have a second one (inner) behind it, or that one itself."""

    kind: Literal["impact"]
    outer: Sphere | Compact
    speed: Annotated[float, At("outer.speed")]
    """Of the outer body towards what it strikes, m/s, positive."""
    offset: Annotated[float, At("outer.offset")] = 0.0
    angle: Annotated[float, At("outer.angle")] = 0.0
    outer_friction: Annotated[float, At("outer.friction")] = 0.0
    body: Body | None
    wall: Wall | None
    plate: Plate | None
    inner: Sphere | Compact | None
    gap: Annotated[float, At("inner.gap")] = 0.0
    """Initial distance of the inner body from the body between, m."""
    inner_speed: Annotated[float, At("inner.speed")] = 0.0
    """Of the inner body towards the other one at the start, m/s."""
    inner_friction: Annotated[float, At("inner.friction")] = 0.0
    friction: float = 0.0
    outer_spin: Annotated[float, At("outer.spin")] = 0.0
    inner_spin: Annotated[float, At("inner.spin")] = 0.0
    series: object = None
    fluid: object = None
    elements_per_contact_radius: Annotated[float, At("reference.elements_per_contact_radius")]
    geometry: Annotated[Literal["solid"], At("reference.geometry")] = "solid"
    element_order: Annotated[Literal[1, 2], At("reference.element_order")] = 2

    @property
    def struck_is_inner(self) -> bool:
        """Whether nothing lies between outer and inner body."""
        return self.body is None and self.wall is None and self.plate is None

    @property
    def struck_material(self) -> Material | None:
        """Of what the outer body strikes; None: it is rigid."""
        if self.body is not None:
            return self.body.material
        if self.plate is not None:
            return self.plate.material
        if self.wall is not None:
            return self.wall.material
        return self.inner.material if self.inner is not None else None

    @property
    def struck_velocity(self) -> float:
        """Of what the outer body strikes at the start, along z, m/s."""
        return self.inner_speed if self.struck_is_inner else 0.0

    @property
    def closing_speed(self) -> float:
        """With which outer body and what it strikes approach each other, m/s."""
        return self.speed + self.struck_velocity

    @property
    def held(self) -> bool | None:
        """Whether plate or body is held; None: there is neither."""
        if self.body is not None:
            return bool(self.body.fixed)
        return self.plate.edge != "free" if self.plate is not None else None

    @property
    def initial_energy(self) -> float:
        """Kinetic energy of both bodies at the start, J."""
        inner = self.inner.mass * self.inner_speed**2 if self.inner is not None else 0.0
        return 0.5 * (self.outer.mass * self.speed**2 + inner)

    def partners(self) -> dict[str, Sphere | Compact]:
        """The bodies that have a contact with the elastic body, plate, wall or inner body."""
        found: dict[str, Sphere | Compact] = {OUTER: self.outer}
        if self.inner is not None and not self.struck_is_inner:
            found[INNER] = self.inner
        return found

    def has(self, name: str) -> bool:
        """Whether a quantity or curve means something in this scene."""
        if name == "efficiency" or name.startswith(("inner_velocity", "inner_displacement")):
            return self.inner is not None
        if name == "first_frequency":
            return self.held is not None
        if name == "inner_restitution":
            return INNER in self.partners() and self.inner_speed > 0.0
        return not name.startswith("inner") or INNER in self.partners()

    def body_scene(self, file: Path) -> BodyScene:
        """The scene as the mesher of bodies reads it.

        Raises:
            SceneError: there is no body, or no place where one strikes it.
        """
        body, found = self.body, {}
        if body is None:
            raise SceneError("the scene has no body from a file")
        for (name, partner), at in zip(self.partners().items(), body.at, strict=False):
            found[name] = Contact(at, partner.tip_radius)
        about = BodyFile(str(file), body.unit, body.fixed, body.element_size, None)
        return BodyScene("impact", about, found[OUTER], found.get(INNER))


def parse_scene(document: Any) -> Scene:
    """The scene in a decoded ``scene.json``.

    Raises:
        SceneError: a field is missing, unknown or of another type, or this solver does not cover
            the scene.
    """
    if isinstance(document, dict) and "materials" in (document.get("body") or {}):
        raise SceneError(
            "body.materials is given; the reference takes one material: give body.material"
        )
    scene = decode(Scene, document)
    for refused, sentence in _refusals(scene):
        if refused:
            raise SceneError(sentence)
    return scene


def _refusals(scene: Scene) -> Iterator[tuple[bool, str]]:
    """Whether a scene is refused, and why."""
    named = ("body", "wall", "plate")
    there = [name for name in named if getattr(scene, name) is not None]
    yield len(there) > 1, f"the scene has {' and '.join(there)}; it must have one of them at most"
    yield scene.struck_is_inner and scene.inner is None, "inner is missing: nothing is struck"
    if scene.inner is not None:
        beyond = next((name for name in ("wall", "plate") if name in there), None)
        yield beyond is not None, f"inner is given with {beyond}; remove one of them"
    for name in ("offset", "angle"):
        value = getattr(scene, name)
        yield value != 0.0, f"outer.{name} is {value:g}; this solver strikes along the normal: 0"
    for name, value in (
        ("friction", scene.friction),
        ("outer.friction", scene.outer_friction),
        ("inner.friction", scene.inner_friction),
        ("outer.spin", scene.outer_spin),
        ("inner.spin", scene.inner_spin),
    ):
        yield value != 0.0, f"{name} is {value:g}; this solver has none: it must be 0"
    for name in ("series", "fluid"):
        given = getattr(scene, name) is not None
        yield given, f"{name} is given; this solver has one dry impact: it must be null"
    for name in ("body", "plate"):
        struck = getattr(scene, name)
        ratio = struck.damping_ratio if struck is not None else 0.0
        yield ratio != 0.0, f"{name}.damping_ratio is {ratio:g}; this solver has none: it must be 0"
    yield (
        not scene.closing_speed > 0.0,
        (f"the bodies approach each other at {scene.closing_speed:g} m/s; it must be above 0"),
    )
    yield from _of_materials(scene)
    yield from _of_rigid(scene)


def _of_materials(scene: Scene) -> Iterator[tuple[bool, str]]:
    struck = scene.struck_material
    inner = scene.inner.material if scene.inner is not None else None
    for name, material in (("outer", scene.outer.material), ("struck", struck), ("inner", inner)):
        if material is None:
            continue
        where = f"material {material.name!r} ({name})"
        yield (
            material.yielding is not None,
            f"{where} yields (hardening {material.hardening} Pa); this solver is elastic",
        )
        yield bool(material.relaxation), f"{where} relaxes; this solver is elastic"


def _of_rigid(scene: Scene) -> Iterator[tuple[bool, str]]:
    bodies = (("outer", scene.outer), ("inner", scene.inner))
    for name, body in bodies:
        yield (
            isinstance(body, Compact) and name not in scene.rigid,
            f"{name}.kind is 'compact', whose tip deforms; this solver has rigid tips only: name "
            "it in reference.rigid",
        )
        yield name in scene.rigid and body is None, f"reference.rigid names {name}, which is absent"
    yield (
        scene.struck_is_inner and scene.rigid_bodies == "both",
        "reference.rigid is 'both'; one of two bodies must deform",
    )
    yield (
        scene.wall is not None and scene.wall.material is None and OUTER in scene.rigid,
        "reference.rigid is 'outer', but the wall is rigid; one of them must deform",
    )
    yield (
        scene.struck_is_inner and INNER in scene.rigid,
        "reference.rigid names inner, which the outer body strikes; name outer",
    )
