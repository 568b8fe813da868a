"""Points of the unit cube that scenes are made of, the same ones every time."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.stats import qmc

STRATA = {
    "dry": 256,
    "film": 40,
    "friction": 40,
    "relaxing": 40,
    "yielding": 40,
    "off-centre": 60,
    "body": 60,
    "seat": 60,
    "oblique": 200,
}
"""Scenes of each stratum. New strata come last: the place is part of the seed."""
SEED = 20261127
DIMENSION = 24
"""Most coordinates that a scene takes."""

Table = dict[str, Any]
"""Of a scene, SI."""


class Point:
    """A point of the unit cube whose coordinates are taken one after the other."""

    def __init__(self, coordinates: list[float]) -> None:
        self._left = iter(coordinates)

    def uniform(self, low: float, high: float) -> float:
        """Between the bounds."""
        return low + next(self._left) * (high - low)

    def log(self, low: float, high: float) -> float:
        """Between the bounds, even in the logarithm."""
        return math.exp(self.uniform(math.log(low), math.log(high)))

    def some(self, share: float, draw: Callable[[float], float]) -> float:
        """In a share of all scenes what ``draw`` makes of a number between 0 and 1, else 0."""
        at = next(self._left)
        return draw(at / share) if at < share else 0.0

    def one_of(self, *choices: str) -> str:
        """One of equally likely choices."""
        return choices[int(self.uniform(0.0, len(choices)))]


def between(low: float, high: float) -> Callable[[float], float]:
    """For `Point.some`: between the bounds, even in the logarithm."""
    return lambda at: low * (high / low) ** at


def points(stratum: str, count: int) -> list[Point]:
    """The first points of a stratum."""
    size = 2 ** math.ceil(math.log2(count))
    seed = SEED + list(STRATA).index(stratum)
    sequence = qmc.Sobol(DIMENSION, scramble=True, seed=seed)
    return [Point([float(at) for at in point]) for point in sequence.random(size)[:count]]
