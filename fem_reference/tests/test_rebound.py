"""The published experiment: balls that rebound obliquely from glass."""

from __future__ import annotations

import math

import pytest

from fem_reference.plate_impact.studies.rebound import (
    ANGLES,
    FRICTION,
    MEASURED,
    SPEED,
    SPIN,
    TANGENTIAL,
    Rebound,
    measured_normal,
    rebound,
    rows,
)


def test_the_measured_values_are_those_of_one_experiment() -> None:
    """tan(rebound) = tangential over normal restitution times tan(angle), in separate figures."""
    assert measured_normal() == pytest.approx(1.0, abs=0.05)
    # beyond 30 degrees the balls slide: 1 - mu (1 + e) / tan(angle)
    for angle, value in MEASURED[TANGENTIAL][-3:]:
        slides = 1.0 - FRICTION * 1.98 / math.tan(math.radians(angle))
        assert value == pytest.approx(slides, abs=0.02)


def test_what_a_difference_may_be_has_its_parts() -> None:
    """Of a rebound that is linear in the angle and in the friction."""

    def found(offset: float) -> list[Rebound]:
        return [Rebound(0.98, 0.5 + offset, 10.0 * angle, 0.8 * angle) for angle in ANGLES]

    for row in rows(TANGENTIAL, found(0.03), found(0.01), found(0.05)):
        assert row.simulated == pytest.approx(0.53)
        assert [row.mesh, row.inputs] == pytest.approx([0.01, 0.04])
        assert row.data == pytest.approx(0.0075 * 0.90142)
        assert row.validation == pytest.approx(math.hypot(0.01, 0.04, row.data))
        assert (row.verdict == "within") == (abs(row.error) <= row.validation)
    spins = rows(SPIN, found(0.0), found(0.0), found(0.0))
    assert spins[0].data == pytest.approx(math.hypot(3.0, 0.0075 * 612.88))


@pytest.mark.evidence
def test_a_ball_rebounds_as_it_was_measured() -> None:
    """Where it slides, on the coarsest mesh there is: what the tables' last rows say."""
    found = rebound(50.0, 2.0)
    assert 0.965 < found.normal < 0.995
    assert found.tangential == pytest.approx(0.848, abs=0.015)
    assert found.angle == pytest.approx(45.3, abs=1.0)
    assert found.spin == pytest.approx(
        2.5 * (1.0 - found.tangential) * SPEED * 0.766 / 2.5e-3, rel=0.03
    )
