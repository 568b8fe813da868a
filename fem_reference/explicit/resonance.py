"""Runs with sub-cycling, made again without it where their levels resonated."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TypeVar

from ..common.errors import DivergedError
from .levels import MOST_LEVELS

LARGEST_ENERGY_RESIDUAL = 1e-5
"""Of a run with sub-cycling; beyond it levels have resonated, and the run is made without them."""

T = TypeVar("T")


def stable_run(attempt: Callable[[int], T], account: Callable[[T], tuple[int, float]]) -> T:
    """A run with sub-cycling, or without where that diverges or its ledger cannot be read.

    Args:
        attempt: makes a run with at most so many levels.
        account: number of levels of a run, and the energy its ledger misses over the initial one.
    """
    try:
        run = attempt(MOST_LEVELS)
    except DivergedError as error:
        failed = str(error)
    else:
        levels, residual = account(run)
        if levels == 1 or residual <= LARGEST_ENERGY_RESIDUAL:
            return run
        failed = (
            f"energy residual {residual:.2g} with sub-cycling, "
            f"{LARGEST_ENERGY_RESIDUAL:g} is allowed"
        )
    print(f"{failed}; stepping again without sub-cycling", file=sys.stderr)
    return attempt(1)
