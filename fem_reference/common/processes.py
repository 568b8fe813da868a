"""``solve`` of a solid scene: one process, or several started by mpirun or a batch system."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import sysconfig
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .errors import RunError, SolverError
from .groups import affinity, quota
from .parent import launched
from .progress import Progress

LOOK = 0.3
"""Time in which the load of the machine is measured, s."""
SPARE = 0.3
"""Cores' worth of other work that does not count."""
LAST_WORDS = 0.5
"""Time that the launcher has to pass on why a process ends all others, s."""
INHERITED = (
    *("PMIX_", "PMI_", "HYDI_", "OMPI_COMM_", "OMPI_UNIVERSE"),
    *("OMPI_MCA_ess", "OMPI_MCA_orte", "OMPI_MCA_pmix"),
)
"""What a process that has used MPI leaves in the environment of those it starts."""


def busy_cores(system: Path = Path("/")) -> float:
    """Cores that the machine's programs keep busy now; 0 where the system does not say."""

    def times() -> tuple[float, float]:
        fields = (system / "proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:]
        return sum(map(float, fields[:8])), float(fields[3]) + float(fields[4])

    try:
        total, idle = times()
        time.sleep(LOOK)
        after, idle_after = times()
    except (OSError, ValueError, IndexError):
        return 0.0
    spent = after - total
    return (os.cpu_count() or 1) * (1.0 - (idle_after - idle) / spent) if spent > 0.0 else 0.0


def crowded(processes: int, busy: float, cores: int) -> str | None:
    """A sentence where processes that wait for each other would have to share their cores."""
    if processes == 1 or processes + busy <= cores + SPARE:
        return None
    return (
        f"other programs keep {busy:.1f} of {cores} cores busy: {processes} processes wait for "
        "each other at every step and may take several times as long as one; --np 1 does not wait"
    )


def launcher() -> str | None:
    """Path of mpirun: that of this Python's environment, else the first on PATH.

    PyPI's mpi4py takes libmpi and mpirun from the environment. The launcher of another MPI starts
    processes that do not find each other.
    """
    own = os.pathsep.join([str(Path(sys.executable).parent), sysconfig.get_path("scripts")])
    for path in (own, None):
        for name in ("mpirun", "mpiexec"):
            program = shutil.which(name, path=path)
            if program:
                return program
    return None


def launched_by(command: list[str], processes: int) -> tuple[list[str], dict[str, str]]:
    """The command that runs ``command`` in so many processes, and its environment.

    Raises:
        SolverError: there is no mpirun.
    """
    inherited = {k: v for k, v in os.environ.items() if not k.startswith(INHERITED)}
    if processes == 1:
        return command, inherited
    program = launcher()
    if program is None:
        raise SolverError(
            "mpirun is missing; --np needs it: `pip install mpich` with PyPI's mpi4py, "
            "openmpi-bin with Debian's"
        )
    # Libraries have one thread, the loop is told its own; no refusal for root: who may start the
    # solver may start it so.
    settings = {
        "OMP_NUM_THREADS": "1",
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        # Processes that are told to end do so at once: they have nothing to put in order.
        "OMPI_MCA_odls_base_sigkill_timeout": "0",
        # Two runs side by side would be bound to the same cores, threads of a process to one.
        "OMPI_MCA_hwloc_base_binding_policy": "none",
        # Forces of a step on shared nodes pass at once: a handshake takes four times as long.
        "OMPI_MCA_btl_vader_eager_limit": "262144",
    }
    if processes >= (os.cpu_count() or 1):
        # Somebody else needs a processor too: waiting must not keep it busy.
        settings["OMPI_MCA_mpi_yield_when_idle"] = "1"
        settings["MPIR_CVAR_POLLS_BEFORE_YIELD"] = "1"
    return [program, "-n", str(processes), *command], {**settings, **inherited}


def _launch(processes: int) -> None:
    """Become this command in ``processes`` processes.

    Raises:
        SolverError: there is no mpirun.
    """
    cores = len(affinity())
    said = crowded(processes, busy_cores() * cores / (os.cpu_count() or 1), cores)
    if said is not None:
        Progress().report("note", 1.0, said)
    again = [sys.executable, "-m", "fem_reference", *sys.argv[1:]]
    command, environment = launched_by(again, processes)
    sys.stdout.flush()
    os.execve(command[0], command, environment)


def threads_per_process(requested: int, comm: Any) -> int:
    """Threads of this process: its share of those requested on its machine, 0: of its cores."""
    processes, there = 1, len(affinity())
    if comm.size > 1:
        from .fenicsx import on_this_machine

        here = on_this_machine(comm)
        processes = int(here.size)
        # A launcher may have bound every process to cores of its own.
        there = len(frozenset().union(*here.allgather(affinity())))
        here.Free()
    return max(1, int(requested or min(there, quota())) // processes)


def in_processes(arguments: argparse.Namespace, work: Callable[[Any], None]) -> None:
    """Call ``work`` with the communicator, in as many processes as ``arguments.np`` says.

    Raises:
        RunError: in a run of one process; several are ended together with its exit status.
    """
    if arguments.np > 1 and not launched():
        _launch(arguments.np)
    from .fenicsx import world

    comm = world()
    if launched() and comm.size == 1:
        raise SolverError(
            f"the mpirun that started the processes belongs to another MPI than that of "
            f"{sys.executable}: each process is alone; `impactcheck doctor` names the right one"
        )
    try:
        work(comm)
    except RunError as error:
        if comm.size == 1:
            raise
        # The others may be waiting for this process: end them all.
        Progress().error(str(error))
        print(f"error: {error}", file=sys.stderr, flush=True)
        # MPICH's launcher may drop what it has not passed on yet, as it does on a busy machine
        time.sleep(LAST_WORDS)
        comm.Abort(error.exit_status)
    except Exception:
        if comm.size == 1:
            raise
        traceback.print_exc()
        comm.Abort(1)
