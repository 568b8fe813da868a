"""Compares two result folders: ``same_summary ONE OTHER band|relative LIMIT [BANDS]``.

Every quantity has to agree within LIMIT times its band, which is in ONE or in the folder BANDS, or
within LIMIT times its value. Exit status 1 if one does not.
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
    return summary[name], summary.get("uncertainty", {}).get(name, 0.0)


def main(one: Path, other: Path, kind: str, limit: float, bands: Path) -> int:
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
        scale = bound if kind == "band" else abs(one_value)
        part = difference / scale if scale > 0.0 else float(difference > 0.0)
        worst = max(worst, part)
        print(f"{name:22} {one_value: .10g} {other_value: .10g}  difference {part:.2g} ({kind})")
    print(f"nodes {meshes[0]} and {meshes[1]}; largest difference {worst:.2g}, allowed {limit:g}")
    return 0 if worst <= limit else 1


if __name__ == "__main__":
    first, second, of, most, where = [*sys.argv[1:], sys.argv[1]][:5]
    sys.exit(main(Path(first), Path(second), of, float(most), Path(where)))
