"""The result folder: complete or not there at all."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .errors import SolverError

CHECKSUMS = "checksums.sha256"
PROVENANCE = "provenance.json"
PARTIAL_PREFIX = ".partial-"
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
def result_folder(target: Path) -> Iterator[Path]:
    """A temporary sibling of ``target`` that takes its place when the block succeeds.

    Whatever is at ``target`` already is replaced then. If the process dies, at most a folder
    ``.partial-*`` is left.
    """
    parent = target.absolute().parent
    try:
        parent.mkdir(parents=True, exist_ok=True)
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


def write_series(path: Path, times: list[float], names: list[str]) -> None:
    """A .pvd file: the .vtu files ``names`` beside it at ``times`` (s), for ParaView."""
    entries = "".join(
        f'    <DataSet timestep="{instant:.10g}" part="0" file="{name}"/>\n'
        for instant, name in zip(times, names, strict=True)
    )
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" '
        f'byte_order="LittleEndian">\n  <Collection>\n{entries}  </Collection>\n</VTKFile>\n',
        encoding="ascii",
    )
