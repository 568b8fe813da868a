"""Join the rows of the validation base into its table.

    python validation/table.py ROWS validation/base.jsonl

One scene a line, in the order of the names; those that were refused or not solved with the reason.
Scenes of the table that have no new row stay. Under `values` each quantity has the reference's
value in the limit of fine meshes, the half width of its 95 % band, and those of models A, B and C.
`truncation` is the error of the omitted modes that the result of model C states.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

MODELS = ("A", "B", "C")
LARGEST = 1_000_000
"""Bytes of the table, which comes with the program."""
DIGITS = 6
"""Of values; of half widths and of scenes' hashes it is fewer that tell."""
BAND_DIGITS = 3
HASH = 16

Row = dict[str, Any]


def short(value: float | None) -> float | None:
    """With the digits that are kept."""
    return None if value is None else float(f"{value:.{DIGITS}g}")


def known(limit: float, band: float) -> list[float | None]:
    """What a line has of a reference's quantity: the limit and the half width of its band."""
    return [short(limit), float(f"{band:.{BAND_DIGITS}g}")]


def with_models(row: Row, results: Row) -> Row:
    """A line of the table with these results of the models."""
    similarity = results["C"].get("similarity") or {"numbers": {}, "results": {}}
    values = {
        name: of[:2] + [short(results.get(model, {}).get(name)) for model in MODELS]
        for name, of in row["values"].items()
    }
    numbers = {
        part: {name: short(value) for name, value in similarity[part].items()}
        for part in ("numbers", "results")
    }
    failed = {model: of["refused"] for model, of in results.items() if "refused" in of}
    kept = {name: value for name, value in row.items() if name != "failed"}
    stated = {"truncation": short(results["C"].get("truncation_error"))}
    return kept | numbers | stated | {"values": values} | ({"failed": failed} if failed else {})


def read(table: Path) -> list[Row]:
    """The lines; none of a table that is not there yet."""
    lines = table.read_text(encoding="utf-8").splitlines() if table.exists() else []
    return [json.loads(line) for line in lines]


def write(table: Path, rows: Iterable[Row]) -> None:
    """Write the lines. Raises `ValueError` of a table that is too large."""
    ordered = sorted(rows, key=lambda row: str(row["scene"]))
    text = "".join(json.dumps(row, separators=(",", ":")) + "\n" for row in ordered)
    if len(text) > LARGEST:
        raise ValueError(f"the table has {len(text)} bytes; it may have {LARGEST}")
    table.write_text(text, encoding="utf-8")


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", type=Path)
    parser.add_argument("table", type=Path)
    given = parser.parse_args()
    rows = {row["scene"]: row for row in read(given.table)}
    for path in given.rows.glob("*.json"):
        row = json.loads(path.read_text(encoding="utf-8"))
        # what stands may have been improved since (`finer.py`, `models.py`)
        if rows.get(path.stem, {}).get("content") != row["content"]:
            rows[path.stem] = row
    write(given.table, rows.values())
    unsolved = sum("refused" in row for row in rows.values())
    print(f"{len(rows)} scenes, {unsolved} of them refused or not solved: {given.table}")


if __name__ == "__main__":
    main()
