"""The curves of a plate impact: sampled, resampled and written."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import numpy as np

from ..common.arrays import Floats
from ..common.output import SAMPLES
from ..common.uncertainty import bands

HISTORY_COLUMNS = (
    "time",
    "outer_displacement",
    "outer_velocity",
    "outer_force",
    "plate_displacement",
    "plate_velocity",
    "inner_displacement",
    "inner_velocity",
    "inner_force",
)


class Sampled(Protocol):
    """What a history is made of."""

    @property
    def times(self) -> Floats:
        """(m,) raw sampling instants, s."""

    @property
    def rows(self) -> Floats:
        """(m, 8) as `Motion.sample`."""


def history(run: Sampled) -> tuple[Floats, float]:
    """Table (samples, 9) of `HISTORY_COLUMNS`, and the sampling interval, s.

    Forces are impulse over interval, the interval centred on the sample; at both ends only its
    half inside the run counts.
    """
    raw = run.times.size - 1
    # An even number of raw intervals, so that the middle between two samples is one of them.
    stride = max(2, 2 * round(raw / SAMPLES / 2))
    keep = np.arange(0, run.times.size, stride)
    interval = float(stride * (run.times[1] - run.times[0]))
    table = np.empty((keep.size, len(HISTORY_COLUMNS)))
    table[:, 0] = run.times[keep]
    for column, source in ((1, 0), (2, 1), (4, 3), (5, 4), (6, 5), (7, 6)):
        table[:, column] = run.rows[keep, source]
    low = np.maximum(keep - stride // 2, 0)
    high = np.minimum(keep + stride // 2, raw)
    for column, source in ((3, 2), (8, 7)):
        impulse = run.rows[high, source] - run.rows[low, source]
        table[:, column] = impulse / (run.times[high] - run.times[low])
    return table, interval


def resampled(run: Sampled, times: Floats) -> Floats:
    """Table (samples, 9) of `HISTORY_COLUMNS` at ``times`` (evenly spaced, s) of another run."""
    table = np.empty((times.size, len(HISTORY_COLUMNS)))
    table[:, 0] = times
    for column, source in ((1, 0), (2, 1), (4, 3), (5, 4), (6, 5), (7, 6)):
        table[:, column] = np.interp(times, run.times, run.rows[:, source])
    half = 0.5 * (times[1] - times[0]) if times.size > 1 else 0.0
    low, high = np.maximum(times - half, times[0]), np.minimum(times + half, times[-1])
    for column, source in ((3, 2), (8, 7)):
        impulse = np.interp(high, run.times, run.rows[:, source])
        impulse -= np.interp(low, run.times, run.rows[:, source])
        table[:, column] = impulse / np.maximum(high - low, np.finfo(float).tiny)
    return table


def curve_bands(runs: Iterable[Sampled], factors: list[float]) -> Floats:
    """(samples, 8) half widths of the 95 % bands of the finest run's history.

    Args:
        runs: finest first.
        factors: of each mesh, on the number of elements.
    """
    finest, *coarser = runs
    table, _ = history(finest)
    tables = np.stack([table, *(resampled(run, table[:, 0]) for run in coarser)])
    return bands(tables[:, :, 1:], 1.0 / np.array(factors))[2]
