"""Graded one-dimensional divisions: geometric growth from a fine end up to a cap."""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

LEAST_OF_TWO = 1.25
"""Length over that of the first element from which there are two: a shorter second one is a sliver.
"""


@dataclass(frozen=True)
class Segment:
    """A piece of a line: ``count`` elements, each ``ratio`` times as long as the one before."""

    length: float
    count: int
    ratio: float = 1.0

    @property
    def reversed(self) -> Segment:
        """The same piece run through from the other end."""
        return Segment(self.length, self.count, 1.0 / self.ratio)


def _sum(count: int, ratio: float) -> float:
    """1 + q + ... + q^(n-1)."""
    if abs(ratio - 1.0) < 1e-9:
        return float(count)
    return (ratio**count - 1.0) / (ratio - 1.0)


def _fit(length: float, first: float, count: int) -> Segment:
    """``count`` elements over ``length``, the first as long as ``first``."""
    target = length / first
    low, high = 1e-3, 1e3
    ratio = float(brentq(lambda q: _sum(count, q) - target, low, high, xtol=1e-13, rtol=1e-13))
    return Segment(length, count, ratio)


def graded(length: float, first: float, cap: float, ratio: float) -> list[Segment]:
    """Divide ``length`` (m): elements of ``first`` (m) at first, growing by ``ratio`` to ``cap``.

    Returns one or two segments: growth, then elements of about ``cap``. Element sizes scale
    with (first, cap, ln ratio) up to rounding, so meshes made with scaled arguments are
    systematically refined.
    """
    if cap <= first * 1.001:
        return [Segment(length, max(1, math.ceil(length / first - 1e-9)))]
    growing = max(1, round(math.log(cap / first) / math.log(ratio)))
    exact = (cap / first) ** (1.0 / growing)
    grown = first * _sum(growing, exact)
    rest = length - grown
    if rest > 0.5 * cap:
        return [Segment(grown, growing, exact), Segment(rest, max(1, round(rest / cap)))]
    if length < LEAST_OF_TWO * first:
        return [Segment(length, 1)]
    count = 2
    while first * _sum(count, ratio) < length * (1.0 - 1e-9):
        count += 1
    return [_fit(length, first, count)]
