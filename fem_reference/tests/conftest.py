"""Scenes shared by the tests: small meshes of Table 1's plate and variations of it."""

from __future__ import annotations

import json
from typing import Any

import pytest

from fem_reference.axisymmetric.system import System
from fem_reference.plate_impact.axisymmetric_run import Run, integrate
from fem_reference.plate_impact.estimate import estimate_contact
from fem_reference.plate_impact.meshing import build_system, mesh_impact, mesh_settings
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
    return scene


def make_system(scene: Scene, factor: float = 1.0) -> tuple[System, float]:
    """The assembled system of a scene and the Hertz contact duration."""
    estimate = estimate_contact(scene)
    settings = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, factor)
    return build_system(scene, mesh_impact(scene, settings)), estimate.duration


@pytest.fixture(scope="session")
def scene() -> Scene:
    return parse_scene(document())


@pytest.fixture(scope="session")
def system(scene: Scene) -> System:
    return make_system(scene)[0]


@pytest.fixture(scope="session")
def duration(scene: Scene) -> float:
    return estimate_contact(scene).duration


@pytest.fixture(scope="session")
def run(system: System, scene: Scene, duration: float) -> Run:
    return integrate(system, scene.speed, duration)
