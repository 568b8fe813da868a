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
import shutil
import subprocess
import tempfile
from pathlib import Path

from ..common.errors import SolverError

FLAGS = ("-std=gnu11", "-O3", "-march=native", "-ffp-contract=fast", "-fPIC", "-shared")
MAX_INTERVALS = 256
MAX_LEVELS = 16
_SOURCE = Path(__file__).with_name("kernel.c")
_INT32 = ctypes.POINTER(ctypes.c_int32)
_DOUBLE = ctypes.POINTER(ctypes.c_double)


class Contact(ctypes.Structure):
    """Mirror of ``Contact`` in kernel.c."""

    _fields_ = (
        ("pairs", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
        ("sphere", _INT32),
        ("plate", _INT32),
        ("gap", _DOUBLE),
        ("compliance", _DOUBLE),
        ("normal", ctypes.c_double),
        ("impulse", ctypes.c_double),
        ("work", ctypes.c_double),
        ("force", ctypes.c_double),
        ("last", ctypes.c_int64),
        ("split", ctypes.c_int64),
        ("intervals", ctypes.c_int64),
        ("first_step", ctypes.c_int64 * MAX_INTERVALS),
        ("last_step", ctypes.c_int64 * MAX_INTERVALS),
        ("outermost", ctypes.c_int32),
        ("reserved2", ctypes.c_int32),
    )


class Level(ctypes.Structure):
    """Mirror of ``Level`` in kernel.c."""

    _fields_ = (
        ("shared", ctypes.c_int32),
        ("shared_fixed", ctypes.c_int32),
        ("inner", ctypes.c_int32),
        ("rows", ctypes.c_int32),
        ("node", _INT32),
        ("row", _INT32),
        ("column", _INT32),
        ("block", _DOUBLE),
    )


class State(ctypes.Structure):
    """Mirror of ``State`` in kernel.c."""

    _fields_ = (
        ("nodes", ctypes.c_int64),
        ("inverse", _DOUBLE),
        ("u", _DOUBLE),
        ("v", _DOUBLE),
        ("f", _DOUBLE),
        ("dt", ctypes.c_double),
        ("step", ctypes.c_int64),
        ("levels", ctypes.c_int32),
        ("contacts", ctypes.c_int32),
        ("support_impulse", ctypes.c_double),
        ("velocity_before", _DOUBLE),
        ("body_mass", ctypes.c_double * 2),
        ("rigid_start", ctypes.c_double * 2),
        ("rigid", ctypes.c_double * 2),
        ("centre", ctypes.c_int32 * 2),
        ("contact", Contact * 2),
        ("level", Level * MAX_LEVELS),
    )


def compiler() -> str:
    """Path of the C compiler: $CC, else cc, gcc or clang.

    Raises:
        SolverError: there is none.
    """
    asked = os.environ.get("CC")
    for name in (asked,) if asked else ("cc", "gcc", "clang"):
        path = shutil.which(name)
        if path:
            return path
    raise SolverError(
        f"no C compiler found ({asked or 'cc, gcc, clang'}); the time loop needs one: "
        "install gcc or set CC"
    )


def compiler_version() -> str:
    """First line of the compiler's --version."""
    output = subprocess.run([compiler(), "--version"], capture_output=True, text=True, check=False)
    return output.stdout.splitlines()[0] if output.stdout else "unknown"


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


def compiled(source: Path, name: str) -> ctypes.CDLL:
    """The library built from ``source``, once per source, flags, compiler and processor.

    Args:
        source: C source, one file.
        name: how the library's name in the cache begins.

    Raises:
        SolverError: no compiler, or it failed.
    """
    program = compiler()
    parts = (" ".join(FLAGS), compiler_version(), _processor())
    content = b"\0".join([source.read_bytes(), *(part.encode() for part in parts)])
    folder = _cache_folder()
    library = folder / f"{name}-{hashlib.sha256(content).hexdigest()[:24]}.so"
    if library.exists():
        return ctypes.CDLL(str(library))
    handle, temporary = tempfile.mkstemp(suffix=".so", prefix=".build-", dir=folder)
    os.close(handle)
    try:
        result = subprocess.run(
            [program, *FLAGS, "-o", temporary, str(source), "-lm"],
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


def load() -> ctypes.CDLL:
    """The compiled kernel.

    Raises:
        SolverError: no compiler, or it failed.
    """
    kernel = compiled(_SOURCE, "kernel")
    kernel.state_size.restype = ctypes.c_int64
    kernel.run.argtypes = [ctypes.POINTER(State), ctypes.c_int64, ctypes.c_int64, _DOUBLE]
    kernel.run.restype = None
    kernel.stiffness_product.argtypes = [ctypes.POINTER(State), _DOUBLE, _DOUBLE]
    kernel.stiffness_product.restype = None
    kernel.triad.argtypes = [_DOUBLE, _DOUBLE, _DOUBLE, ctypes.c_int64, ctypes.c_int64]
    kernel.triad.restype = None
    if kernel.state_size() != ctypes.sizeof(State):
        raise SolverError("the compiled time loop and its Python side disagree on their layout")
    return kernel
