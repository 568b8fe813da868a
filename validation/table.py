"""Join the rows of the validation base into its table.

    python validation/table.py ROWS validation/base.jsonl

One scene a line, in the order of the names; those that were refused or not solved with the reason.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

LARGEST = 1_000_000
"""Bytes of the table, which comes with the program."""


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", type=Path)
    parser.add_argument("table", type=Path)
    given = parser.parse_args()
    rows = [json.loads(path.read_text()) for path in sorted(given.rows.glob("*.json"))]
    for row in rows:
        # the scene comes from its number
        row.pop("file", None)
    text = "".join(json.dumps(row, separators=(",", ":")) + "\n" for row in rows)
    if len(text) > LARGEST:
        parser.error(f"the table has {len(text)} bytes; it may have {LARGEST}")
    given.table.write_text(text, encoding="utf-8")
    unsolved = sum("refused" in row for row in rows)
    print(f"{len(rows)} scenes, {unsolved} of them refused or not solved: {given.table}")


if __name__ == "__main__":
    main()
