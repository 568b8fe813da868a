"""FEniCSx' cache of compiled forms: what a killed run or a full disk leaves there, and its errors.

FFCx marks a form as being compiled by the form's C file, and as compiled by ``.c.cached``. Where
its maker was killed, everybody after it waits for that file's compilation until they give up: "JIT
compilation timed out". A library that is damaged or gone would fail at every run.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable
from functools import wraps
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any, TypeVar, cast

from .cache import FORMS, cache_folder, is_whole
from .errors import SolverError

_LOCK = ".impactcheck-lock"
_CLEARING = ".impactcheck-clearing"
_READY = ".c.cached"

F = TypeVar("F", bound=Callable[..., Any])


def clear_unusable() -> int | None:
    """Remove forms that cannot be used, so that they are compiled again; called before dolfinx.

    Runs share a lock as long as they live: who is alone with it knows that nobody compiles. One at
    a time clears: what another run has compiled anew meanwhile is complete.

    Returns:
        The lock's file descriptor, never closed; None where the cache cannot be written.
    """
    cache = cache_folder() / FORMS
    try:
        cache.mkdir(parents=True, exist_ok=True)
        lock, clearing = (
            os.open(cache / name, os.O_RDWR | os.O_CREAT, 0o666) for name in (_LOCK, _CLEARING)
        )
        fcntl.flock(clearing, fcntl.LOCK_EX)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            alone = True
        except BlockingIOError:
            alone = False
        for name in {path.name.partition(".")[0] for path in cache.glob("libffcx_*.c*")}:
            _clear(cache / name, alone)
        fcntl.flock(lock, fcntl.LOCK_SH)
        os.close(clearing)
    except OSError:
        return None
    return lock


def _clear(form: Path, alone: bool) -> None:
    """Remove the files of a form if it is unusable; one that may be being compiled stays."""
    source, ready = form.with_suffix(".c"), form.with_suffix(_READY)
    libraries = [form.with_suffix(suffix) for suffix in EXTENSION_SUFFIXES]
    is_ready = ready.exists()
    usable = source.exists() and any(map(is_whole, libraries))
    if (is_ready and not usable) or (alone and not is_ready):
        # the mark of a form being compiled goes last
        for path in (ready, *libraries, source):
            path.unlink(missing_ok=True)


def compiles(function: F) -> F:
    """A function that lets FEniCSx compile a form, whose errors then name the cache folder."""
    # cffi's errors of compiler and linker are no OSError
    from cffi import VerificationError  # type: ignore[import-untyped]

    @wraps(function)
    def named(*arguments: Any, **options: Any) -> Any:
        try:
            return function(*arguments, **options)
        except (OSError, ImportError, VerificationError) as error:
            raise SolverError(
                f"FEniCSx could not compile a form in the cache folder {cache_folder() / FORMS}: "
                f"{error}"
            ) from error

    return cast("F", named)
