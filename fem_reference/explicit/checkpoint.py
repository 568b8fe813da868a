"""Checkpoints: a killed run goes on from the last one.

One file per run, written beside its place and renamed, so that it is complete or not there.
States are kept in the model's numbering: a run may go on with another number of processes.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from ..common.settings import Settings
from .loop import Loop

INTERVAL = 60.0
"""Wall-clock time between checkpoints, s."""


def write_arrays(path: Path, **arrays: Any) -> None:
    """Write an ``.npz`` file that is complete or not there, even if the machine fails.

    Raises:
        SolverError: it cannot be written.
    """
    temporary = path.with_name(f".partial-{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as stream:
            np.savez(stream, **arrays)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(path)
    except OSError as error:
        raise SolverError(f"checkpoint {path} cannot be written: {error}") from error


class Checkpoint:
    """The checkpoint file of one run.

    Args:
        path: of the file.
        identity: what the state belongs to; a file with another one is not used.
        interval: wall-clock time between checkpoints, s; 0: at every chance.
    """

    def __init__(self, path: Path, identity: str, interval: float = INTERVAL) -> None:
        self.path, self.identity, self.interval = path, identity, interval
        self._last = time.monotonic()

    def due(self, comm: Any) -> bool:
        """Whether it is time; the first process decides for all."""
        return bool(comm.bcast(time.monotonic() - self._last >= self.interval))

    def save(self, loop: Loop, **values: Any) -> None:
        """Write the state of ``loop`` and further arrays and numbers.

        Raises:
            SolverError: the file cannot be written.
        """
        u, v = loop.gather(loop.u), loop.gather(loop.v)
        if loop.springs is not None and loop.ledger is not None:
            values |= {"extension": loop.springs.extension, **loop.ledger.state}
        if loop.comm.rank == 0:
            scalars = {"identity": self.identity, "problem": loop.problem.checkpoint()}
            write_arrays(self.path, u=u, v=v, scalars=np.array(json.dumps(scalars)), **values)
        loop.comm.barrier()
        self._last = time.monotonic()

    def load(self) -> dict[str, Any] | None:
        """The state saved; None if there is none of this run."""
        try:
            with np.load(self.path, allow_pickle=False) as file:
                values = {name: file[name] for name in file.files}
            scalars = json.loads(str(values.pop("scalars")))
        except (OSError, ValueError, KeyError, zipfile.BadZipFile):
            return None
        if scalars.pop("identity") != self.identity:
            return None
        return {**values, **scalars}

    def remove(self) -> None:
        """The run is complete."""
        self.path.unlink(missing_ok=True)


def checkpoint_of(
    settings: Settings, method: list[Any], meshes: Iterable[tuple[Floats, Ints]], suffix: str = ""
) -> Checkpoint:
    """Of a run on ``meshes`` (points and cells); ``method`` is what else its state depends on."""
    digest = hashlib.sha256()
    digest.update(json.dumps([*method, settings.courant], sort_keys=True).encode())
    for points, cells in meshes:
        digest.update(np.round(points, 15).tobytes())
        digest.update(cells.tobytes())
    path = settings.folder / f"{settings.label}{suffix}.npz"
    return Checkpoint(path, digest.hexdigest(), settings.checkpoint_interval)
