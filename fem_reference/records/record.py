"""A record as columns: its format, its reader, its channels."""

from __future__ import annotations

import warnings
from pathlib import Path

from ..common.errors import RunError, SceneError


def convert(file: Path, out: Path) -> None:
    """Write the channels of a record to ``out``.

    Raises:
        SceneError: the record cannot be read, or it asks for more than is read.
        SolverError: the library of its format is missing, or the columns cannot be written.
    """
    # numpy, and the format's library, in the process that reads
    from .formats import format_of, reader_of
    from .write import write_columns

    form = format_of(file)
    reader = reader_of(form, file)
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
