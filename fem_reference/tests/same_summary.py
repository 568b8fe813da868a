"""Compares two result folders: ``same_summary ONE OTHER SHARE [BANDS]``; exit status 1 if unlike.

Every quantity has to agree within SHARE of its band, which stands in ONE or in the folder BANDS.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path


def main(one: Path, other: Path, share: float, bands: Path) -> int:
    """Print the differences; 0 if all are small enough."""
    a, b, c = (
        json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        for folder in (one, other, bands)
    )
    meshes = a["mesh"]["nodes"], b["mesh"]["nodes"]
    worst = 0.0
    # The bands of curves have names of their own.
    for name, bound in ((n, b) for n, b in c["uncertainty"].items() if n in a):
        part = abs(a[name] - b[name]) / bound if bound > 0.0 else float(a[name] != b[name])
        worst = max(worst, part)
        print(f"{name:22} {a[name]: .10g} {b[name]: .10g}  difference {part:.2g} of the band")
    print(f"nodes {meshes[0]} and {meshes[1]}; largest difference {worst:.2g}, allowed {share:g}")
    return 0 if worst <= share else 1


if __name__ == "__main__":
    first, second = Path(sys.argv[1]), Path(sys.argv[2])
    sys.exit(main(first, second, float(sys.argv[3]), Path([*sys.argv, sys.argv[1]][4])))
