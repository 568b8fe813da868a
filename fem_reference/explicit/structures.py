"""Mirrors of the C structures of `kernel.c` and its parts; `kernel.load` checks their sizes."""

from __future__ import annotations

import ctypes

MAX_INTERVALS = 256
INT32 = ctypes.POINTER(ctypes.c_int32)
INT64 = ctypes.POINTER(ctypes.c_int64)
DOUBLE = ctypes.POINTER(ctypes.c_double)
VECTOR = ctypes.c_double * 3


class Record(ctypes.Structure):
    """Mirror of ``Record`` in C."""

    _fields_ = (
        ("impulse", ctypes.c_double),
        ("work", ctypes.c_double),
        ("force", ctypes.c_double),
        ("stored", ctypes.c_double),
        ("last", ctypes.c_int64),
        ("split", ctypes.c_int64),
        ("intervals", ctypes.c_int64),
        ("first_step", ctypes.c_int64 * MAX_INTERVALS),
        ("last_step", ctypes.c_int64 * MAX_INTERVALS),
        ("outermost", ctypes.c_int64),
    )


class Tip(ctypes.Structure):
    """Mirror of ``Tip`` in C."""

    _fields_ = (
        ("flexibility", DOUBLE),
        ("matrix", DOUBLE),
        ("multipliers", DOUBLE),
        ("wanted", DOUBLE),
        ("closed", INT32),
        ("closings", ctypes.c_int64),
        ("factor", DOUBLE),
        ("factored", ctypes.c_int64),
    )


class Pairs(ctypes.Structure):
    """Mirror of ``Pairs`` in C."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("candidate", INT32),
        ("opposite", INT32),
        ("gap", DOUBLE),
        ("compliance", DOUBLE),
        ("before", DOUBLE),
        ("normal", ctypes.c_double),
        ("friction", ctypes.c_double),
        ("sliding", DOUBLE),
        ("rubbed", ctypes.c_double),
        ("tip", ctypes.POINTER(Tip)),
        ("record", Record),
    )


class Film(ctypes.Structure):
    """Mirror of ``Film`` in C."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("places", ctypes.c_int64),
        ("node", INT32),
        ("corner", INT32),
        ("weight", DOUBLE),
        ("radius", DOUBLE),
        ("area", DOUBLE),
        ("gap", ctypes.c_double),
        ("curvature", ctypes.c_double),
        ("minimum_gap", ctypes.c_double),
        ("rates", ctypes.c_int64),
        ("first_rate", ctypes.c_double),
        ("log_ratio", ctypes.c_double),
        ("viscosity", DOUBLE),
        ("pressure", DOUBLE),
        ("flow", DOUBLE),
        ("load", DOUBLE),
        ("before", DOUBLE),
        ("force", ctypes.c_double),
        ("impulse", ctypes.c_double),
        ("work", ctypes.c_double),
    )


class Plastic(ctypes.Structure):
    """Mirror of ``Plastic`` in C."""

    _fields_ = (
        ("elements", ctypes.c_int64),
        ("nodes", ctypes.c_int64),
        ("touched", INT32),
        ("node", INT32),
        ("gradient", DOUBLE),
        ("weight", DOUBLE),
        ("shear", DOUBLE),
        ("yield_strength", DOUBLE),
        ("hardening", DOUBLE),
        ("rate", DOUBLE),
        ("exponent", DOUBLE),
        ("strain", DOUBLE),
        ("accumulated", DOUBLE),
        ("work", DOUBLE),
        ("force", DOUBLE),
    )


class Rigid(ctypes.Structure):
    """Mirror of ``Rigid`` in C."""

    _fields_ = (
        ("mobility", ctypes.c_double * 9),
        ("turning", ctypes.c_double * 9),
        ("mass", ctypes.c_double),
        ("u", VECTOR),
        ("v", VECTOR),
        ("spin", VECTOR),
        ("before", VECTOR),
        ("spun", VECTOR),
        ("force", VECTOR),
    )


class Contact(ctypes.Structure):
    """Mirror of ``Contact`` in C."""

    _fields_ = (
        ("kind", ctypes.c_int32),
        ("count", ctypes.c_int32),
        ("node", INT32),
        ("facet", INT32),
        ("weight", DOUBLE),
        ("normal", DOUBLE),
        ("gap", DOUBLE),
        ("place", DOUBLE),
        ("radius", ctypes.c_double),
        ("rigid", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
        ("multipliers", DOUBLE),
        ("compliance", DOUBLE),
        ("friction", ctypes.c_double),
        ("traction", DOUBLE),
        ("active", INT32),
        ("rubbed", ctypes.c_double),
        ("impulse", VECTOR),
        ("force", VECTOR),
        ("record", Record),
    )


class Voltage(ctypes.Structure):
    """Mirror of ``Voltage`` in C."""

    _fields_ = (
        ("node", ctypes.c_int64),
        ("force_per_voltage", ctypes.c_double),
        ("capacitance", ctypes.c_double),
        ("source", ctypes.c_double),
        ("resistance", ctypes.c_double),
        ("elastance", ctypes.c_double),
        ("charge", ctypes.c_double),
        ("extension", ctypes.c_double),
        ("force", ctypes.c_double),
        ("before", ctypes.c_double),
        ("impulse", ctypes.c_double),
        ("work", ctypes.c_double),
        ("heat", ctypes.c_double),
    )


class Problem(ctypes.Structure):
    """Mirror of ``Problem`` in C."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("map", INT32),
        ("inverse", DOUBLE),
        ("u", DOUBLE),
        ("predicted", DOUBLE),
        ("before", DOUBLE),
        ("force", DOUBLE),
        ("contacts", ctypes.c_int32),
        ("rigids", ctypes.c_int32),
        ("matched", ctypes.c_int64),
        ("contact", ctypes.POINTER(Contact)),
        ("rigid", ctypes.POINTER(Rigid)),
        ("pairs", ctypes.POINTER(Pairs)),
        ("film", ctypes.POINTER(Film)),
        ("plastic", ctypes.POINTER(Plastic)),
        ("voltage", ctypes.POINTER(Voltage)),
        ("dt", ctypes.c_double),
        ("tolerance", ctypes.c_double),
        ("step", ctypes.c_int64),
        ("sweeps", ctypes.c_int64),
        ("unconverged", ctypes.c_int64),
        ("reaction", VECTOR),
    )


class RowPart(ctypes.Structure):
    """Mirror of ``Part`` in C, of two components."""

    _fields_ = (
        ("border_shared", ctypes.c_int64),
        ("border", ctypes.c_int64),
        ("shared_free", ctypes.c_int64),
        ("shared", ctypes.c_int64),
        ("free", ctypes.c_int64),
        ("rows", ctypes.c_int64),
        ("node", INT32),
        ("row", INT64),
        ("column", INT32),
        ("block", DOUBLE),
        ("outer", INT64),
        ("outer_column", INT32),
        ("outer_block", DOUBLE),
    )


class ElementPart(ctypes.Structure):
    """Mirror of ``Part`` in C, of three components."""

    _fields_ = (
        ("number", ctypes.c_int64),
        ("part", INT32),
        ("size", ctypes.c_int64),
        ("fours", ctypes.c_int64),
        ("element", DOUBLE),
        ("node", INT32),
        ("free", ctypes.c_int64),
        ("moving", ctypes.c_int64),
        ("moves", INT32),
    )


PARTS: dict[int, type[ctypes.Structure]] = {2: RowPart, 3: ElementPart}
"""By components of displacement per node."""


class Relaxing(ctypes.Structure):
    """Mirror of ``Relaxing`` in C."""

    _fields_ = (
        ("level", ctypes.c_int64),
        ("count", ctypes.c_int64),
        ("entries", ctypes.c_int64),
        ("node", INT32),
        ("lasting", ctypes.c_double),
        ("ratio", DOUBLE),
        ("decay", DOUBLE),
        ("growth", DOUBLE),
    )


class State(ctypes.Structure):
    """Mirror of ``State`` in C."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("levels", ctypes.c_int64),
        ("parts", ctypes.c_int64),
        ("part", ctypes.c_void_p),
        ("inverse", DOUBLE),
        ("u", DOUBLE),
        ("effective", DOUBLE),
        ("v", DOUBLE),
        ("f", DOUBLE),
        ("support", DOUBLE),
        ("relaxings", ctypes.c_int64),
        ("relaxing", ctypes.POINTER(Relaxing)),
        ("springs", ctypes.c_int64),
        ("extension", DOUBLE),
        ("problem", ctypes.POINTER(Problem)),
    )


class Carried(ctypes.Structure):
    """Mirror of ``Carried`` in C."""

    _fields_ = (
        ("mass", ctypes.c_double),
        ("start", ctypes.c_double),
        ("displacement", ctypes.c_double),
        ("node", ctypes.c_int64),
    )


class Watched(ctypes.Structure):
    """Mirror of ``Watched`` in C."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("node", INT32),
        ("share", DOUBLE),
    )
