"""Bulk data of Nastran and OptiStruct: grid points, solids and shells by property, supports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..common.errors import SceneError
from .abaqus import Numbers
from .cells import SOLIDS
from .source import Group, MeshFile

SOLID_CARDS = {
    "CTETRA": ("tetra", "tetra10"),
    "CHEXA": ("hexahedron", "hexahedron20"),
    "CPENTA": ("wedge", "wedge15"),
    "CPYRAM": ("pyramid", "pyramid13"),
    "CPYRA": ("pyramid", "pyramid13"),
}
"""Linear and quadratic cell of each."""
ORDER = {
    "hexahedron20": (*range(12), 16, 17, 18, 19, 12, 13, 14, 15),
    "wedge15": (*range(9), 12, 13, 14, 9, 10, 11),
}
"""Positions, in Nastran's order, of the nodes in VTK's."""
SHELL_CARDS = {"CTRIA3": 3, "CTRIA6": 3, "CTRIAR": 3, "CQUAD4": 4, "CQUAD8": 4, "CQUADR": 4}
SUPPORTS = ("SPC", "SPC1")
EXPONENT = re.compile(r"(?<=[0-9.])([+-]\d+)$")
COLUMNS = 72


def read_nastran(path: Path) -> MeshFile:
    """The mesh of a bulk data file; groups are named by property ("1") and support ("spc 1").

    Raises:
        SceneError: it is not one, or has what is not covered; the card is named.
    """
    grid: dict[int, list[float]] = {}
    solids: dict[str, list[list[int]]] = {}
    properties: dict[str, list[int]] = {}
    shells: dict[str, list[list[int]]] = {}
    supports: dict[str, list[int]] = {}
    for name, fields in _cards(path):
        try:
            if name == "GRID":
                if fields[1] not in ("", "0"):
                    raise ValueError(
                        f"it uses coordinate system {fields[1]}; export the basic system"
                    )
                grid[int(fields[0])] = [_real(each) for each in fields[2:5]]
            elif name in SOLID_CARDS:
                cell, row = _solid(name, fields)
                solids.setdefault(cell, []).append(row)
                properties.setdefault(cell, []).append(int(fields[1]))
            elif name in SHELL_CARDS:
                corners = [int(each) for each in fields[2 : 2 + SHELL_CARDS[name]]]
                shells.setdefault(fields[1], []).append(corners)
            else:
                held = _held(name, fields)
                supports.setdefault(f"spc {fields[0]}", []).extend(held)
        except (ValueError, IndexError) as error:
            number = fields[0] if fields else "?"
            raise SceneError(f"{path.name}: {name} {number}: {error}") from error
    if not grid:
        raise SceneError(f"{path.name} has no GRID points: it is no bulk data of Nastran")
    return _mesh(path, grid, solids, properties, shells, supports)


def _cards(path: Path) -> Iterator[tuple[str, list[str]]]:
    """Names and fields of the cards that matter, continuation lines joined."""
    wanted = {"GRID", *SOLID_CARDS, *SHELL_CARDS, *SUPPORTS}
    name, fields = "", list[str]()
    with path.open(encoding="utf-8", errors="replace") as stream:
        for raw in stream:
            line = raw.partition("$")[0].rstrip().expandtabs(8)
            if not line:
                continue
            head, data = _line(line)
            if head in ("", "+", "*"):
                fields += data
                continue
            if name in wanted:
                yield name, fields
            name, fields = head, data
            if name == "INCLUDE":
                raise SceneError(
                    f"{path.name}: files included are not read; write one file with all in it"
                )
            if name == "ENDDATA":
                return
    if name in wanted:
        yield name, fields


def _line(line: str) -> tuple[str, list[str]]:
    """The first field, without its star, "" or "+" if the line goes on; and the data fields."""
    free = "," in line
    first = (line.partition(",")[0] if free else line[:8]).strip().upper()
    large = first.endswith("*") or first.startswith("*")
    count = 4 if large else 8
    if free:
        data = [each.strip() for each in line.split(",")[1 : count + 1]]
    else:
        width = 16 if large else 8
        data = [line[k : k + width].strip() for k in range(8, COLUMNS, width)]
    name = "+" if first[:1] in ("+", "*") else first.rstrip("*").split(" ")[0]
    return name, data + [""] * (count - len(data))


def _real(text: str) -> float:
    """A number; Nastran leaves out the E of an exponent."""
    if not text:
        return 0.0
    text = text.upper().replace("D", "E")
    return float(text if "E" in text else EXPONENT.sub(r"E\1", text))


def _solid(name: str, fields: list[str]) -> tuple[str, list[int]]:
    """The kind of cell, and its number and nodes in VTK's order."""
    nodes = fields[2:]
    while nodes and not nodes[-1]:
        nodes = nodes[:-1]
    counts = {SOLIDS[cell].corners + len(SOLIDS[cell].middles): cell for cell in SOLID_CARDS[name]}
    if len(nodes) not in counts or "" in nodes:
        raise ValueError(
            f"has {sum(map(bool, nodes))} nodes; {' or '.join(map(str, counts))} are read"
        )
    cell = counts[len(nodes)]
    numbers = [int(each) for each in nodes]
    return cell, [int(fields[0]), *(numbers[k] for k in ORDER.get(cell, range(len(nodes))))]


def _held(name: str, fields: list[str]) -> list[int]:
    """Grid points that a support holds in all three directions."""
    if name == "SPC":
        pairs = [(fields[k], fields[k + 1]) for k in (1, 4) if fields[k]]
        return [int(point) for point, held in pairs if set("123") <= set(held)]
    if not set("123") <= set(fields[1]):
        return []
    points = [each for each in fields[2:] if each]
    if len(points) == 3 and points[1].upper() == "THRU":
        return list(range(int(points[0]), int(points[2]) + 1))
    return [int(each) for each in points]


def _mesh(
    path: Path,
    grid: dict[int, list[float]],
    solids: dict[str, list[list[int]]],
    properties: dict[str, list[int]],
    shells: dict[str, list[list[int]]],
    supports: dict[str, list[int]],
) -> MeshFile:
    at = Numbers("grid point", np.array(list(grid), dtype=np.int64))
    where = f"an element of {path.name}"
    blocks = [(cell, at.of(np.array(rows)[:, 1:], where)) for cell, rows in solids.items()]
    owner = np.array([each for cell in solids for each in properties[cell]], dtype=np.int64)
    groups = [
        Group(str(number), "volume", elements=np.flatnonzero(owner == number))
        for number in np.unique(owner)
    ]
    for name, rows in shells.items():
        sizes = sorted({len(row) for row in rows})
        facets = [at.of(np.array([row for row in rows if len(row) == n]), where) for n in sizes]
        groups.append(Group(name, "surface", facets=facets))
    for name, points in supports.items():
        there = np.array([each for each in points if each in grid], dtype=np.int64)
        if there.size:
            groups.append(Group(name, "nodes", nodes=np.unique(at.of(there, name))))
    counts = {cell: len(rows) for cell, rows in solids.items()}
    if shells:
        counts["shell"] = sum(map(len, shells.values()))
    return MeshFile(np.array(list(grid.values())), blocks, groups, counts)
