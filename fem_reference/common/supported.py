"""MPI, dolfinx and PETSc of a release that this package supports; importing others raises."""

from __future__ import annotations

import re

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

# isort: split
# after MPI: the wheels of PyPI find the libmpi that mpi4py has loaded, and no other
import dolfinx
from petsc4py import PETSc

from .errors import SolverError

__all__ = ["MPI", "PETSc", "dolfinx", "fault"]

OLDEST, NEWEST = (0, 5), (0, 11)
"""Releases of dolfinx with which the tests pass, both included."""
WHEELS = "`pip install dolfinx-solver-real` (Linux x86-64, Python 3.12 or later) installs one"
"""How to install a supported FEniCSx."""


def fault(release: str, scalar: npt.DTypeLike) -> str | None:
    """Why a dolfinx of this release, with scalars of this type, is refused; None if it is not."""
    found = re.match(r"(\d+)\.(\d+)", release)
    if found is None or not OLDEST <= tuple(map(int, found.groups())) <= NEWEST:
        first, last = (".".join(map(str, bound)) for bound in (OLDEST, NEWEST))
        return f"dolfinx {release} is not supported, only {first} to {last}; {WHEELS}"
    if np.issubdtype(np.dtype(scalar), np.complexfloating):
        return f"PETSc of dolfinx {release} has complex scalars, real ones are required; {WHEELS}"
    return None


_fault = fault(str(dolfinx.__version__), PETSc.ScalarType)
if _fault is not None:
    raise SolverError(_fault)
