"""Bands: the published example of the grid convergence index, and data whose error is known."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference.common.uncertainty import curve_band, grid_convergence_index, least_squares

SIZES = np.array([0.84**-k for k in range(5)])


def test_grid_convergence_index_of_the_published_example() -> None:
    """Celik et al. 2008, table 1, first column."""
    found = grid_convergence_index((6.063, 5.972, 5.863), 1.5, 4.0 / 3.0)
    assert found.order == pytest.approx(1.53397, abs=1e-5)
    assert found.extrapolated == pytest.approx(6.168496, abs=1e-6)
    assert found.relative_index == pytest.approx(0.021750, abs=1e-6)


@pytest.mark.parametrize("order", [1.1, 1.5, 1.9])
def test_order_and_limit_of_a_clean_sequence(order: float) -> None:
    estimate = least_squares(7.0 + 0.3 * SIZES**order, SIZES)
    assert estimate.order == pytest.approx(order, abs=1e-4)
    assert estimate.extrapolated == pytest.approx(7.0, abs=1e-4)
    assert estimate.band == pytest.approx(1.25 * 0.3, rel=1e-3)


@pytest.mark.parametrize(("order", "nearer"), [(0.7, 1.0), (3.0, 2.0)])
def test_an_impossible_order_is_not_believed(order: float, nearer: float) -> None:
    estimate = least_squares(7.0 + 0.3 * SIZES**order, SIZES)
    assert estimate.order is None
    slope = 0.3 * (SIZES[-1] ** order - 1.0) / (SIZES[-1] ** nearer - 1.0)
    assert estimate.extrapolated == pytest.approx(7.3 - slope, abs=0.1)


def test_two_meshes_that_agree_by_chance_do_not_make_the_band_vanish() -> None:
    values = 100.0 + np.array([0.3, 0.3, 0.9, 0.6, 1.6])
    assert least_squares(values, SIZES).band > 0.3


def test_equal_values_have_no_band() -> None:
    assert least_squares(np.zeros(5), SIZES).band == 0.0


def test_fewer_than_four_meshes_are_refused() -> None:
    with pytest.raises(ValueError, match="at least 4"):
        least_squares(np.zeros(3), SIZES[:3])


def test_band_holds_the_limit_of_scattered_sequences() -> None:
    """Second order with scatter a third as large: 95 of 100 bands hold and are no barn doors."""
    random = np.random.default_rng(11)
    held, widths = 0, []
    for _ in range(400):
        values = 0.3 * SIZES**2 + 0.1 * random.standard_normal(5)
        estimate = least_squares(values, SIZES)
        held += abs(values[0]) <= estimate.band
        widths.append(estimate.band)
    assert held >= 0.95 * 400
    assert np.median(widths) < 5.0 * 0.3


def test_band_of_a_curve_holds_it_where_curves_cross() -> None:
    t = np.linspace(0.0, 6.0, 400)
    curves = np.stack([np.sin(t) + 0.01 * h**1.5 * np.sin(7.0 * t) for h in SIZES])
    band = curve_band(curves, SIZES, 20)
    assert np.all(np.abs(curves[0] - np.sin(t)) <= band)
    assert band.max() < 0.05
