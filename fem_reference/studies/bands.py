"""Truth of the bands: the error of a middling mesh against a much finer one, and its band."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..common.fenicsx import alone
from ..common.progress import Progress
from ..common.series import Series, estimates
from ..common.settings import Options, Settings
from ..plate_impact.history import curve_bands, history, resampled
from ..plate_impact.result import QUANTITIES, RATIO, problem, quantities
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
    with TemporaryDirectory() as name:
        folder, options = Path(name), Options()
        posed = problem(scene, "paper", alone(), options)
        middle, meshes = Series(posed, MIDDLE, alone(), options, folder, progress).solve()
        settings = Settings(options.courant, folder, options.checkpoint_interval, "finer")
        finer = posed.compute(FINE, settings, progress.report, None)
    found, bands = quantities(scene, finer), estimates(meshes)
    trials = [
        Trial(
            scene.name,
            name,
            meshes[0].values[name],
            bands[name].band,
            found[name],
            tuple(mesh.values[name] for mesh in meshes),
        )
        for name in QUANTITIES
    ]
    table, _ = history(middle.run)
    shared = table[:, 0] <= finer.run.times[-1]
    other = resampled(finer.run, table[shared, 0])
    band = curve_bands(meshes, [mesh.factor for mesh in meshes], middle.estimate.duration)
    inside = abs(table[shared, 1:] - other[:, 1:]) <= band[shared]
    seconds = {
        "middle": middle.run.loop_seconds,
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
