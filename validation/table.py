"""Join the rows of the validation base into its table.

    python validation/table.py ROWS validation/base.jsonl

One scene a line, in the order of the names; those that were refused or not solved with the reason.
Scenes of the table that have no new row stay. Under `values` each quantity has the reference's
value in the limit of fine meshes, the half width of its 95 % band, and those of models A, B and C.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from solve import MODELS, short

SIDES = ("extrapolated", "bands")
"""Of a row: what is known of the reference."""
LARGEST = 1_000_000
"""Bytes of the table, which comes with the program."""


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
        similarity = kept.pop("similarity") or {"numbers": {}, "results": {}}
        for part in ("numbers", "results"):
            kept[part] = {name: short(value) for name, value in similarity[part].items()}
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
