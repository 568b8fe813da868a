"""Builds `kernel.c` for this machine, once, and gives access to it.

The library lies in the user's cache folder under a name that is a hash of source, flags,
compiler and processor, and appears there by renaming, so concurrent runs do not disturb
each other.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..common.arrays import Floats
from ..common.compiler import compiler, compiler_version
from ..common.errors import SolverError

FLAGS = ("-std=gnu11", "-O3", "-fopenmp", "-march=native", "-ffp-contract=fast", "-fPIC", "-shared")
MAX_INTERVALS = 256
FACET_NODES = 6
CORNERS = 3
LANES = {2: 2, 3: 4}
"""Numbers per node in work space, by components."""
SPACED = 16
SAMPLED = 8
"""Numbers in a row of ``run``."""
AGAINST_SURFACE, AGAINST_SPHERE = 0, 1
_SOURCE = Path(__file__).with_name("kernel.c")
_INT32 = ctypes.POINTER(ctypes.c_int32)
_INT64 = ctypes.POINTER(ctypes.c_int64)
_DOUBLE = ctypes.POINTER(ctypes.c_double)
_VECTOR = ctypes.c_double * 3


class Record(ctypes.Structure):
    """Mirror of ``Record`` in kernel.c."""

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
    """Mirror of ``Tip`` in kernel.c."""

    _fields_ = (
        ("flexibility", _DOUBLE),
        ("matrix", _DOUBLE),
        ("multipliers", _DOUBLE),
        ("wanted", _DOUBLE),
        ("closed", _INT32),
        ("closings", ctypes.c_int64),
        ("factor", _DOUBLE),
        ("factored", ctypes.c_int64),
    )


class Pairs(ctypes.Structure):
    """Mirror of ``Pairs`` in kernel.c."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("candidate", _INT32),
        ("opposite", _INT32),
        ("gap", _DOUBLE),
        ("compliance", _DOUBLE),
        ("before", _DOUBLE),
        ("normal", ctypes.c_double),
        ("friction", ctypes.c_double),
        ("sliding", _DOUBLE),
        ("rubbed", ctypes.c_double),
        ("tip", ctypes.POINTER(Tip)),
        ("record", Record),
    )


class Film(ctypes.Structure):
    """Mirror of ``Film`` in kernel.c."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("places", ctypes.c_int64),
        ("node", _INT32),
        ("corner", _INT32),
        ("weight", _DOUBLE),
        ("radius", _DOUBLE),
        ("area", _DOUBLE),
        ("gap", ctypes.c_double),
        ("curvature", ctypes.c_double),
        ("minimum_gap", ctypes.c_double),
        ("rates", ctypes.c_int64),
        ("first_rate", ctypes.c_double),
        ("log_ratio", ctypes.c_double),
        ("viscosity", _DOUBLE),
        ("pressure", _DOUBLE),
        ("flow", _DOUBLE),
        ("load", _DOUBLE),
        ("before", _DOUBLE),
        ("force", ctypes.c_double),
        ("impulse", ctypes.c_double),
        ("work", ctypes.c_double),
    )


class Plastic(ctypes.Structure):
    """Mirror of ``Plastic`` in kernel.c."""

    _fields_ = (
        ("elements", ctypes.c_int64),
        ("nodes", ctypes.c_int64),
        ("touched", _INT32),
        ("node", _INT32),
        ("gradient", _DOUBLE),
        ("weight", _DOUBLE),
        ("shear", _DOUBLE),
        ("yield_strength", _DOUBLE),
        ("hardening", _DOUBLE),
        ("rate", _DOUBLE),
        ("exponent", _DOUBLE),
        ("strain", _DOUBLE),
        ("accumulated", _DOUBLE),
        ("work", _DOUBLE),
        ("force", _DOUBLE),
    )


class Rigid(ctypes.Structure):
    """Mirror of ``Rigid`` in kernel.c."""

    _fields_ = (
        ("mobility", ctypes.c_double * 9),
        ("turning", ctypes.c_double * 9),
        ("mass", ctypes.c_double),
        ("u", _VECTOR),
        ("v", _VECTOR),
        ("spin", _VECTOR),
        ("before", _VECTOR),
        ("spun", _VECTOR),
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
        ("reserved", ctypes.c_int32),
        ("multipliers", _DOUBLE),
        ("compliance", _DOUBLE),
        ("friction", ctypes.c_double),
        ("traction", _DOUBLE),
        ("active", _INT32),
        ("rubbed", ctypes.c_double),
        ("impulse", _VECTOR),
        ("force", _VECTOR),
        ("record", Record),
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
        ("matched", ctypes.c_int64),
        ("contact", ctypes.POINTER(Contact)),
        ("rigid", ctypes.POINTER(Rigid)),
        ("pairs", ctypes.POINTER(Pairs)),
        ("film", ctypes.POINTER(Film)),
        ("plastic", ctypes.POINTER(Plastic)),
        ("dt", ctypes.c_double),
        ("tolerance", ctypes.c_double),
        ("step", ctypes.c_int64),
        ("sweeps", ctypes.c_int64),
        ("unconverged", ctypes.c_int64),
        ("reaction", _VECTOR),
    )


class Part(ctypes.Structure):
    """Mirror of ``Part`` in kernel.c."""

    _fields_ = (
        ("border_shared", ctypes.c_int64),
        ("border", ctypes.c_int64),
        ("shared_free", ctypes.c_int64),
        ("shared", ctypes.c_int64),
        ("free", ctypes.c_int64),
        ("rows", ctypes.c_int64),
        ("node", _INT32),
        ("row", _INT64),
        ("column", _INT32),
        ("block", _DOUBLE),
        ("outer", _INT64),
        ("outer_column", _INT32),
        ("outer_block", _DOUBLE),
    )


class Relaxing(ctypes.Structure):
    """Mirror of ``Relaxing`` in kernel.c."""

    _fields_ = (
        ("level", ctypes.c_int64),
        ("count", ctypes.c_int64),
        ("terms", ctypes.c_int64),
        ("node", _INT32),
        ("lasting", ctypes.c_double),
        ("ratio", _DOUBLE),
        ("decay", _DOUBLE),
        ("growth", _DOUBLE),
    )


class State(ctypes.Structure):
    """Mirror of ``State`` in kernel.c."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("levels", ctypes.c_int64),
        ("parts", ctypes.c_int64),
        ("part", ctypes.POINTER(Part)),
        ("inverse", _DOUBLE),
        ("u", _DOUBLE),
        ("effective", _DOUBLE),
        ("v", _DOUBLE),
        ("f", _DOUBLE),
        ("support", _DOUBLE),
        ("relaxings", ctypes.c_int64),
        ("relaxing", ctypes.POINTER(Relaxing)),
        ("springs", ctypes.c_int64),
        ("extension", _DOUBLE),
        ("problem", ctypes.POINTER(Problem)),
    )


class Carried(ctypes.Structure):
    """Mirror of ``Carried`` in kernel.c."""

    _fields_ = (
        ("mass", ctypes.c_double),
        ("start", ctypes.c_double),
        ("displacement", ctypes.c_double),
        ("node", ctypes.c_int64),
    )


_C_TYPES: dict[type[np.generic], Any] = {
    np.int32: ctypes.c_int32,
    np.int64: ctypes.c_int64,
    np.float64: ctypes.c_double,
}


class Arrays:
    """Keeps the arrays that C structures point to."""

    def __init__(self) -> None:
        self._kept: list[object] = []

    def pointer(self, array: npt.ArrayLike, dtype: type[np.generic]) -> Any:
        """Pointer to the array itself where type and layout fit, else to a copy."""
        contiguous = np.ascontiguousarray(np.asarray(array, dtype=dtype))
        self._kept.append(contiguous)
        return contiguous.ctypes.data_as(ctypes.POINTER(_C_TYPES[dtype]))


def doubles(array: Floats) -> Any:
    """Pointer to a contiguous array, for the duration of a call."""
    return array.ctypes.data_as(_DOUBLE)


def _processor() -> str:
    """What -march=native depends on."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine() + platform.processor()
    return "".join(sorted({x for x in lines if x.startswith(("model name", "flags", "Features"))}))


def _cache_folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME")
    folder = Path(base) if base else Path.home() / ".cache"
    folder = folder / "impactcheck" / "kernels"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    fallback = Path(tempfile.gettempdir()) / f"impactcheck-kernels-{os.getuid()}"
    fallback.mkdir(mode=0o700, exist_ok=True)
    if fallback.stat().st_uid != os.getuid():
        raise SolverError(f"cache folder {fallback} belongs to another user; set XDG_CACHE_HOME")
    return fallback


def _compiled(components: int) -> ctypes.CDLL:
    """The library for 2 or 3 components, built once per source, flags, compiler and processor."""
    program = compiler()
    flags = (*FLAGS, f"-DCOMPONENTS={components}")
    parts = (" ".join(flags), compiler_version(), _processor())
    sources = [path.read_bytes() for path in sorted(_SOURCE.parent.glob("*.c"))]
    content = b"\0".join([*sources, *(part.encode() for part in parts)])
    folder = _cache_folder()
    library = folder / f"kernel-{components}-{hashlib.sha256(content).hexdigest()[:24]}.so"
    if library.exists():
        return ctypes.CDLL(str(library))
    handle, temporary = tempfile.mkstemp(suffix=".so", prefix=".build-", dir=folder)
    os.close(handle)
    try:
        result = subprocess.run(
            [program, *flags, "-o", temporary, str(_SOURCE), "-lm"],
            capture_output=True,
            text=True,
            check=False,
        )
        if result.returncode != 0:
            detail = (result.stderr.strip().splitlines() or ["no message"])[0]
            raise SolverError(f"{program} could not compile the time loop: {detail}")
        Path(temporary).replace(library)
    finally:
        Path(temporary).unlink(missing_ok=True)
    return ctypes.CDLL(str(library))


class Watched(ctypes.Structure):
    """Mirror of ``Watched`` in kernel.c."""

    _fields_ = (
        ("count", ctypes.c_int64),
        ("node", _INT32),
        ("share", _DOUBLE),
    )


def load(components: int) -> ctypes.CDLL:
    """The compiled kernel for 2 or 3 components of displacement per node.

    Raises:
        SolverError: no compiler, or it failed.
    """
    kernel = _compiled(components)
    state, count = ctypes.POINTER(State), ctypes.c_int64
    for name, arguments in {
        "advance": (state, count),
        "drift": (state, count, count),
        "contact_step": (ctypes.POINTER(Problem),),
        "run": (state, ctypes.POINTER(Carried), ctypes.POINTER(Watched), count, count, _DOUBLE),
        "stiffness_product": (state, count, count, _DOUBLE, _DOUBLE),
        "pack": (_DOUBLE, _INT64, count, _DOUBLE),
        "unpack": (_DOUBLE, _INT64, count, _DOUBLE),
        "triad": (_DOUBLE, _DOUBLE, _DOUBLE, count, count),
    }.items():
        function = getattr(kernel, name)
        function.argtypes, function.restype = arguments, None
    kernel.read_all.argtypes, kernel.read_all.restype = (_DOUBLE, count, count), ctypes.c_double
    kernel.layout.restype = ctypes.c_int64
    for number, mirror in enumerate(
        (
            *(Record, Pairs, Rigid, Contact, Problem, Part, State, Carried, Tip, Watched, Film),
            *(Plastic, Relaxing),
        )
    ):
        if kernel.layout(number) != ctypes.sizeof(mirror):
            raise SolverError(
                f"the compiled time loop and its Python side disagree on {mirror.__name__}"
            )
    return kernel
