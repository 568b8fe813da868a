"""Scenes of kind impact, and their solutions on one small mesh."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fem_reference.common.fenicsx import alone
from fem_reference.common.settings import Settings
from fem_reference.general_impact.scene import Scene, parse_scene
from fem_reference.general_impact.solve import Solution, compute

STEEL = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}
SPHERE = {"kind": "sphere", "radius": 0.004, "material": STEEL}


def document(**changes: Any) -> dict[str, Any]:
    """A steel sphere on nothing yet; a change is ``wall=...`` or ``outer__speed=...``."""
    scene: dict[str, Any] = {
        "name": "test",
        "kind": "impact",
        "scene_hash": "0",
        "settings_hash": "0",
        "outer": SPHERE | {"speed": 0.5},
        "run": {"end_time": None},
        "reference": {"geometry": "solid", "elements_per_contact_radius": 2.0},
    }
    scene = json.loads(json.dumps(scene))
    for path, value in changes.items():
        *parents, last = path.split("__")
        node = scene
        for key in parents:
            node = node[key]
        node[last] = value
    return scene


def struck(path: Path, outer: object, inner: object = None, **changes: Any) -> dict[str, Any]:
    """The table of a body from a file."""
    body: dict[str, Any] = {
        "content": hashlib.sha256(path.read_bytes()).hexdigest(),
        "unit": None,
        "material": STEEL,
        "fixed": [],
        "element_size": None,
        "damping_ratio": 0.0,
        "at": [outer, inner],
    }
    return body | changes


def solved(changes: dict[str, Any], file: Path | None = None) -> tuple[Scene, Solution]:
    """A verified solution with the elements that the scene asks for."""
    scene = parse_scene(document(**changes))
    with TemporaryDirectory() as folder:
        settings = Settings(0.9, Path(folder), 0.0, "test")
        return scene, compute(scene, file, 1.0, settings, alone(), lambda *_: None)
