"""What a run that was ended while it compiled leaves in dolfinx's cache.

FFCx marks a form as being compiled by the form's C file. Where its maker was killed, everybody
after it waits for that file's compilation until they give up: "JIT compilation timed out".
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

_LOCK = ".impactcheck-lock"


def clear_unfinished() -> int | None:
    """Remove forms whose compilation nobody finishes any more; called before dolfinx compiles.

    Runs share a lock as long as they live: who is alone with it knows that nobody compiles.

    Returns:
        The lock's file descriptor, never closed; None where the cache cannot be written.
    """
    cache = Path(os.getenv("XDG_CACHE_HOME") or Path.home() / ".cache") / "fenics"
    try:
        cache.mkdir(parents=True, exist_ok=True)
        lock = os.open(cache / _LOCK, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            pass
        else:
            for source in cache.glob("libffcx_*.c"):
                if not source.with_suffix(".c.cached").exists():
                    source.unlink(missing_ok=True)
        fcntl.flock(lock, fcntl.LOCK_SH)
    except OSError:
        return None
    return lock
