"""The scene: what is read from ``scene.json``, checked once and then immutable (SI units)."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import SceneError

EDGES = ("clamped", "simply-supported", "free")
GEOMETRIES = ("axisymmetric", "solid")
RIGID: dict[str, tuple[str, ...]] = {
    "none": (),
    "outer": ("outer",),
    "inner": ("inner",),
    "both": ("outer", "inner"),
}


@dataclass(frozen=True)
class Material:
    """Linear isotropic elastic material."""

    name: str
    youngs_modulus: float
    """Pa"""
    poisson_ratio: float
    density: float
    """kg/m^3"""

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2), Pa: what a half-space or a plate in bending feels."""
        return self.youngs_modulus / (1.0 - self.poisson_ratio**2)

    @property
    def shear_modulus(self) -> float:
        """E / (2 (1 + nu)), Pa."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def lame_lambda(self) -> float:
        """First Lame parameter, Pa."""
        nu = self.poisson_ratio
        return self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))


@dataclass(frozen=True)
class Plate:
    """Circular plate of constant thickness."""

    radius: float
    thickness: float
    edge: str
    """One of `EDGES`."""
    material: Material

    @property
    def bending_stiffness(self) -> float:
        """Kirchhoff bending stiffness D = E h^3 / (12 (1 - nu^2)), N m."""
        return self.material.plane_strain_modulus * self.thickness**3 / 12.0

    @property
    def surface_density(self) -> float:
        """Mass per area rho h, kg/m^2."""
        return self.material.density * self.thickness


@dataclass(frozen=True)
class Sphere:
    """Solid sphere."""

    radius: float
    material: Material

    @property
    def volume(self) -> float:
        """4/3 pi r^3, m^3."""
        return 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self.material.density * self.volume


@dataclass(frozen=True)
class Scene:
    """A sphere (outer) strikes a plate that a second sphere (inner) touches from below."""

    name: str
    scene_hash: str
    settings_hash: str
    plate: Plate
    outer: Sphere
    inner: Sphere
    speed: float
    """Speed of the outer sphere towards the plate, m/s, positive."""
    gap: float
    """Initial distance of the inner sphere from the plate, m."""
    end_time: float | None
    """s; None: until no further contact is possible."""
    elements_per_contact_radius: float
    geometry: str
    """One of `GEOMETRIES`."""
    element_order: int
    """1 linear, 2 quadratic; of solid geometry only."""
    rigid: tuple[str, ...]
    """Bodies ("outer", "inner") that are rigid; of solid geometry only."""
    raw: dict[str, Any]
    """The document as given, for the provenance."""


class Reader:
    """Typed access to one JSON object; every error names the field's full path."""

    def __init__(self, node: Any, path: str) -> None:
        if not isinstance(node, dict):
            raise SceneError(f"{path or 'the scene'} must be an object, not {_show(node)}")
        self.node = node
        self.path = path

    def _name(self, key: str) -> str:
        return f"{self.path}.{key}" if self.path else key

    def allow(self, *keys: str) -> None:
        """Refuse keys other than ``keys``."""
        for key in self.node:
            if key not in keys:
                raise SceneError(
                    f"{self._name(key)} is not a known field; known are {', '.join(keys)}"
                )

    def get(self, key: str) -> Any:
        """The value of a key that has to be there."""
        if key not in self.node:
            raise SceneError(f"{self._name(key)} is missing")
        return self.node[key]

    def child(self, key: str) -> Reader:
        """The object under a key."""
        return Reader(self.get(key), self._name(key))

    def text(self, key: str) -> str:
        """The text under a key."""
        value = self.get(key)
        if not isinstance(value, str):
            raise SceneError(f"{self._name(key)} must be a text, not {_show(value)}")
        return value

    def choice(self, key: str, allowed: tuple[str, ...]) -> str:
        """A text that is one of ``allowed``."""
        value = self.text(key)
        if value not in allowed:
            raise SceneError(
                f"{self._name(key)} is {value!r}, which this solver does not support; "
                f"supported: {', '.join(allowed)}"
            )
        return value

    def number(
        self,
        key: str,
        unit: str,
        *,
        above: float = 0.0,
        below: float = math.inf,
        inclusive: bool = False,
    ) -> float:
        """A finite number above (or at, if ``inclusive``) one bound and below another."""
        value = self.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SceneError(f"{self._name(key)} must be a number in {unit}, not {_show(value)}")
        number = float(value)
        low_ok = number >= above if inclusive else number > above
        if not math.isfinite(number) or not low_ok or not number < below:
            relation = "at least" if inclusive else "above"
            limit = f" and below {below:g} {unit}" if math.isfinite(below) else ""
            raise SceneError(
                f"{self._name(key)} is {number:g} {unit}; "
                f"it must be finite, {relation} {above:g} {unit}{limit}"
            )
        return number


def _show(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:37] + "..."


def read_material(reader: Reader) -> Material:
    """The material an object describes."""
    reader.allow("name", "youngs_modulus", "poisson_ratio", "density")
    return Material(
        name=reader.text("name"),
        youngs_modulus=reader.number("youngs_modulus", "Pa"),
        poisson_ratio=reader.number("poisson_ratio", "(no unit)", above=-1.0, below=0.5),
        density=reader.number("density", "kg/m^3"),
    )


def _plate(reader: Reader) -> Plate:
    reader.allow("radius", "thickness", "edge", "material", "damping_ratio")
    if reader.node.get("damping_ratio") is not None:
        damping = reader.number("damping_ratio", "(no unit)", inclusive=True)
        if damping > 0.0:
            raise SceneError(
                f"plate.damping_ratio is {damping:g}; this solver has no damping, it must be 0"
            )
    return Plate(
        radius=reader.number("radius", "m"),
        thickness=reader.number("thickness", "m"),
        edge=reader.choice("edge", EDGES),
        material=read_material(reader.child("material")),
    )


def _sphere(reader: Reader, extra: str) -> Sphere:
    reader.choice("kind", ("sphere",))
    reader.allow("kind", "radius", "material", extra)
    return Sphere(
        radius=reader.number("radius", "m"), material=read_material(reader.child("material"))
    )


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
        "fluid",
        "run",
        "reference",
    )
    if root.node.get("fluid") is not None:
        raise SceneError("fluid is given; this solver is for dry impacts, it must be null")
    reference = root.child("reference")
    geometry, element_order, rigid = _geometry(reference)
    end_time = None
    if root.node.get("run") is not None:
        run = root.child("run")
        run.allow("end_time")
        if run.node.get("end_time") is not None:
            end_time = run.number("end_time", "s")
    outer, inner = root.child("outer"), root.child("inner")
    return Scene(
        name=root.text("name"),
        scene_hash=root.text("scene_hash"),
        settings_hash=root.text("settings_hash"),
        plate=_plate(root.child("plate")),
        outer=_sphere(outer, "speed"),
        inner=_sphere(inner, "gap"),
        speed=outer.number("speed", "m/s"),
        gap=inner.number("gap", "m", inclusive=True),
        end_time=end_time,
        elements_per_contact_radius=reference.number(
            "elements_per_contact_radius", "(no unit)", above=2.0, below=65.0, inclusive=True
        ),
        geometry=geometry,
        element_order=element_order,
        rigid=rigid,
        raw=document,
    )


def read_document(path: Path) -> Any:
    """The decoded ``scene.json``, or the scene in a ``provenance.json``; not yet checked.

    Raises:
        SceneError: the file cannot be read or is not JSON.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"scene file {path} cannot be read: {error}") from error
    try:
        document = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise SceneError(f"scene file {path} is not valid JSON: {error}") from error
    inner = document.get("scene") if isinstance(document, dict) else None
    return inner if isinstance(inner, dict) else document


def read_scene(path: Path) -> Scene:
    """Read and check a scene file of kind plate-impact.

    Raises:
        SceneError: the file cannot be read, is not JSON, or its content is not valid.
    """
    return parse_scene(read_document(path))
