"""Versions of everything a result depends on; works without any of it installed."""

from __future__ import annotations

import platform
from importlib import import_module
from pkgutil import walk_packages

PACKAGE = __name__.partition(".")[0]
MODULES = (
    "dolfinx",
    "ufl",
    "basix",
    "ffcx",
    "cffi",
    "mpi4py",
    "petsc4py",
    "slepc4py",
    "gmsh",
    "numpy",
    "scipy",
    "meshio",
)
# Debian's packages of the libraries that a wheel takes from the system
LIBRARIES = {"gmsh": "libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1"}


def _version(module: str) -> str | None:
    try:
        found = import_module(module)
    except Exception:  # a broken installation must be reported like a missing one
        return None
    return str(getattr(found, "__version__", "unknown"))


def _petsc() -> str | None:
    try:
        return ".".join(str(part) for part in import_module("petsc4py.PETSc").Sys.getVersion())
    except Exception:
        return None


def _mpi() -> str | None:
    """First line that the MPI library prints about itself."""
    try:
        about = str(import_module("mpi4py.MPI").Get_library_version())
    except Exception:
        return None
    return " ".join(about.splitlines()[0].strip("\0").split())


def _compiler() -> str | None:
    from .compiler import compiler_version
    from .errors import SolverError

    try:
        return compiler_version()
    except (SolverError, OSError):
        return None


def of_modules(modules: list[str]) -> dict[str, str | None]:
    """Versions of Python and of some modules alone; None where one is missing."""
    return {"python": platform.python_version(), **{name: _version(name) for name in modules}}


def versions() -> dict[str, str | None]:
    """Version per program or module; None where it is missing."""
    mpi = _mpi()  # first: the wheels of PyPI find the libmpi that mpi4py has loaded, and no other
    found: dict[str, str | None] = {"python": platform.python_version()}
    found |= {name: _version(name) for name in MODULES}
    found["petsc"] = _petsc()
    found["mpi"] = mpi
    found["compiler"] = _compiler()
    return found


def _refused() -> str | None:
    """Why a module that is there cannot be used; None if all can, or are missing."""
    from .errors import SolverError

    for module in (*MODULES, f"{__package__}.supported"):
        try:
            import_module(module)
        except ModuleNotFoundError:
            continue
        except SolverError as error:
            return str(error)
        except Exception as error:
            missing = "cannot open shared object file" in str(error)
            hint = (
                f"; as root: apt-get install {LIBRARIES[module]}"
                if missing and module in LIBRARIES
                else ""
            )
            return f"{module} cannot be imported: {error}{hint}"
    return None


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


def installed() -> dict[str, str | None]:
    """What the program asks an interpreter for: package, versions, MPI's launcher, refusal."""
    from .processes import launcher

    found = {"fem_reference": package(), **versions()}
    return {**found, "mpirun": launcher(), "refused": _refused()}
