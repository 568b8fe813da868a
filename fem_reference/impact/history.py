"""The history of a run: curves at even instants, made of raw samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Protocol

import numpy as np

from ..common.arrays import Floats
from ..common.output import SAMPLES
from ..common.uncertainty import bands


class Sampled(Protocol):
    """What a history is made of."""

    @property
    def times(self) -> Floats:
        """(m,) instants of the raw samples, s."""

    @property
    def rows(self) -> Floats:
        """(m, columns) raw samples."""


@dataclass(frozen=True)
class Sampling:
    """Instants of a history, and the interval about each over which forces are averaged."""

    at: Floats
    """(samples,) s, evenly spaced"""
    low: Floats
    """(samples,) s"""
    high: Floats
    """(samples,) s"""
    interval: float
    """Between two instants, s."""

    @staticmethod
    def on(times: Floats) -> Sampling:
        """About `SAMPLES` of the instants (m,) of raw samples; intervals begin and end at some."""
        last = times.size - 1
        # An even number of raw intervals, so that the middle between two samples is one of them.
        stride = max(2, 2 * round(last / SAMPLES / 2))
        keep = np.arange(0, times.size, stride)
        low = times[np.maximum(keep - stride // 2, 0)]
        high = times[np.minimum(keep + stride // 2, last)]
        return Sampling(times[keep], low, high, float(stride * (times[1] - times[0])))

    def of_others(self) -> Sampling:
        """The same instants for runs with other raw samples: all ends with the last of them."""
        half = 0.5 * (self.at[1] - self.at[0]) if self.at.size > 1 else 0.0
        low, high = np.maximum(self.at - half, self.at[0]), np.minimum(self.at + half, self.at[-1])
        return Sampling(self.at, low, high, self.interval)


@dataclass(frozen=True)
class Level:
    """A displacement or velocity, interpolated."""

    name: str
    column: int
    """Of the raw samples."""
    rate: int | None = None
    """Column of the velocity with which it goes on after the end of a run; None: it stays."""

    def at(self, run: Sampled, sampling: Sampling) -> Floats:
        """The curve (samples,)."""
        values = np.interp(sampling.at, run.times, run.rows[:, self.column])
        if self.rate is not None:
            late = np.maximum(sampling.at - run.times[-1], 0.0)
            values = values + np.interp(sampling.at, run.times, run.rows[:, self.rate]) * late
        return np.asarray(values)


@dataclass(frozen=True)
class Force:
    """Magnitude of a mean force: impulse over interval. One component keeps its sign."""

    name: str
    columns: tuple[int, ...]
    """Of its components' impulses in the raw samples."""

    def at(self, run: Sampled, sampling: Sampling) -> Floats:
        """The curve (samples,)."""
        length = np.maximum(sampling.high - sampling.low, np.finfo(float).tiny)

        def component(column: int) -> Floats:
            impulse = np.interp(sampling.high, run.times, run.rows[:, column])
            return (impulse - np.interp(sampling.low, run.times, run.rows[:, column])) / length

        return np.asarray(reduce(np.hypot, map(component, self.columns)))


Curves = Sequence[Level | Force]


def columns(curves: Curves) -> tuple[str, ...]:
    """Names of the columns of a history."""
    return ("time", *(curve.name for curve in curves))


def history(curves: Curves, run: Sampled, sampling: Sampling) -> Floats:
    """Table (samples, 1 + curves) of `columns`."""
    return np.column_stack([sampling.at, *(curve.at(run, sampling) for curve in curves)])


def curve_bands(tables: Sequence[Floats], factors: Sequence[float]) -> Floats:
    """(samples, curves) half widths of the 95 % bands of the first history.

    Args:
        tables: of all meshes, finest first.
        factors: of each mesh, on the number of elements.
    """
    return bands(np.stack(tables)[:, :, 1:], 1.0 / np.array(factors))[2]


def curve_uncertainty(curves: Curves, widths: Floats) -> dict[str, float]:
    """Root mean square and largest half width of the bands (samples, curves)."""
    found = {}
    for curve, band in zip(curves, widths.T, strict=True):
        found[f"{curve.name}_rms"] = float(np.sqrt(np.mean(band**2)))
        found[f"{curve.name}_max"] = float(band.max())
    return found
