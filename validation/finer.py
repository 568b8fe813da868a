"""References of the validation base on finer meshes: `--resolution paper`, 1.5 times the elements.

    python validation/finer.py SCENES validation/base.jsonl ROWS [--only dry] [--count 24]

solves scenes of a group that are drawn at random, as far as `ROWS/<scene>.json` is not there yet,
writes them into `finer.jsonl` next to the table, and prints quantiles of the differences over the
bands of the table, of scenes that were not solved again before. The program judges its prediction
intervals by them.

    python validation/finer.py SCENES validation/base.jsonl ROWS --doubtful

solves those again in which model C and the reference differ by more than `DOUBTFUL` bands, and
writes the values of the finer meshes into the table. Most are errors of the reference, which five
meshes that agree by chance do not show.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from models import PROGRAM
from solve import each_on_a_core, limits, write_whole
from table import Row, known, read, write

QUANTILES = (0.5, 0.9, 0.95, 1.0)
DOUBTFUL = 0.6
"""Difference of model C and the reference over its band: more than two standard deviations."""
NOTABLE = 2e-3
"""Difference over the value below which no scene is solved again."""
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


def is_doubtful(row: Row) -> bool:
    """Whether a scene is to be solved on finer meshes."""
    decided = [of for of in row["values"].values() if of[1] and of[-1] is not None]
    differs = any(
        abs(of[-1] - of[0]) > max(DOUBTFUL * of[1], NOTABLE * abs(of[-1])) for of in decided
    )
    return differs and "resolution" not in row


def with_finer(row: Row, after: dict[str, list[float]]) -> Row:
    """A line of the table with the reference's values on finer meshes."""
    values = {
        name: known(*after[name]) + of[2:] if name in after else of
        for name, of in row["values"].items()
    }
    return row | {"values": values, "resolution": "paper"}


def solve_missing(names: list[str], scenes: Path, rows: Path, program: Path) -> dict[str, Row]:
    """Values on finer meshes of the scenes ``names``, of those that can be solved."""

    def work(path: Path) -> bool:
        try:
            write_whole(rows / f"{path.stem}.json", finer(path, program))
        except subprocess.CalledProcessError as error:
            print(f"{path.stem}: {error.stderr}", file=sys.stderr, flush=True)
            return error.returncode > 0  # below: a signal
        return True

    rows.mkdir(parents=True, exist_ok=True)
    solved = {name: rows / f"{name}.json" for name in names}
    each_on_a_core([scenes / f"{n}.toml" for n, row in solved.items() if not row.exists()], work)
    return {
        name: json.loads(row.read_text(encoding="utf-8"))
        for name, row in solved.items()
        if row.exists()
    }


def line(row: Row, after: dict[str, list[float]]) -> Row:
    """A line of `finer.jsonl`."""
    values = {name: known(*of) for name, of in after.items()}
    return {"scene": row["scene"], "hash": row["hash"], "values": values}


def main() -> None:
    """Solve what is missing, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("rows", type=Path)
    parser.add_argument("--only", default="dry", help="group that scenes are drawn from")
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--doubtful", action="store_true", help="improve the table")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    table = {row["scene"]: row for row in read(given.table)}
    solved = {name: row for name, row in table.items() if "values" in row}
    if given.doubtful:
        chosen = [name for name, row in solved.items() if is_doubtful(row)]
    else:
        group = sorted(name for name, row in solved.items() if row["stratum"] == given.only)
        chosen = random.Random(given.seed).sample(group, min(given.count, len(group)))
    coarse = [name for name in chosen if "resolution" not in table[name]]
    after = solve_missing(coarse, given.scenes, given.rows, given.program)
    found = [ratio for name in after for ratio in ratios(table[name], after[name])]
    if given.doubtful:
        table |= {name: with_finer(table[name], after[name]) for name in after}
        write(given.table, table.values())
    else:
        # what was doubtful has the values of the finer meshes already
        doubtful = [table[name] for name in chosen if name not in coarse]
        after |= {row["scene"]: {n: of[:2] for n, of in row["values"].items()} for row in doubtful}
        missing = [name for name in chosen if name not in after]
        if missing:
            parser.error(f"not solved, so that the rest is no random sample: {', '.join(missing)}")
        write(given.table.with_name("finer.jsonl"), (line(table[n], after[n]) for n in chosen))
    if not found:
        parser.error("no finer mesh decides a value")
    rms = float(np.sqrt(np.mean(np.square(found))))
    shown = ", ".join(f"{100 * q:g} %: {np.quantile(found, q):.2f}" for q in QUANTILES)
    print(f"{len(found)} values; difference over the band: rms {rms:.2f}, at the quantiles {shown}")


if __name__ == "__main__":
    main()
