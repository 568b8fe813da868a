"""Truth of the bands of bodies: `coarse` series of random boxes and brackets and a finer mesh."""

from __future__ import annotations

import hashlib
import json
import random
from pathlib import Path
from typing import Any

import numpy as np

from ..common.errors import RunError
from ..common.fenicsx import alone
from ..common.output import write_json
from ..common.progress import Progress
from ..common.settings import RESOLUTIONS, Options, Settings
from ..common.uncertainty import ORDER, least_squares
from ..impact.series import MESHES, Target
from .parts import box, bracket, uniform, write_part
from .result import RATIO, TARGETED, quantities
from .scene import parse_scene
from .solve import compute

MM = 1e-3
FACTORS = [RESOLUTIONS["coarse"] * RATIO**k for k in range(MESHES)]
"""Of the meshes of `coarse`, finest first."""
TRUTH = 1.25 * FACTORS[0]
"""Of the finer mesh."""
COLUMNS = (*TARGETED, Target("first_frequency"))


def draw_scene(seed: int, folder: Path) -> tuple[dict[str, Any], Path]:
    """A random scene and the file of its part, which is written into a folder."""
    draw = random.Random(seed)
    part = (box if seed % 2 else bracket)(draw)
    name = f"{part.kind}-{seed}"
    path = folder / f"{name}.step"
    write_part(part, path)
    steel = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}

    def sphere() -> dict[str, Any]:
        return {"kind": "sphere", "radius": uniform(draw, 3.0, 8.0) * MM, "material": steel}

    metres = [[MM * x for x in place] for place in (part.held, part.struck, part.behind())]
    body = {
        "content": hashlib.sha256(path.read_bytes()).hexdigest(),
        "unit": None,
        "material": steel,
        "fixed": [metres[0]],
        "element_size": None,
        "damping_ratio": 0.0,
        "at": metres[1:],
    }
    scene = {
        "name": name,
        "kind": "impact",
        "scene_hash": f"{seed:x}",
        "settings_hash": "0",
        "outer": sphere() | {"speed": round(10.0 ** draw.uniform(-0.5, 0.5), 3)},
        "inner": sphere(),
        "body": body,
        "run": {"end_time": None},
        "reference": {"geometry": "solid", "elements_per_contact_radius": 4.0},
    }
    return scene, path


def solve(seed: int, folder: Path, progress: Progress) -> None:
    """Write ``<seed>-<factor>.json`` with the quantities of each mesh that is not there yet.

    Raises:
        RunError: the method refuses the scene.
    """
    document, path = draw_scene(seed, folder)
    scene = parse_scene(document)
    settings = Settings(Options().courant, folder / f"{seed}.kept", 0.0, "")
    for factor in [*FACTORS[::-1], TRUTH]:
        target = folder / f"{seed}-{factor:.4f}.json"
        if not target.exists():
            solution = compute(scene, path, factor, settings, alone(), progress.report)
            numbers = {"dofs": solution.dofs, "seconds": solution.run.processor_seconds}
            write_json(target, {"scene": document, "values": quantities(scene, solution)} | numbers)


def _row(seed: int, folder: Path) -> list[str]:
    def read(factor: float) -> dict[str, Any]:
        text = (folder / f"{seed}-{factor:.4f}.json").read_text(encoding="utf-8")
        return dict(json.loads(text))

    meshes, truth = [read(factor) for factor in FACTORS], read(TRUTH)
    # the finer mesh is off itself
    seen = 1.0 - (FACTORS[0] / TRUTH) ** ORDER
    cells = [truth["scene"]["name"], f"{meshes[0]['dofs'] / 1000:.0f} 000"]
    cells.append(f"{sum(mesh['seconds'] for mesh in meshes):.0f}")
    for column in COLUMNS:
        values = np.array([mesh["values"][column.name] for mesh in meshes])
        found = least_squares(values, 1.0 / np.array(FACTORS))
        error = (values[0] - truth["values"][column.name]) / seen
        share = 100.0 / column.scale(truth["values"])
        cells.append(f"{share * error:+.2f} of {share * found.band:.2f}")
    return cells


def report(count: int, folder: Path, progress: Progress) -> None:
    """Solve ``count`` random scenes, or what is missing of them, and write ``body-bands.md``."""
    folder.mkdir(parents=True, exist_ok=True)
    rows, refused = [], []
    for seed in range(1, count + 1):
        try:
            solve(seed, folder, progress)
            rows.append(_row(seed, folder))
        except RunError as error:
            refused.append(f"- seed {seed}: {error}")
    head = ["scene", "unknowns", "processor time, s", *(column.name for column in COLUMNS)]
    lines = [
        "# Bands of random boxes and brackets at `coarse`",
        "",
        f"Error against a mesh with {TRUTH / FACTORS[0]:g} times the elements in every direction, "
        "its own error added, and the 95 % band, both in % of the value (a restitution: of 1).",
        "",
        *(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)),
        *(["", "Refused:", "", *refused] if refused else []),
    ]
    (folder / "body-bands.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
