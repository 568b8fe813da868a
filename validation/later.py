"""Scenes drawn after the validation base: each is predicted first and solved then.

    python validation/later.py FOLDER validation/later.jsonl

draws the next scenes of the groups into FOLDER and writes a line for each that has a prediction:
the 95 % intervals. The next run solves those that have no reference yet and adds its values with
the half widths of their bands. So what is predicted stands before what is found.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path

import draw
from models import PROGRAM, results
from points import STRATA
from solve import each_on_a_core, solve, write_whole
from table import Row, known, read, short, write

COUNTS = {
    "dry": 3,
    "film": 1,
    "friction": 1,
    "relaxing": 1,
    "yielding": 1,
    "body": 1,
    "seat": 1,
    "oblique": 1,
}
"""Scenes of each group."""
TRIED = 8
"""Scenes of a group that are drawn for it at most; some lie beyond the base."""


def predicted(group: str, folder: Path, program: Path) -> Iterator[Row]:
    """The next scenes of a group that have a prediction."""
    draw.write(group, STRATA[group] + TRIED, folder)
    for k in range(STRATA[group], STRATA[group] + TRIED):
        name = f"{group}-{k:03}"
        intervals = results(folder / f"{name}.toml", program)["C"].get("prediction")
        if intervals:
            bounds = {of: [short(at["low"]), short(at["high"])] for of, at in intervals.items()}
            yield {"scene": name, "prediction": bounds}


def within(line: Row) -> dict[str, bool]:
    """Of each predicted quantity whether the reference has it within interval and its own error."""
    found = {}
    for name, (low, high) in line["prediction"].items():
        if name in line["values"]:
            limit, band = line["values"][name]
            found[name] = abs(limit - 0.5 * (low + high)) <= math.hypot(0.5 * (high - low), band)
    return found


def main() -> None:
    """Predict, or solve what is predicted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    lines = read(given.table)
    before = len(lines)
    groups = {line["scene"].rsplit("-", 1)[0] for line in lines}
    for group in sorted(COUNTS.keys() - groups):
        next_ones = predicted(group, given.folder, given.program)
        lines += itertools.islice(next_ones, COUNTS[group])
    write(given.table, lines)
    if len(lines) > before:
        print(f"{len(lines)} scenes are predicted; run again to solve them", file=sys.stderr)
        return
    missing = [line for line in lines if not line.keys() & {"values", "refused"}]

    def work(path: Path) -> bool:
        write_whole(path.with_suffix(".json"), solve(path, given.program))
        return True

    paths = [given.folder / f"{line['scene']}.toml" for line in missing]
    each_on_a_core([path for path in paths if not path.with_suffix(".json").exists()], work)
    for line in lines:
        solved = given.folder / f"{line['scene']}.json"
        if line in missing and solved.exists():
            row = json.loads(solved.read_text(encoding="utf-8"))
            if "refused" in row:
                line["refused"] = row["refused"]
            else:
                line["values"] = {name: known(*of[:2]) for name, of in row["values"].items()}
        if "values" in line:
            held = within(line)
            missed = ", ".join(name for name, holds in held.items() if not holds)
            print(f"{line['scene']}: {sum(held.values())} of {len(held)} within; {missed or 'all'}")
    write(given.table, lines)


if __name__ == "__main__":
    main()
