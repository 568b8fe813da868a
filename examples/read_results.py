"""Reads what impactcheck wrote: a comparison, its curves, and a sweep.

``python3 read_results.py REPORT_DIR [SWEEP.csv]``
"""

import csv
import json
import sys
from pathlib import Path


def main(report: Path, sweep: Path | None) -> None:
    """Print verdicts, largest forces and the best point of the sweep."""
    comparison = json.loads((report / "comparison.json").read_text())
    for scene in comparison["scenes"]:
        for model in scene["models"]:
            own, reference = model["summary"]["efficiency"], scene["reference"]["efficiency"]
            name = f"{scene['scene']}, model {model['model']}"
            print(f"{name}: {model['verdict']}, efficiency {own:.4f} (reference {reference:.4f})")
        with (report / f"{scene['scene']}.csv").open(newline="") as file:
            curves = list(csv.DictReader(file))
        names = [name for name in curves[0] if name.endswith("force")]
        peaks = {name: max(float(row[name]) for row in curves) for name in names}
        print("  largest samples of the forces, N:", peaks)
    if sweep:
        with sweep.open(newline="") as file:
            rows = list(csv.DictReader(file))
        best = max(rows, key=lambda row: float(row["efficiency"] or "nan"))
        print(f"best of {len(rows)} points of the sweep:", best)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: read_results.py REPORT_DIR [SWEEP.csv]")
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
