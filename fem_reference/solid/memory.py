"""Memory a run needs, stated before it starts."""

from __future__ import annotations

import contextlib
import resource
from pathlib import Path
from typing import Any

from ..common.errors import SolverError
from ..common.groups import control_groups
from ..explicit.loop import Loop

BASE = 0.25e9
"""Interpreter, modules and the compiler of the forms, bytes per process.

Measured: 0.21e9, and 0.22e9 where the forms are not in FEniCSx' cache yet."""
PER_NODE = {1: 6.0e3, 2: 2.5e3}
"""Largest use per node by element order, bytes.

Measured: 4.5e3 while gmsh makes the mesh (98 000 nodes), and 0.8e3 in the loop and the fields
(10 000 to 137 000 nodes)."""
SHARE = 0.9
"""Of the free memory that may be used."""


def memory_needed(nodes: int, order: int, processes: int) -> float:
    """Bytes, all processes together."""
    return BASE * processes + PER_NODE[order] * nodes


def memory_free(processes: int = 1, system: Path = Path("/")) -> float | None:
    """Bytes that a run can still use, all processes together; None where the system does not say.

    The least that the machine, the control groups (containers, batch systems) and the limit of
    the shell leave.

    Args:
        processes: of the run.
        system: root of the file system that is asked.
    """
    free = [_available(system / "proc/meminfo"), *_left_in_groups(system)]
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit != resource.RLIM_INFINITY:
        # the limit is of each process
        free.append(processes * max(float(limit) - _mapped(system), 0.0))
    known = [bytes_free for bytes_free in free if bytes_free is not None]
    return min(known, default=None)


def _available(meminfo: Path) -> float | None:
    with contextlib.suppress(OSError, ValueError, IndexError):
        for line in meminfo.read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return float(line.split()[1]) * 1024.0
    return None


def _mapped(system: Path) -> float:
    """Address space that this process has taken already, bytes."""
    with contextlib.suppress(OSError, ValueError, IndexError):
        pages = (system / "proc/self/statm").read_text(encoding="ascii").split()[0]
        return float(pages) * resource.getpagesize()
    return 0.0


def _left_in_groups(system: Path) -> list[float]:
    """What every control group that this process is in, or one above, leaves of its memory."""
    left = []
    for group, unified in control_groups("memory", system):
        names = ("max", "current") if unified else ("limit_in_bytes", "usage_in_bytes")
        # a group without a limit says "max"
        with contextlib.suppress(OSError, ValueError):
            most, now = (int((group / f"memory.{name}").read_text()) for name in names)
            left.append(float(max(most - now + _file_cache(group), 0)))
    return left


def _file_cache(group: Path) -> int:
    """Bytes of a control group's use that the system gives back when they are needed."""
    with contextlib.suppress(OSError, ValueError, KeyError):
        lines = (group / "memory.stat").read_text(encoding="ascii").splitlines()
        numbers = dict(line.split() for line in lines)
        return int(numbers.get("total_inactive_file") or numbers["inactive_file"])
    return 0


def require_memory(
    nodes: int, order: int, comm: Any, free: float | None = None, refinement: float = 1.0
) -> str:
    """State the memory needed; all processes are taken to share one machine's.

    Args:
        nodes: of the mesh at hand.
        order: of its elements.
        comm: of the processes.
        free: bytes, by default what `memory_free` finds.
        refinement: of the finest mesh of the series over this one, in every direction: memory that
            it will not have is told before hours are spent on the others.

    Returns:
        A sentence for the progress.

    Raises:
        SolverError: more than is free.
    """
    finest = round(nodes * refinement**3)
    needed = memory_needed(finest, order, comm.size)
    # one answer for all: a process that goes on alone would wait for the others
    if free is None:
        free = comm.bcast(memory_free(comm.size) if comm.rank == 0 else None)
    which = "the run has" if refinement == 1.0 else "the finest mesh of the series has about"
    text = f"{nodes} nodes, {3 * nodes} dofs"
    if refinement > 1.0:
        text += f", about {3 * finest} on the finest mesh"
    text += f": about {needed / 1e9:.2g} GB"
    if free is None:
        return text
    if needed > SHARE * free:
        raise SolverError(
            f"{which} {3 * finest} dofs and needs about {needed / 1e9:.3g} GB of memory, "
            f"{SHARE * free / 1e9:.3g} GB are free for it; lower "
            "reference.elements_per_contact_radius or use a machine with more memory"
        )
    return f"{text} of {free / 1e9:.2g} GB free"


def peak_memory(comm: Any) -> float:
    """Largest memory in use so far, all processes together, bytes."""
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    # The number above is inherited from the process that started this one, where it was larger.
    with contextlib.suppress(OSError, StopIteration):
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        own = int(next(line for line in lines if line.startswith("VmHWM")).split()[1])
    return float(comm.allreduce(own * 1024.0))


def machine(loop: Loop, stated: float, used: float) -> dict[str, Any]:
    """What a run needed: levels, contact solver, processes, memory stated and used, bytes."""
    state = loop.problem.state
    return {
        "nodes_per_level": list(loop.levels),
        "contact_sweeps_per_step": state.sweeps / max(1, state.step),
        "contact_unconverged_steps": state.unconverged,
        "processes": loop.comm.size,
        "threads": loop.threads,
        "peak_memory": used,
        "memory_stated": stated,
    }
