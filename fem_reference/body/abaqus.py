"""Input files of Abaqus and CalculiX: nodes, solid elements, sets and surfaces of one part."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..common.arrays import Ints
from ..common.errors import SceneError
from .cells import SOLIDS
from .source import Group, MeshFile

NODES = {
    "C3D4": "tetra", "C3D10": "tetra10", "C3D8": "hexahedron", "C3D20": "hexahedron20",
    "C3D6": "wedge", "C3D15": "wedge15", "C3D5": "pyramid",
}  # fmt: skip
VARIANTS = "RHIMTSE"
"""Letters after an element's name that leave its nodes alone: reduced integration, hybrid, ..."""
FACES = {
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    8: (
        (0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0),
    ),
    6: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    5: ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
}  # fmt: skip
"""Corners of the faces S1, S2, ... by the number of an element's corners."""
SHAPELESS = ("MASS", "ROTARYI", "SPRING", "DASHPOT", "CONN", "DCOUP", "GAP")
"""Elements without a shape."""

Reference = tuple[str, str]
"""The element or set of elements, and the face, of a surface's line."""


@dataclass
class _Deck:
    numbers: list[int] = field(default_factory=list)
    points: list[list[float]] = field(default_factory=list)
    elements: dict[str, list[list[int]]] = field(default_factory=dict)
    """By kind of cell: number and nodes."""
    other: list[int] = field(default_factory=list)
    """Numbers of elements that are no solids."""
    node_sets: dict[str, list[int | str]] = field(default_factory=dict)
    element_sets: dict[str, list[int | str]] = field(default_factory=dict)
    surfaces: dict[str, list[Reference]] = field(default_factory=dict)
    internal: set[str] = field(default_factory=set)
    """Names that a pre-processor has made for itself."""
    parts: int = 0
    instances: int = 0
    of_assembly: bool = False
    """Within *ASSEMBLY, outside *INSTANCE: nodes there are reference points."""


@dataclass(frozen=True)
class _Block:
    """A keyword, its parameters in capitals, and its data lines."""

    keyword: str
    parameters: dict[str, str]
    line: int
    rows: list[list[str]]
    """Fields of the data lines; the last one of a line that ends with a comma is empty."""


def read_abaqus(path: Path) -> MeshFile:
    """The mesh and the sets of an input file.

    Raises:
        SceneError: it is not one, or has what is not covered; the line is named.
    """
    deck = _Deck()
    for block in _blocks(path):
        try:
            _take(deck, block)
        except (ValueError, IndexError) as error:
            raise SceneError(
                f"{path.name}, line {block.line}: *{block.keyword}: {error}"
            ) from error
    if not deck.numbers:
        raise SceneError(f"{path.name} has no *NODE: it is no input file of Abaqus or CalculiX")
    return _mesh(path, deck)


def _blocks(path: Path) -> list[_Block]:
    found: list[_Block] = []
    head: str | None = None
    text = path.read_text(encoding="utf-8", errors="replace")
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.strip()
        if not line or line.startswith("**"):
            continue
        if line.startswith("*") or head is not None:
            head = (head or "") + line
            if head.endswith(","):  # a keyword's line that goes on in the next
                continue
            keyword, parameters = _head(head)
            found.append(_Block(keyword, parameters, number, []))
            head = None
        elif found:
            found[-1].rows.append([each.strip() for each in line.split(",")])
    return found


def _head(line: str) -> tuple[str, dict[str, str]]:
    keyword, *parameters = (each.strip() for each in line[1:].split(","))
    pairs = (each.partition("=") for each in parameters if each)
    named = {key.strip().upper(): value.strip().strip('"').upper() for key, _, value in pairs}
    return " ".join(keyword.upper().split()), named


def _take(deck: _Deck, block: _Block) -> None:
    """Add what a keyword says to the deck; keywords without a meaning here are passed over."""
    if block.keyword == "INCLUDE":
        raise ValueError("files included are not read; write one file with everything in it")
    if block.keyword == "PART":
        deck.parts += 1
    elif block.keyword in ("ASSEMBLY", "END ASSEMBLY", "END INSTANCE"):
        deck.of_assembly = block.keyword != "END ASSEMBLY"
    elif block.keyword == "INSTANCE":
        deck.instances += 1
        deck.of_assembly = False
        if block.rows:
            raise ValueError("an instance that is moved is not read; export the part by itself")
    elif block.keyword == "NODE":
        if not deck.of_assembly:
            _take_nodes(deck, block)
    elif block.keyword == "ELEMENT":
        _take_elements(deck, block)
    elif block.keyword in ("NSET", "ELSET"):
        _take_set(deck, block)
    elif block.keyword == "SURFACE":
        _take_surface(deck, block)
    if deck.parts > 1 or deck.instances > 1:
        raise ValueError("the file has several parts or instances; export one part by itself")


def _take_set(deck: _Deck, block: _Block) -> None:
    name, members = _named(block, block.keyword), _members(block)
    if deck.of_assembly and "INSTANCE" not in block.parameters:
        members = [each for each in members if isinstance(each, str)]
    sets = deck.node_sets if block.keyword == "NSET" else deck.element_sets
    sets.setdefault(name, []).extend(members)
    if "INTERNAL" in block.parameters:
        deck.internal.add(name)


def _take_surface(deck: _Deck, block: _Block) -> None:
    name, kind = _named(block, "NAME"), block.parameters.get("TYPE", "ELEMENT")
    if kind == "NODE":
        deck.node_sets.setdefault(name, []).extend(_member(row[0]) for row in block.rows)
    elif kind == "ELEMENT":
        rows = deck.surfaces.setdefault(name, [])
        rows += [(row[0].upper(), row[1].upper() if len(row) > 1 else "") for row in block.rows]


def _named(block: _Block, key: str) -> str:
    if not block.parameters.get(key):
        raise ValueError(f"the parameter {key} is missing")
    return block.parameters[key]


def _take_nodes(deck: _Deck, block: _Block) -> None:
    if block.parameters.get("SYSTEM", "R") != "R":
        raise ValueError("only rectangular coordinates (SYSTEM=R) are read")
    numbers = [int(row[0]) for row in block.rows]
    for row in block.rows:
        place = [float(x) if x else 0.0 for x in row[1:4]]
        deck.points.append(place + [0.0] * (3 - len(place)))
    deck.numbers += numbers
    if "NSET" in block.parameters:
        deck.node_sets.setdefault(block.parameters["NSET"], []).extend(numbers)


def cell_of(kind: str) -> str | None:
    """The kind of cell of an Abaqus element; None: it has no volume."""
    if not kind.startswith("C3D"):
        return None
    digits = "C3D" + "".join(c for c in kind[3:] if c.isdigit())
    if digits not in NODES or any(c not in VARIANTS for c in kind[len(digits) :]):
        known = ", ".join(NODES)
        raise ValueError(f"elements {kind} are not read; known are {known} and their variants")
    return NODES[digits]


def _take_elements(deck: _Deck, block: _Block) -> None:
    kind = _named(block, "TYPE")
    cell = cell_of(kind)
    if cell is not None:
        count = SOLIDS[cell].corners + len(SOLIDS[cell].middles)
        rows = list(_joined(block.rows, count + 1, kind))
        deck.elements.setdefault(cell, []).extend(rows)
        numbers = [row[0] for row in rows]
    else:
        goes_on = [False, *(row[-1] == "" for row in block.rows)]
        firsts = [row[0] for row, on in zip(block.rows, goes_on, strict=False) if not on]
        numbers = [int(each) for each in firsts]
        if not kind.startswith(SHAPELESS):
            deck.other += numbers
    if "ELSET" in block.parameters:
        deck.element_sets.setdefault(block.parameters["ELSET"], []).extend(numbers)


def _joined(rows: list[list[str]], count: int, kind: str) -> Iterator[list[int]]:
    """Rows of ``count`` numbers, each from as many data lines as it takes."""
    row: list[int] = []
    for each in rows:
        row += [int(number) for number in each if number]
        if len(row) == count:
            yield row
            row = []
        elif len(row) > count:
            break
    if row:
        wrong = f"element {row[0]} has {len(row) - 1} nodes"
        raise ValueError(f"{wrong} in its lines; {kind} has {count - 1}")


def _members(block: _Block) -> list[int | str]:
    if "GENERATE" not in block.parameters:
        return [_member(each) for row in block.rows for each in row if each]
    found: list[int | str] = []
    for row in ([int(each) for each in row if each] for row in block.rows):
        first, last, step = (*row, 1)[:3]
        if step < 1 or last < first:
            raise ValueError(f"GENERATE cannot go from {first} to {last} in steps of {step}")
        found += range(first, last + 1, step)
    return found


def _member(text: str) -> int | str:
    """A number, or the name of a set (after the name of its instance, if any)."""
    text = text.strip('"')
    return int(text) if text.lstrip("+-").isdigit() else text.upper().rpartition(".")[2]


class Numbers:
    """Positions of nodes or elements by the numbers of the file."""

    def __init__(self, what: str, numbers: Ints):
        self.what = what
        self.order = np.argsort(numbers, kind="stable")
        self.sorted = numbers[self.order]
        twice = np.flatnonzero(np.diff(self.sorted) == 0)
        if twice.size:
            raise SceneError(f"{what} {self.sorted[twice[0]]} is defined twice in the file")

    def of(self, numbers: Ints, where: str) -> Ints:
        """Positions of numbers of any shape."""
        at = np.minimum(np.searchsorted(self.sorted, numbers), self.sorted.size - 1)
        wrong = self.sorted[at] != numbers
        if wrong.any():
            raise SceneError(f"{where} names {self.what} {numbers[wrong][0]}, which is not there")
        return np.asarray(self.order[at])


def _resolve(sets: dict[str, list[int | str]], name: str, within: tuple[str, ...] = ()) -> Ints:
    """Numbers of a set, those of the sets that it names included."""
    if name in within or name not in sets:
        what = "contains itself" if name in within else "is not there"
        raise SceneError(f"the set {name!r} of the .inp file {what}")
    found: list[Ints] = []
    for each in sets[name]:
        more = _resolve(sets, each, (*within, name)) if isinstance(each, str) else np.array([each])
        found.append(more)
    return np.unique(np.concatenate(found)) if found else np.zeros(0, dtype=np.int64)


def _mesh(path: Path, deck: _Deck) -> MeshFile:
    nodes = Numbers("node", np.array(deck.numbers, dtype=np.int64))
    blocks = [
        (cell, np.array(rows, dtype=np.int64).reshape(len(rows), -1))
        for cell, rows in deck.elements.items()
    ]
    solids = [(cell, nodes.of(rows[:, 1:], f"an element of {path.name}")) for cell, rows in blocks]
    numbers = np.concatenate([rows[:, 0] for _, rows in blocks] or [np.zeros(0, dtype=np.int64)])
    groups = [
        Group(name, "nodes", nodes=nodes.of(_resolve(deck.node_sets, name), f"the set {name!r}"))
        for name in deck.node_sets
        if name not in deck.internal
    ]
    elements = Numbers("element", np.append(numbers, np.array(deck.other, dtype=np.int64)))
    for name in (each for each in deck.element_sets if each not in deck.internal):
        at = elements.of(_resolve(deck.element_sets, name), f"the set {name!r}")
        at = at[at < numbers.size]
        if at.size:
            groups.append(Group(name, "elements", elements=at))
    cells = [nodes for _, block in solids for nodes in block]
    for name, rows in deck.surfaces.items():
        groups.append(_surface(name, rows, deck, elements, cells))
    counts = {cell: len(rows) for cell, rows in blocks} | (
        {"other": len(deck.other)} if deck.other else {}
    )
    return MeshFile(np.array(deck.points), solids, groups, counts)


def _surface(
    name: str, rows: list[Reference], deck: _Deck, elements: Numbers, cells: list[Ints]
) -> Group:
    corners: dict[int, list[Ints]] = {}
    where = f"the surface {name!r}"
    for what, face in rows:
        one = np.array([int(what)]) if what.isdigit() else None
        numbers = _resolve(deck.element_sets, what) if one is None else one
        for at in elements.of(numbers, where):
            cell = cells[at] if at < len(cells) else np.zeros(0, dtype=np.int64)
            faces = FACES.get(_corner_count(cell.size), ())
            index = int(face[1:]) - 1 if face[:1] == "S" and face[1:].isdigit() else -1
            if not 0 <= index < len(faces):
                raise SceneError(
                    f"{where} has the face {face!r} of an element; it must be one of its faces "
                    "S1, S2, ..."
                )
            corner = cell[list(faces[index])]
            corners.setdefault(corner.size, []).append(corner)
    return Group(name, "surface", facets=[np.array(each) for each in corners.values()])


def _corner_count(nodes: int) -> int:
    counts = {cell.corners + len(cell.middles): cell.corners for cell in SOLIDS.values()}
    return counts.get(nodes, 0)
