"""CalculiX's input: bodies, contacts, what is observed, and the step.

Lengths are written in mm, times in ms, forces in N: then masses are in g, stresses in MPa, speeds
in m/s and energies in mJ, and CalculiX's own small constants meet numbers of their size.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import islice

from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from .wedge import Wedge

MILLI = 1e3
"""mm per m, ms per s, mJ per J."""
MEGA = 1e-6
"""MPa per Pa, g/mm^3 per kg/m^3."""
FREE_MODES = 2
"""A free body's first one is its rigid motion."""


@dataclass(frozen=True)
class Part:
    """A body of revolution."""

    name: str
    wedge: Wedge
    material: Material
    clamped: Ints
    """Nodes of the plane that cannot move along r."""
    supported: Ints
    """Nodes of the plane that cannot move along z."""
    speed: float = 0.0
    """Along z at the start, m/s."""


@dataclass(frozen=True)
class Contact:
    """Face-to-face contact without friction, pressure proportional to the penetration."""

    name: str
    slave: list[tuple[int, str]]
    master: list[tuple[int, str]]
    stiffness: float
    """Pa/m"""


@dataclass(frozen=True)
class Observer:
    """A node without stiffness whose axial displacement is the weighted sum of others'."""

    name: str
    node: int
    nodes: Ints
    weights: Floats
    """Their sum is 1."""


@dataclass(frozen=True)
class Steps:
    """Implicit steps of fixed length (Hilber, Hughes & Taylor 1977)."""

    time_step: float
    """s"""
    end: float
    """s"""
    damping: float
    """Their alpha, from -1/3 to 0."""


@dataclass(frozen=True)
class Deck:
    """Everything CalculiX is given."""

    parts: list[Part]
    contacts: list[Contact] = field(default_factory=list)
    observers: list[Observer] = field(default_factory=list)

    def impact(self, steps: Steps) -> str:
        """The deck of an impact."""
        speeds = [part for part in self.parts if part.speed != 0.0]
        lines = [*self._model(), "*INITIAL CONDITIONS, TYPE=VELOCITY"]
        lines += [f"N{part.name},3,{part.speed:.15g}" for part in speeds]
        by_name = {part.name: part for part in speeds}
        lines += [
            f"{o.node},3,{by_name[o.name].speed:.15g}" for o in self.observers if o.name in by_name
        ]
        lines += [
            "*STEP, INC=10000000",
            f"*DYNAMIC, DIRECT, ALPHA={steps.damping:g}",
            f"{MILLI * steps.time_step:.12g},{MILLI * steps.end:.12g}",
        ]
        for contact in self.contacts:
            lines += [f"*CONTACT PRINT, SLAVE=S{contact.name}, MASTER=M{contact.name}", "CF"]
        for observer in self.observers:
            lines += [f"*NODE PRINT, NSET=O{observer.name}", "U,V"]
        for part in self.parts:
            lines += [f"*EL PRINT, ELSET=E{part.name}, TOTALS=ONLY", "ELSE,ELKE"]
        return "\n".join([*lines, "*END STEP", ""])

    def modes(self, count: int) -> str:
        """The deck of the lowest eigenfrequencies."""
        step = ["*STEP", "*FREQUENCY", f"{count}", "*END STEP", ""]
        return "\n".join([*self._model(), *step])

    def _model(self) -> list[str]:
        lines: list[str] = []
        for part in self.parts:
            lines += _body(part)
        for observer in self.observers:
            lines += _observer(observer)
        for part in self.parts:
            lines += _constraints(part)
        for contact in self.contacts:
            lines += _contact(contact)
        return lines


def _rows(values: Iterable[object], per_line: int) -> list[str]:
    """Values separated by commas; a line that goes on ends with one."""
    it = iter(values)
    lines = []
    while chunk := [str(value) for value in islice(it, per_line)]:
        lines.append(",".join(chunk) + ",")
    return [*lines[:-1], lines[-1].removesuffix(",")]


def _body(part: Part) -> list[str]:
    wedge, material = part.wedge, part.material
    lines = [f"*NODE, NSET=N{part.name}"]
    for number, (x, y, z) in wedge.nodes:
        lines.append(f"{number},{MILLI * x:.15g},{MILLI * y:.15g},{MILLI * z:.15g}")
    for kind, elements in wedge.elements.items():
        if elements:
            lines.append(f"*ELEMENT, TYPE={kind}, ELSET=E{part.name}")
        for number, nodes in elements:
            lines += _rows([number, *nodes], 16)
    return [
        *lines,
        f"*NSET, NSET=P{part.name}, GENERATE",
        f"{wedge.first[0]},{wedge.first[-1]}",
        f"*MATERIAL, NAME=A{part.name}",
        "*ELASTIC",
        f"{MEGA * material.youngs_modulus:.15g},{material.poisson_ratio:.15g}",
        "*DENSITY",
        f"{MEGA * material.density:.15g}",
        f"*SOLID SECTION, ELSET=E{part.name}, MATERIAL=A{part.name}",
    ]


def _equation(terms: list[tuple[int, int, float]]) -> list[str]:
    """Node, direction and coefficient of each term; the sum is zero, the first one follows.

    CalculiX reads lines of 132 characters: four terms of twelve digits.
    """
    written = [f"{node},{direction},{factor:.12g}" for node, direction, factor in terms]
    return [str(len(terms)), *_rows(written, 4)]


def _constraints(part: Part) -> list[str]:
    wedge = part.wedge
    lines = ["*EQUATION"]
    for twin, leader, angle in wedge.twins:
        cosine, sine = math.cos(angle), math.sin(angle)
        lines += _equation([(twin, 1, 1.0), (leader, 1, -cosine)])
        lines += _equation([(twin, 2, 1.0), (leader, 1, -sine)])
        lines += _equation([(twin, 3, 1.0), (leader, 3, -1.0)])
    lines += ["*BOUNDARY", f"P{part.name},2,2"]
    lines += [f"{wedge.first[node]},1,1" for node in {*wedge.plane.axis, *part.clamped}]
    lines += [f"{wedge.first[node]},3,3" for node in part.supported]
    return lines


def _observer(observer: Observer) -> list[str]:
    """Only its axial displacement means anything."""
    terms = zip(observer.nodes.tolist(), observer.weights.tolist(), strict=True)
    return [
        f"*NODE, NSET=O{observer.name}",
        f"{observer.node},0,0,0",
        "*EQUATION",
        *_equation([(observer.node, 3, 1.0), *((node, 3, -weight) for node, weight in terms)]),
    ]


def _contact(contact: Contact) -> list[str]:
    lines = []
    for side, faces in (("S", contact.slave), ("M", contact.master)):
        lines.append(f"*SURFACE, NAME={side}{contact.name}")
        lines += [f"{element},{face}" for element, face in faces]
    return [
        *lines,
        f"*SURFACE INTERACTION, NAME=I{contact.name}",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{contact.stiffness * MEGA / MILLI:.12g}",
        f"*CONTACT PAIR, INTERACTION=I{contact.name}, TYPE=SURFACE TO SURFACE",
        f"S{contact.name},M{contact.name}",
    ]
