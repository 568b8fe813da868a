"""Discretisation uncertainty of a solution from a second, coarser one.

Roache's grid convergence index for two systematically refined meshes (J. Fluids Eng. 116
(1994) 405): U = F |f1 - f2| / (r^p - 1), with the safety factor F = 3 that he asks for when
only two meshes are used, taken as a 95 % bound. The order p is not measured by two meshes.
"""

from __future__ import annotations

import math

SAFETY_FACTOR = 3.0
ASSUMED_ORDER = 2.0
"""Formal order of bilinear elements and central differences."""


def two_grid_uncertainty(fine: float, coarse: float, ratio: float) -> float:
    """Absolute 95 % bound of the discretisation error of ``fine``; ratio of element sizes > 1."""
    return SAFETY_FACTOR * abs(fine - coarse) / (math.pow(ratio, ASSUMED_ORDER) - 1.0)
