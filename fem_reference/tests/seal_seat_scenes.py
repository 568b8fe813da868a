"""The two designs of the seal seat as documents a solver receives."""

from __future__ import annotations

import math
from typing import Any

DEGREE = math.pi / 180.0


def seat_document(improved: bool = False, **changes: Any) -> dict[str, Any]:
    """A valid ``scene.json``; ``seat__tilt=...`` changes one number of a table."""
    polymer = {
        "name": "polymer",
        "youngs_modulus": 2.6e9,
        "poisson_ratio": 0.38,
        "density": 1320.0,
    }
    steel = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}
    document: dict[str, Any] = {
        "name": "seat",
        "kind": "seal-seat",
        "scene_hash": "scene",
        "settings_hash": "settings",
        "geometry_hash": "geometry",
        "seat": {
            "material": polymer,
            "membrane_radius": 8e-3,
            "membrane_thickness": 0.5e-3,
            "island_length": 10e-3,
            "island_width": 6e-3,
            "island_height": 2.95e-3,
            "seat_distance": 5e-3,
            "seated_height": 3.3e-3,
            "tilt": 15.0 * DEGREE,
            "aperture_angle": 120.0 * DEGREE,
            "bore_radius": 0.6e-3,
            "bore_depth": 1.6e-3,
            "notch": {"width": 1.4e-3, "floor": 0.5e-3} if improved else None,
        },
        "sphere": {"radius": 1.5e-3, "material": steel, "mass": 1.1e-4, "body": "rigid"},
        "actuator": {
            "mass": 2e-3,
            "speed": 1.0,
            "tip_radius": 3e-3,
            "tip_positions": [-4.5e-3, 4.5e-3] if improved else [0.0],
        },
        "intended_angle": 15.0 * DEGREE,
        "run": {"end_time": None},
        "reference": {"geometry": "solid", "elements_per_ring_radius": 10.0},
    }
    for name, value in changes.items():
        *tables, key = name.split("__")
        place = document
        for table in tables:
            place = place[table]
        place[key] = value
    return document
