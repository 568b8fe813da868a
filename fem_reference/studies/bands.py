"""Truth of the bands: the error of a middling mesh against a much finer one, and its band."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..common.progress import Progress
from ..plate_impact.axisymmetric import compute
from ..plate_impact.convergence import QUANTITIES, RATIO, quantities, solve_sequence
from ..plate_impact.history import history, resampled
from ..plate_impact.scene import Scene, read_scene

FINE = 1.5
"""Factor on the elements of the finer mesh, as at `fine` resolution."""
MIDDLE = FINE * RATIO**4
"""Of the mesh whose band is tried: half as many elements in each direction."""


@dataclass(frozen=True)
class Trial:
    """One quantity of one scene."""

    scene: str
    quantity: str
    value: float
    band: float
    finer: float
    sequence: tuple[float, ...]
    """Values the band is made from, the tried one first."""

    @property
    def holds(self) -> bool:
        """Whether the finer mesh's value lies within the band."""
        return abs(self.value - self.finer) <= self.band


def try_bands(scene: Scene, progress: Progress) -> tuple[list[Trial], dict[str, Any]]:
    """Trials of all quantities, and of the curves the share of samples within the band."""
    sequence = solve_sequence(scene, MIDDLE, progress=progress)
    finer = compute(scene, FINE, progress=progress, label="finer mesh: ")
    found = quantities(scene, finer.run, finer.system)
    trials = [
        Trial(
            scene.name,
            name,
            float(sequence.values[name][0]),
            sequence.estimates[name].band,
            found[name],
            tuple(float(v) for v in sequence.values[name]),
        )
        for name in QUANTITIES
    ]
    table, _ = history(sequence.finest.run)
    shared = table[:, 0] <= finer.run.times[-1]
    other = resampled(finer.run, table[shared, 0])
    inside = abs(table[shared, 1:] - other[:, 1:]) <= sequence.curve_bands()[shared]
    seconds = {
        "middle": sequence.finest.run.loop_seconds,
        "finer": finer.run.loop_seconds,
        "curves_within": float(inside.mean()),
    }
    return trials, seconds


def report(paths: list[Path], out: Path, progress: Progress) -> bool:
    """Try the bands of all scenes; write ``out`` (JSON) and a Markdown table beside it.

    Returns:
        Whether in every quantity at least nine of ten scenes keep their band.
    """
    rows: list[dict[str, Any]] = []
    lines = [
        "| scene | quantity | value | band | finer mesh | error / band |",
        "|---|---|---|---|---|---|",
    ]
    kept: dict[str, list[bool]] = {name: [] for name in QUANTITIES}
    for path in paths:
        scene = read_scene(path)
        trials, more = try_bands(scene, progress)
        for trial in trials:
            kept[trial.quantity].append(trial.holds)
            error = abs(trial.value - trial.finer)
            share = error / trial.band if trial.band > 0.0 else (0.0 if error == 0.0 else 99.0)
            lines.append(
                f"| {trial.scene} | {trial.quantity} | {trial.value:.6g} | {trial.band:.2g} "
                f"| {trial.finer:.6g} | {share:.2f}{'' if trial.holds else ' **out**'} |"
            )
            rows.append({**trial.__dict__, "holds": trial.holds})
        rows.append({"scene": scene.name, **more})
        lines.append(
            f"| {scene.name} | curves, share of samples | | | | {more['curves_within']:.4f} |"
        )
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(json.dumps({"schema_version": 1, "rows": rows}, indent=2) + "\n")
        out.with_suffix(".md").write_text("\n".join(lines) + "\n")
    lines.append("")
    for name, held in kept.items():
        lines.append(f"{name}: {sum(held)} of {len(held)} within the band\n")
    out.with_suffix(".md").write_text("\n".join(lines) + "\n")
    return all(sum(held) >= 0.9 * len(held) for held in kept.values())
