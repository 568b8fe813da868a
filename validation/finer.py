"""How far the references of the validation base are off, over their bands, against finer meshes.

    python validation/finer.py SCENES validation/base.jsonl ROWS [--count 24] [--program PATH]

solves the least expensive scenes of the table again at `--resolution paper`, with 1.5 times the
elements in every direction, as far as `ROWS/<scene>.json` is not there yet, and prints quantiles of
the differences over the bands of the table.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from models import PROGRAM
from solve import limits
from table import read

QUANTILES = (0.5, 0.9, 0.95, 1.0)
FINE = 0.5
"""Largest band of the finer meshes over that of the table: others do not decide."""


def finer(path: Path, program: Path) -> dict[str, list[float]]:
    """Values and bands of the finer meshes by quantity."""
    with tempfile.TemporaryDirectory() as folder:
        options = ("--resolution", "paper", "--json")
        command: list[str | Path] = [program, "--store", folder, "reference", path, *options]
        ran = subprocess.run(command, capture_output=True, text=True, check=True)
    return limits(json.loads(ran.stdout)["convergence"])


def ratios(before: dict[str, Any], after: dict[str, Any]) -> list[float]:
    """Differences over the bands of the table, of the quantities that the finer meshes decide."""
    found = []
    for name, (value, band, *_) in before["values"].items():
        exact, rest = after.get(name, (None, None))
        if value is None or not band or exact is None or rest is None:
            continue
        if rest <= FINE * band:
            found.append(abs(value - exact) / band)
    return found


def main() -> None:
    """Solve what is missing, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("rows", type=Path)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    given.rows.mkdir(parents=True, exist_ok=True)
    solved = (row for row in read(given.table) if "values" in row)
    known = sorted(solved, key=lambda row: float(row["seconds"]))
    found: list[float] = []
    for before in known[: given.count]:
        target = given.rows / f"{before['scene']}.json"
        if not target.exists():
            try:
                result = finer(given.scenes / f"{before['scene']}.toml", given.program)
            except subprocess.CalledProcessError as error:
                print(f"{before['scene']}: {error.stderr}", file=sys.stderr)
                continue
            target.write_text(json.dumps(result), encoding="utf-8")
        found += ratios(before, json.loads(target.read_text(encoding="utf-8")))
    if not found:
        parser.error("no finer mesh decides a value")
    rms = float(np.sqrt(np.mean(np.square(found))))
    shown = ", ".join(f"{100 * q:g} %: {np.quantile(found, q):.2f}" for q in QUANTILES)
    print(f"{len(found)} values; difference over the band: rms {rms:.2f}, at the quantiles {shown}")


if __name__ == "__main__":
    main()
