"""A channel of a record: what is known of it before its samples are read."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats

MOST_ROWS = 20_000_000
"""Samples of a channel."""
MOST_VALUES = 200_000_000
"""Samples of a record, all channels together."""
HEADING = re.compile(r".*[\[(]\s*([^\[\]()]*[^\[\]()\d\s][^\[\]()]*?)\s*[\])]\s*")
"""A name that ends with a unit in brackets, which is not a number alone."""


@dataclass(frozen=True)
class Channel:
    """A channel of numbers over time, or of the times of others."""

    name: str
    rows: int
    """Samples, as the file's headers state them."""
    read: Callable[[], Any]
    """Its samples: numbers, dates or durations, in one dimension."""
    unit: str | None = None
    start: float | None = None
    """Time of the first sample of an evenly sampled channel, s."""
    interval: float | None = None
    """Between its samples, s."""
    time: int | None = None
    """Channel that has its times, by its place in the record."""
    group: tuple[str, ...] = ()
    """Groups or structures that it is in, from the outermost."""
    label: str = ""
    """Its name in its group."""
    dated: bool = False
    """Whether its samples are dates or durations."""


def is_numeric(dtype: np.dtype[Any]) -> bool:
    """Whether an array of this type has real numbers, truth values, dates or durations."""
    return dtype.kind in "biufmM"


def is_dated(dtype: np.dtype[Any]) -> bool:
    """Whether an array of this type has dates or durations."""
    return dtype.kind in "mM"


def unit_in(name: str) -> str | None:
    """The unit in a heading such as ``force [N]`` or ``force (kN)``."""
    found = HEADING.fullmatch(name)
    return found[1] if found else None


def as_floats(values: Any) -> Floats:
    """Samples as floats; dates as seconds after the first one, durations in seconds.

    What is no date is NaN.
    """
    array = np.ravel(values)
    if not is_dated(array.dtype):
        return array.astype(np.float64, copy=False)
    known = array[~np.isnat(array)]
    since = array - known[0] if array.dtype.kind == "M" and known.size else array
    return np.where(np.isnat(since), np.nan, since / np.timedelta64(1, "s"))


def require_size(name: str, rows: int) -> None:
    """Refuse a channel that is too long.

    Raises:
        ValueError: it has more than `MOST_ROWS` samples.
    """
    if rows > MOST_ROWS:
        raise ValueError(f"channel {name!r} has {rows} samples; at most {MOST_ROWS} are read")


def require_sizes(channels: list[Channel]) -> None:
    """Refuse a record without samples, or one that is too large.

    Raises:
        ValueError: naming the channel and the bound.
    """
    if not channels:
        raise ValueError("it has no channel of numbers")
    for channel in channels:
        require_size(channel.name, channel.rows)
    values = sum(channel.rows for channel in channels)
    if values > MOST_VALUES:
        raise ValueError(
            f"its {len(channels)} channels have {values} samples; at most {MOST_VALUES} are read"
        )
