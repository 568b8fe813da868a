"""Truth of the bands of bodies: `coarse` series of random boxes and brackets and a finer mesh."""

from __future__ import annotations

import hashlib
import json
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from ..body.files import gmsh_session
from ..common.errors import RunError
from ..common.fenicsx import alone
from ..common.output import write_json
from ..common.progress import Progress
from ..common.settings import RESOLUTIONS, Options, Settings
from ..common.uncertainty import ORDER, least_squares
from ..impact.series import MESHES, Target
from .result import RATIO, TARGETED, quantities
from .scene import parse_scene
from .solve import compute

MM = 1e-3
FACTORS = [RESOLUTIONS["coarse"] * RATIO**k for k in range(MESHES)]
"""Of the meshes of `coarse`, finest first."""
TRUTH = 1.25 * FACTORS[0]
"""Of the finer mesh."""
COLUMNS = (*TARGETED, Target("first_frequency"))


@dataclass(frozen=True)
class Part:
    """A random part, mm."""

    kind: str
    size: tuple[float, float, float]
    wall: float
    foot: float
    """Thickness of a bracket's foot."""
    fillet: float
    struck: tuple[float, float, float]
    """Where the outer body strikes; the inner one lies behind the wall."""
    inward: tuple[int, int, int]
    held: tuple[float, float, float]
    """On the face that is held."""

    def behind(self) -> list[float]:
        """Where the inner body lies."""
        return [
            p + self.wall * direction for p, direction in zip(self.struck, self.inward, strict=True)
        ]


def _uniform(draw: random.Random, low: float, high: float) -> float:
    return round(draw.uniform(low, high), 3)


def _sizes(
    draw: random.Random, wall: float, *spans: tuple[float, float]
) -> tuple[float, float, float]:
    """Length, width and height between multiples of the wall."""
    length, width, height = (round(wall * draw.uniform(*span), 3) for span in spans)
    return length, width, height


def box(draw: random.Random) -> Part:
    """A box that is open below; its rim is held, its lid is struck."""
    wall = _uniform(draw, 1.0, 3.0)
    length, width, height = _sizes(draw, wall, (5, 9), (5, 8), (3, 6))
    away = 2.0 * wall
    struck = (_uniform(draw, away, length - away), _uniform(draw, away, width - away), height)
    fillet, held = round(wall * draw.uniform(1.1, 1.6), 3), (0.5 * wall, 0.5 * width, 0.0)
    return Part("box", (length, width, height), wall, 0.0, fillet, struck, (0, 0, -1), held)


def bracket(draw: random.Random) -> Part:
    """An angle; the underside of its foot is held, its wall is struck."""
    wall = _uniform(draw, 1.0, 3.0)
    foot = round(wall * draw.uniform(0.8, 2.0), 3)
    length, width, height = _sizes(draw, wall, (5, 9), (4, 8), (6, 9))
    fillet = round(wall * draw.uniform(0.7, 1.6), 3)
    low = foot + fillet + 0.5 * wall
    struck = (
        0.0,
        _uniform(draw, 1.5 * wall, width - 1.5 * wall),
        _uniform(draw, low, height - wall),
    )
    held = (0.5 * length, 0.5 * width, 0.0)
    return Part("bracket", (length, width, height), wall, foot, fillet, struck, (1, 0, 0), held)


def _edges(low: tuple[float, ...], high: tuple[float, ...]) -> list[int]:
    gmsh.model.occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*low, *high, 1)]


def write_part(part: Part, path: Path) -> None:
    """Write a part as STEP."""
    occ, (length, width, height), wall = gmsh.model.occ, part.size, part.wall
    with gmsh_session():
        if part.kind == "box":
            outside = occ.addBox(0, 0, 0, *part.size)
            below = _edges((-1, -1, -0.1), (length + 1, width + 1, 0.1))
            all_edges = _edges((-1, -1, -1), (length + 1, width + 1, height + 1))
            rounded = [edge for edge in all_edges if edge not in below]
            solid = occ.fillet([outside], rounded, [part.fillet])[0]
            hollow = (length - 2 * wall, width - 2 * wall, height - wall)
            occ.cut([solid], [(3, occ.addBox(wall, wall, 0, *hollow))])
        else:
            foot = occ.addBox(0, 0, 0, length, width, part.foot)
            back = occ.addBox(0, 0, 0, wall, width, height)
            solid = occ.fuse([(3, foot)], [(3, back)])[0][0][1]
            corner = _edges(
                (wall - 0.1, -1, part.foot - 0.1), (wall + 0.1, width + 1, part.foot + 0.1)
            )
            occ.fillet([solid], corner, [part.fillet])
        occ.synchronize()
        gmsh.write(str(path))


def draw_scene(seed: int, folder: Path) -> tuple[dict[str, Any], Path]:
    """A random scene and the file of its part, which is written into a folder."""
    draw = random.Random(seed)
    part = (box if seed % 2 else bracket)(draw)
    name = f"{part.kind}-{seed}"
    path = folder / f"{name}.step"
    write_part(part, path)
    steel = {"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0}

    def sphere() -> dict[str, Any]:
        return {"kind": "sphere", "radius": _uniform(draw, 3.0, 8.0) * MM, "material": steel}

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
