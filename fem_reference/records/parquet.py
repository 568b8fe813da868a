"""Parquet, by PyArrow."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from .channel import Channel, unit_in
from .clock import timed


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The columns of numbers of a Parquet file; units are in headings or fields' metadata.

    Raises ValueError where two columns have one name.
    """
    with pq.ParquetFile(path) as file:
        fields = list(file.schema_arrow)
        names = [field.name for field in fields]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f"two columns are called {twice!r}")
        rows = file.metadata.num_rows
        read = [_channel(file, rows, each) for each in fields if rows and _is_read(each.type)]
        yield timed(read, {})


def _is_read(kind: Any) -> bool:
    """Whether a column of this type has numbers, truth values, instants or durations."""
    tests = (pa.types.is_integer, pa.types.is_floating, pa.types.is_decimal, pa.types.is_boolean)
    return any(test(kind) for test in tests) or _is_dated(kind)


def _is_dated(kind: Any) -> bool:
    """Whether a column of this type has instants or durations."""
    return bool(pa.types.is_timestamp(kind) or pa.types.is_duration(kind))


def _channel(file: Any, rows: int, field: Any) -> Channel:
    """The channel of a column."""
    stated = (field.metadata or {}).get(b"unit", b"").decode(errors="replace")
    dated = _is_dated(field.type)
    return Channel(
        field.name,
        rows,
        partial(_values, file, field.name, dated),
        "s" if dated else stated or unit_in(field.name),
        label=field.name,
        dated=dated,
    )


def _values(file: Any, name: str, dated: bool) -> Any:
    """A column; what is missing is NaN, or no date."""
    column = file.read(columns=[name]).column(0)
    if not dated:
        column = column.cast(pa.float64(), safe=False)
    return column.to_numpy()
