"""The formats of records: how a file of each begins, and which library reads it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import cast

from ..common.errors import SceneError, SolverError
from .channel import Channel

HEAD = 128
"""Bytes of a file's beginning that tell its format."""

Reader = Callable[[Path], AbstractContextManager[list[Channel]]]
"""Opens a record; its channels can be read until the context ends."""


@dataclass(frozen=True)
class Format:
    """A format of records."""

    name: str
    """For users."""
    begins: bytes
    """First bytes of every file, white space before them aside."""
    extensions: tuple[str, ...]
    module: str
    """Of this package, with a function ``channels``."""
    library: str
    """Name for pip."""

    def __str__(self) -> str:
        return f"{'an' if self.name == 'HDF5' else 'a'} {self.name} file"


FORMATS = (
    Format("UFF", b"-1", (".uff", ".unv"), "uff", "pyuff"),
    Format("TDMS", b"TDSm", (".tdms",), "tdms", "npTDMS"),
    Format("MATLAB 5", b"MATLAB 5.0", (".mat",), "matlab", "scipy"),
    Format("MATLAB 7.3", b"MATLAB 7.3", (".mat",), "hdf5", "h5py"),
    Format("HDF5", b"\x89HDF\r\n\x1a\n", (".h5", ".hdf5"), "hdf5", "h5py"),
    Format("Parquet", b"PAR1", (".parquet",), "parquet", "pyarrow"),
    Format("WAV", b"RIFF", (".wav",), "wav", "scipy"),
)


def format_of(file: Path) -> Format:
    """The format of a record, by its first bytes.

    Raises:
        SceneError: the file cannot be read, or begins as no format does.
    """
    try:
        with file.open("rb") as stream:
            head = stream.read(HEAD)
    except OSError as error:
        raise SceneError(f"{file} cannot be read: {error.strerror}") from error
    for form in FORMATS:
        if head.lstrip(b" \r\n").startswith(form.begins):
            return form
    suffix = file.suffix.lower()
    meant = [form for form in FORMATS if suffix in form.extensions]
    if not meant:
        known = ", ".join(end for form in FORMATS for end in form.extensions)
        raise SceneError(f"{file} is in no binary format that is known; known are {known}")
    names = " or ".join(form.name for form in meant)
    begins = " or ".join(repr(form.begins)[1:] for form in meant)
    raise SceneError(
        f"{file} is no {names} file: it begins with {repr(head[:8])[1:]}, such a file with {begins}"
    )


def reader_of(form: Format, file: Path) -> Reader:
    """The function that opens records of a format.

    Raises:
        SolverError: its library is not installed.
    """
    try:
        module = import_module(f".{form.module}", __package__)
    except ImportError as error:
        raise SolverError(
            f"{file} is {form}; {form.library} reads it: pip install {form.library} ({error})"
        ) from error
    return cast(Reader, module.channels)
