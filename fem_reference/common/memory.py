"""Memory a run needs, stated before it starts."""

from __future__ import annotations

import contextlib
import resource
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import SolverError
from .groups import control_groups

BASE = 0.24e9
"""Interpreter and modules, bytes per process; measured: 0.17e9, and up to 0.235e9 while forms
compile."""


@dataclass(frozen=True)
class Elements:
    """Of a geometry."""

    components: int
    """Displacements of a node."""
    per_node: float
    """Largest use per node beyond `BASE`, bytes."""


AXISYMMETRIC = Elements(2, 13.0e3)
"""Measured while matrices are assembled and factorised (47 500 nodes): 7.6e3 where most nodes are
the spheres', 13e3 where they are the plate's."""
SOLID = {1: Elements(3, 4.6e3), 2: Elements(3, 0.9e3)}
"""By element order. Measured: 4.3e3 while gmsh makes the mesh of linear elements (49 000 nodes),
0.6e3 of quadratic ones (59 000), and 0.8e3 in the loop and the fields (10 000 to 137 000)."""
SHARE = 0.9
"""Of the free memory that may be used."""


def memory_needed(nodes: int, elements: Elements, processes: int) -> float:
    """Bytes, all processes together."""
    return BASE * processes + elements.per_node * nodes


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
    nodes: int, elements: Elements, comm: Any, free: float | None = None, refinement: float = 1.0
) -> str:
    """State the memory needed; all processes are taken to share one machine's.

    Args:
        nodes: of the mesh at hand.
        elements: that it has.
        comm: of the processes.
        free: bytes, by default what `memory_free` finds.
        refinement: of the finest mesh of the series over this one, in every direction: memory that
            it will not have is stated before hours are spent on the others.

    Returns:
        A sentence for the progress.

    Raises:
        SolverError: more than is free.
    """
    finest = round(nodes * refinement**elements.components)
    # what these processes are already is not free any more
    more = elements.per_node * finest
    # one answer for all: a process that goes on alone would wait for the others
    if free is None:
        free = comm.bcast(memory_free(comm.size) if comm.rank == 0 else None)
    which = "the run has" if refinement == 1.0 else "the finest mesh of the series has about"
    dofs = elements.components * nodes
    text = f"{nodes} nodes, {dofs} dofs"
    if refinement > 1.0:
        text += f", about {elements.components * finest} on the finest mesh"
    text += f": about {memory_needed(finest, elements, comm.size) / 1e9:.2g} GB"
    if free is None:
        return text
    if more > SHARE * free:
        raise SolverError(
            f"{which} {elements.components * finest} dofs and needs about {more / 1e9:.3g} GB more "
            f"memory, {SHARE * free / 1e9:.3g} GB are free for it; lower "
            "reference.elements_per_contact_radius or use a machine with more memory"
        )
    return f"{text}, {free / 1e9:.2g} GB free"


def peak_memory(comm: Any) -> float:
    """Largest memory in use so far, all processes together, bytes."""
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    # The number above is inherited from the process that started this one, where it was larger.
    with contextlib.suppress(OSError, StopIteration):
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        own = int(next(line for line in lines if line.startswith("VmHWM")).split()[1])
    return float(comm.allreduce(own * 1024.0))
