"""Makes bracket.step: an angle of two walls with a fillet, 30 x 20 x 20 mm."""

import sys
from pathlib import Path

import gmsh


def main(out: Path) -> None:
    """Writes the part to ``out``, a .step file in mm."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    foot = occ.addBox(0, 0, 0, 30, 20, 3)
    wall = occ.addBox(0, 0, 0, 2, 20, 20)
    solid = occ.fuse([(3, foot)], [(3, wall)])[0][0][1]
    occ.synchronize()
    corner = [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(1.9, -1, 2.9, 2.1, 21, 3.1, 1)]
    occ.fillet([solid], corner, [4])
    occ.synchronize()
    gmsh.write(str(out))
    gmsh.finalize()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "bracket.step"))
