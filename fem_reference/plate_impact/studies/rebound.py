"""A published experiment: ceramic balls that rebound obliquely from a block of glass.

Kharaz, Gorham & Salman (2001), Powder Technol. 120, 281-291: balls of aluminium oxide, 5 mm in
diameter, strike a thick block of soda-lime glass with 3.9 m/s at angles from normal to glancing.
They measured rebound angle, tangential restitution and spin. The numbers here are those that the
authors of Lethe tabulate from its figures (examples/dem/3d-oblique-wall-impact,
`oblique_wall_impact_postprocessing.py`), the materials those that they and MFiX (test DEM05) give.
Nothing here is fitted.

The words are ASME V&V 20's: E = S - D, and u_val from the mesh, the inputs and the data.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from ...common.arrays import Floats
from ...common.fenicsx import alone
from ...common.progress import Progress
from ...solid.system import make_loop
from ..estimate import estimate_contact, shortest_wavelengths
from ..half_model import half_model
from ..half_motion import HalfMotion
from ..scene import Scene, parse_scene
from ..solid_motion import integrate_solid

BALL = {"name": "alumina", "youngs_modulus": 380e9, "poisson_ratio": 0.23, "density": 4000.0}
GLASS = {"name": "glass", "youngs_modulus": 70e9, "poisson_ratio": 0.25, "density": 2500.0}
RADIUS, SPEED = 2.5e-3, 3.9
"""m, m/s"""
FRICTION = 0.092
"""As measured where the ball slides."""
BLOCK = 0.015
"""Radius and thickness of the glass that is modelled, m: its rim, which is held, answers late."""
TANGENTIAL, SPIN, ANGLE = "tangential restitution", "spin, rad/s", "rebound angle, deg"
MEASURED: dict[str, tuple[tuple[float, float], ...]] = {
    TANGENTIAL: (
        (1.84, 0.79344),
        (3.703, 0.74533),
        (9.496, 0.67257),
        (20.012, 0.59691),
        (30.127, 0.68756),
        (39.382, 0.77148),
        (49.694, 0.84761),
        (60.02, 0.90142),
    ),
    SPIN: (
        (6.143, 136.18),
        (10.991, 265.69),
        (21.251, 577.65),
        (31.157, 612.88),
        (39.143, 595.49),
        (50.348, 453.21),
        (60.328, 382.09),
    ),
    ANGLE: (
        (2.15, 1.733),
        (4.096, 2.962),
        (9.826, 6.518),
        (20.567, 12.208),
        (30.29, 21.67),
        (39.535, 32.613),
        (49.747, 45.125),
        (60.208, 57.474),
    ),
}
"""By angle from the normal, degrees."""
ANGLES = (1.5, 4.0, 7.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 61.0)
"""Where finite elements are solved, degrees."""
READ_ANGLE, READ_SHARE = 0.3, 0.0075
"""Standard uncertainty of what is read off a figure: of its abscissa, degrees (the tabulated ones
are that far from round angles, and from each other for one impact), and of its ordinate over the
largest (tan(rebound) tan(angle)^-1 over the tangential restitution, which is one over the normal
one, scatters as much)."""
FRICTION_SHARE = 0.025
"""Standard uncertainty of the friction over its value, which nobody states: taken."""


@dataclass(frozen=True)
class Rebound:
    """Of the ball from the block."""

    normal: float
    """Velocity along the normal after over before."""
    tangential: float
    """The same along the surface."""
    spin: float
    """rad/s"""
    angle: float
    """From the normal, degrees."""

    @property
    def quantities(self) -> dict[str, float]:
        """As in `MEASURED`."""
        return {TANGENTIAL: self.tangential, SPIN: self.spin, ANGLE: self.angle}


def scene(angle: float, friction: float, elements: float, block: float = BLOCK) -> Scene:
    """A ball that strikes at ``angle`` degrees, ``elements`` per contact radius."""
    document: dict[str, Any] = {
        "name": "rebound",
        "description": "ball on a block of glass",
        "kind": "plate-impact",
        "scene_hash": "",
        "settings_hash": "",
        "friction": friction,
        "plate": {"radius": block, "thickness": block, "edge": "clamped", "material": GLASS},
        "outer": {
            "kind": "sphere",
            "radius": RADIUS,
            "material": BALL,
            "speed": SPEED,
            "angle": math.radians(angle),
        },
        # out of reach
        "inner": {"kind": "sphere", "radius": RADIUS, "material": BALL, "gap": 1e-3},
        "run": {"end_time": 2e-5},
        "reference": {
            "geometry": "solid",
            "elements_per_contact_radius": elements,
            "rigid": "inner",
        },
    }
    return parse_scene(document)


def rebound(
    angle: float, elements: float, friction: float = FRICTION, block: float = BLOCK
) -> Rebound:
    """Strike the block and come off."""
    made = scene(angle, friction, elements, block)
    estimate = estimate_contact(made)
    plate = half_model(made, estimate, shortest_wavelengths(made, estimate.duration), 1.0)
    run = integrate_solid(
        make_loop(plate.model, alone()), plate, made, estimate.duration, HalfMotion
    )
    assert run.sideways is not None
    assert not run.in_contact_at_end
    along = run.sideways.velocities[0]
    return Rebound(
        run.outer_velocity / made.normal_speed,
        along / made.tangential_velocity,
        run.sideways.spins[0],
        math.degrees(math.atan2(along, run.outer_velocity)),
    )


@dataclass(frozen=True)
class Row:
    """What the finite elements say of a measured value, with standard uncertainties."""

    angle: float
    simulated: float
    measured: float
    mesh: float
    inputs: float
    data: float

    @property
    def error(self) -> float:
        """E = S - D."""
        return self.simulated - self.measured

    @property
    def validation(self) -> float:
        """u_val."""
        return math.hypot(self.mesh, self.inputs, self.data)

    @property
    def verdict(self) -> str:
        """As `impactcheck compare` has it."""
        if abs(self.error) <= self.validation:
            return "within"
        return "undecided" if abs(self.error) <= 2.0 * self.validation else "model error shown"


def rows(
    quantity: str, fine: Sequence[Rebound], coarse: Sequence[Rebound], rougher: Sequence[Rebound]
) -> list[Row]:
    """Of a quantity, at its measured angles.

    Args:
        quantity: a key of `MEASURED`.
        fine: at `ANGLES`.
        coarse: the same with fewer elements; half the difference is taken for the mesh.
        rougher: as ``coarse`` with `FRICTION_SHARE` more friction.
    """

    def over_angles(found: Iterable[Rebound]) -> Callable[[float], Floats]:
        curve: Callable[[float], Floats] = PchipInterpolator(
            ANGLES, [each.quantities[quantity] for each in found]
        )
        return curve

    curve, on_coarse, more = map(over_angles, (fine, coarse, rougher))
    largest = max(value for _, value in MEASURED[quantity])
    found = []
    for angle, value in MEASURED[quantity]:
        ends = curve(angle + READ_ANGLE), curve(max(angle - READ_ANGLE, ANGLES[0]))
        reading = 0.5 * abs(float(ends[0] - ends[1]))
        found.append(
            Row(
                angle,
                float(curve(angle)),
                value,
                0.5 * abs(float(curve(angle) - on_coarse(angle))),
                abs(float(more(angle) - on_coarse(angle))),
                math.hypot(reading, READ_SHARE * largest),
            )
        )
    return found


def measured_normal() -> Floats:
    """Normal restitutions that the other tables make together: tangential one, angles of an impact.

    Of the larger angles; the smaller ones are not read well enough.
    """
    tangential = {round(angle, -1): value for angle, value in MEASURED[TANGENTIAL]}
    return np.array(
        [
            tangential[round(angle, -1)]
            * math.tan(math.radians(angle))
            / math.tan(math.radians(back))
            for angle, back in MEASURED[ANGLE][2:]
        ]
    )


def _table(heading: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    parts = [heading, ["---"] * len(heading), *lines]
    return "\n".join(f"| {' | '.join(line)} |" for line in parts)


def _line(row: Row) -> list[str]:
    numbers = (*astuple(row)[1:3], row.error, row.mesh, row.inputs, row.data, row.validation)
    return [f"{row.angle:.1f}", *(f"{number:.4g}" for number in numbers), row.verdict]


def report_rebound(
    out: Path, progress: Progress, elements: tuple[float, float] = (4.0, 3.0)
) -> None:
    """Write the tables to ``out`` (Markdown), from meshes of so many elements per radius."""
    fine, coarse = elements
    cases = [(fine, FRICTION), (coarse, FRICTION), (coarse, FRICTION * (1.0 + FRICTION_SHARE))]
    solved: list[list[Rebound]] = []
    for number, (count, friction) in enumerate(cases):
        solved.append([])
        for k, angle in enumerate(ANGLES):
            done = (number + k / len(ANGLES)) / len(cases)
            progress.report("stepping", done, f"{angle:g} degrees, {count:g} elements")
            solved[-1].append(rebound(angle, count, friction))
    tables, heading = [], ["angle, deg", "S", "D", "E", "mesh", "inputs", "data", "u_val", ""]
    verdicts: Counter[str] = Counter()
    for quantity in MEASURED:
        found = rows(quantity, *solved)
        verdicts.update(row.verdict for row in found)
        tables.append(f"## {quantity.capitalize()}\n\n{_table(heading, map(_line, found))}\n")
    wide_factor = 1.6
    wider = rebound(ANGLES[3], coarse, block=wide_factor * BLOCK)
    change = max(
        abs(wide / own - 1.0)
        for wide, own in zip(astuple(wider), astuple(solved[1][3]), strict=True)
    )
    normal = np.array([each.normal for each in solved[0]])
    implied = measured_normal()
    text = f"""# Balls that rebound obliquely from glass

Made by `python3 -m fem_reference rebound`: aluminium oxide balls of 5 mm strike soda-lime glass
with {SPEED:g} m/s, measured by Kharaz, Gorham and Salman (Powder Technol. 120, 2001, 281-291),
solved in three dimensions with Coulomb friction ({FRICTION:g}) between elastic bodies. Nothing is
fitted. The measured numbers are read off that paper's figures by the authors of Lethe, who
tabulate them (examples/dem/3d-oblique-wall-impact); how uncertain reading is (angles
{READ_ANGLE:g} degrees, values {100.0 * READ_SHARE:g} % of the largest) is told from the tables
themselves. The friction is taken to be known to {100.0 * FRICTION_SHARE:g} %, which the paper does
not state. Angles are from the normal; S finite elements, D experiment, E = S - D, u_val as of ASME
V&V 20 with its parts, standard uncertainties.

Of {verdicts.total()} values {verdicts["within"]} are within u_val, {verdicts["undecided"]} within
twice that; {verdicts["model error shown"]} are beyond.

Normal restitution of the finite elements: {normal.min():.4f} to {normal.max():.4f} (elastic waves
alone). The tables have none; tangential restitution and rebound angle together make
{implied.mean():.3f} with a scatter of {implied.std(ddof=1):.3f}, Chung and Ooi (2011) take 0.98.
With a block {wide_factor:g} times as large nothing changes by more than {100.0 * change:.1f} % at
{ANGLES[3]:g} degrees.

{chr(10).join(tables)}"""
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")
    progress.report("writing", 1.0, str(out))
