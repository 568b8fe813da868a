"""The folder of compiled loops and forms, and whether a library in it is complete."""

from __future__ import annotations

import os
import struct
import sys
import tempfile
from pathlib import Path

from .errors import SolverError

VARIABLE = "XDG_CACHE_HOME"
"""Environment variable that names the user's cache folder; dolfinx reads it too."""
FORMS = Path("fenics")
"""Folder of dolfinx in the cache."""
LOOPS = Path("impactcheck", "kernels")
"""Folder of the time loop in the cache."""
ELF_HEADER = 64
"""Bytes of the header of a 64-bit ELF file."""


def cache_folder() -> Path:
    """The user's cache folder."""
    return Path(os.environ.get(VARIABLE) or Path.home() / ".cache")


def _is_writable(cache: Path) -> bool:
    """Whether this user can compile into ``cache``; its folders are made if need be."""
    try:
        for folder in (cache / FORMS, cache / LOOPS):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if not os.access(folder, os.W_OK | os.X_OK):
                return False
    except OSError:
        return False
    return True


def use_writable_cache() -> None:
    """Compile into a folder among the temporary files where the user's cache cannot be written.

    Raises:
        SolverError: that folder cannot be used either.
    """
    cache = cache_folder()
    if not _is_writable(cache):
        other = Path(tempfile.gettempdir()) / f"impactcheck-cache-{os.getuid()}"
        # a folder of somebody else could hold code of somebody else
        if not _is_writable(other) or other.stat().st_uid != os.getuid():
            raise SolverError(
                f"the cache folder {cache} cannot be written, nor can {other} of this user; "
                f"set {VARIABLE} to a folder for compiled code"
            )
        cache = other
    os.environ[VARIABLE] = str(cache)


def is_whole(library: Path) -> bool:
    """Whether the file of a shared library is complete.

    A linker puts the table of sections at the end of an ELF file, and the section of their names
    last: a file that was cut, or whose end never reached the disk, lacks them. Files of other
    systems are only required not to be empty.
    """
    try:
        with library.open("rb") as stream:
            size = os.fstat(stream.fileno()).st_size
            header = stream.read(ELF_HEADER)
            if not sys.platform.startswith("linux"):
                return size > 0
            if header[:4] != b"\x7fELF" or len(header) < ELF_HEADER:
                return False
            (table,) = struct.unpack_from("=Q", header, 40)
            entry, count, names = struct.unpack_from("=HHH", header, 58)
            stream.seek(table + entry * names)
            return table + entry * count <= size and any(stream.read(entry))
    except OSError:
        return False
