"""Versions of everything a result depends on; works without any of it installed."""

from __future__ import annotations

import platform
from importlib import import_module
from pkgutil import walk_packages

PACKAGE = __name__.partition(".")[0]
MODULES = {
    "dolfinx": ("dolfinx", "__version__"),
    "ufl": ("ufl", "__version__"),
    "basix": ("basix", "__version__"),
    "ffcx": ("ffcx", "__version__"),
    "cffi": ("cffi", "__version__"),
    "mpi4py": ("mpi4py", "__version__"),
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


def package() -> str | None:
    """Folder of this package; None if one of its modules cannot be imported."""
    root = import_module(PACKAGE)
    # rigid bodies by MuJoCo run in an environment of their own, and no reference needs them
    apart = (".tests", f"{PACKAGE}.flight", "__main__")
    modules = [module.name for module in walk_packages(root.__path__, PACKAGE + ".")]
    try:
        for name in modules:
            if not any(part in name for part in apart):
                import_module(name)
    except Exception:  # as in `_version`
        return None
    return str(root.__path__[0])
