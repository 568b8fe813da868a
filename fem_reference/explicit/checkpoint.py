"""Checkpoints: a killed run goes on from the last one.

One file per run, written beside its place and renamed, so that it is complete or not there.
States are kept in the model's numbering: a run may go on with another number of processes.
"""

from __future__ import annotations

import fcntl
import json
import os
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..common.errors import SolverError
from ..solid.loop import Loop

INTERVAL = 60.0
"""Wall-clock time between checkpoints, s."""


@contextmanager
def exclusive(folder: Path, comm: Any, waiting: Callable[[], None]) -> Iterator[None]:
    """Hold the checkpoints in ``folder`` for this run; another run beside it waits.

    The lock is on the folder that holds ``folder``; it goes with the process, however that ends.

    Raises:
        SolverError: that folder cannot be locked.
    """
    lock = None
    if comm.rank == 0:
        try:
            folder.parent.mkdir(parents=True, exist_ok=True)
            lock = os.open(folder.parent, os.O_RDONLY)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                waiting()
                fcntl.flock(lock, fcntl.LOCK_EX)
        except OSError as error:
            raise SolverError(f"{folder.parent} cannot be locked: {error}") from error
    comm.barrier()
    try:
        yield
    finally:
        if lock is not None:
            os.close(lock)


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
        if loop.comm.rank == 0:
            scalars = {"identity": self.identity, "problem": loop.problem.checkpoint()}
            temporary = self.path.with_name(f".partial-{self.path.name}")
            try:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                with temporary.open("wb") as stream:
                    np.savez(stream, u=u, v=v, scalars=np.array(json.dumps(scalars)), **values)
                    stream.flush()
                    os.fsync(stream.fileno())
                temporary.replace(self.path)
            except OSError as error:
                raise SolverError(f"checkpoint {self.path} cannot be written: {error}") from error
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
