"""What a file has: nodes, solid cells, and named groups of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from .scene import no_such_name


def _none() -> Ints:
    return np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Group:
    """A named part of a body."""

    name: str
    kind: str
    """volume, surface, curve, point; nodes, elements."""
    nodes: Ints = field(default_factory=_none)
    facets: Sequence[Ints] = ()
    """Corners (k, 2 to 4) of lines, triangles, quadrilaterals."""
    elements: Ints = field(default_factory=_none)
    about: dict[str, Any] = field(default_factory=dict)
    """More that is stated of it: place and area of a CAD face."""

    def count(self) -> int:
        """How many elements, facets or nodes it has."""
        if self.kind in ("volume", "elements"):
            return int(self.elements.size)
        if self.kind in ("surface", "curve"):
            return sum(each.shape[0] for each in self.facets) or int(self.elements.size)
        return int(self.nodes.size)

    def described(self) -> dict[str, Any]:
        """As the command `groups` states it."""
        return {"name": self.name, "kind": self.kind, "count": self.count(), **self.about}


@dataclass(frozen=True)
class MeshFile:
    """The content of a mesh file, in its own numbers."""

    points: Floats
    """(n, 3)"""
    solids: list[tuple[str, Ints]]
    """Kinds of cells (`cells.SOLIDS`) and their nodes."""
    groups: list[Group]
    counts: dict[str, int]
    """Elements of every kind, also those without volume."""


def named(groups: Sequence[Group], name: str, path: str, kinds: tuple[str, ...]) -> Group:
    """The group of a name; of several that share it the one whose kind comes first in ``kinds``.

    Capitals count only if two names differ by nothing else.

    Raises:
        SceneError: there is none; those that there are are listed.
    """
    usable = [each for each in groups if each.kind in kinds]
    found = [each for each in usable if each.name == name]
    found = found or [each for each in usable if each.name.casefold() == name.casefold()]
    if not found:
        raise no_such_name(name, path, [each.name for each in usable])
    return min(found, key=lambda each: kinds.index(each.kind))
