"""Scenes of a sphere that strikes a part from a STEP file, with or without a second one behind it.

Lengths are drawn as multiples of the wall that is struck, moduli and densities as ratios. The speed
follows from the contact patch.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

from points import Point, Table, between

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from fem_reference.common.hertz import hertz_stiffness
from fem_reference.general_impact.parts import Part, beam, box, bracket, write_part

ELEMENTS = 3.0
"""Across the contact radius at `paper` resolution."""
PATCHES = (0.06, 0.3)
"""Contact radius over the wall; a larger one reaches over fillets and edges."""
LARGEST = 3.0
"""Radius of the outer sphere over the wall, as far as `HEAVIEST` allows."""
RADII = (0.6, 1.0)
"""Of the outer sphere over the largest one."""
BEHIND = (0.6, 1.8)
"""Radius of the inner sphere over the outer one's."""
STEEPEST = 0.12
"""Patch over radius of a sphere; the reference refuses more than 0.18."""
HEAVIEST = 0.4
"""Mass of the outer sphere over that of the part. On a held beam a heavier one strikes again and
again, for ten times as long as the first contact and more."""

MM = 1e-3
SHAPES = {"box": box, "bracket": bracket, "beam": beam}


def part(point: Point) -> Part:
    """What is struck: the first coordinates of a point."""
    return SHAPES[point.one_of(*SHAPES)](point)


def room(shape: Part) -> float:
    """Radius of the largest sphere that fits behind the place that is struck, mm."""
    (x, y, z), (length, width, _), wall = shape.struck, shape.size, shape.wall
    if shape.kind == "box":
        return min(x, y, length - x, width - y) - wall
    # a sphere that does not reach the foot fits into its fillet or, if larger, clears it
    return z - shape.foot if shape.kind == "bracket" else math.inf


def _modulus(*materials: Table) -> float:
    """Hertz's E*, Pa."""
    return 1.0 / math.fsum((1.0 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in materials)


def _mass(sphere: Table, materials: Table) -> float:
    density = float(materials[sphere["material"]]["density"])
    return 4.0 / 3.0 * math.pi * float(sphere["radius"]) ** 3 * density


def body(point: Point) -> Table:
    """A sphere strikes a part that is held or free."""
    shape = part(point)
    wall = shape.wall * MM
    of_body = {
        "youngs_modulus": point.log(5e9, 200e9),
        "poisson_ratio": point.uniform(0.1, 0.42),
        "density": point.log(1500.0, 8000.0),
    }
    of_spheres = {
        "youngs_modulus": of_body["youngs_modulus"] * point.log(0.3, 30.0),
        "poisson_ratio": point.uniform(0.1, 0.4),
        "density": of_body["density"] * point.log(0.5, 5.0),
    }
    mass = HEAVIEST * shape.volume * MM**3 * of_body["density"]
    heaviest = (3.0 * mass / (4.0 * math.pi * of_spheres["density"])) ** (1 / 3)
    radius = min(LARGEST * wall, heaviest) * point.log(*RADII)
    behind = min(radius * point.some(0.6, between(*BEHIND)), 0.95 * room(shape) * MM)
    # an inner sphere that is smaller than the outer one has the steeper patch of both
    steepest = STEEPEST * radius * min(1.0, (behind or radius) / radius) ** (2 / 3)
    patch = min(wall * point.log(*PATCHES), steepest)
    approach = patch**2 / radius
    energy = 0.4 * hertz_stiffness(_modulus(of_body, of_spheres), radius) * approach**2.5
    outer = {"kind": "sphere", "radius": radius, "material": "spheres"}
    materials = {"body": of_body, "spheres": of_spheres}
    scene: Table = {
        "kind": "impact",
        "materials": materials,
        "body": {"material": "body"},
        "outer": outer
        | {
            "speed": math.sqrt(2.0 * energy / _mass(outer, materials)),
            "at": [MM * x for x in shape.struck],
        },
        "reference": {"elements_per_contact_radius": ELEMENTS},
    }
    if behind:
        at = [MM * x for x in shape.behind()]
        scene["inner"] = {"kind": "sphere", "radius": behind, "material": "spheres", "at": at}
        if gap := point.some(0.3, between(0.03, 3.0)):
            scene["inner"]["gap"] = gap * approach
    if point.one_of("held", "held", "free") == "held":
        scene["body"]["fixed"] = [[MM * x for x in shape.held]]
    return scene


def write_file(point: Point, path: Path) -> None:
    """The STEP file of the part that a point makes."""
    write_part(part(point), path)
