"""Solid cells of other programs: their corners, faces and midside nodes."""

from __future__ import annotations

from dataclasses import dataclass

from ..solid.mesh import EDGES, FACES

HEX_EDGES = (
    (0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7),
)  # fmt: skip
HEX_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
WEDGE_EDGES = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
WEDGE_QUADS = ((0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2))
WEDGE_TRIANGLES = ((0, 2, 1), (3, 4, 5))
PYRAMID_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))
PYRAMID_QUADS = ((0, 3, 2, 1),)
PYRAMID_TRIANGLES = ((0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))


@dataclass(frozen=True)
class Cell:
    """A kind of solid cell. Faces have their corners counter-clockwise seen from outside."""

    corners: int
    faces: tuple[tuple[int, ...], ...]
    middles: tuple[tuple[int, ...], ...] = ()
    """Of every node after the corners, the corners in whose middle it lies."""

    @property
    def quadratic(self) -> bool:
        """Whether there are midside nodes."""
        return bool(self.middles)


_HEX = tuple(range(8))
SOLIDS = {
    "tetra": Cell(4, FACES),
    "tetra10": Cell(4, FACES, EDGES),
    "hexahedron": Cell(8, HEX_FACES),
    "hexahedron20": Cell(8, HEX_FACES, HEX_EDGES),
    "hexahedron27": Cell(8, HEX_FACES, (*HEX_EDGES, *HEX_FACES, _HEX)),
    "wedge": Cell(6, WEDGE_QUADS + WEDGE_TRIANGLES),
    "wedge15": Cell(6, WEDGE_QUADS + WEDGE_TRIANGLES, WEDGE_EDGES),
    "wedge18": Cell(6, WEDGE_QUADS + WEDGE_TRIANGLES, WEDGE_EDGES + WEDGE_QUADS),
    "pyramid": Cell(5, PYRAMID_QUADS + PYRAMID_TRIANGLES),
    "pyramid13": Cell(5, PYRAMID_QUADS + PYRAMID_TRIANGLES, PYRAMID_EDGES),
    "pyramid14": Cell(5, PYRAMID_QUADS + PYRAMID_TRIANGLES, PYRAMID_EDGES + PYRAMID_QUADS),
}
"""By name; nodes in VTK's order (up to the order of the face nodes, which `middles` states)."""

FACET_CORNERS = {
    "line": 2, "line3": 2,
    "triangle": 3, "triangle6": 3, "triangle7": 3,
    "quad": 4, "quad8": 4, "quad9": 4,
}  # fmt: skip
"""Corners of the cells that are no solids."""

GMSH_NODES = {
    "tetra10": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8),
    "hexahedron20": (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15),
    "hexahedron27": (
        *range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26,
    ),
    "wedge15": (*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11),
    "wedge18": (*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16),
    "pyramid13": (*range(5), 5, 8, 10, 6, 7, 9, 11, 12),
    "pyramid14": (*range(5), 5, 8, 10, 6, 7, 9, 11, 12, 13),
}  # fmt: skip
"""Positions, in gmsh's order, of the nodes of the cells above."""

GMSH_TYPES = {
    1: "line", 8: "line3", 2: "triangle", 9: "triangle6", 3: "quad", 16: "quad8", 10: "quad9",
    4: "tetra", 11: "tetra10", 5: "hexahedron", 17: "hexahedron20", 12: "hexahedron27",
    6: "wedge", 18: "wedge15", 13: "wedge18", 7: "pyramid", 19: "pyramid13", 14: "pyramid14",
    15: "vertex",
}  # fmt: skip
