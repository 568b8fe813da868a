"""``solve`` of a solid scene: one process, or several started by mpirun or a batch system."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import traceback

from ..errors import RunError, SolverError
from ..progress import Progress
from ..scene import Scene

LAUNCHED = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "PMI_RANK")
"""Set by MPI's launchers in the processes they start."""


def _launch(processes: int) -> None:
    """Become mpirun with this command in ``processes`` processes.

    Raises:
        SolverError: there is no mpirun.
    """
    program = shutil.which("mpirun") or shutil.which("mpiexec")
    if program is None:
        raise SolverError("mpirun is missing; --np needs it: install openmpi-bin")
    # One thread per process, and no refusal for root: who may start the solver may start it so.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    for name in ("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"):
        os.environ.setdefault(name, "1")
    sys.stdout.flush()
    command = [program, "-n", str(processes), sys.executable, "-m", "fem_reference", *sys.argv[1:]]
    os.execv(program, command)


def solve_solid(scene: Scene, arguments: argparse.Namespace) -> None:
    """Run ``solve`` for a scene with solid geometry.

    Raises:
        RunError: in a run of one process; several are ended together with its exit status.
    """
    if not any(name in os.environ for name in LAUNCHED) and arguments.np > 1:
        _launch(arguments.np)
    from ..fenicsx import world
    from .result import solve

    comm = world()
    try:
        solve(
            scene,
            arguments.out,
            arguments.resolution,
            comm,
            courant=arguments.courant,
            stress_times=arguments.stress_at,
            frames=arguments.fields,
            checkpoint=arguments.checkpoint,
            checkpoint_interval=arguments.checkpoint_interval,
        )
    except RunError as error:
        if comm.size == 1:
            raise
        # The others may be waiting for this process: end them all.
        Progress().error(str(error))
        print(f"error: {error}", file=sys.stderr, flush=True)
        comm.Abort(error.exit_status)
    except Exception:
        if comm.size == 1:
            raise
        traceback.print_exc()
        comm.Abort(1)
