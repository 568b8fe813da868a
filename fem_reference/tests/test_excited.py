"""The lowest frequency that contacts excite, of a body with a diagonal stiffness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fem_reference.common.arrays import Floats
from fem_reference.common.errors import SolverError
from fem_reference.explicit import excited

STIFFNESS = np.arange(1.0, 31.0) ** 2


class Springs:
    """Thirty springs with a mass each, in the place of a loop."""

    mass = np.full(10, 1.0 / 30.0)

    def body_masses(self) -> Floats:
        """Of the one body."""
        return np.array([1.0])

    def dot(self, first: Floats, second: Floats) -> float:
        """Inner product."""
        return float(first @ second)

    def product(self, vector: Floats) -> Floats:
        """Force of a displacement."""
        return STIFFNESS * vector


@pytest.fixture(autouse=True)
def _of_springs(monkeypatch: pytest.MonkeyPatch) -> None:
    def static_shape(_loop: Any, _body: int, load: Floats, *_more: Any) -> Floats:
        return load / STIFFNESS

    monkeypatch.setattr(excited, "static_shape", static_shape)
    monkeypatch.setattr(excited, "free_components", lambda *_: np.ones(30))


def found(loads: list[Floats]) -> float:
    """The angular frequency, over that of the softest spring."""
    of_unit: Any = Springs()
    return 2.0 * math.pi * excited.excited_frequency(of_unit, 0, loads, of_unit) / math.sqrt(30.0)


def test_the_lowest_mode_that_a_load_excites_is_found() -> None:
    """Among thirty, of which the two lowest do not move the contacts."""
    load = np.where(STIFFNESS > 4.0, 1.0, 0.0)
    assert found([load]) == pytest.approx(3.0, rel=1e-6)


def test_a_mode_that_does_not_converge_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two vectors are too few for thirty modes."""
    monkeypatch.setattr(excited, "VECTORS", 2)
    monkeypatch.setattr(excited, "MOST_VECTORS", 2)
    with pytest.raises(SolverError, match="was not found"):
        found([np.linspace(1.0, 900.0, 30)])
