"""The result folder: complete or not there at all."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import Floats
from .errors import SolverError

CHECKSUMS = "checksums.sha256"
PROVENANCE = "provenance.json"
PARTIAL_PREFIX = ".partial-"
LEAST_SPACE = 100e6
"""Bytes that must be free before a run begins: a result without fields over time takes 1 to 30 MB,
its kept states up to twice that."""
SAMPLES = 2000
"""About how many samples a history has."""


def require_replaceable(target: Path, document: Any, replace: bool) -> None:
    """Refuse to put the result of ``document`` (a decoded scene.json) where something else lies.

    A result of the same scene with the same settings is computed again without asking; another
    result only if ``replace``; what is no result, never.

    Raises:
        SolverError: naming what is there.
    """
    if not target.exists() or (target.is_dir() and not any(target.iterdir())):
        return
    if not (target / PROVENANCE).is_file():
        raise SolverError(
            f"the output {target} exists and is no result folder (it has no {PROVENANCE}); "
            "choose another --out"
        )
    if replace:
        return
    try:
        there = json.loads((target / PROVENANCE).read_text(encoding="utf-8"))
        name = there["scene"]["name"]
        same = all(there[key] == document.get(key) for key in ("scene_hash", "settings_hash"))
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise SolverError(
            f"the output folder {target} holds a {PROVENANCE} that cannot be read ({error}); "
            "choose another --out, or give --replace"
        ) from error
    if not same:
        raise SolverError(
            f"the output folder {target} holds a solution of another scene or with other settings "
            f"(scene {name!r}, scene_hash {there['scene_hash'][:12]}); choose another --out, or "
            "give --replace"
        )


@contextmanager
def exclusive(folder: Path, comm: Any, waiting: Callable[[], None]) -> Iterator[None]:
    """Hold ``folder`` for this run, made if need be; another run that asks for it waits.

    The lock goes with the process, however that ends. An empty folder is removed with it.

    Raises:
        SolverError: the folder cannot be made or locked.
    """
    lock = _locked(folder, waiting) if comm.rank == 0 else None
    comm.barrier()
    try:
        yield
    finally:
        if lock is not None:
            with suppress(OSError):
                folder.rmdir()
            os.close(lock)


def _locked(folder: Path, waiting: Callable[[], None]) -> int:
    """Descriptor of the folder, locked."""
    while True:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lock = os.open(folder, os.O_RDONLY)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                waiting()
                fcntl.flock(lock, fcntl.LOCK_EX)
            if os.path.samestat(os.fstat(lock), folder.stat()):
                return lock
            os.close(lock)
        except FileNotFoundError:
            continue  # whoever held it has removed it
        except OSError as error:
            raise SolverError(f"{folder} cannot be locked: {error}") from error


@contextmanager
def result_folder(target: Path) -> Iterator[Path]:
    """A temporary sibling of ``target`` that takes its place when the block succeeds.

    Whatever is at ``target`` already is replaced then. If the process dies, at most a folder
    ``.partial-*`` is left.

    Raises:
        SolverError: the folder cannot be made or written, or the disk is nearly full.
    """
    parent = target.absolute().parent
    try:
        parent.mkdir(parents=True, exist_ok=True)
        free = shutil.disk_usage(parent).free
        if free < LEAST_SPACE:
            raise SolverError(
                f"the disk of {parent} has {free / 1e6:.3g} MB left; a result and the states on "
                f"the way to it need {LEAST_SPACE / 1e6:.3g} MB, fields over time more"
            )
        partial = Path(tempfile.mkdtemp(prefix=f"{PARTIAL_PREFIX}{target.name}-", dir=parent))
        partial.chmod(0o755)
    except OSError as error:
        raise SolverError(f"the output folder {target} cannot be made: {error}") from error
    try:
        yield partial
        _write_checksums(partial)
        old = None
        if target.exists():
            old = Path(tempfile.mkdtemp(prefix=f"{PARTIAL_PREFIX}{target.name}-old-", dir=parent))
            target.replace(old / target.name)
        partial.replace(target)
        if old is not None:
            shutil.rmtree(old, ignore_errors=True)
    except OSError as error:
        raise SolverError(f"the output folder {target} cannot be written: {error}") from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _write_checksums(folder: Path) -> None:
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
        for path in sorted(folder.iterdir())
    ]
    with (folder / CHECKSUMS).open("w", encoding="ascii") as stream:
        stream.writelines(lines)
        stream.flush()
        os.fsync(stream.fileno())


def write_json(path: Path, document: dict[str, Any]) -> None:
    """Indented JSON; NaN and infinity are refused."""
    path.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def write_history(
    path: Path, columns: Sequence[str], table: Floats, bands: Floats, digits: int
) -> None:
    """Comma-separated: ``columns``, then half widths of bands of all but the first, if any."""
    names = [*columns, *(f"{name}_band" for name in columns[1:][: bands.shape[1]])]
    formats = [f"%.{digits}g"] * len(columns) + ["%.3g"] * bands.shape[1]
    rows = np.column_stack([table, bands])
    np.savetxt(path, rows, fmt=formats, delimiter=",", header=",".join(names), comments="")
