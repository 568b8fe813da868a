"""Solve scenes of the validation base: reference, its band, and the reduced models.

    python validation/solve.py SCENES ROWS [--known TABLE] [--shard 1/4] [--longest SECONDS]

writes `ROWS/<scene>.json` for every scene file in the folder SCENES that has none yet and is not in
TABLE; so a run that was stopped goes on, and shards on several machines share the work. Each core
solves a scene of its own: threads do not pay for meshes as small as these. A scene that is refused
or not solved gets a row with the reason; one that takes longer than SECONDS gets none, and waits
for a run that allows more.
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

import numpy as np
from models import PROGRAM, reason, results
from table import HASH, Row, known, read, with_models

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from fem_reference.common.uncertainty import bands

ORDER = 2.0
"""Of the limits in the table, that of bilinear elements. A reference's own limit takes 1.5, which
keeps its bands safe; there, on the meshes of `coarse`, force peaks lie .3 to .5 % below those of
finer meshes, with 2 less than .1 % (`finer.py`)."""
LAST = 10.0
"""Seconds that a program has to end what it has started."""
CONTACTS = ("outer_contacts", "inner_contacts")
"""Numbers of contacts, which seal seats do not count."""


def limits(convergence: Row) -> dict[str, list[float]]:
    """Of each quantity the value in the limit of fine meshes, and the half width of its band."""
    sizes = 1.0 / np.array([mesh["factor"] for mesh in convergence["meshes"]])
    found = {}
    for name, of in convergence["quantities"].items():
        limit, _, band = bands(np.array(of["values"]), sizes, ORDER)
        found[name] = [float(limit), float(band)]
    return found


def of_reference(document: Row) -> Row:
    """What a line keeps of the comparison with a reference."""
    scene = document["scenes"][0]
    reference = scene["reference"]
    found = limits(reference["convergence"])
    return {
        "hash": reference["scene_hash"][:HASH],
        "dofs": reference["mesh"]["dofs"],
        "unsound": [check["check"] for check in scene["integrity"] if check["verdict"] == "fail"],
        "contacts": [reference[name] for name in CONTACTS if name in reference],
        "values": {name: known(*of) for name, of in found.items()},
    }


def _run(command: Sequence[str | Path], longest: float | None) -> subprocess.CompletedProcess[str]:
    """Run the program; after ``longest`` seconds it ends what it has started, and itself."""
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as started:
        try:
            output, errors = started.communicate(timeout=longest)
        except subprocess.TimeoutExpired:
            started.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                started.wait(LAST)
            started.kill()
            raise
    return subprocess.CompletedProcess(command, started.returncode, output, errors)


def solve(
    path: Path, program: Path, longest: float | None = None, resolution: str = "coarse"
) -> Row:
    """The line of a scene with a fresh reference; or why there is none.

    Raises ``subprocess.TimeoutExpired`` after ``longest`` seconds, ``InterruptedError`` if a signal
    ends the run.
    """
    begun = time.monotonic()
    file = tomllib.loads(path.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        options = ("--compute", "--json", "--resolution", resolution)
        command: list[str | Path] = [program, "--store", f"{folder}/store", "compare", path]
        command += [*options, "--out", f"{folder}/page"]
        ran = _run(command, longest)
    if ran.returncode < 0:
        raise InterruptedError(f"ended by signal {-ran.returncode}")
    found: Row = {
        "scene": path.stem,
        "stratum": path.stem.rsplit("-", 1)[0],
        "content": content(path),
        "seconds": round(time.monotonic() - begun, 1),
    }
    if not ran.stdout.strip():
        return found | {"refused": reason(ran.stderr), "status": ran.returncode}
    found |= of_reference(json.loads(ran.stdout))
    found["speed"] = file["actuator" if "actuator" in file else "outer"]["speed"]
    return with_models(found, results(path, program))


def _shard(text: str) -> tuple[int, int]:
    number, count = (int(part) for part in text.split("/"))
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"shard {text}: the number must be 1 to {count}")
    return number, count


def content(path: Path) -> str:
    """Short hash of a scene file: a scene that is drawn otherwise is solved again."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12]


def _row(rows: Path, path: Path) -> Path:
    return rows / f"{path.stem}.json"


def usable_cores() -> Sequence[int | None]:
    """The processor cores of this process; without names where the system gives none."""
    if hasattr(os, "sched_getaffinity"):
        return sorted(os.sched_getaffinity(0))
    return [None] * (os.cpu_count() or 1)


def each_on_a_core(paths: Iterable[Path], work: Callable[[Path], bool]) -> None:
    """Do ``work`` on every path, one at a time on each core.

    A core stops where ``work`` gives ``False``. Exits on Ctrl-C.
    """
    missing: SimpleQueue[Path] = SimpleQueue()
    for path in paths:
        missing.put(path)

    def on(core: int | None) -> None:
        if core is not None:
            os.sched_setaffinity(0, {core})  # of this thread and of what it starts
        with contextlib.suppress(Empty):
            while work(missing.get_nowait()):
                pass

    workers = [Thread(target=on, args=(core,), daemon=True) for core in usable_cores()]
    for worker in workers:
        worker.start()
    try:
        for worker in workers:
            worker.join()
    except KeyboardInterrupt:
        sys.exit("stopped; the next run goes on with what is missing")


def write_whole(target: Path, row: object) -> None:
    """Write a row at once: a run that is killed leaves none or all of it."""
    partial = target.with_suffix(".partial")
    partial.write_text(json.dumps(row), encoding="utf-8")
    shutil.move(partial, target)


def main() -> None:
    """Solve what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path)
    parser.add_argument("rows", type=Path)
    parser.add_argument("--shard", type=_shard, default=(1, 1), help="such as 2/4: the second of 4")
    parser.add_argument("--known", type=Path, help="table of scenes that are not solved again")
    parser.add_argument("--longest", type=float, help="seconds for a scene; others wait")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    given = parser.parse_args()
    number, count = given.shard
    known = {row["scene"]: row["content"] for row in read(given.known)} if given.known else {}
    given.rows.mkdir(parents=True, exist_ok=True)
    # from every stratum early
    paths = sorted(given.scenes.glob("*.toml"), key=lambda path: (path.stem[-3:], path.stem))
    missing = [
        path
        for path in paths[number - 1 :: count]
        if known.get(path.stem) != content(path) and not _row(given.rows, path).exists()
    ]

    def work(path: Path) -> bool:
        try:
            found = solve(path, given.program, given.longest)
        except subprocess.TimeoutExpired:
            print(f"{path.stem}: over {given.longest:g} s, waits", file=sys.stderr, flush=True)
            return True
        except InterruptedError as error:
            print(f"{path.stem}: {error}", file=sys.stderr, flush=True)
            return False
        write_whole(_row(given.rows, path), found)
        outcome = found.get("refused", f"{found.get('dofs')} unknowns")
        print(f"{path.stem}: {found['seconds']} s, {outcome}", file=sys.stderr, flush=True)
        return True

    each_on_a_core(missing, work)


if __name__ == "__main__":
    main()
