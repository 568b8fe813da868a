"""Random plate impacts over the range the axisymmetric reference covers."""

from __future__ import annotations

import math
from typing import Any, get_args

import numpy as np

from ...common.bodies import Edge
from ...common.hertz import effective_modulus, hertz_stiffness, hertz_time_scale
from ..scene import Scene, parse_scene


def draw(seed: int) -> Scene:
    """The scene of ``seed``; it may be one that the method refuses."""
    random = np.random.default_rng(seed)

    def log(low: float, high: float) -> float:
        return float(math.exp(random.uniform(math.log(low), math.log(high))))

    def material(name: str) -> dict[str, Any]:
        return {
            "name": name,
            "youngs_modulus": log(1e9, 1e12),
            "poisson_ratio": float(random.uniform(0.0, 0.48)),
            "density": log(800.0, 2e4),
        }

    radius, edges = log(3e-3, 0.1), get_args(Edge)
    outer_radius = radius * log(0.1, 1.0)
    document: dict[str, Any] = {
        "name": f"random-{seed}",
        "kind": "plate-impact",
        "scene_hash": str(seed),
        "settings_hash": str(seed),
        "plate": {
            "radius": radius,
            "thickness": radius * log(0.02, 1.0),
            "edge": edges[int(random.integers(len(edges)))],
            "material": material("plate"),
        },
        "outer": {
            "kind": "sphere",
            "radius": outer_radius,
            "material": material("outer"),
            "speed": log(0.1, 10.0),
        },
        "inner": {
            "kind": "sphere",
            "radius": outer_radius * log(0.33, 3.0),
            "material": material("inner"),
            "gap": 0.0,
        },
        "reference": {"geometry": "axisymmetric", "elements_per_contact_radius": 12},
    }
    if random.integers(2):
        document["inner"]["gap"] = _approach(parse_scene(document)) * log(0.01, 1.0)
    return parse_scene(document)


def _approach(scene: Scene) -> float:
    """Of the outer sphere and a half-space of the plate's material, at most, m."""
    outer = scene.outer
    stiffness = hertz_stiffness(
        effective_modulus(outer.material, scene.plate.material), outer.tip_radius
    )
    return 1.0932 * scene.speed * hertz_time_scale(outer.mass, stiffness, scene.speed)
