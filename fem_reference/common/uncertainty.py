"""Discretisation uncertainty of a solution from systematically refined meshes.

Two rules. `grid_convergence_index` is the three-mesh procedure of Celik et al. (2008, J. Fluids
Eng. 130, 078001); it presumes smooth, monotonic convergence. Force peaks scatter by about 0.1 %
with the position of the contact's edge between the nodes, and two meshes may agree by chance.
`least_squares` is for such data: as Eca & Hoekstra (2014, J. Comput. Phys. 262, 104) an expansion
is fitted to four meshes or more and the scatter about the fit enters the band, but of fixed order:
five meshes do not tell the order from the scatter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Floats = NDArray[np.float64]

SAFETY_FACTOR = 1.25
ORDER = 1.5
"""Bilinear elements converge with second order; where the stress is singular like
1/sqrt(distance), as under the edge of contact, quantities that are quadratic in the error of the
stress converge with first order (twice 1/2: Strang & Fix, An Analysis of the Finite Element
Method, chapter 8). This is the middle."""
SCATTER_ORDER = 2.0
"""Between nodes of distance h the edge of contact leaves the force uncertain by (h/a)^2."""
STANDARD_ERRORS = 2.5
"""In a band, besides the error fitted. Calibrated on random impacts and tried on others (the study
`bands`)."""


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

    extrapolated: float
    """Value at vanishing element size."""
    deviation: float
    """Standard deviation of the finest mesh about the fit."""
    band: float
    """Half width of the 95 % band about the finest mesh's value."""


def least_squares(values: Floats, sizes: Floats) -> Estimate:
    """Error estimate and 95 % band of one quantity; see `bands`, for values (n,)."""
    limit, deviation, band = bands(values, sizes)
    return Estimate(float(limit), float(deviation), float(band))


def bands(values: Floats, sizes: Floats, order: float = ORDER) -> tuple[Floats, Floats, Floats]:
    """Limits, scatters and half widths of the 95 % bands about the values on the finest mesh.

    phi_0 + alpha h^`order` is fitted by least squares, weighted for a scatter that grows like
    h^`SCATTER_ORDER`; the band is the distance to phi_0 and `STANDARD_ERRORS` of phi_0.

    Args:
        values: (n, ...) finest mesh first, n >= 4: of a quantity, or of curves on common instants.
        sizes: (n,) element sizes, in any unit.
        order: of convergence.
    """
    count = sizes.size
    if count < 4:
        raise ValueError(f"{count} meshes; least squares need at least 4")
    h = sizes[:, None] / sizes[0]
    weights = h**-SCATTER_ORDER
    matrix = weights * np.hstack([np.ones_like(h), h**order])
    # Of the differences to the finest mesh: equal values have no band, not even round-off.
    differences = weights * (values - values[0]).reshape(count, -1)
    fitted = np.linalg.lstsq(matrix, differences, rcond=None)[0]
    misses = differences - matrix @ fitted
    deviation = np.sqrt(np.sum(misses**2, axis=0) / (count - 2))
    standard_error = deviation * math.sqrt(np.linalg.inv(matrix.T @ matrix)[0, 0])
    band = np.abs(fitted[0]) + STANDARD_ERRORS * standard_error
    shape = values.shape[1:]
    return values[0] + fitted[0].reshape(shape), deviation.reshape(shape), band.reshape(shape)
