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

from ..axisymmetric.system import AxisymmetricSystem, critical_time_step
from ..common.progress import Progress
from ..plate_impact.axisymmetric_motion import AxisymmetricMotion, integrate_axisymmetric
from ..plate_impact.estimate import estimate_contact
from ..plate_impact.meshing import build_system, mesh_impact, mesh_settings
from ..plate_impact.scene import Scene, parse_scene

STEEL = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}
WALL = {"name": "wall", "youngs_modulus": 2.1e14, "poisson_ratio": 0.3, "density": 7.78e6}
"""A thousand times as stiff and as heavy as steel: waves are as fast, steps as long."""
RADIUS, SPEED = 0.01, 0.02
"""Of the sphere, m and m/s: the contact radius stays a small share of the radius."""
ONSET = 1.60
"""Largest Hertz pressure at first yield over the yield strength, nu = 0.3."""
SPEEDS = (2.1, 5.3, 10.5, 26.0, 53.0, 105.0)


@dataclass(frozen=True)
class Wall:
    """A perfectly plastic sphere at ``ratio`` times its speed of first yield on a rigid wall."""

    ratio: float

    @property
    def modulus(self) -> float:
        """E*, Pa."""
        return float(210e9 / (1.0 - 0.3**2))

    @property
    def pressure(self) -> float:
        """Largest at first yield, Pa.

        (2 E*/pi) (d/R)^(1/2), with d at the energy (8/15) E* R^(1/2) d^(5/2).
        """
        mass = STEEL["density"] * 4.0 / 3.0 * math.pi * RADIUS**3  # type: ignore[operator]
        energy = 0.5 * mass * (SPEED / self.ratio) ** 2
        approach = (energy / (8.0 / 15.0 * self.modulus * math.sqrt(RADIUS))) ** 0.4
        return float(2.0 * self.modulus / math.pi * math.sqrt(approach / RADIUS))

    @property
    def strength(self) -> float:
        """Y, Pa."""
        return self.pressure / ONSET

    @property
    def first_force(self) -> float:
        """At first yield, N: (pi p0)^3 R^2 / (6 E*^2)."""
        return (math.pi * self.pressure) ** 3 * RADIUS**2 / (6.0 * self.modulus**2)

    def scene(self, elements: float) -> Scene:
        """With ``elements`` per contact radius."""
        soft = {**STEEL, "yield_strength": self.strength, "hardening": 0.0}
        document: dict[str, Any] = {
            "name": "wall",
            "description": "sphere on a rigid wall",
            "kind": "plate-impact",
            "scene_hash": "",
            "settings_hash": "",
            "plate": {"radius": 0.006, "thickness": 0.003, "edge": "free", "material": WALL},
            "outer": {"kind": "sphere", "radius": RADIUS, "material": soft, "speed": SPEED},
            "inner": {"kind": "sphere", "radius": RADIUS, "material": WALL, "gap": 1e-3},
            "run": {"end_time": 1.6e-4},
            "reference": {"geometry": "axisymmetric", "elements_per_contact_radius": elements},
        }
        return parse_scene(document)


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
    run, motion = integrate_axisymmetric(system, scene, duration, end_time=scene.end_time)
    plate_mass = math.pi * scene.plate.radius**2 * scene.plate.surface_density
    after = run.outer_velocity / SPEED
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


def _row(ratio: float, found: Sequence[Rebound]) -> list[str]:
    finest = found[-1]
    return [
        f"{ratio:g}",
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
    for number, ratio in enumerate(SPEEDS):
        progress.report("stepping", number / len(SPEEDS), f"{ratio:g} times the speed of onset")
        rows.append(_row(ratio, [rebound(Wall(ratio), n) for n in counts]))
    restitution = [f"restitution, {n:g} elements" for n in counts]
    heading = ["V/V_y", *restitution, "E* a/(Y R)", "p/Y", "energy residual", "inside the boxes"]
    text = f"""# Yielding of the finite elements on a rigid wall

Made by `python3 -m fem_reference yielding`: a perfectly plastic steel sphere of 10 mm.

Force at first yield over that of p0 = 1.60 Y, by elements per contact radius:

{_table(("elements", "force"), onset)}

Rebound by speed over that of first yield; contact radius and mean pressure at the peak:

{_table(heading, rows)}
"""
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")
    progress.report("writing", 1.0, str(out))
