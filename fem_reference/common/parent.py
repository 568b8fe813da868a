"""Who started this process, and how it ends: with its parent, or by a signal."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

SIZES = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
"""Number of processes, set by MPI's launchers in the processes they start."""
PARENT = "IMPACTCHECK_PARENT"
"""Number of the process of the program that started the run, in its environment and its ranks'."""
PR_SET_PDEATHSIG = 1
"""See prctl(2)."""


def launched() -> bool:
    """Whether one of MPI's launchers started this process as one of several."""
    sizes = (os.environ.get(name, "") for name in SIZES)
    return any(size.isdecimal() and int(size) > 1 for size in sizes)


def end_with_parent() -> None:
    """Let the system end this process with its parent: the program, or MPI's launcher.

    By a signal, because a thread that watches would have to wait for the solver to let go of the
    interpreter. It outlasts exec: ``mpirun``, which this process may become, ends as well. Where
    there is no such signal (other systems than Linux) the next line of progress finds nobody
    listening. A run that was started by hand may outlive its shell.
    """
    parent = os.environ.get(PARENT)
    if parent is None or not sys.platform.startswith("linux"):
        return
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if not launched() and os.getppid() != int(parent):
        sys.exit("the program that started this run is gone")


class EndedBySignalError(BaseException):
    """A signal that ends the process once what is half made is gone."""


def end_by_signal() -> None:
    """Let a closed terminal, SIGTERM and Ctrl-C end a run that was started by hand in good order.

    What is half made goes then. The program that starts runs clears up after them itself, and
    launchers end their processes at once. A signal that the shell has ignored (nohup) stays so.
    """
    if PARENT in os.environ or launched():
        return

    # PETSc would end the process on the spot
    options = os.environ.get("PETSC_OPTIONS", "")
    os.environ["PETSC_OPTIONS"] = f"{options} -no_signal_handler".strip()

    def ended(number: int, _: object) -> None:
        signal.signal(number, signal.SIG_DFL)
        raise EndedBySignalError(number)

    for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, ended)
