"""The file of columns: a line of JSON, then the samples, column after column."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SolverError
from .channel import Channel, as_floats, require_sizes


def write_columns(out: Path, form: str, channels: list[Channel]) -> None:
    """Write the channels of a record.

    Args:
        out: one line of JSON, which ends with a line feed, then little-endian doubles.
        form: name of the record's format.
        channels: of an open record; one at a time is read.

    Raises:
        ValueError: the record is too large or empty, or its samples cannot be read.
        SolverError: the file cannot be written.
    """
    require_sizes(channels)
    head = {"format": form, "columns": [_described(channel) for channel in channels]}
    try:
        with out.open("wb") as stream:
            stream.write(json.dumps(head, allow_nan=False).encode() + b"\n")
            for channel in channels:
                stream.write(np.ascontiguousarray(_samples(channel), dtype="<f8").data)
    except OSError as error:
        raise SolverError(f"{out} cannot be written: {error}") from error


def _described(channel: Channel) -> dict[str, Any]:
    """The channel in the line of JSON; a clock that is no clock is left out."""
    start, interval = channel.start, channel.interval
    even = start is not None and interval is not None
    if not (even and math.isfinite(start or 0.0) and 0.0 < (interval or 0.0) < math.inf):
        start = interval = None
    return {
        "name": _text(channel.name),
        "unit": _text(channel.unit).strip() or None if channel.unit else None,
        "rows": channel.rows,
        "start": start,
        "interval": interval,
        "time": channel.time,
    }


def _text(text: str) -> str:
    """Text that every reader of JSON takes: without halves of characters."""
    return text.encode(errors="replace").decode()


def _samples(channel: Channel) -> Floats:
    """The samples of a channel.

    Raises:
        ValueError: they cannot be read, or are not as many as the file states.
    """
    try:
        values = as_floats(channel.read())
    except Exception as error:
        reason = str(error) or type(error).__name__
        raise ValueError(f"channel {channel.name!r}: {reason}") from error
    if values.size != channel.rows:
        raise ValueError(
            f"channel {channel.name!r} has {values.size} samples, its header states {channel.rows}"
        )
    return values
