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
from ..common.cache import LOOPS, cache_folder, is_whole
from ..common.compiler import compiler, compiler_version
from ..common.errors import SolverError
from .structures import (
    DOUBLE,
    INT64,
    PARTS,
    Carried,
    Contact,
    Film,
    Pairs,
    Plastic,
    Problem,
    Record,
    Relaxing,
    Rigid,
    State,
    Tip,
    Voltage,
    Watched,
)

FLAGS = ("-std=gnu11", "-O3", "-fopenmp", "-march=native", "-ffp-contract=fast", "-fPIC", "-shared")
FACET_NODES = 6
CORNERS = 3
LANES = {2: 2, 3: 4}
"""Numbers per node in work space, by components."""
READ_BEYOND = 3
"""Numbers behind the last displacement that are read with it."""
SPACED = 16
SAMPLED = 8
"""Numbers in a row of ``run``."""
AGAINST_SURFACE, AGAINST_SPHERE = 0, 1
_SOURCE = Path(__file__).with_name("kernel.c")


_C_TYPES: dict[type[np.generic], Any] = {
    np.int32: ctypes.c_int32,
    np.int64: ctypes.c_int64,
    np.float64: ctypes.c_double,
}


class Arrays:
    """Keeps the arrays that C structures point to."""

    def __init__(self) -> None:
        self._references: list[object] = []

    def pointer(self, array: npt.ArrayLike, dtype: type[np.generic]) -> Any:
        """Pointer to the array itself where type and layout fit, else to a copy."""
        contiguous = np.ascontiguousarray(np.asarray(array, dtype=dtype))
        self._references.append(contiguous)
        return contiguous.ctypes.data_as(ctypes.POINTER(_C_TYPES[dtype]))


def doubles(array: Floats) -> Any:
    """Pointer to a contiguous array, for the duration of a call."""
    return array.ctypes.data_as(DOUBLE)


def _processor() -> str:
    """What -march=native depends on."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine() + platform.processor()
    return "".join(sorted({x for x in lines if x.startswith(("model name", "flags", "Features"))}))


def _compiled(components: int) -> ctypes.CDLL:
    """The library for 2 or 3 components, built once per source, flags, compiler and processor."""
    program = compiler()
    flags = (*FLAGS, f"-DCOMPONENTS={components}")
    parts = (" ".join(flags), compiler_version(), _processor())
    sources = [path.read_bytes() for path in sorted(_SOURCE.parent.glob("*.c"))]
    content = b"\0".join([*sources, *(part.encode() for part in parts)])
    folder = cache_folder() / LOOPS
    library = folder / f"kernel-{components}-{hashlib.sha256(content).hexdigest()[:24]}.so"
    try:
        if not is_whole(library):
            folder.mkdir(parents=True, exist_ok=True)
            _compile([program, *flags], library)
        return ctypes.CDLL(str(library))
    except OSError as error:
        raise SolverError(
            f"the time loop cannot be compiled into the cache folder {folder}: {error}"
        ) from error


def _compile(command: list[str], library: Path) -> None:
    """Compile the time loop; what lies at ``library`` is replaced when it is complete."""
    handle, temporary = tempfile.mkstemp(suffix=".so", prefix=".build-", dir=library.parent)
    os.close(handle)
    try:
        result = subprocess.run(
            [*command, "-o", temporary, str(_SOURCE), "-lm"],
            capture_output=True,
            text=True,
            check=False,
        )
        if result.returncode != 0:
            detail = (result.stderr.strip().splitlines() or ["no message"])[0]
            raise SolverError(
                f"{command[0]} could not compile the time loop into the cache folder "
                f"{library.parent}: {detail}"
            )
        Path(temporary).replace(library)
    finally:
        Path(temporary).unlink(missing_ok=True)


def load(components: int) -> ctypes.CDLL:
    """The compiled kernel for 2 or 3 components of displacement per node.

    Raises:
        SolverError: no compiler, or it failed.
    """
    kernel = _compiled(components)
    state, count = ctypes.POINTER(State), ctypes.c_int64
    functions: dict[str, tuple[Any, ...]] = {
        "advance": (state, count),
        "drift": (state, count, count),
        "contact_step": (ctypes.POINTER(Problem),),
        "run": (state, ctypes.POINTER(Carried), ctypes.POINTER(Watched), count, count, DOUBLE),
        "stiffness_product": (state, count, count, DOUBLE, DOUBLE),
        "triad": (DOUBLE, DOUBLE, DOUBLE, count, count),
    }
    if components == 3:
        vectors = (DOUBLE, count, INT64, count, DOUBLE)
        functions |= dict.fromkeys(("pack", "unpack", "take", "put"), vectors)
        functions |= {"process_follows": (state,)}
        functions |= dict.fromkeys(("process_acts", "process_drifts"), (state, count))
    for name, arguments in functions.items():
        function = getattr(kernel, name)
        function.argtypes, function.restype = arguments, None
    kernel.read_all.argtypes, kernel.read_all.restype = (DOUBLE, count, count), ctypes.c_double
    kernel.layout.restype = ctypes.c_int64
    mirrors: tuple[type[ctypes.Structure], ...] = (
        *(Record, Pairs, Rigid, Contact, Problem, PARTS[components], State, Carried, Tip, Watched),
        *(Film, Plastic, Relaxing, Voltage),
    )
    for number, mirror in enumerate(mirrors):
        if kernel.layout(number) != ctypes.sizeof(mirror):
            raise SolverError(
                f"the compiled time loop and its Python side disagree on {mirror.__name__}"
            )
    return kernel
