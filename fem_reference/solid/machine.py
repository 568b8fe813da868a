"""What a run of solids needed of the machine."""

from __future__ import annotations

from typing import Any

from ..explicit.loop import Loop


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
