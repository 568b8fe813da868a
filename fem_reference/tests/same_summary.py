"""Compares two result folders: ``same_summary ONE OTHER SHARE [BANDS]``; exit status 1 if unlike.

Every quantity has to agree within SHARE of its band, which stands in ONE or in the folder BANDS.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any


def found(summary: dict[str, Any], name: str) -> tuple[float, float]:
    """Value and band of a quantity; of a run cut during a contact those at its end."""
    at_end = summary.get("at_end", {}).get(name)
    if at_end is not None:
        return at_end["value"], at_end["band"]
    return summary[name], summary["uncertainty"].get(name, 0.0)


def main(one: Path, other: Path, share: float, bands: Path) -> int:
    """Print the differences; 0 if all are small enough."""
    a, b, c = (
        json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        for folder in (one, other, bands)
    )
    meshes = a["mesh"]["nodes"], b["mesh"]["nodes"]
    worst = 0.0
    # The bands of curves have names of their own.
    for name in (name for name in {**c["uncertainty"], **c.get("at_end", {})} if name in a):
        (one_value, _), (other_value, _), (_, bound) = (found(each, name) for each in (a, b, c))
        difference = abs(one_value - other_value)
        part = difference / bound if bound > 0.0 else float(difference > 0.0)
        worst = max(worst, part)
        print(f"{name:22} {one_value: .10g} {other_value: .10g}  difference {part:.2g} of the band")
    print(f"nodes {meshes[0]} and {meshes[1]}; largest difference {worst:.2g}, allowed {share:g}")
    return 0 if worst <= share else 1


if __name__ == "__main__":
    first, second = Path(sys.argv[1]), Path(sys.argv[2])
    sys.exit(main(first, second, float(sys.argv[3]), Path([*sys.argv, sys.argv[1]][4])))
