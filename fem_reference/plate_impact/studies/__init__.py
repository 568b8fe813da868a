"""Studies of plate impacts: cost and speed of the method, truth of its bands, what is known."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...common.arguments import Study, count, whole
from ...common.progress import Progress


def _dofs(text: str) -> int:
    return whole(text, 1, 10_000_000)


def _of_bands(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scene", type=Path, nargs="+", default=[], help="or provenance.json")
    parser.add_argument("--random", type=count, default=0, metavar="N", help="or N random scenes")
    parser.add_argument(
        "--out", type=Path, required=True, help="folder of what is solved, and of bands.md"
    )


def _bands(arguments: argparse.Namespace) -> None:
    from .bands import report

    report(arguments.scene, arguments.random, arguments.out, Progress())


def _of_cost(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scene", type=Path, required=True, help="or provenance.json")
    parser.add_argument("--out", type=Path, required=True, help="JSON")


def _cost(arguments: argparse.Namespace) -> None:
    from .cost import report_cost

    report_cost(arguments.scene, arguments.out)


def _of_speed(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scene", type=Path, required=True, help="of solid geometry")
    parser.add_argument("--out", type=Path, required=True, help="JSON; a table .md is added")
    parser.add_argument(
        "--dofs", type=_dofs, nargs="+", default=(), metavar="N", help="by default three sizes"
    )


def _speed(arguments: argparse.Namespace) -> None:
    from .speed import SIZES, report_speed

    report_speed(arguments.scene, tuple(arguments.dofs) or SIZES, arguments.out)


def _of_a_page(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, required=True, help="Markdown")


def _yielding(arguments: argparse.Namespace) -> None:
    from .yielding import report_yielding

    report_yielding(arguments.out, Progress())


def _rebound(arguments: argparse.Namespace) -> None:
    from .rebound import report_rebound

    report_rebound(arguments.out, Progress())


STUDIES = {
    "bands": Study("bands of middling meshes compared with a finer one", _of_bands, _bands),
    "cost": Study("cost over error on several meshes, limits of the machine", _of_cost, _cost),
    "speed": Study("speed of the 3D loop on threads and processes", _of_speed, _speed),
    "yielding": Study("a plastic sphere on a rigid wall", _of_a_page, _yielding),
    "rebound": Study("balls that rebound from glass, as measured", _of_a_page, _rebound),
}
"""By name."""
