"""Control groups of this process: what containers and batch systems leave of the machine."""

from __future__ import annotations

import contextlib
import math
import os
from pathlib import Path, PurePosixPath


def control_groups(controller: str, system: Path = Path("/")) -> list[tuple[Path, bool]]:
    """Folders of the groups with a controller that this process is in, or one above.

    With each whether it belongs to the unified hierarchy (version 2). ``system`` is the root of the
    file system that is asked.
    """
    try:
        lines = (system / "proc/self/cgroup").read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        return []
    found = []
    for line in (line for line in lines if line.count(":") >= 2):
        _, controllers, path = line.split(":", 2)
        if controllers and controller not in controllers.split(","):
            continue
        mount = system / "sys/fs/cgroup" / (controller if controllers else "")
        own = PurePosixPath(path.strip("/"))
        found += [(mount / group, not controllers) for group in (own, *own.parents)]
    return found


def affinity() -> frozenset[int]:
    """Processor cores this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return frozenset(os.sched_getaffinity(0))
    return frozenset(range(os.cpu_count() or 1))


def quota(system: Path = Path("/")) -> float:
    """Cores' worth of time that the control groups allow, infinite where they set no limit."""
    least = math.inf
    for group, unified in control_groups("cpu", system):
        # a group without a limit says "max", or -1
        with contextlib.suppress(OSError, ValueError):
            if unified:
                most, period = (group / "cpu.max").read_text(encoding="ascii").split()
            else:
                names = ("cpu.cfs_quota_us", "cpu.cfs_period_us")
                most, period = ((group / name).read_text(encoding="ascii") for name in names)
            if int(most) > 0:
                least = min(least, int(most) / int(period))
    return least
