"""Reads a record in a process of its own.

On damaged files libraries in C crash, never end, or decompress without bound.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path

from ..common.errors import RunError, SceneError, SolverError
from ..common.parent import PARENT, end_with_parent

LEAST_SECONDS = 60.0
"""Time for any file."""
BYTES_PER_SECOND = 1e6
"""Of a file; formats as text are read ten times as fast, binary ones a hundred times."""


MOST_MEMORY = 3_000_000_000
"""Bytes that reading may take: twice the largest record as doubles."""


def seconds_for(file: Path) -> float:
    """Longest time that reading a file may take, s."""
    return LEAST_SECONDS + (file.stat().st_size / BYTES_PER_SECOND if file.is_file() else 0.0)


def guarded(read: Callable[[], None], file: Path, seconds: float) -> None:
    """Read a file; started before any library has threads.

    Args:
        read: reads it.
        file: for the sentence.
        seconds: longest time.

    Raises:
        RunError: the reader's, or that it crashed or did not end.
    """
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_read, args=(read, sender, os.getpid()))
    process.start()
    sender.close()
    try:
        if not receiver.poll(seconds):
            raise SceneError(f"{file} cannot be read: its library does not end ({seconds:.0f} s)")
        error = receiver.recv()
    except EOFError as ended:
        process.join()
        raise SceneError(
            f"{file} cannot be read: its library crashes (exit status {process.exitcode})"
        ) from ended
    finally:
        process.kill()
        process.join()
    if error is not None:
        raise error


def _read(read: Callable[[], None], sender: Connection, parent: int) -> None:
    """Read, in the new process, and send the error or None."""
    # the process that waits says and clears up what is to be
    for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)
    os.environ[PARENT] = str(parent)
    end_with_parent()
    _, most = resource.getrlimit(resource.RLIMIT_DATA)
    least = MOST_MEMORY if most == resource.RLIM_INFINITY else min(MOST_MEMORY, most)
    resource.setrlimit(resource.RLIMIT_DATA, (least, most))
    try:
        read()
    except RunError as error:
        sender.send(error)
    except Exception as error:
        sender.send(SolverError(f"the record's reader failed: {type(error).__name__}: {error}"))
    else:
        sender.send(None)
