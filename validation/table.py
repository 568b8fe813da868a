"""Join the rows of the validation base into its table.

    python validation/table.py ROWS validation/base.jsonl

One scene a line, in the order of the names; those that were refused or not solved with the reason.
Scenes of the table that have no new row stay. Under `values` each quantity has the reference's
value in the limit of fine meshes, the half width of its 95 % band, and those of models A, B and C.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bodies
import seats
from solve import MODELS

SIDES = ("extrapolated", "bands")
"""Of a row: what is known of the reference."""
LARGEST = 1_000_000
"""Bytes of the table, which comes with the program."""


def of_plate(scene: dict[str, Any]) -> dict[str, float]:
    """Numbers of a plate impact that were drawn, by the names that the program has for them."""
    plate, outer, inner = scene["plate"], scene["outer"], scene["inner"]
    materials = scene["materials"]
    of_plate = materials[plate["material"]]
    ratios = {
        f"modulus of the {name} body over the plate's": materials[body["material"]][
            "youngs_modulus"
        ]
        / of_plate["youngs_modulus"]
        for name, body in (("outer", outer), ("inner", inner))
    }
    return ratios | {
        "thickness over radius of the plate": plate["thickness"] / plate["radius"],
        "Poisson's ratio of the plate": of_plate["poisson_ratio"],
        "damping ratio of the plate": plate.get("damping_ratio", 0.0),
        "speed of the inner body over the outer one's": inner.get("speed", 0.0) / outer["speed"],
        "coefficient of friction": scene.get("friction", 0.0),
        "offset over radius of the plate": outer.get("offset", 0.0) / plate["radius"],
    }


PROPORTIONS: dict[str, Callable[[dict[str, Any]], dict[str, float]]] = {
    "plate-impact": of_plate,
    "impact": bodies.proportions,
    "seal-seat": seats.proportions,
}
"""Numbers of a scene that were drawn, by its kind."""


def line(row: dict[str, Any]) -> dict[str, Any]:
    """What the table keeps of a scene, which its number makes again."""
    scene = row["file"]
    kept = {name: value for name, value in row.items() if name not in ("file", *SIDES, "models")}
    if "refused" not in row:
        models = [row["models"].get(model, {}) for model in MODELS]
        kept["values"] = {
            name: [side.get(name) for side in (*(row[side] for side in SIDES), *models)]
            for name in row["extrapolated"]
        }
        kept["speed"] = scene["actuator" if "actuator" in scene else "outer"]["speed"]
        kept["proportions"] = {
            name: float(f"{value:.7g}") for name, value in PROPORTIONS[scene["kind"]](scene).items()
        }
    return kept


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", type=Path)
    parser.add_argument("table", type=Path)
    given = parser.parse_args()
    before = given.table.read_text(encoding="utf-8").splitlines() if given.table.exists() else []
    lines = {row["scene"]: row for row in map(json.loads, before)}
    for path in given.rows.glob("*.json"):
        lines[path.stem] = line(json.loads(path.read_text()))
    rows = [lines[name] for name in sorted(lines)]
    text = "".join(json.dumps(row, separators=(",", ":")) + "\n" for row in rows)
    if len(text) > LARGEST:
        parser.error(f"the table has {len(text)} bytes; it may have {LARGEST}")
    given.table.write_text(text, encoding="utf-8")
    unsolved = sum("refused" in row for row in rows)
    print(f"{len(rows)} scenes, {unsolved} of them refused or not solved: {given.table}")


if __name__ == "__main__":
    main()
