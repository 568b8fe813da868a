"""CalculiX's input: bodies, contacts, what is observed, and the step.

Lengths are written in mm, times in ms, forces in N: then masses are in g, stresses in MPa, speeds
in m/s and energies in mJ, and CalculiX's own small constants meet numbers of their size.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice

from ..common.arrays import Floats
from ..common.bodies import Material

MILLI = 1e3
"""mm per m, ms per s, mJ per J."""
MEGA = 1e-6
"""MPa per Pa, g/mm^3 per kg/m^3."""
FREE_MODES = 2
"""A free body's first one is its rigid motion."""


Term = tuple[int, int, float]
"""Node, direction (1 to 3) and coefficient in a linear equation."""
Elements = dict[str, list[tuple[int, list[int]]]]
"""By CalculiX's type: number and nodes of each element."""


@dataclass(frozen=True)
class Part:
    """A body."""

    name: str
    nodes: list[tuple[int, Floats]]
    """Number and place (3,) of every node, m."""
    elements: Elements
    material: Material
    held: list[tuple[int, int]]
    """Node and direction of displacements that are zero."""
    equations: list[list[Term]] = field(default_factory=list)
    """Sums of terms that are zero; the first term of each follows the others."""
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """At the start, m/s."""

    @property
    def last(self) -> tuple[int, int]:
        """Largest numbers of its nodes and elements."""
        elements = [number for kind in self.elements.values() for number, _ in kind]
        return max(number for number, _ in self.nodes), max(elements)


@dataclass(frozen=True)
class Contact:
    """Face-to-face contact without friction, pressure proportional to the penetration."""

    name: str
    slave: list[tuple[int, str]]
    master: list[tuple[int, str]]
    stiffness: float
    """Pa/m"""


AXIAL = 3
"""Direction of an observer's only displacement."""


@dataclass(frozen=True)
class Observer:
    """A node without stiffness; its displacement along z is the weighted sum of others'."""

    name: str
    node: int
    terms: list[Term]
    """Nodes, directions and weights."""
    speed: float = 0.0
    """At the start, m/s."""


@dataclass(frozen=True)
class Steps:
    """Implicit steps of fixed length (Hilber, Hughes & Taylor 1977)."""

    time_step: float
    """s"""
    end: float
    """s"""
    damping: float
    """Their alpha, from -1/3 to 0."""
    changes: float | None = None
    """Share of the contact's points of integration that may still open or close when an iteration
    ends; None: CalculiX's own, 0.001."""


@dataclass(frozen=True)
class Deck:
    """Everything CalculiX is given."""

    parts: list[Part]
    contacts: list[Contact] = field(default_factory=list)
    observers: list[Observer] = field(default_factory=list)

    def impact(self, steps: Steps) -> str:
        """The deck of an impact."""
        lines = [*self._model(), "*INITIAL CONDITIONS, TYPE=VELOCITY"]
        for part in self.parts:
            moving = [(k, v) for k, v in enumerate(part.velocity, 1) if v != 0.0]
            lines += [f"N{part.name},{direction},{_number(speed)}" for direction, speed in moving]
        moved = [observer for observer in self.observers if observer.speed != 0.0]
        lines += [f"{observer.node},{AXIAL},{_number(observer.speed)}" for observer in moved]
        lines.append("*STEP, INC=10000000")
        if steps.changes is not None:
            # its own values follow: random perturbation, softening, iterations
            lines += ["*CONTROLS, PARAMETERS=CONTACT", f"{steps.changes:g},0.1,100,60"]
        lines += [
            f"*DYNAMIC, DIRECT, ALPHA={steps.damping:g}",
            f"{MILLI * steps.time_step:.12g},{MILLI * steps.end:.12g}",
        ]
        for contact in self.contacts:
            lines += [f"*CONTACT PRINT, SLAVE=S{contact.name}, MASTER=M{contact.name}", "CF"]
        for observer in self.observers:
            lines += _printed(observer, "U,V")
        for part in self.parts:
            lines += [f"*EL PRINT, ELSET=E{part.name}, TOTALS=ONLY", "ELSE,ELKE"]
        return "\n".join([*lines, "*END STEP", ""])

    def modes(self, count: int) -> str:
        """The deck of the lowest eigenfrequencies."""
        lines = [*self._model(), "*STEP", "*FREQUENCY", f"{count}"]
        lines += [line for observer in self.observers for line in _printed(observer, "U")]
        return "\n".join([*lines, "*END STEP", ""])

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


def _number(value: float) -> str:
    """CalculiX reads 20 characters of a number; the exponent's last digit would be lost."""
    exact = f"{value:.15g}"
    return exact if len(exact) <= 20 else f"{value:.12g}"


def _rows(values: Iterable[object], per_line: int) -> list[str]:
    """Values separated by commas; a line that goes on ends with one."""
    it = iter(values)
    lines = []
    while chunk := [str(value) for value in islice(it, per_line)]:
        lines.append(",".join(chunk) + ",")
    return [*lines[:-1], lines[-1].removesuffix(",")]


def _body(part: Part) -> list[str]:
    material = part.material
    lines = [f"*NODE, NSET=N{part.name}"]
    for number, (x, y, z) in part.nodes:
        lines.append(f"{number},{_number(MILLI * x)},{_number(MILLI * y)},{_number(MILLI * z)}")
    for kind, elements in part.elements.items():
        if elements:
            lines.append(f"*ELEMENT, TYPE={kind}, ELSET=E{part.name}")
        for number, nodes in elements:
            lines += _rows([number, *nodes], 16)
    return [
        *lines,
        f"*MATERIAL, NAME=A{part.name}",
        "*ELASTIC",
        f"{_number(MEGA * material.youngs_modulus)},{_number(material.poisson_ratio)}",
        "*DENSITY",
        f"{_number(MEGA * material.density)}",
        f"*SOLID SECTION, ELSET=E{part.name}, MATERIAL=A{part.name}",
    ]


def _equation(terms: Sequence[Term]) -> list[str]:
    """The sum of the terms is zero, the first one follows.

    CalculiX reads lines of 132 characters: four terms of twelve digits.
    """
    written = [f"{node},{direction},{factor:.12g}" for node, direction, factor in terms]
    return [str(len(terms)), *_rows(written, 4)]


def _constraints(part: Part) -> list[str]:
    lines = ["*EQUATION"] if part.equations else []
    for terms in part.equations:
        lines += _equation(terms)
    lines += ["*BOUNDARY"] if part.held else []
    return [*lines, *(f"{node},{direction},{direction}" for node, direction in part.held)]


def _observer(observer: Observer) -> list[str]:
    """Only its displacement along z means anything."""
    terms = [(node, direction, -weight) for node, direction, weight in observer.terms]
    return [
        f"*NODE, NSET=O{observer.name}",
        f"{observer.node},0,0,0",
        "*EQUATION",
        *_equation([(observer.node, AXIAL, 1.0), *terms]),
    ]


def _printed(observer: Observer, what: str) -> list[str]:
    return [f"*NODE PRINT, NSET=O{observer.name}", what]


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
