"""Flights of the sphere after the impact by MuJoCo, a program of rigid bodies by others.

Compared with the reduced flight: another chamber (thin boxes), another contact (a damped spring,
hard and short), another time integration (small fixed steps). Nothing here is shared with it.

Units are mm, ms and g, in which forces are N: in SI the chamber's numbers are too small for
MuJoCo's own thresholds.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ..common.arguments import Study, count
from ..common.errors import SolverError
from ..common.progress import Progress


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, required=True, help="JSON")
    parser.add_argument("--number", type=count, default=500, metavar="N", help="flights (500)")


def _flights(arguments: argparse.Namespace) -> None:
    try:
        from .cases import report_flights
    except ImportError as error:
        message = f"{error}; install it by `make setup` and run target/python-tools/bin/python"
        raise SolverError(f"a Python module is missing: {message}") from error
    report_flights(arguments.out, arguments.number, Progress())


FLIGHTS = Study("flights and shocks of the sphere by MuJoCo", _arguments, _flights)
