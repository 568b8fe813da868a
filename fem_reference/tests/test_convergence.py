"""Refinement to a target error: as far as needed and no further."""

from __future__ import annotations

from typing import Any, cast

import pytest

from fem_reference.common.errors import SolverError
from fem_reference.plate_impact import convergence
from fem_reference.plate_impact.convergence import RATIO, refine
from fem_reference.plate_impact.scene import Scene


class Converging:
    """Stands for a sequence whose band falls with the 1.5th power of the element size."""

    def __init__(self, factor: float) -> None:
        self.factor = factor

    def relative_error(self) -> float:
        """Of efficiency and force peaks."""
        return float(0.01 * self.factor**-1.5)


@pytest.fixture
def tried(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    factors: list[float] = []

    def solve_sequence(scene: Scene, factor: float, **options: Any) -> Converging:
        factors.append(factor)
        return Converging(factor)

    monkeypatch.setattr(convergence, "solve_sequence", solve_sequence)
    return factors


def refined(scene: Scene, target: float) -> Converging:
    return cast(Converging, refine(scene, 1.0, target))


def test_a_mesh_that_is_fine_enough_is_not_refined(scene: Scene, tried: list[float]) -> None:
    assert refined(scene, 0.02).factor == 1.0
    assert tried == [1.0]


@pytest.mark.parametrize("target", [0.009, 0.005, 0.001])
def test_refinement_stops_at_the_first_mesh_that_is_fine_enough(
    scene: Scene, tried: list[float], target: float
) -> None:
    sequence = refined(scene, target)
    assert sequence.relative_error() <= target
    # The mesh one step coarser would not do.
    assert Converging(sequence.factor * RATIO).relative_error() > target
    assert tried == sorted(tried)


def test_an_error_out_of_reach_is_refused_with_what_was_reached(
    scene: Scene, tried: list[float]
) -> None:
    with pytest.raises(SolverError, match="1e-05 is asked for"):
        refined(scene, 1e-5)
    assert max(tried) <= convergence.MOST_REFINED
