"""Builds `kernel.c` with the flags and in the cache of the axisymmetric kernel."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

from ..common.errors import SolverError
from ..explicit.kernel import compiled

MAX_INTERVALS = 256
FACET_NODES = 6
AGAINST_SURFACE, AGAINST_SPHERE = 0, 1
_SOURCE = Path(__file__).with_name("kernel.c")
_INT32 = ctypes.POINTER(ctypes.c_int32)
_INT64 = ctypes.POINTER(ctypes.c_int64)
_DOUBLE = ctypes.POINTER(ctypes.c_double)
_VECTOR = ctypes.c_double * 3


class Rigid(ctypes.Structure):
    """Mirror of ``Rigid`` in kernel.c."""

    _fields_ = (
        ("mobility", ctypes.c_double * 9),
        ("mass", ctypes.c_double),
        ("u", _VECTOR),
        ("v", _VECTOR),
        ("before", _VECTOR),
        ("force", _VECTOR),
    )


class Contact(ctypes.Structure):
    """Mirror of ``Contact`` in kernel.c."""

    _fields_ = (
        ("kind", ctypes.c_int32),
        ("count", ctypes.c_int32),
        ("node", _INT32),
        ("facet", _INT32),
        ("weight", _DOUBLE),
        ("normal", _DOUBLE),
        ("gap", _DOUBLE),
        ("place", _DOUBLE),
        ("radius", ctypes.c_double),
        ("rigid", ctypes.c_int32),
        ("outermost", ctypes.c_int32),
        ("multipliers", _DOUBLE),
        ("compliance", _DOUBLE),
        ("active", _INT32),
        ("impulse", _VECTOR),
        ("normal_impulse", ctypes.c_double),
        ("force", _VECTOR),
        ("work", ctypes.c_double),
        ("last", ctypes.c_int64),
        ("split", ctypes.c_int64),
        ("intervals", ctypes.c_int64),
        ("first_step", ctypes.c_int64 * MAX_INTERVALS),
        ("last_step", ctypes.c_int64 * MAX_INTERVALS),
    )


class Problem(ctypes.Structure):
    """Mirror of ``Problem`` in kernel.c."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("map", _INT32),
        ("inverse", _DOUBLE),
        ("u", _DOUBLE),
        ("predicted", _DOUBLE),
        ("before", _DOUBLE),
        ("force", _DOUBLE),
        ("contacts", ctypes.c_int32),
        ("rigids", ctypes.c_int32),
        ("contact", ctypes.POINTER(Contact)),
        ("rigid", ctypes.POINTER(Rigid)),
        ("dt", ctypes.c_double),
        ("tolerance", ctypes.c_double),
        ("step", ctypes.c_int64),
        ("sweeps", ctypes.c_int64),
        ("unconverged", ctypes.c_int64),
        ("reaction", _VECTOR),
    )


class Level(ctypes.Structure):
    """Mirror of ``Level`` in kernel.c."""

    _fields_ = (
        ("shared", ctypes.c_int64),
        ("rows", ctypes.c_int64),
        ("node", _INT32),
        ("row", _INT64),
        ("column", _INT32),
        ("block", _DOUBLE),
    )


class State(ctypes.Structure):
    """Mirror of ``State`` in kernel.c."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("levels", ctypes.c_int64),
        ("level", ctypes.POINTER(Level)),
        ("inverse", _DOUBLE),
        ("u", _DOUBLE),
        ("v", _DOUBLE),
        ("f", _DOUBLE),
        ("problem", ctypes.POINTER(Problem)),
    )


def load() -> Any:
    """The compiled kernel.

    Raises:
        SolverError: no compiler, or it failed.
    """
    kernel = compiled(_SOURCE, "solid")
    kernel.layout.restype = ctypes.c_int64
    kernel.advance.argtypes = [ctypes.POINTER(State), ctypes.c_int64]
    kernel.advance.restype = None
    kernel.contact_step.argtypes = [ctypes.POINTER(Problem)]
    kernel.contact_step.restype = None
    kernel.drift.argtypes = [ctypes.POINTER(State), ctypes.c_int64]
    kernel.drift.restype = None
    kernel.stiffness_product.argtypes = [
        ctypes.POINTER(State),
        ctypes.c_int64,
        ctypes.c_int64,
        _DOUBLE,
        _DOUBLE,
    ]
    kernel.stiffness_product.restype = None
    for number, mirror in enumerate((Rigid, Contact, Problem, Level, State)):
        if kernel.layout(number) != ctypes.sizeof(mirror):
            raise SolverError(
                f"the compiled time loop and its Python side disagree on {mirror.__name__}"
            )
    return kernel
