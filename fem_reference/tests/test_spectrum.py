"""The lowest eigenfrequency by inverse iteration."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from fem_reference.common.arrays import Floats
from fem_reference.explicit.loop import Loop
from fem_reference.explicit.spectrum import first_frequency


class Held:
    """A body without rigid motions."""

    def __init__(self) -> None:
        self.motions: list[tuple[Floats, float]] = []

    def out_of_motion(self, x: Floats) -> Floats:
        """All of it."""
        return x

    def out_of_force(self, force: Floats) -> Floats:
        """All of it."""
        return force


def structure(squared: Floats) -> Loop:
    """Nodes of mass 1 kg with these squares of angular frequencies. Shape (3 n,)."""
    modes = np.linalg.qr(np.random.default_rng(2).normal(size=(squared.size, squared.size)))[0]
    stiffness = modes @ np.diag(squared) @ modes.T
    count = squared.size // 3
    mass = np.ones(count)
    loop: Any = SimpleNamespace(
        body=np.zeros(count, dtype=int),
        inverse=np.ones(3 * count),
        mass=mass,
        system=SimpleNamespace(owned=np.arange(count), points=np.zeros((count, 3))),
        dot=lambda a, b: float(a @ b),
        total=lambda value: value,
        diagonal=np.diag(stiffness),
        product=lambda x: stiffness @ x,
        modes=modes,
    )
    return cast(Loop, loop)


@pytest.mark.parametrize("distance", [1e-1, 1e-2])
@pytest.mark.parametrize("share", [1.0, 1e-1])
def test_the_lower_of_two_close_frequencies_is_found(distance: float, share: float) -> None:
    """Also where the motion that the iteration begins with has less of it."""
    random = np.random.default_rng(1)
    loop = structure(np.concatenate([[1.0, 1.0 + distance], random.uniform(2.0, 1e3, 58)]))
    shares = random.uniform(0.5, 1.0, 60)
    shares[0] = share
    start = cast(Any, loop).modes @ shares
    found = first_frequency(loop, 0, start=start, floating=Held())
    assert found == pytest.approx(1.0 / (2.0 * math.pi), rel=1e-5)
