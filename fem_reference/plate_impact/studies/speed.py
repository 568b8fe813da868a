"""Speed of the three-dimensional loop on threads and processes, beside what the memory delivers."""

from __future__ import annotations

import json
import math
import pickle
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...common.fenicsx import world
from ...common.output import write_json
from ...common.processes import launched_by
from ...common.progress import Progress
from ...explicit import kernel
from ...explicit.levels import MOST_LEVELS
from ...explicit.loop import SerialLoop
from ...explicit.parallel import ParallelLoop
from ...explicit.spectrum import critical_time_step
from ...solid.model import Model
from ...solid.system import SolidSystem
from ..estimate import estimate_contact, shortest_wavelengths
from ..scene import Scene, read_scene
from ..solid_model import plate_model

SIZES = (20_000, 100_000, 400_000)
"""Degrees of freedom, about."""
WAYS = ((1, 1), (2, 1), (1, 2))
"""Threads and processes."""
SECONDS = 0.6
"""Of stepping, at least, per trial."""
TRIALS = 5
HEADING = """# Speed of the three-dimensional loop

Wall time per degree of freedom and step in one run on this machine, every element at every step
(1 level) or sub-cycled; what the loop reads and writes a second, and what as many cores read of as
much memory, measured in between. `python3 -m fem_reference speed` makes it again.

"""
NODE = 136
"""Bytes that a step reads and writes per node."""


@dataclass(frozen=True)
class Speed:
    """One way to step one mesh."""

    dofs: int
    threads: int
    processes: int
    levels: int
    nanoseconds_per_dof_and_step: float
    """Of wall time, the best of `TRIALS`."""
    bytes_per_second: float | None
    """That the loop reads and writes, where every element acts at every step."""
    read_bandwidth: float
    """Bytes per second that as many threads read of as much memory, measured in between."""
    others: tuple[int, ...]
    """Nodes of other processes that each one reads."""


def read_bandwidth(numbers: int, threads: int) -> float:
    """Bytes per second of the sum over an array, read by so many threads."""
    values = np.ones(max(1, numbers))
    library = kernel.load(3)
    repetitions = max(1, 40_000_000 // values.size)
    best = math.inf
    for _ in range(TRIALS + 1):
        started = time.perf_counter()
        for _ in range(repetitions):
            library.read_all(kernel.doubles(values), values.size, threads)
        best = min(best, time.perf_counter() - started)
    return 8.0 * values.size * repetitions / best


def model_of(scene: Scene, dofs: int) -> Model:
    """The scene's model with about so many degrees of freedom."""
    estimate = estimate_contact(scene)
    waves = shortest_wavelengths(scene, estimate.duration)
    factor = 1.0
    for _ in range(6):
        model = plate_model(scene, estimate, waves, factor).model
        found = 3 * int(model.first[-1])
        if abs(found - dofs) < 0.1 * dofs:
            break
        factor *= (dofs / found) ** 0.4
    return model


def measure(model: Model, threads: int, comm: Any, most_levels: tuple[int, ...]) -> list[Speed]:
    """In all processes of ``comm``, with each of these numbers of levels at most."""
    system = SolidSystem(model, comm)
    kind = SerialLoop if comm.size == 1 else ParallelLoop
    loop = kind(system, comm, threads)
    found, time_step = [], 0.9 * critical_time_step(loop)
    for most in most_levels:
        loop.set_step(time_step, 1, most)
        seconds = _step_seconds(loop, comm)
        dofs, size = 3 * system.mass.size, comm.allreduce(loop.divided.size)
        moved = size + NODE * system.mass.size
        comm.barrier()
        bandwidth = comm.allreduce(read_bandwidth(loop.divided.size // 8, threads))
        found.append(
            Speed(
                *(dofs, threads, comm.size, len(loop.levels), seconds / dofs * 1e9),
                moved / seconds if len(loop.levels) == 1 else None,
                bandwidth,
                tuple(comm.allgather(system.ghosts.size)),
            )
        )
    return found


def _step_seconds(loop: SerialLoop, comm: Any) -> float:
    """Wall time per step."""
    steps, best = loop.meeting, math.inf
    for trial in range(TRIALS + 1):
        comm.barrier()
        started = time.perf_counter()
        loop.advance(steps)
        took = comm.bcast(time.perf_counter() - started)
        if trial == 0:
            # the first trial finds how many steps last long enough
            steps *= max(1, math.ceil(SECONDS / took))
            continue
        best = min(best, took / steps)
    return best


def speed(scene: Scene, sizes: tuple[int, ...], out: Path, progress: Progress) -> list[Speed]:
    """Measure all `WAYS`, write ``out`` (JSON), and the table beside it (.md)."""
    found: list[Speed] = []
    with TemporaryDirectory() as folder:
        place = Path(folder) / "model"
        for number, dofs in enumerate(sizes):
            place.write_bytes(pickle.dumps(model_of(scene, dofs)))
            for way, (threads, processes) in enumerate(WAYS):
                progress.report(
                    "stepping",
                    (number + way / len(WAYS)) / len(sizes),
                    f"{dofs} dofs, {threads} threads, {processes} processes",
                )
                found += _in_processes(place, threads, processes)
    out.parent.mkdir(parents=True, exist_ok=True)
    write_json(out, {"schema_version": 1, "points": [asdict(point) for point in found]})
    out.with_suffix(".md").write_text(HEADING + table(found), encoding="utf-8")
    return found


def _in_processes(place: Path, threads: int, processes: int) -> list[Speed]:
    command = [sys.executable, "-m", __name__, str(place), str(threads)]
    launched, environment = launched_by(command, processes)
    subprocess.run(launched, check=True, env=environment)
    found = json.loads(place.with_suffix(".json").read_text(encoding="utf-8"))
    return [Speed(**point) for point in found]


def table(points: list[Speed]) -> str:
    """In Markdown."""
    lines = [
        "| dofs | levels | threads | processes | ns per dof and step | over one thread | "
        "loop, GB/s | read bandwidth, GB/s |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for p in points:
        one = next(q for q in points if (q.dofs, q.levels) == (p.dofs, p.levels))
        rate = "" if p.bytes_per_second is None else f"{p.bytes_per_second / 1e9:.1f}"
        gain = one.nanoseconds_per_dof_and_step / p.nanoseconds_per_dof_and_step
        lines.append(
            f"| {p.dofs} | {p.levels} | {p.threads} | {p.processes} | "
            f"{p.nanoseconds_per_dof_and_step:.2f} | {gain:.2f} | {rate} | "
            f"{p.read_bandwidth / 1e9:.1f} |"
        )
    return "\n".join(lines) + "\n"


def report_speed(path: Path, sizes: tuple[int, ...], out: Path) -> None:
    """`speed` of a scene file; the table goes to standard output."""
    print(table(speed(read_scene(path), sizes, out, Progress(sys.stderr))), end="")


if __name__ == "__main__":
    _place, _comm = Path(sys.argv[1]), world()
    _model: Model = pickle.loads(_place.read_bytes())
    _found = measure(_model, int(sys.argv[2]), _comm, (1, MOST_LEVELS))
    if _comm.rank == 0:
        _text = json.dumps([asdict(point) for point in _found])
        _place.with_suffix(".json").write_text(_text, encoding="utf-8")
