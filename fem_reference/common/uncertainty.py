"""Discretisation uncertainty of a solution from systematically refined meshes.

Two rules. `grid_convergence_index` is the three-mesh procedure of Celik et al. (2008, J. Fluids
Eng. 130, 078001); it presumes smooth, monotonic convergence. Force peaks scatter by about 0.1 %
with the position of the contact's edge between the nodes, and two meshes may agree by chance.
`least_squares` is the rule of Eca & Hoekstra (2014, J. Comput. Phys. 262, 104) for such data: an
expansion is fitted to four meshes or more, and the scatter about the fit enters the band.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

Floats = NDArray[np.float64]

SAFETY_FACTOR = 1.25
LOWEST_ORDER, HIGHEST_ORDER = 1.0, 2.0
"""Orders possible. Bilinear elements converge with second order; where the stress is singular like
1/sqrt(distance), as under the edge of contact, quantities that are quadratic in the error of the
stress converge with first order (twice 1/2: Strang & Fix, An Analysis of the Finite Element
Method, chapter 8). An order observed outside is scatter."""


@dataclass(frozen=True)
class GridConvergence:
    """Result of the three-mesh procedure."""

    order: float
    extrapolated: float
    relative_index: float
    """GCI of the finest mesh over its value, with the safety factor 1.25."""


def grid_convergence_index(
    values: tuple[float, float, float], r21: float, r32: float
) -> GridConvergence:
    """Celik's grid convergence index.

    Args:
        values: on the fine, middle and coarse mesh.
        r21: element size of the middle mesh over the fine one's, > 1.
        r32: the same for coarse and middle.

    Raises:
        ValueError: no order can be found: two values agree, or the differences do not shrink.
    """
    e21, e32 = values[1] - values[0], values[2] - values[1]
    if e21 == 0.0 or e32 == 0.0:
        raise ValueError("two of the three values agree: no order can be observed")
    sign = math.copysign(1.0, e32 / e21)
    ratio = abs(e32 / e21)

    def miss(p: float) -> float:
        q = math.log((r21**p - sign) / (r32**p - sign))
        return p - abs(math.log(ratio) + q) / math.log(r21)

    # The published iteration is a fixed point; bracketed, it cannot run away.
    grid = np.linspace(0.02, 20.0, 1000)
    signs = np.sign([miss(p) for p in grid])
    change = np.flatnonzero(signs[1:] != signs[:-1])
    if change.size == 0:
        raise ValueError("the differences of the three values do not shrink: no order is observed")
    at = int(change[0])
    order = float(brentq(miss, grid[at], grid[at + 1]))
    growth = r21**order
    extrapolated = (growth * values[0] - values[1]) / (growth - 1.0)
    index = SAFETY_FACTOR * abs(e21 / values[0]) / (growth - 1.0)
    return GridConvergence(order, extrapolated, index)


@dataclass(frozen=True)
class Estimate:
    """A quantity on the finest mesh, and what the sequence says about its error."""

    order: float | None
    """Observed order; None: not between the orders possible, the nearer of them was fitted."""
    extrapolated: float
    """Value at vanishing element size."""
    scatter: float
    """Standard deviation of the meshes about the fit."""
    band: float
    """Half width of the 95 % band about the finest mesh's value."""


def least_squares(values: Floats, sizes: Floats) -> Estimate:
    """Error estimate and 95 % band of the value on the finest mesh.

    phi_0 + alpha h^p is fitted with weights 1 and 1/h, p between `LOWEST_ORDER` and
    `HIGHEST_ORDER`; the fit of smaller scatter counts. With s the scatter and D the mean step
    between values, the band is 1.25 |fit - phi_0| + s + |phi_1 - fit|, and
    3 s/D (|fit - phi_0| + s + |phi_1 - fit|) if s exceeds D: nothing is known then but the scatter.

    (The published rule takes orders down to 1/2 and, above 2, fixed second order with a factor of 3
    in place of 1.25.)

    Args:
        values: (n,) finest mesh first, n >= 4.
        sizes: (n,) element sizes, in any unit.
    """
    if values.size < 4:
        raise ValueError(f"{values.size} meshes; least squares need at least 4")
    h = sizes / sizes[0]
    spread = float(np.ptp(values))
    if spread == 0.0:
        return Estimate(None, float(values[0]), 0.0, 0.0)

    def fit(p: float, weights: Floats) -> tuple[float, Floats]:
        matrix = np.stack([np.ones_like(h), h**p], axis=1)
        root = np.sqrt(weights)
        coefficients = np.linalg.lstsq(matrix * root[:, None], values * root, rcond=None)[0]
        misses = values - matrix @ coefficients
        # Three parameters: the order is one of them.
        deviation = math.sqrt(h.size * float(weights @ misses**2) / (h.size - 3))
        return deviation, coefficients

    candidates = []
    for weights in (np.full(h.size, 1.0 / h.size), (1.0 / h) / np.sum(1.0 / h)):
        inside = minimize_scalar(
            lambda p, w=weights: fit(p, w)[0],
            bounds=(LOWEST_ORDER, HIGHEST_ORDER),
            method="bounded",
            options={"xatol": 1e-8},
        )
        for order in (LOWEST_ORDER, float(inside.x), HIGHEST_ORDER):
            deviation, coefficients = fit(order, weights)
            candidates.append((deviation, order, coefficients))
    deviation, order, coefficients = min(candidates, key=lambda c: c[0])
    at_bound = min(order - LOWEST_ORDER, HIGHEST_ORDER - order) < 1e-6
    error = abs(float(coefficients[1]))
    miss = abs(float(values[0] - coefficients.sum()))
    step = spread / (values.size - 1)
    if deviation < step:
        band = SAFETY_FACTOR * error + deviation + miss
    else:
        band = 3.0 * deviation / step * (error + deviation + miss)
    return Estimate(None if at_bound else order, float(coefficients[0]), deviation, band)


def curve_band(curves: Floats, sizes: Floats, reach: int) -> Floats:
    """(m,) half width of a band about a curve, from the same curve on coarser meshes.

    The difference to each coarser mesh, over the growth of the element size less one (first
    order, the lowest seen), estimates the error; the largest of the meshes at least 1.3 times as
    coarse counts, times 1.25. Curves cross, which would let the band vanish at some instants: it
    is the largest value within ``reach`` samples to either side.

    Args:
        curves: (n, m) finest mesh first, on common instants.
        sizes: (n,) element sizes.
        reach: samples.
    """
    growth = sizes / sizes[0]
    coarse = growth > 1.3
    errors = np.abs(curves[coarse] - curves[0]) / (growth[coarse] - 1.0)[:, None]
    band = SAFETY_FACTOR * errors.max(axis=0)
    padded = np.pad(band, reach, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    return np.asarray(windows.max(axis=1))
