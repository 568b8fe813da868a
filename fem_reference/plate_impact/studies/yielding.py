"""Yielding against what is known of it: a sphere on a rigid wall.

Onset at p0 = 1.60 Y, a mean pressure that grows towards that of a hardness test, and rebound
(Johnson 1985, Contact Mechanics, ch. 6.2, 6.3 and 11.4; Jackson, Green & Marghitu 2010, Nonlinear
Dyn. 60, 217).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...axisymmetric.system import AxisymmetricSystem, critical_time_step
from ...common.progress import Progress
from ..axisymmetric_motion import AxisymmetricMotion, integrate_axisymmetric
from ..estimate import estimate_contact
from ..meshing import build_system, mesh_impact, mesh_settings
from ..scene import Scene, parse_scene

STEEL = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}
WALL = {"name": "wall", "youngs_modulus": 2.1e15, "poisson_ratio": 0.3, "density": 7.78e7}
"""Ten thousand times as stiff and as heavy as steel: waves are as fast, steps as long.

At a thousand times the sphere rebounds 0.35 % faster, at a hundred thousand 0.03 % slower."""
RADIUS, STRENGTH = 0.01, 600e6
"""Of the sphere, m, and its yield strength, Pa: it begins to yield at 9.5 mm/s."""
ONSET = 1.60
"""Largest Hertz pressure at first yield over the yield strength, nu = 0.3."""
SPEEDS = (2.1, 5.3, 10.5, 26.0, 53.0, 105.0, 269.0)
"""From 0.02 to 2.6 m/s: the faster, the more is left in the waves of the sphere, as in reality."""


@dataclass(frozen=True)
class Wall:
    """A plastic sphere at ``ratio`` times its speed of first yield on a rigid wall."""

    ratio: float
    strength: float = STRENGTH
    """Y, Pa."""
    hardening: float = 0.0
    """H, Pa."""

    @property
    def modulus(self) -> float:
        """E*, Pa."""
        return float(210e9 / (1.0 - 0.3**2))

    @property
    def speed(self) -> float:
        """m/s; first yield at the energy (8/15) E* R^(1/2) d^(5/2), d = R (pi p0/(2 E*))^2."""
        mass = STEEL["density"] * 4.0 / 3.0 * math.pi * RADIUS**3  # type: ignore[operator]
        approach = RADIUS * (math.pi * ONSET * self.strength / (2.0 * self.modulus)) ** 2
        energy = 8.0 / 15.0 * self.modulus * math.sqrt(RADIUS) * approach**2.5
        return self.ratio * math.sqrt(2.0 * energy / mass)

    @property
    def first_force(self) -> float:
        """At first yield, N: (pi p0)^3 R^2 / (6 E*^2)."""
        return (math.pi * ONSET * self.strength) ** 3 * RADIUS**2 / (6.0 * self.modulus**2)

    def scene(self, elements: float) -> Scene:
        """With ``elements`` per contact radius."""
        soft = {**STEEL, "yield_strength": self.strength, "hardening": self.hardening}
        document: dict[str, Any] = {
            "name": "wall",
            "description": "sphere on a rigid wall",
            "kind": "plate-impact",
            "scene_hash": "",
            "settings_hash": "",
            "plate": {"radius": 0.006, "thickness": 0.003, "edge": "free", "material": WALL},
            "outer": {"kind": "sphere", "radius": RADIUS, "material": soft, "speed": self.speed},
            "inner": {"kind": "sphere", "radius": RADIUS, "material": WALL, "gap": 1e-3},
            # Hertz's contact lasts 53 us at 1 m/s, longer than any that yields.
            "run": {"end_time": 7.3e-5 * self.speed**-0.2},
            "reference": {"geometry": "axisymmetric", "elements_per_contact_radius": elements},
        }
        return parse_scene(document)


SLOW = Wall(105.0, 126e6)
"""As far beyond first yield as at 1 m/s, but so slow that nothing is left in waves."""
HARDENED = [Wall(ratio, hardening=h) for ratio in (53.0, 269.0) for h in (6e9, 60e9)]


def _system(scene: Scene) -> tuple[AxisymmetricSystem, float]:
    estimate = estimate_contact(scene)
    sizes = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, 1.0)
    return build_system(scene, mesh_impact(scene, sizes)), estimate.duration


def first_yield(wall: Wall, elements: float) -> float:
    """Force at the first plastic work over the exact one."""
    system, _ = _system(wall.scene(elements))
    motion = AxisymmetricMotion(system)
    motion.loop.set_step(0.9 * critical_time_step(system), 1)
    plastic, stride = motion.loop.problem.plastic, 50
    assert plastic is not None
    force = before = 0.0
    while plastic.work.sum() == 0.0:
        impulse = float(motion.sample(1, stride)[0, 2])
        force, before = (impulse - before) / (stride * motion.loop.dt), impulse
    return force / wall.first_force


@dataclass(frozen=True)
class Rebound:
    """Of a sphere from the wall."""

    restitution: float
    """Relative speed after over before."""
    depth: float
    """E* a / (Y R) at the peak."""
    pressure: float
    """Mean pressure at the peak over Y."""
    energy_residual: float
    inside: bool
    """Whether it stayed within what may touch and may yield."""


def rebound(wall: Wall, elements: float) -> Rebound:
    """Strike the wall and come off."""
    scene = wall.scene(elements)
    system, duration = _system(scene)
    run, motion = integrate_axisymmetric(
        system, scene, duration, end_time=scene.end_time, most_levels=1
    )
    plate_mass = math.pi * scene.plate.radius**2 * scene.plate.surface_density
    after = run.outer_velocity / wall.speed
    recoil = (1.0 + after) * scene.outer.mass / plate_mass
    radii = motion.radii[0]
    outermost = int(np.searchsorted(radii, 0.999999 * run.contacts[0].outermost_radius))
    last = min(outermost + 1, radii.size - 1)
    # the edge lies between the last node that touched and the next
    contact = 0.5 * float(radii[outermost] + radii[last])
    assert motion.dents is not None
    return Rebound(
        after + recoil,
        wall.modulus * contact / (wall.strength * RADIUS),
        run.contacts[0].force_peak / (math.pi * contact**2 * wall.strength),
        run.energy_residual,
        outermost + 1 < radii.size and not motion.dents.reach_the_edge(),
    )


def _table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heading, ["---"] * len(heading), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _row(wall: Wall, found: Sequence[Rebound]) -> list[str]:
    finest = found[-1]
    return [
        f"{wall.ratio:g}",
        f"{wall.speed:.3f}",
        f"{1e-6 * wall.strength:g}",
        f"{1e-9 * wall.hardening:g}",
        *(f"{each.restitution:.3f}" for each in found),
        f"{finest.depth:.1f}",
        f"{finest.pressure:.2f}",
        f"{max(each.energy_residual for each in found):.1e}",
        "yes" if all(each.inside for each in found) else "no",
    ]


def report_yielding(out: Path, progress: Progress, counts: Sequence[float] = (5, 10, 15)) -> None:
    """Write the tables to ``out`` (Markdown), by elements per contact radius."""
    onset = [(f"{n:g}", f"{first_yield(Wall(1.05), n):.3f}") for n in counts]
    rows = []
    walls = [*map(Wall, SPEEDS), SLOW, *HARDENED]
    for number, wall in enumerate(walls):
        message = f"{wall.ratio:g} times the speed of onset"
        progress.report("stepping", number / len(walls), message)
        rows.append(_row(wall, [rebound(wall, n) for n in counts]))
    restitution = [f"restitution, {n:g} elements" for n in counts]
    heading = [
        "V/V_y",
        "V, m/s",
        "Y, MPa",
        "H, GPa",
        *restitution,
        "E* a/(Y R)",
        "p/Y",
        "energy residual",
        "inside the boxes",
    ]
    text = f"""# Yielding of the finite elements on a rigid wall

Made by `python3 -m fem_reference yielding`: a plastic steel sphere of 10 mm.

Force at first yield over that of p0 = 1.60 Y, by elements per contact radius:

{_table(("elements", "force"), onset)}

Rebound by speed over that of first yield; contact radius (up to half an element) and mean
pressure at the peak. The row of 126 MPa is as far beyond first yield as the other one of 105, but
slow: the difference is left in the waves of the sphere. H is the hardening.

{_table(heading, rows)}
"""
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")
    progress.report("writing", 1.0, str(out))
