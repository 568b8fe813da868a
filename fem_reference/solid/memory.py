"""Memory a run needs, stated before it starts."""

from __future__ import annotations

import contextlib
import resource
from pathlib import Path
from typing import Any

from ..common.errors import SolverError
from ..explicit.loop import Loop

BASE = 0.25e9
"""Interpreter, modules and the compiler of the forms, bytes per process.

Measured: 0.21e9, and 0.22e9 where the forms are not in FEniCSx' cache yet."""
PER_NODE = {1: 8.2e3, 2: 13.0e3}
"""Largest use per node by element order, bytes: during assembly, where K exists several times.

Measured: 7.4e3 (50 000 and 200 000 nodes) and 10.4e3 to 12.1e3 (10 000 to 106 000 nodes); the
levels of sub-cycling need no more, they take the place of K."""
SHARE = 0.9
"""Of the free memory that may be used."""


def memory_needed(nodes: int, order: int, processes: int) -> float:
    """Bytes, all processes together."""
    return BASE * processes + PER_NODE[order] * nodes


def memory_free() -> float | None:
    """Bytes that a new program can use; None where the system does not say."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return float(line.split()[1]) * 1024.0
    except (OSError, ValueError, IndexError):
        pass
    return None


def require_memory(nodes: int, order: int, comm: Any, free: float | None = None) -> str:
    """State the memory needed; all processes are taken to share one machine's.

    Returns:
        A sentence for the progress.

    Raises:
        SolverError: more than is free.
    """
    needed = memory_needed(nodes, order, comm.size)
    free = free if free is not None else memory_free()
    text = f"{nodes} nodes, {3 * nodes} dofs: about {needed / 1e9:.2g} GB"
    if free is None:
        return text
    if needed > SHARE * free:
        raise SolverError(
            f"the run has {3 * nodes} dofs and needs about {needed / 1e9:.3g} GB of memory, "
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
        "peak_memory": used,
        "memory_stated": stated,
    }
