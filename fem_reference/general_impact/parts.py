"""Random parts of walls and bars, and their CAD files."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import gmsh

from ..body.files import gmsh_session

CHANGING = (
    (re.compile(r"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'"), "'1970-01-01T00:00:00'"),
    (re.compile(r"'Open CASCADE STEP translator [^']*'"), "'part'"),
)
"""What OpenCASCADE writes anew into each file, the time and a count, and what stands there."""


class Draw(Protocol):
    """What parts are drawn from: `random.Random`, or the points of a sequence."""

    def uniform(self, a: float, b: float, /) -> float:
        """A number between bounds."""


@dataclass(frozen=True)
class Part:
    """A random part, mm."""

    kind: str
    size: tuple[float, float, float]
    wall: float
    """Thickness of what is struck."""
    foot: float
    """Thickness of a bracket's foot."""
    fillet: float
    struck: tuple[float, float, float]
    """Where the outer body strikes; the inner one lies behind the wall."""
    inward: tuple[int, int, int]
    held: tuple[float, float, float]
    """On the face that is held."""

    @property
    def volume(self) -> float:
        """Of the part, mm^3."""
        (length, width, height), wall, fillet = self.size, self.wall, self.fillet
        # what a fillet takes from a convex edge, or adds to a concave one
        corner = (1.0 - 0.25 * math.pi) * fillet**2
        if self.kind == "box":
            edges = 4.0 * (height - fillet) + 2.0 * (length + width - 4.0 * fillet)
            # an eighth of a sphere stays of each upper corner
            lost = corner * edges + 4.0 * (1.0 - math.pi / 6.0) * fillet**3
            hollow = (length - 2.0 * wall) * (width - 2.0 * wall) * (height - wall)
            return length * width * height - lost - hollow
        if self.kind == "bracket":
            return width * (length * self.foot + wall * (height - self.foot) + corner)
        return length * width * height

    def behind(self) -> list[float]:
        """Where the inner body lies."""
        return [
            p + self.wall * direction for p, direction in zip(self.struck, self.inward, strict=True)
        ]


def uniform(draw: Draw, low: float, high: float) -> float:
    """A length between bounds, to a micrometre or less."""
    return round(draw.uniform(low, high), 3)


def _sizes(draw: Draw, wall: float, *spans: tuple[float, float]) -> tuple[float, float, float]:
    """Length, width and height between multiples of the wall."""
    length, width, height = (round(wall * draw.uniform(*span), 3) for span in spans)
    return length, width, height


def box(draw: Draw) -> Part:
    """A box that is open below; its rim is held, its lid is struck."""
    wall = uniform(draw, 1.0, 3.0)
    length, width, height = _sizes(draw, wall, (5, 9), (5, 8), (3, 6))
    away = 2.0 * wall
    struck = (uniform(draw, away, length - away), uniform(draw, away, width - away), height)
    fillet, held = round(wall * draw.uniform(1.1, 1.6), 3), (0.5 * wall, 0.5 * width, 0.0)
    return Part("box", (length, width, height), wall, 0.0, fillet, struck, (0, 0, -1), held)


def bracket(draw: Draw) -> Part:
    """An angle; the underside of its foot is held, its wall is struck."""
    wall = uniform(draw, 1.0, 3.0)
    foot = round(wall * draw.uniform(0.8, 2.0), 3)
    length, width, height = _sizes(draw, wall, (5, 9), (4, 8), (6, 9))
    fillet = round(wall * draw.uniform(0.7, 1.6), 3)
    low = foot + fillet + 0.5 * wall
    struck = (
        0.0,
        uniform(draw, 1.5 * wall, width - 1.5 * wall),
        uniform(draw, low, height - wall),
    )
    held = (0.5 * length, 0.5 * width, 0.0)
    return Part("bracket", (length, width, height), wall, foot, fillet, struck, (1, 0, 0), held)


def beam(draw: Draw) -> Part:
    """A bar; one end is held, its upper side is struck."""
    wall = uniform(draw, 1.0, 3.0)
    length, width = (round(wall * draw.uniform(*span), 3) for span in ((6, 14), (1.2, 3)))
    struck = (uniform(draw, 0.25 * length, 0.9 * length), 0.5 * width, wall)
    held = (0.0, 0.5 * width, 0.5 * wall)
    return Part("beam", (length, width, wall), wall, 0.0, 0.0, struck, (0, 0, -1), held)


def _edges(low: tuple[float, ...], high: tuple[float, ...]) -> list[int]:
    gmsh.model.occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*low, *high, 1)]


@contextmanager
def _quiet() -> Iterator[None]:
    """Without standard output, on which OpenCASCADE reports each file that it writes."""
    kept = os.dup(1)
    with Path(os.devnull).open("w") as nothing:
        os.dup2(nothing.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


def write_part(part: Part, path: Path) -> None:
    """Write a part as STEP; the same part is always the same text."""
    occ, (length, width, height), wall = gmsh.model.occ, part.size, part.wall
    with gmsh_session():
        if part.kind == "box":
            outside = occ.addBox(0, 0, 0, *part.size)
            below = _edges((-1, -1, -0.1), (length + 1, width + 1, 0.1))
            all_edges = _edges((-1, -1, -1), (length + 1, width + 1, height + 1))
            rounded = [edge for edge in all_edges if edge not in below]
            solid = occ.fillet([outside], rounded, [part.fillet])[0]
            hollow = (length - 2 * wall, width - 2 * wall, height - wall)
            occ.cut([solid], [(3, occ.addBox(wall, wall, 0, *hollow))])
        elif part.kind == "beam":
            occ.addBox(0, 0, 0, *part.size)
        else:
            foot = occ.addBox(0, 0, 0, length, width, part.foot)
            back = occ.addBox(0, 0, 0, wall, width, height)
            solid = occ.fuse([(3, foot)], [(3, back)])[0][0][1]
            corner = _edges(
                (wall - 0.1, -1, part.foot - 0.1), (wall + 0.1, width + 1, part.foot + 0.1)
            )
            occ.fillet([solid], corner, [part.fillet])
        occ.synchronize()
        with _quiet():
            gmsh.write(str(path))
    # a scene is identified by the content of its file
    text = path.read_text(encoding="utf-8")
    for changing, constant in CHANGING:
        text = changing.sub(constant, text)
    path.write_text(text, encoding="utf-8")
