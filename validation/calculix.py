"""CalculiX on random scenes of the validation base: an independent program's values.

    python validation/calculix.py SCENES validation/base.jsonl ROWS [--count 8]

draws dry scenes with two spheres, solves those that have no `ROWS/<scene>.json` yet (minutes each),
writes them into `calculix.jsonl` next to the table, and prints how many values agree, and how far
they differ.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import subprocess
import tempfile
import tomllib
from pathlib import Path
from statistics import median

from models import PROGRAM
from solve import each_on_a_core, write_whole
from table import Row, known, read, write

LONGEST = 1.5
"""End of the last contact over that of the first: a step of CalculiX is 1/150 of a contact."""


def is_taken(row: Row, scenes: Path) -> bool:
    """Whether CalculiX solves a scene of the table, within minutes."""
    if row["stratum"] != "dry" or "values" not in row:
        return False
    scene = tomllib.loads((scenes / f"{row['scene']}.toml").read_text(encoding="utf-8"))
    spheres = all(scene[body]["kind"] == "sphere" for body in ("outer", "inner"))
    ends = [row["values"].get(f"{body}_contact_end", [None])[0] for body in ("outer", "inner")]
    if not spheres or "damping_ratio" in scene["plate"] or None in ends:
        return False
    return bool(max(ends) <= LONGEST * min(ends))


def solve(path: Path, program: Path) -> Row:
    """Values of a scene by CalculiX, with the half widths of their uncertainties (95 %)."""
    options = ("--solver", "calculix", "--resolution", "coarse", "--json")
    with tempfile.TemporaryDirectory() as store:
        command: list[str | Path] = [program, "--store", store, "reference", path, *options]
        ran = subprocess.run(command, capture_output=True, text=True, check=True)
    found = json.loads(ran.stdout)
    return {
        name: known(found[name], error)
        for name, error in found["uncertainty"].items()
        if error is not None and found.get(name) is not None
    }


def agreeing(ours: Row, theirs: Row) -> dict[str, bool]:
    """Of each quantity of both programs whether it agrees within their combined uncertainty."""
    both = [name for name in theirs if ours.get(name, [None])[0] is not None]
    return {
        name: abs(ours[name][0] - theirs[name][0]) <= math.hypot(ours[name][1], theirs[name][1])
        for name in both
    }


def main() -> None:
    """Solve what is missing, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("rows", type=Path)
    parser.add_argument("--count", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    given.rows.mkdir(parents=True, exist_ok=True)
    taken = {row["scene"]: row for row in read(given.table) if is_taken(row, given.scenes)}
    chosen = random.Random(given.seed).sample(sorted(taken), min(given.count, len(taken)))
    solved = {name: given.rows / f"{name}.json" for name in chosen}

    def work(path: Path) -> bool:
        write_whole(solved[path.stem], solve(path, given.program))
        return True

    each_on_a_core([given.scenes / f"{n}.toml" for n in chosen if not solved[n].exists()], work)
    lines = [
        {"scene": name, "values": json.loads(solved[name].read_text(encoding="utf-8"))}
        for name in chosen
    ]
    write(given.table.with_name("calculix.jsonl"), lines)
    differences: dict[str, list[float]] = {}
    for line in lines:
        ours, theirs = taken[line["scene"]]["values"], line["values"]
        agree = agreeing(ours, theirs)
        other = ", ".join(name for name, same in agree.items() if not same)
        print(f"{line['scene']}: {sum(agree.values())} of {len(agree)} agree; {other or 'all'}")
        for name in agree:
            differences.setdefault(name, []).append(abs(ours[name][0] / theirs[name][0] - 1.0))
    for name, of in sorted(differences.items()):
        print(f"{name}: median difference {100 * median(of):.2g} %, largest {100 * max(of):.2g} %")


if __name__ == "__main__":
    main()
