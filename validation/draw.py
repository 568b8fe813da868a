"""Random scenes of the validation base, space-filling in dimensionless numbers.

    python validation/draw.py FOLDER [--only STRATUM]

writes `FOLDER/<stratum>-<number>.toml`, and the STEP file of a body with the same name. The same
number is always the same scene: the points are a scrambled Sobol sequence of each stratum, and more
scenes leave the first ones as they are.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bodies
import seats
from points import STRATA, Point, Table, between, points

ELEMENTS = 8.0
"""Across the contact radius at `paper` resolution; off-centre impacts take a quarter."""

STEEPEST = 0.15
"""Patch over radius of the outer body, which Hertz's contact supposes to be small."""


def _body(point: Point, radius: float, density: float, material: str) -> Table:
    """A sphere of this radius, or a compact body of its mass with another tip."""
    blunt = point.some(0.25, between(0.3, 3.0))
    if not blunt:
        return {"kind": "sphere", "radius": radius, "material": material}
    mass = 4.0 / 3.0 * math.pi * radius**3 * density
    return {"kind": "compact", "mass": mass, "tip_radius": blunt * radius, "material": material}


def _tip(body: Table) -> float:
    return float(body["radius" if body["kind"] == "sphere" else "tip_radius"])


def _first_period(plate: Table, material: Table) -> float:
    """Of a thin plate, s; a free one's lowest axisymmetric mode."""
    radius, thickness = float(plate["radius"]), float(plate["thickness"])
    eigenvalue = {"clamped": 10.22, "simply-supported": 4.94, "free": 9.0}[plate["edge"]]
    modulus = material["youngs_modulus"] / (12.0 * (1.0 - material["poisson_ratio"] ** 2))
    speed = math.sqrt(modulus / material["density"]) * thickness
    return 2.0 * math.pi * radius**2 / (eigenvalue * speed)


Range = tuple[float, float]


def dry(
    point: Point,
    patches: Range = (0.02, 0.6),
    times: Range = (0.03, 3.0),
    keeps_patch: bool = False,
) -> Table:
    """A dry central impact.

    Args:
        point: the coordinates.
        patches: contact radius over the thickness, that of Hertz's impact on a half-space.
        times: its duration over the plate's first period.
        keeps_patch: where the body would be too small for the patch, the impact lasts longer;
            else the patch is smaller.
    """
    thickness = 1e-3
    plate = {
        "radius": thickness / point.log(0.02, 0.4),
        "thickness": thickness,
        "edge": point.one_of("clamped", "clamped", "simply-supported", "free"),
        "material": "plate",
    }
    materials = {
        "plate": {
            "youngs_modulus": point.log(5e9, 120e9),
            "poisson_ratio": point.uniform(0.0, 0.45),
            "density": point.log(1500.0, 8000.0),
        },
        "bodies": {"poisson_ratio": point.uniform(0.1, 0.4)},
    }
    of_plate, of_bodies = materials["plate"], materials["bodies"]
    for name, low, high in (("youngs_modulus", 0.3, 100.0), ("density", 0.3, 8.0)):
        ratio = math.sqrt(point.log(low, high))
        of_bodies[name] = of_plate[name] * ratio
        of_plate[name] /= ratio
    # Hertz's impact on a half-space: a = sqrt(r d), d^(5/2) = 15 m v^2 / (16 E* sqrt(r)),
    # T = 2.9433 d / v; r follows from a and T, v from r
    modulus = 1.0 / sum(
        (1.0 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in materials.values()
    )
    patch = thickness * point.log(*patches)
    time = point.log(*times) * _first_period(plate, of_plate)
    per_square = 16.0 * modulus / (2.9433**2 * 20.0 * math.pi * of_bodies["density"])
    per_patch = time**2 * per_square
    # a patch that is small against the radius, as Hertz's contact supposes
    steepest = point.log(0.02, STEEPEST)
    if patch > steepest * (per_patch * patch) ** (1 / 3):
        if keeps_patch:
            per_patch = patch**2 / steepest**3
            time = math.sqrt(per_patch / per_square)
        else:
            patch = math.sqrt(steepest**3 * per_patch)
    cube = per_patch * patch
    outer = _body(point, cube ** (1 / 3), of_bodies["density"], "bodies")
    approach = patch**2 / _tip(outer)
    outer["speed"] = 2.9433 * approach / time * (_tip(outer) / cube ** (1 / 3)) ** 0.25
    inner = _body(
        point, cube ** (1 / 3) * point.log(0.1, 10.0) ** (1 / 3), of_bodies["density"], "bodies"
    )
    if gap := point.some(0.3, between(0.03, 3.0)):
        inner["gap"] = gap * approach
    if speed := point.some(0.3, lambda at: -0.5 + 1.5 * at):
        inner["speed"] = speed * outer["speed"]
    if damping := point.some(0.25, between(1e-3, 0.1)):
        plate["damping_ratio"] = damping
    scene = {"materials": materials, "plate": plate, "outer": outer, "inner": inner}
    return scene | {"reference": {"elements_per_contact_radius": ELEMENTS}}


def _duration(scene: Table) -> float:
    """Of the outer contact on a half-space, s."""
    outer, moduli = scene["outer"], scene["materials"].values()
    modulus = 1.0 / sum((1.0 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in moduli)
    density = scene["materials"]["bodies"]["density"]
    mass = outer.get("mass", 4.0 / 3.0 * math.pi * _tip(outer) ** 3 * density)
    speed = float(outer["speed"])
    power = 15.0 * mass * speed**2 / (16.0 * modulus * math.sqrt(_tip(outer)))
    return 2.9433 * float(power**0.4) / speed


def film(point: Point) -> Table:
    """With a squeeze film below the plate."""
    scene = dry(point)
    scene["plate"].pop("damping_ratio", None)
    scene["inner"].pop("speed", None)
    density = point.log(500.0, 2000.0)
    scene["fluid"] = {
        "viscosity": point.log(1e-4, 0.1),
        "density": density,
        "minimum_gap": point.log(1e-7, 2e-6),
    }
    if ratio := point.some(0.3, lambda at: 0.3 + 0.7 * at):
        scene["fluid"]["added_mass_frequency_ratio"] = ratio
    # the film slows the inner body for ever: both sides are compared at one time
    # after the contact, which a flexible plate prolongs
    period = _first_period(scene["plate"], scene["materials"]["plate"])
    scene["run"] = {"end_time": 4.0 * _duration(scene) + period}
    return scene


def _of_spheres(scene: Table) -> Table:
    """With spheres of the same mass instead of compact bodies."""
    density = scene["materials"]["bodies"]["density"]
    for body in (scene["outer"], scene["inner"]):
        if body["kind"] == "compact":
            volume = body.pop("mass") / density
            del body["tip_radius"]
            body |= {"kind": "sphere", "radius": (3.0 * volume / (4.0 * math.pi)) ** (1 / 3)}
    return scene


def friction(point: Point) -> Table:
    """With friction in both contacts, of spheres."""
    return _of_spheres(dry(point)) | {"friction": point.log(0.03, 0.5)}


def relaxing(point: Point) -> Table:
    """The plate or the bodies are viscoelastic."""
    scene = dry(point)
    scene["plate"].pop("damping_ratio", None)
    relaxes = point.one_of("plate", "plate", "bodies")
    if relaxes == "bodies":
        # the tip of a compact body is an elastic half-space
        scene = _of_spheres(scene)
    scene["materials"][relaxes] |= {
        "loss_factor": point.log(0.003, 0.1),
        "modulus_frequency": 0.5 / _duration(scene),
    }
    return scene


def yielding(point: Point) -> Table:
    """The plate or the bodies yield: 1 to 100 times the speed of first yield."""
    scene = dry(point)
    moduli = scene["materials"].values()
    modulus = 1.0 / sum((1.0 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in moduli)
    # first yield at a pressure of 1.6 Y; an impact's pressure grows with v^(2/5)
    approach = _duration(scene) * scene["outer"]["speed"] / 2.9433
    pressure = 2.0 / math.pi * modulus * math.sqrt(approach / _tip(scene["outer"]))
    yields = scene["materials"][point.one_of("plate", "plate", "bodies")]
    yields["yield_strength"] = pressure / (1.6 * point.log(1.0, 100.0) ** 0.4)
    yields["hardening"] = yields["youngs_modulus"] * point.log(1e-4, 0.05)
    return scene


def _of_solids(scene: Table) -> Table:
    """For solid elements, which take spheres and undamped plates."""
    _of_spheres(scene)
    plate = scene["plate"]
    plate.pop("damping_ratio", None)
    # model C has no form of supported plates, A and B have none of free ones
    plate["edge"] = "clamped"
    scene["reference"]["elements_per_contact_radius"] = ELEMENTS / 4.0
    return scene


def off_centre(point: Point) -> Table:
    """The outer body strikes away from the centre."""
    scene = _of_solids(dry(point))
    plate = scene["plate"]
    plate["radius"] = min(plate["radius"], 20.0 * plate["thickness"])
    scene["outer"]["offset"] = plate["radius"] * point.uniform(0.02, 0.6)
    return scene


def oblique(point: Point) -> Table:
    """The outer body strikes at an angle, with friction; a third of them away from the centre.

    The duration is drawn over the first period of the plate with its own radius, which is cut then.
    """
    # small contacts on thin plates take hours
    scene = _of_solids(dry(point, (0.1, 0.6), (0.03, 0.3), keeps_patch=True))
    plate, outer = scene["plate"], scene["outer"]
    plate["radius"] = min(plate["radius"], 8.0 * plate["thickness"])
    # half the standard: the references of these scenes were computed before it was raised
    scene["reference"]["elements_per_thickness"] = 1.0
    scene["friction"] = point.log(0.03, 0.6)
    outer["angle"] = math.radians(point.uniform(5.0, 75.0))
    # the velocity across the plate is the one drawn
    outer["speed"] /= math.cos(outer["angle"])
    if offset := point.some(1.0 / 3.0, lambda at: 0.02 + 0.48 * at):
        outer["offset"] = plate["radius"] * offset
    return scene


DRAWN: dict[str, Callable[[Point], Table]] = {
    "dry": dry,
    "film": film,
    "friction": friction,
    "relaxing": relaxing,
    "yielding": yielding,
    "off-centre": off_centre,
    "body": bodies.body,
    "seat": seats.seat,
    "oblique": oblique,
}
"""Makes a scene of a stratum."""
FILES = {"body": bodies.write_file}
"""Writes the file that a scene of a stratum names."""


def scenes(stratum: str, count: int) -> list[Table]:
    """The first scenes of a stratum, SI."""
    found = []
    for k, point in enumerate(points(stratum, count)):
        scene: Table = {"name": f"{stratum}-{k:03}", "kind": "plate-impact"} | DRAWN[stratum](point)
        if stratum in FILES:
            scene["body"]["file"] = f"{scene['name']}.step"
        found.append(scene)
    return found


def _toml(table: Table, path: str = "") -> str:
    """A scene that one can read: numbers of six digits."""

    def value(of: Any) -> str:
        if isinstance(of, list):
            return f"[{', '.join(map(value, of))}]"
        return f"{of:.6g}" if isinstance(of, float) else f'"{of}"'

    parts = {key: part for key, part in table.items() if isinstance(part, dict)}
    lines = [f"{key} = {value(part)}" for key, part in table.items() if key not in parts]
    text = "".join(f"{line}\n" for line in lines)
    if path and lines:
        text = f"\n[{path}]\n{text}"
    return text + "".join(_toml(part, f"{path}.{key}".lstrip(".")) for key, part in parts.items())


def write(stratum: str, count: int, folder: Path) -> None:
    """Write the first scenes of a stratum into a folder."""
    for scene, point in zip(scenes(stratum, count), points(stratum, count), strict=True):
        path = folder / f"{scene['name']}.toml"
        path.write_text(_toml(scene), encoding="utf-8")
        if stratum in FILES:
            FILES[stratum](point, path.with_suffix(".step"))


def main() -> None:
    """Write the scenes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=STRATA, help="one stratum")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for stratum, count in STRATA.items():
        if given.only in (None, stratum):
            write(stratum, count, given.folder)


if __name__ == "__main__":
    main()
