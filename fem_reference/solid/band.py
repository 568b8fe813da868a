"""Discretisation uncertainty from three systematically refined meshes.

Grid convergence index (Celik et al. 2008, J. Fluids Eng. 130, 078001) with the factors of safety of
Roache: 1.25 where the three meshes converge monotonically with an order near the expected one,
otherwise 3 with the expected order and the larger of the two changes.
"""

from __future__ import annotations

import math

EXPECTED_ORDER = 1.5
"""The displacement's gradient has a square-root singularity at the edge of contact."""
LEAST_ORDER, LARGEST_ORDER = 0.75, 3.0


def observed_order(fine: float, medium: float, coarse: float, ratio: float) -> float | None:
    """Order of convergence for one ratio of element sizes; None unless monotone."""
    first, second = medium - fine, coarse - medium
    if first == 0.0 or second / first <= 1.0:
        return None
    return math.log(second / first) / math.log(ratio)


def band(fine: float, medium: float, coarse: float, ratio: float) -> float:
    """Absolute 95 % bound of the discretisation error of ``fine``; ratio of element sizes > 1."""
    order = observed_order(fine, medium, coarse, ratio)
    if order is not None and LEAST_ORDER <= order <= LARGEST_ORDER:
        return 1.25 * abs(medium - fine) / (math.pow(ratio, min(order, 2.0)) - 1.0)
    growth = math.pow(ratio, EXPECTED_ORDER)
    change = max(abs(medium - fine), abs(coarse - medium) / growth)
    return 3.0 * change / (growth - 1.0)
