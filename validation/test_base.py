"""The tables of the validation base fit each other."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from calculix import agreeing
from table import read

FOLDER = Path(__file__).resolve().parent


def test_calculix_agrees_on_random_scenes() -> None:
    """At least 95 % of the values within the combined uncertainty of both programs."""
    base = {row["scene"]: row["values"] for row in read(FOLDER / "base.jsonl") if "values" in row}
    lines = read(FOLDER / "calculix.jsonl")
    agree = [of for line in lines for of in agreeing(base[line["scene"]], line["values"]).values()]
    assert len(lines) >= 8
    assert len(agree) >= 60
    assert sum(agree) >= 0.95 * len(agree)
