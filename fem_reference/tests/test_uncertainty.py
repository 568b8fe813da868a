"""Bands: the published example of the grid convergence index, and data whose error is known."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference.common.uncertainty import bands, grid_convergence_index, least_squares

SIZES = np.array([0.84**-k for k in range(5)])


def test_grid_convergence_index_of_the_published_example() -> None:
    """Celik et al. 2008, table 1, first column."""
    found = grid_convergence_index((6.063, 5.972, 5.863), 1.5, 4.0 / 3.0)
    assert found.order == pytest.approx(1.53397, abs=1e-5)
    assert found.extrapolated == pytest.approx(6.168496, abs=1e-6)
    assert found.relative_index == pytest.approx(0.021750, abs=1e-6)


def test_limit_and_error_of_a_clean_sequence() -> None:
    estimate = least_squares(7.0 + 0.3 * SIZES**1.5, SIZES)
    assert estimate.extrapolated == pytest.approx(7.0, abs=1e-12)
    assert estimate.deviation == pytest.approx(0.0, abs=1e-12)
    assert estimate.band == pytest.approx(0.3, rel=1e-9)


@pytest.mark.parametrize(("order", "least", "most"), [(1.0, 0.6, 0.65), (2.0, 1.75, 1.8)])
def test_what_another_order_makes_of_the_band(order: float, least: float, most: float) -> None:
    """Without scatter: an error of first order is 1.6 times its band, of second 0.56 times."""
    band = least_squares(7.0 + 0.3 * SIZES**order, SIZES).band
    assert least < band / 0.3 < most


def test_bands_of_curves_are_those_of_every_instant() -> None:
    curves = np.random.default_rng(5).standard_normal((5, 7, 2))
    limit, deviation, band = bands(curves, SIZES)
    one = least_squares(curves[:, 3, 1], SIZES)
    assert (limit[3, 1], deviation[3, 1], band[3, 1]) == pytest.approx(
        (one.extrapolated, one.deviation, one.band)
    )


def test_two_meshes_that_agree_by_chance_do_not_make_the_band_vanish() -> None:
    values = 100.0 + np.array([0.3, 0.3, 0.9, 0.6, 1.6])
    assert least_squares(values, SIZES).band > 0.3


def test_equal_values_have_no_band() -> None:
    assert least_squares(np.zeros(5), SIZES).band == 0.0


def test_fewer_than_four_meshes_are_refused() -> None:
    with pytest.raises(ValueError, match="at least 4"):
        least_squares(np.zeros(3), SIZES[:3])


@pytest.mark.parametrize(("order", "scatter_order"), [(1.5, 2.0), (2.0, 0.0), (2.0, 2.0)])
def test_band_holds_the_limit_of_perturbed_sequences(order: float, scatter_order: float) -> None:
    """With scatter a third as large as the error: 95 of 100 bands hold and are no barn doors."""
    random = np.random.default_rng(11)
    covered, widths = 0, []
    for _ in range(400):
        values = 0.3 * SIZES**order + 0.1 * SIZES**scatter_order * random.standard_normal(5)
        estimate = least_squares(values, SIZES)
        covered += abs(values[0]) <= estimate.band
        widths.append(estimate.band)
    assert covered >= 0.95 * 400
    assert np.median(widths) < 3.5 * 0.3


def test_bands_shrink_with_the_mesh() -> None:
    """Over one step of refinement they rarely grow, and never double."""
    random = np.random.default_rng(12)
    grown = []
    for _ in range(400):
        sizes = 0.84 ** -np.arange(6.0)
        values = 0.3 * sizes**1.5 + 0.05 * sizes**2 * random.standard_normal(6)
        fine, coarse = (least_squares(values[k : k + 5], sizes[k : k + 5]) for k in (0, 1))
        grown.append(fine.band / coarse.band)
    assert np.mean(np.array(grown) > 1.0) < 0.2
    assert max(grown) < 2.0
