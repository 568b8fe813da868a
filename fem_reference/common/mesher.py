"""gmsh, started so that it leaves the signal handlers of the process alone."""

from __future__ import annotations

import inspect

import gmsh


def start_gmsh() -> None:
    """Start gmsh without the user's configuration; `gmsh.finalize` ends it."""
    # since 4.9 it takes Ctrl-C for itself otherwise
    options = {"interruptible": False} if _takes_signals() else {}
    gmsh.initialize([], readConfigFiles=False, **options)
    gmsh.option.setNumber("General.Terminal", 0)


def _takes_signals() -> bool:
    return "interruptible" in inspect.signature(gmsh.initialize).parameters
