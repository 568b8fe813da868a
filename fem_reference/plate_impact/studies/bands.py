"""Truth of the bands: errors of middling meshes against a much finer one, and their bands.

Every scene is solved once on eight meshes, whose values and curves are kept: each series of five of
them is tried, and any other rule can be tried on them without solving again.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...common.errors import RunError, SolverError
from ...common.output import write_json
from ...common.progress import Progress
from ...common.settings import Options, Settings
from ...common.uncertainty import ORDER
from ...impact.history import Sampling, curve_bands, curve_uncertainty, history
from ...impact.series import MESHES, MeshResult, estimates
from ..axisymmetric import compute
from ..result import CURVES, QUANTITIES, RATIO, quantities
from ..scene import Scene, read_scene
from .random_scenes import draw

FACTORS = [RATIO**k for k in range(2, MESHES + 4)]
"""Of the meshes that the series are made of, on the number of elements; the first is about
`coarse`'s."""
TRUTH = 2.0 * FACTORS[0]
"""Of the finest mesh."""
LONGEST = 20.0
"""Processor time of the finest mesh's loop, s; scenes that would take longer are omitted."""


@dataclass(frozen=True)
class Trial:
    """One quantity of one scene on one mesh."""

    scene: str
    factor: float
    """Of the mesh tried, on the number of elements."""
    quantity: str
    size: float
    """Magnitude of the quantity; of curves the peak."""
    error: float
    """Against the truth, that one's error of the order fitted added."""
    band: float


def solve(scene: Scene, folder: Path, progress: Progress) -> None:
    """Write ``<name>.json`` and ``<name>.npz`` with all values and raw curves of the meshes.

    Raises:
        RunError: the method refuses the scene, or it takes too long.
    """
    values: dict[str, dict[str, float]] = {}
    curves: dict[str, Any] = {}
    with TemporaryDirectory() as name:
        settings = Settings(Options().courant, Path(name), Options().checkpoint_interval, "")
        lead = compute(scene, FACTORS[0], settings, progress.report)
        if lead.run.processor_seconds * (TRUTH / lead.factor) ** 3 > LONGEST:
            raise SolverError(f"the finest mesh would take more than {LONGEST:g} s")
        for factor in [*FACTORS, TRUTH]:
            solution = compute(scene, factor, settings, progress.report, lead)
            key = f"{factor:.6f}"
            values[key] = quantities(scene, solution)
            curves[f"t{key}"], curves[f"r{key}"] = solution.run.times, solution.run.rows
    np.savez_compressed(folder / f"{scene.name}.npz", **curves)
    write_json(folder / f"{scene.name}.json", {"scene": scene.raw, "values": values})


def trials(folder: Path, name: str) -> list[Trial]:
    """All quantities and curves of a scene solved, on every series of meshes."""
    document = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    with np.load(folder / f"{name}.npz") as raw:
        runs = {
            key: MeshResult(float(key), values, raw[f"t{key}"], raw[f"r{key}"], {})
            for key, values in document["values"].items()
        }
    truth, *meshes = sorted(runs.values(), key=lambda mesh: -mesh.factor)
    found = []
    for k in range(len(meshes) - MESHES + 1):
        tried, coarser = meshes[k], meshes[k : k + MESHES]
        # The truth is off itself.
        seen = 1.0 - (tried.factor / truth.factor) ** ORDER
        sampling = Sampling.on(tried.times)
        table, exact, *others = (
            history(CURVES, run, sampling if run is tried else sampling.of_others())
            for run in (tried, truth, *coarser[1:])
        )
        peaks = np.abs(exact).max(axis=0)
        band = curve_bands([table, *others], [mesh.factor for mesh in coarser])
        errors = curve_uncertainty(CURVES, np.abs(table - exact)[:, 1:] / seen)
        sizes = curve_uncertainty(CURVES, np.tile(peaks[1:], (2, 1)))
        bands = curve_uncertainty(CURVES, band)
        for quantity, estimate in estimates(coarser).items():
            errors[quantity] = abs(tried.values[quantity] - truth.values[quantity]) / seen
            sizes[quantity] = abs(truth.values[quantity])
            bands[quantity] = estimate.band
        # A contact that never closes has none of them.
        found += [
            Trial(name, tried.factor, quantity, sizes[quantity], errors[quantity], bands[quantity])
            for quantity in errors
            if sizes[quantity] > 0.0
        ]
    return found


def _row(title: str, tried: list[Trial]) -> str:
    error, band, size = np.array([(t.error, t.band, t.size) for t in tried]).T
    share = error / np.maximum(band, np.finfo(float).tiny)
    return (
        f"| {title} | {len(tried)} | {100.0 * np.mean(share <= 1.0):.1f} | {np.median(share):.2f} "
        f"| {np.quantile(share, 0.99):.2f} | {100.0 * np.median(band / size):.3f} "
        f"| {100.0 * np.mean(band / size):.3f} |"
    )


def table(tried: list[Trial]) -> str:
    """Markdown: what the bands of these trials come to, per quantity and together."""
    groups = {name: [t for t in tried if t.quantity == name] for name in QUANTITIES}
    groups["all quantities"] = [t for t in tried if t.quantity in QUANTITIES]
    for ending in ("rms", "max"):
        groups[f"curves, {ending}"] = [t for t in tried if t.quantity.endswith(ending)]
    lines = [
        "| | trials | within, % | error / band, median | 99 % | band, median, % | mean, % |",
        "|---|---|---|---|---|---|---|",
        *(_row(title, group) for title, group in groups.items() if group),
    ]
    return "\n".join(lines) + "\n"


def _scenes(paths: list[Path], random: int, folder: Path, progress: Progress) -> Iterator[Scene]:
    """Those of ``paths`` and ``random`` ones, solved; without those that cannot be."""

    def solved(scene: Scene) -> bool:
        try:
            if not (folder / f"{scene.name}.json").exists():
                solve(scene, folder, progress)
        except RunError as error:
            progress.report("refused", 0.0, f"{scene.name}: {error}")
            return False
        return True

    yield from filter(solved, map(read_scene, paths))
    yield from islice(filter(solved, map(draw, count(1))), random)


def report(paths: list[Path], random: int, folder: Path, progress: Progress) -> None:
    """Solve what is not in ``folder`` yet, and write ``bands.md`` there.

    The rule was calibrated on random scenes of odd seed; those of even seed are the evidence.
    """
    folder.mkdir(parents=True, exist_ok=True)
    halves: tuple[list[Trial], list[Trial]] = ([], [])
    for scene in _scenes(paths, random, folder, progress):
        # The hash of a random scene is its seed.
        halves[int(scene.scene_hash, 16) % 2].extend(trials(folder, scene.name))
    titles = ("Even hashes", "Odd hashes (of random scenes calibrated on)")
    parts = [f"{t}\n\n{table(half)}" for t, half in zip(titles, halves, strict=True) if half]
    (folder / "bands.md").write_text("\n".join(parts), encoding="utf-8")
