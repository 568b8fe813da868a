"""Versions of everything a result depends on; works without any of it installed."""

from __future__ import annotations

import platform
from importlib import import_module

MODULES = {
    "dolfinx": ("dolfinx", "__version__"),
    "ffcx": ("ffcx", "__version__"),
    "petsc4py": ("petsc4py", "__version__"),
    "slepc4py": ("slepc4py", "__version__"),
    "gmsh": ("gmsh", "__version__"),
    "numpy": ("numpy", "__version__"),
    "scipy": ("scipy", "__version__"),
    "meshio": ("meshio", "__version__"),
}


def _version(module: str, attribute: str) -> str | None:
    try:
        found = import_module(module)
    except Exception:  # a broken installation must be reported like a missing one
        return None
    version = getattr(found, attribute, None)
    return str(version) if version is not None else "unknown"


def _petsc() -> str | None:
    try:
        return ".".join(str(part) for part in import_module("petsc4py.PETSc").Sys.getVersion())
    except Exception:
        return None


def _compiler() -> str | None:
    from .compiler import compiler_version
    from .errors import SolverError

    try:
        return compiler_version()
    except (SolverError, OSError):
        return None


def versions() -> dict[str, str | None]:
    """Version per program or module; None where it is missing."""
    found: dict[str, str | None] = {"python": platform.python_version()}
    for name, (module, attribute) in MODULES.items():
        found[name] = _version(module, attribute)
    found["petsc"] = _petsc()
    found["compiler"] = _compiler()
    return found
