"""The command ``columns``: a record in a binary format as columns of numbers."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from ..common.arguments import Study
from ..common.errors import SceneError, SolverError


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="record: UFF 58, TDMS, MAT, HDF5, Parquet, WAV")
    parser.add_argument(
        "--out", type=Path, required=True, help="a line of JSON, then little-endian doubles"
    )


def _columns(arguments: argparse.Namespace) -> None:
    """Write the channels of a record; the file appears when it is complete.

    Raises:
        SceneError: the record cannot be read, or it asks for more than this command reads.
        SolverError: the library of its format is missing, or the columns cannot be written.
    """
    from .guard import guarded, seconds_for
    from .record import convert

    file, out = arguments.file, arguments.out
    temporary = out.with_name(f".partial-{out.name}")
    try:
        if out.exists() and file.exists() and out.samefile(file):
            raise SceneError(f"--out {out} is the record itself; choose another file")
        out.parent.mkdir(parents=True, exist_ok=True)
        guarded(partial(convert, file, temporary), file, seconds_for(file))
        temporary.replace(out)
    except OSError as error:
        raise SolverError(f"{out} cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)


COLUMNS = Study("columns of a record in a binary format", _arguments, _columns)
