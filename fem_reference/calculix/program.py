"""Runs CalculiX: one process with a deck, watched while it prints, ended with this one."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from ..common.errors import SolverError
from ..common.parent import PR_SET_PDEATHSIG

VARIABLE = "IMPACTCHECK_CCX"
"""Environment variable that names the program."""
JOB = "job"
POLL = 0.1
"""Time between two looks at what was printed, s."""
STALLED = 1800.0
"""A run that has printed nothing new for so long is ended, s: an increment takes seconds."""
LEAST_VERSION = (2, 18)


class DivergedError(SolverError):
    """The iterations of a step did not converge, or its energy was too far off."""


def program() -> str:
    """CalculiX's program.

    Raises:
        SolverError: it is not there.
    """
    named = os.environ.get(VARIABLE) or "ccx"
    found = shutil.which(named)
    if found is None:
        raise SolverError(
            f"the program {named} (CalculiX) is missing; on Debian `sudo apt-get install "
            f"calculix-ccx` brings it, {VARIABLE} names another one"
        )
    return found


def version() -> str:
    """What CalculiX says of its version.

    Raises:
        SolverError: it is not there, cannot be run or is too old.
    """
    path = program()
    try:
        ran = subprocess.run(
            [path, "-v"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60.0
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise SolverError(f"{path} cannot be run: {error}") from error
    said = re.search(r"Version (\d+)\.(\d+)", ran.stdout)
    if said is None:
        raise SolverError(f"{path} is no CalculiX: `{path} -v` does not tell a version")
    found = (int(said[1]), int(said[2]))
    if found < LEAST_VERSION:
        raise SolverError(
            f"{path} is CalculiX {found[0]}.{found[1]}; at least "
            f"{LEAST_VERSION[0]}.{LEAST_VERSION[1]} is required"
        )
    return f"{found[0]}.{found[1]}"


def _end_with_this_process() -> None:
    """Of Linux: called in the new process before it becomes CalculiX."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def run(deck: str, folder: Path, watch: Callable[[Path], bool], threads: int = 1) -> Path:
    """Run a deck until it is done, or ``watch`` says that it may end; what it has printed.

    Args:
        deck: the input.
        folder: made for all its files.
        watch: called again and again with the ``.dat`` file; True ends the run.
        threads: of CalculiX, at most.

    Raises:
        DivergedError: a step did, which a shorter one may not.
        SolverError: CalculiX is missing, failed, or stands still.
    """
    path = program()
    folder.mkdir()
    (folder / f"{JOB}.inp").write_text(deck, encoding="ascii")
    environment = {**os.environ, "OMP_NUM_THREADS": str(max(1, threads))}
    log, printed = folder / "log", folder / f"{JOB}.dat"
    with log.open("wb") as stream:
        try:
            process = subprocess.Popen(
                [path, "-i", JOB],
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                env=environment,
                preexec_fn=_end_with_this_process if sys.platform.startswith("linux") else None,
            )
        except OSError as error:
            raise SolverError(f"{path} cannot be run: {error}") from error
        try:
            if _watched(process, printed, watch):
                return printed
        finally:
            process.kill()
            process.wait()
    if process.returncode != 0:
        reason = _failure(process.returncode, log)
        raise DivergedError(reason) if "diverge" in reason else SolverError(reason)
    return printed


def _watched(
    process: subprocess.Popen[bytes], printed: Path, watch: Callable[[Path], bool]
) -> bool:
    """Whether ``watch`` ended it, before it ended by itself."""
    size, since = -1, time.monotonic()
    while process.poll() is None:
        time.sleep(POLL)
        now = printed.stat().st_size if printed.exists() else 0
        if now == size:
            if time.monotonic() - since > STALLED:
                raise SolverError(
                    f"CalculiX has printed nothing new for {STALLED:g} s; it was ended"
                )
            continue
        size, since = now, time.monotonic()
        if watch(printed):
            return True
    return False


def _failure(status: int, log: Path) -> str:
    """One sentence: how it ended, and the first error it told."""
    text = log.read_text(encoding="ascii", errors="replace")
    if status < 0:
        return f"CalculiX was ended by signal {-status} ({signal.Signals(-status).name})"
    error_text = re.search(r"\*ERROR[^\n]*(?:\n {5,}[^\n]*)*", text)
    at = re.findall(r"actual total time=(\S+)", text)
    reason = " ".join(error_text.group().split()) if error_text else "it did not say why"
    when = f" at {float(at[-1]):.4g} ms" if at else ""
    return f"CalculiX failed with status {status}{when}: {reason}"
