"""Cost against error over meshes, with and without sub-cycling, and the limit of the machine."""

from __future__ import annotations

import json
import math
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...axisymmetric.system import AxisymmetricSystem
from ...common.fenicsx import alone
from ...common.output import write_json
from ...common.progress import Progress
from ...common.settings import Settings
from ...explicit import kernel
from ...explicit.loop import SerialLoop
from ..axisymmetric import compute
from ..axisymmetric_motion import integrate_axisymmetric
from ..estimate import estimate_contact
from ..meshing import build_system, mesh_impact, mesh_settings
from ..result import RATIO, TARGETED, of_run, quantities
from ..scene import Scene, read_scene

EXACT = 3.0
"""Elements, in every direction, of the mesh that counts as exact over those of `paper`."""
FINEST = 1.05
"""The same of the finest mesh that is measured."""
MESHES = 7
MOST_LEVELS = {"on": 5, "off": 1}
CACHE_NUMBERS = 20_000
MEMORY_NUMBERS = 8_000_000
"""Numbers in each of the triad's three arrays: half a megabyte, and far more than any cache."""


BLOCK = 36
"""Bytes of a block: four numbers and a column."""


@dataclass(frozen=True)
class Point:
    """One mesh with or without sub-cycling."""

    factor: float
    sub_cycling: str
    dofs: int
    steps: int
    seconds: float
    """Processor time of the loop."""
    nanoseconds_per_dof_and_step: float
    row_updates_per_node_and_step: float
    """Share of the nodes whose forces are computed at a step, on average."""
    relative_errors: dict[str, float]
    """Of efficiency and force peaks, against the exact mesh; with sign."""
    relative_error: float
    """Largest magnitude of them."""


def triad_bandwidth(numbers: int) -> float:
    """Bytes per second of a = b + s c, three arrays of ``numbers``; the best of five trials."""
    library = kernel.load(2)
    arrays = [np.ones(numbers) for _ in range(3)]
    pointers = [kernel.doubles(array) for array in arrays]
    repetitions = max(1, 20_000_000 // numbers)
    library.triad(*pointers, numbers, 1)
    best = math.inf
    for _ in range(5):
        started = time.process_time()
        library.triad(*pointers, numbers, repetitions)
        best = min(best, time.process_time() - started)
    return 24.0 * numbers * repetitions / best


def product_rates(system: AxisymmetricSystem) -> dict[str, float]:
    """Bytes and operations per second of the loop's own product on a system, and its size."""
    loop = SerialLoop(system, alone())
    x = np.random.default_rng(1).standard_normal(loop.u.size)
    nodes = system.mass.size
    # A node: its displacement, and its force read and written.
    size = loop.divided.size + nodes * (3 * 16 + 8)
    blocks = loop.divided.size // BLOCK
    # 4 products and 4 sums a block, and the same for its mirror image.
    operations = 16 * blocks - 8 * nodes
    repetitions = max(10, 200_000_000 // size)
    best = math.inf
    for _ in range(3):
        started = time.process_time()
        for _ in range(repetitions):
            loop.product(x)
        best = min(best, (time.process_time() - started) / repetitions)
    return {
        "bytes": float(size),
        "bytes_per_second": size / best,
        "operations_per_second": operations / best,
    }


def limits(system: AxisymmetricSystem) -> dict[str, Any]:
    """What the loop's product reaches of what the machine's cache and memory deliver."""
    cache, memory = triad_bandwidth(CACHE_NUMBERS), triad_bandwidth(MEMORY_NUMBERS)
    product = product_rates(system)
    return {
        "triad_cache_bytes_per_second": cache,
        "triad_memory_bytes_per_second": memory,
        "product": product,
        "share_of_cache_bandwidth": product["bytes_per_second"] / cache,
        "share_of_memory_bandwidth": product["bytes_per_second"] / memory,
    }


def _point(scene: Scene, factor: float, sub_cycling: str, exact: dict[str, float]) -> Point:
    estimate = estimate_contact(scene)
    settings = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, factor)
    system = build_system(scene, mesh_impact(scene, settings))
    run, motion = integrate_axisymmetric(
        system,
        scene,
        estimate.duration,
        end_time=scene.end_time,
        most_levels=MOST_LEVELS[sub_cycling],
    )
    nodes = system.mass.size
    updates = sum(count / 2**level for level, count in enumerate(motion.loop.divided.acting))
    found = of_run(scene, run)
    scales = {target.name: target.scale(exact) for target in TARGETED}
    errors = {n: (found[n] - exact[n]) / scale for n, scale in scales.items() if scale > 0.0}
    seconds = run.processor_seconds
    per_step = seconds / run.steps / (2 * nodes) * 1e9
    return Point(
        factor,
        sub_cycling,
        2 * nodes,
        run.steps,
        seconds,
        per_step,
        updates / nodes,
        errors,
        max(abs(error) for error in errors.values()),
    )


def cost(scene: Scene, out: Path, progress: Progress) -> dict[str, Any]:
    """Solve on `MESHES` meshes, measure, write ``out`` (JSON)."""
    with TemporaryDirectory() as folder:
        settings = Settings(0.9, Path(folder), 0.0, "exact")

        def exactly(phase: str, done: float, message: str) -> None:
            progress.report(phase, done, f"exact mesh: {message}")

        solution = compute(scene, EXACT, settings, exactly)
    exact = quantities(scene, solution)
    points = []
    for number in range(MESHES):
        factor = FINEST * RATIO**number
        for sub_cycling in MOST_LEVELS:
            points.append(_point(scene, factor, sub_cycling, exact))
            message = f"{points[-1].dofs} dofs, sub-cycling {sub_cycling}"
            progress.report("stepping", len(points) / (2 * MESHES), message)
    estimate = estimate_contact(scene)
    sizes = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, FINEST * RATIO**2)
    document = {
        "schema_version": 1,
        "scene": scene.name,
        "exact": {"factor": EXACT, "seconds": solution.run.processor_seconds, **exact},
        "points": [asdict(point) for point in points],
        "limits": limits(build_system(scene, mesh_impact(scene, sizes))),
    }
    out.parent.mkdir(parents=True, exist_ok=True)
    write_json(out, document)
    return document


def report_cost(path: Path, out: Path) -> None:
    """`cost` of a scene file; what the machine delivers goes to standard output as JSON."""
    document = cost(read_scene(path), out, Progress(sys.stderr))
    print(json.dumps(document["limits"], indent=2))
