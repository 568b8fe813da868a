"""Makes the CAD parts of this folder: `python3 parts.py [NAME ...]`, with gmsh; sizes in mm."""

import sys
from collections.abc import Callable
from pathlib import Path

import gmsh

occ = gmsh.model.occ


def edges(low: tuple[float, ...], high: tuple[float, ...]) -> list[int]:
    """Edges within a box."""
    occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*low, *high, 1)]


def bracket() -> None:
    """An angle of two walls with a fillet, 30 x 20 x 20 mm."""
    foot = occ.addBox(0, 0, 0, 30, 20, 3)
    wall = occ.addBox(0, 0, 0, 2, 20, 20)
    solid = occ.fuse([(3, foot)], [(3, wall)])[0][0][1]
    occ.fillet([solid], edges((1.9, -1, 2.9), (2.1, 21, 3.1)), [4])


def casing() -> None:
    """A cup of 24 mm diameter with a floor of 1.5 mm and a fillet inside."""
    outside = occ.addCylinder(0, 0, 0, 0, 0, 12, 12)
    inside = occ.addCylinder(0, 0, 1.5, 0, 0, 12, 10)
    solid = occ.cut([(3, outside)], [(3, inside)])[0][0][1]
    occ.fillet([solid], edges((-10.1, -10.1, 1.4), (10.1, 10.1, 1.6)), [2])


def block() -> None:
    """A cube of 20 mm."""
    occ.addBox(-10, -10, -20, 20, 20, 20)


def beam() -> None:
    """A beam with a rectangular section, 40 x 6 x 3 mm."""
    occ.addBox(0, 0, 0, 40, 6, 3)


def box() -> None:
    """A thin-walled box, open below, 20 x 16 x 10 mm, walls of 1.5 mm."""
    outside = occ.addBox(0, 0, 0, 20, 16, 10)
    below = edges((-1, -1, -1), (21, 17, 1))
    others = [edge for edge in edges((-1, -1, -1), (21, 17, 11)) if edge not in below]
    solid = occ.fillet([outside], others, [2])[0]
    occ.cut([solid], [(3, occ.addBox(1.5, 1.5, 0, 17, 13, 8.5))])


PARTS: dict[str, Callable[[], None]] = {
    part.__name__: part for part in (bracket, casing, block, beam, box)
}


def write(name: str, folder: Path) -> None:
    """Writes NAME.step into a folder."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    PARTS[name]()
    occ.synchronize()
    gmsh.write(str(folder / f"{name}.step"))
    gmsh.finalize()


if __name__ == "__main__":
    for part in sys.argv[1:] or PARTS:
        write(part, Path(__file__).parent)
