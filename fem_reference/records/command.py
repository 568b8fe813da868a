"""The command ``columns``: a record in a binary format as columns of numbers."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

from ..common.arguments import Study
from ..common.errors import RunError, SceneError


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="record: UFF 58, TDMS, MAT, HDF5, Parquet, WAV")
    parser.add_argument(
        "--out", type=Path, required=True, help="a line of JSON, then little-endian doubles"
    )


def _columns(arguments: argparse.Namespace) -> None:
    """Write the channels of a record.

    Raises:
        SceneError: the record cannot be read, or it asks for more than this command reads.
        SolverError: the library of its format is missing, or the columns cannot be written.
    """
    file, out = arguments.file, arguments.out
    if out.exists() and file.exists() and out.samefile(file):
        raise SceneError(f"--out {out} is the record itself; choose another file")
    from .formats import format_of, reader_of

    form = format_of(file)
    reader = reader_of(form, file)
    from .write import write_columns

    try:
        # what a library warns of is not for the user: it either reads the file or does not
        with warnings.catch_warnings(action="ignore"), reader(file) as channels:
            write_columns(out, form.name, channels)
    except RunError:
        raise
    except Exception as error:
        # libraries raise anything where a file is damaged
        reason = str(error).strip().partition("\n")[0][:300] or type(error).__name__
        raise SceneError(f"{file} cannot be read as {form}: {reason}") from error


COLUMNS = Study("columns of a record in a binary format", _arguments, _columns)
