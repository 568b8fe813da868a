"""Scenes shared by the tests: small meshes of Table 1's plate and variations of it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

from fem_reference.axisymmetric.modal import elastic_modes
from fem_reference.axisymmetric.system import OUTER, PLATE, AxisymmetricSystem
from fem_reference.common.arrays import Floats
from fem_reference.common.fenicsx import alone
from fem_reference.common.settings import Settings
from fem_reference.explicit.damping import Modes
from fem_reference.explicit.loop import SerialLoop
from fem_reference.plate_impact.axisymmetric import Solution, compute
from fem_reference.plate_impact.axisymmetric_motion import (
    AxisymmetricMotion,
    integrate_axisymmetric,
)
from fem_reference.plate_impact.estimate import estimate_contact
from fem_reference.plate_impact.meshing import build_system, mesh_impact, mesh_settings
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene

STEEL = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}


def document(**changes: Any) -> dict[str, Any]:
    """A valid scene; a change is written ``plate__edge="free"``."""
    scene: dict[str, Any] = {
        "name": "test",
        "description": "steel spheres on a clamped steel plate",
        "kind": "plate-impact",
        "scene_hash": "0",
        "settings_hash": "0",
        "plate": {
            "radius": 0.033,
            "thickness": 0.002,
            "edge": "clamped",
            "material": STEEL,
            "damping_ratio": 0.0,
        },
        "outer": {"kind": "sphere", "radius": 0.01, "material": STEEL, "speed": 0.55},
        "inner": {"kind": "sphere", "radius": 0.01, "material": STEEL, "gap": 0.0},
        "fluid": None,
        "run": {"end_time": None},
        "reference": {"geometry": "axisymmetric", "elements_per_contact_radius": 4},
    }
    # Through text, so that no two bodies share one material.
    scene = json.loads(json.dumps(scene))
    for path, value in changes.items():
        *parents, last = path.split("__")
        node = scene
        for key in parents:
            node = node[key]
        node[last] = value
    # the fewest, for speed
    if scene["reference"]["geometry"] == "solid":
        scene["reference"].setdefault("elements_per_thickness", 1)
    return scene


def make_system(scene: Scene, factor: float = 1.0) -> tuple[AxisymmetricSystem, float]:
    """The assembled system of a scene and the Hertz contact duration."""
    estimate = estimate_contact(scene)
    settings = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, factor)
    return build_system(scene, mesh_impact(scene, settings)), estimate.duration


def integrate(system: AxisymmetricSystem, scene: Scene, duration: float, **options: Any) -> Run:
    """A run of the system."""
    return integrate_axisymmetric(system, scene, duration, **options)[0]


def make_loop(system: AxisymmetricSystem, time_step: float, most_levels: int = 1) -> SerialLoop:
    """The loop of a system, ready to step (s)."""
    loop = SerialLoop(system, alone())
    loop.set_step(time_step, 1, most_levels)
    return loop


def vibrating(
    system: AxisymmetricSystem, mode: int, levels: int, damping_ratio: float = 0.0
) -> tuple[AxisymmetricMotion, Modes, Floats]:
    """A plate that starts in one of its modes with unit modal velocity, bodies leaving it.

    The step is one for half the elements that a scene asks for.

    Returns:
        The motion, the plate's modes, and their masses times shapes.
    """
    modes = elastic_modes(system, 4)
    velocity = np.zeros_like(system.velocity)
    velocity[system.first[OUTER] : system.first[OUTER + 1], 1] = 1e3
    plate = slice(int(system.first[PLATE]), int(system.first[PLATE + 1]))
    velocity[plate] = modes.shapes[:, mode].reshape(-1, 2)
    motion = AxisymmetricMotion(replace(system, velocity=velocity))
    if damping_ratio > 0.0:
        motion.damp(damping_ratio, float(modes.frequencies[-1]))
    motion.loop.set_step(4e-9, 1, levels)
    return motion, modes, np.repeat(system.mass[plate], 2)[:, None] * modes.shapes


def solve_once(scene: Scene) -> Solution:
    """A verified solution with the elements the scene asks for."""
    with TemporaryDirectory() as folder:
        settings = Settings(0.9, Path(folder), 0.0, "test")
        return compute(scene, 1.0, settings, lambda phase, done, message: None)


@pytest.fixture(scope="session")
def scene() -> Scene:
    return parse_scene(document())


@pytest.fixture(scope="session")
def system(scene: Scene) -> AxisymmetricSystem:
    return make_system(scene)[0]


@pytest.fixture(scope="session")
def duration(scene: Scene) -> float:
    return estimate_contact(scene).duration


@pytest.fixture(scope="session")
def run(system: AxisymmetricSystem, scene: Scene, duration: float) -> Run:
    return integrate(system, scene, duration)
