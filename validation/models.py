"""Results of the reduced models for the scenes of the validation base.

    python validation/models.py SCENES validation/base.jsonl [--program PATH]

writes those of the program as it is now into the table, in seconds; the references stay.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

from table import Row, read, with_models, write

PROGRAM = Path(__file__).resolve().parent.parent / "target" / "release" / "impactcheck"
OF_KIND = {"plate-impact": ("A", "B", "C"), "impact": ("C",), "seal-seat": ("C",)}
"""Models that a kind of scene has."""


def reason(stderr: str) -> str:
    """The sentence of an error, which may be broken into lines with bars before them."""
    sentence = stderr[stderr.rfind("\u00d7") + 1 :].split("help:")[0]
    return " ".join(sentence.replace("\u2502", " ").split()).rpartition("error: ")[2]


def results(path: Path, program: Path) -> Row:
    """Of each model as it is by default: its summary, or why it has none."""
    kind = tomllib.loads(path.read_text(encoding="utf-8"))["kind"]
    found: Row = {}
    for model in OF_KIND[kind]:
        command: list[str | Path] = [program, "reduced", path, "--model", model, "--json"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        done = ran.returncode == 0
        found[model] = json.loads(ran.stdout) if done else {"refused": reason(ran.stderr)}
    return found


def main() -> None:
    """Write the models' results into the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()

    def renewed(row: dict[str, Any]) -> dict[str, Any]:
        if "refused" in row:
            return row
        after = with_models(row, results(given.scenes / f"{row['scene']}.toml", given.program))
        for model in after.get("failed", {}).keys() - row.get("failed", {}).keys():
            why = after["failed"][model]
            print(f"{row['scene']}: model {model} fails now: {why}", file=sys.stderr)
        return after

    write(given.table, map(renewed, read(given.table)))


if __name__ == "__main__":
    main()
