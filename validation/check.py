"""Solve a random tenth of the validation base again; fail where a value has moved.

python validation/check.py SCENES validation/base.jsonl [--seed N] [--program PATH]
"""

from __future__ import annotations

import argparse
import random
import sys
from pathlib import Path

from models import PROGRAM
from solve import solve
from table import MODELS, Row, read

SHARE = 0.1
"""Of the scenes that are solved again."""
MOVED = 0.05
"""Change of a reference's value over its 95 % band, and of a model's, that is none."""

NONE = (None,) * (2 + len(MODELS))
"""Values of a quantity that is not there."""


def moved(before: Row, after: Row) -> list[str]:
    """A sentence for each value that is another now."""
    if "refused" in before or "refused" in after:
        reasons = [row.get("refused", "solved") for row in (before, after)]
        return [f"{before['scene']}: {' -> '.join(reasons)}"] if reasons[0] != reasons[1] else []
    sides = ("reference", "band", *MODELS)
    return [
        f"{before['scene']}, {side}: {name} {was:.6g} -> {now}"
        for name, values in before["values"].items()
        for side, was, now in zip(sides, values, after["values"].get(name, NONE), strict=True)
        if side != "band" and was is not None and not _is_same(was, now, values[1])
    ]


def _is_same(value: float, now: float | None, band: float | None) -> bool:
    return now is not None and abs(now - value) <= MOVED * (band or 1e-3 * abs(value))


def main() -> int:
    """Exit status 1: values have moved."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    rows = read(given.table)
    count = max(1, round(SHARE * len(rows)))
    sentences: list[str] = []
    for before in random.Random(given.seed).sample(rows, count):
        path = given.scenes / f"{before['scene']}.toml"
        sentences += moved(
            before, solve(path, given.program, resolution=before.get("resolution", "coarse"))
        )
    print("\n".join(sentences) or f"{count} of {len(rows)} scenes are as they were")
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(main())
