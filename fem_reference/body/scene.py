"""What the mesh of a body needs of a scene of kind impact."""

from __future__ import annotations

import difflib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.decode import decode
from ..common.errors import SceneError


@dataclass(frozen=True)
class Disc:
    """A circular plate about the z axis, from z = 0 to its thickness."""

    radius: float
    thickness: float


@dataclass(frozen=True)
class BodyFile:
    """The file of a body, and what is said of it."""

    path: str
    unit: float | None
    """Metres per number of the file; None: the unit that a CAD file states, else 1."""
    fixed: tuple[object, ...]
    """Names, or points [x, y, z] in m on the faces; none: the body is free."""
    element_size: float | None
    """Largest element of a CAD part, m."""
    materials: object
    """Material (a name) by group of volumes; None: one material."""
    disc: Disc | None = None
    """What is meshed instead of a file."""

    def material_names(self) -> dict[str, str]:
        """Material by group of volumes; empty: one material."""
        return dict(self.materials) if isinstance(self.materials, dict) else {}


@dataclass(frozen=True)
class Contact:
    """Where a body strikes."""

    at: object
    """A name, or a point [x, y, z] in m."""
    tip_radius: float | None


@dataclass(frozen=True)
class BodyScene:
    """A scene of kind impact, as far as the mesh of its body depends on it."""

    kind: str
    body: BodyFile
    outer: Contact
    inner: Contact | None

    def contacts(self) -> dict[str, Contact]:
        """The contacts that there are, by name."""
        return {"outer": self.outer} | ({"inner": self.inner} if self.inner else {})


Place = str | Floats
"""A name, or a point (3,) in m."""


def parse_body_scene(document: Any) -> BodyScene:
    """The scene of a decoded ``scene.json``.

    Raises:
        SceneError: a field is missing, unknown, of the wrong type or out of bounds.
    """
    scene = decode(BodyScene, document)
    for key in ("unit", "element_size"):
        value = getattr(scene.body, key)
        if value is not None and not value > 0.0:
            raise SceneError(f"body.{key} is {value:g} m; it must be above 0")
    disc = scene.body.disc
    if disc and not (disc.radius > 0.0 and disc.thickness > 0.0):
        raise SceneError(f"body.disc is {disc}; radius and thickness must be above 0")
    groups = scene.body.materials
    if groups is not None and not (
        isinstance(groups, dict) and all(isinstance(each, str) for each in groups.values())
    ):
        raise SceneError("body.materials must be an object of names of materials by group")
    for k, each in enumerate(scene.body.fixed):
        place(each, f"body.fixed[{k}]")
    for name, contact in scene.contacts().items():
        place(contact.at, f"{name}.at")
    return scene


def place(value: object, path: str) -> Place:
    """A name or a point from its JSON value.

    Raises:
        SceneError: it is neither.
    """
    if isinstance(value, str) and value.strip():
        return value
    if isinstance(value, list) and len(value) == 3:
        numbers = [isinstance(x, (int, float)) and not isinstance(x, bool) for x in value]
        if all(numbers) and all(math.isfinite(x) for x in value):
            return np.array(value, dtype=np.float64)
    raise SceneError(f"{path} must be a name or a point [x, y, z] in m")


def nearest_first(name: str, names: Sequence[str]) -> list[str]:
    """The names, those most like ``name`` first."""

    def likeness(other: str) -> float:
        return difflib.SequenceMatcher(None, name.casefold(), other.casefold()).ratio()

    return sorted(dict.fromkeys(names), key=lambda other: (-likeness(other), other))


def no_such_name(name: str, path: str, names: Sequence[str]) -> SceneError:
    """The error for a name that the file does not have; it lists those that it has."""
    ordered = nearest_first(name, names)
    listed = ", ".join(repr(each) for each in ordered[:12])
    more = f" and {len(ordered) - 12} more" if len(ordered) > 12 else ""
    there = f"it has {listed}{more}" if ordered else "it has no names; give a point [x, y, z]"
    return SceneError(f"{path} is {name!r}, which the file does not have; {there}")
