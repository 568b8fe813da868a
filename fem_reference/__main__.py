"""Command line: ``solve``, ``modes``, ``mesh``, ``versions`` and studies."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
import traceback
from pathlib import Path

from .common.cache import use_writable_cache
from .common.errors import RunError, SceneError, SolverError
from .common.parent import EndedBySignalError, end_by_signal, end_with_parent
from .common.progress import Progress
from .common.reader import read_document
from .common.settings import SOLVERS
from .kinds import commands_of

RESOLUTION_NAMES = ("coarse", "paper", "fine")


def _times(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of seconds like 1e-5,2e-5"
        ) from None


def _whole(text: str, least: int, most: int) -> int:
    if not text.isdecimal() or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from {least} to {most}")
    return int(text)


def _count(text: str) -> int:
    return _whole(text, 0, 100_000)


def _dofs(text: str) -> int:
    return _whole(text, 1, 10_000_000)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="fem_reference", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    solve = commands.add_parser("solve", help="solve a scene, write a result folder")
    solve.add_argument("--scene", type=Path, required=True, help="scene.json")
    solve.add_argument("--out", type=Path, required=True, help="result folder, made when complete")
    solve.add_argument(
        "--replace", action="store_true", help="even if OUT holds a solution of another scene"
    )
    solve.add_argument("--resolution", choices=RESOLUTION_NAMES, default="paper")
    solve.add_argument(
        "--solver", choices=SOLVERS, default=SOLVERS[0], help="calculix: ccx, plate impacts only"
    )
    solve.add_argument("--stress-at", type=_times, default=(), metavar="T1,T2", help="seconds")
    solve.add_argument(
        "--courant", type=float, default=0.9, help="time step over the critical one (0.9)"
    )
    solve.add_argument(
        "--target-error",
        type=float,
        metavar="X",
        help="refine until the relative 95 %% band of efficiency and force peaks is at most this",
    )
    solve.add_argument(
        "--fields", type=_count, default=0, metavar="N", help="fields at N or more instants"
    )
    solve.add_argument("--np", type=_count, default=1, metavar="N", help="processes (solid only)")
    solve.add_argument(
        "--threads",
        type=_count,
        default=0,
        metavar="N",
        help="cores the time loop uses, all processes together (0: those there are)",
    )
    solve.add_argument(
        "--checkpoint", type=Path, metavar="DIR", help="states of a solid run, to go on from"
    )
    solve.add_argument(
        "--checkpoint-interval", type=float, default=60.0, metavar="S", help="seconds (60)"
    )
    modes = commands.add_parser("modes", help="eigenfrequencies of a plate or a seal seat")
    modes.add_argument("--scene", type=Path, required=True)
    modes.add_argument("--count", type=int, default=8)
    modes.add_argument("--mesh", type=Path, metavar="FILE", help=".vtu, of a seal seat only")
    modes.add_argument(
        "--wet", action="store_true", help="also in the scene's fluid, by potential flow (plates)"
    )
    bands = commands.add_parser("bands", help="bands of middling meshes against a finer one")
    bands.add_argument("--scene", type=Path, nargs="+", default=[], help="or provenance.json")
    bands.add_argument("--random", type=_count, default=0, metavar="N", help="or N random scenes")
    bands.add_argument(
        "--out", type=Path, required=True, help="folder of what is solved, and of bands.md"
    )
    cost = commands.add_parser("cost", help="cost against error over meshes, limits of the machine")
    cost.add_argument("--scene", type=Path, required=True, help="or provenance.json")
    cost.add_argument("--out", type=Path, required=True, help="JSON; a figure .svg beside it")
    speed = commands.add_parser("speed", help="of the 3D loop on threads and processes")
    speed.add_argument("--scene", type=Path, required=True, help="of solid geometry")
    speed.add_argument("--out", type=Path, required=True, help="JSON; a table .md beside it")
    speed.add_argument(
        "--dofs", type=_dofs, nargs="+", default=(), metavar="N", help="by default three sizes"
    )
    yielding = commands.add_parser("yielding", help="a yielding sphere on a rigid wall")
    yielding.add_argument("--out", type=Path, required=True, help="Markdown")
    flights = commands.add_parser("flights", help="flights and shocks of the sphere by MuJoCo")
    flights.add_argument("--out", type=Path, required=True, help="JSON")
    flights.add_argument("--number", type=_count, default=500, metavar="N", help="flights (500)")
    rebound = commands.add_parser("rebound", help="balls that rebound from glass, as measured")
    rebound.add_argument("--out", type=Path, required=True, help="Markdown")
    mesh = commands.add_parser("mesh", help="mesh of a seal seat as .vtu, a .json beside it")
    mesh.add_argument("--scene", type=Path, required=True, help="scene.json of kind seal-seat")
    mesh.add_argument("--out", type=Path, required=True, help="FILE.vtu")
    mesh.add_argument("--resolution", choices=RESOLUTION_NAMES, default="paper")
    mesh.add_argument(
        "--size-factor", type=float, default=1.0, metavar="X", help="X times as large elements"
    )
    commands.add_parser("versions", help="versions of everything a result depends on")
    return parser


def _run(arguments: argparse.Namespace) -> None:
    # Only `versions` must work without the finite-element modules: import late.
    if arguments.command == "versions":
        from .common.versions import installed

        print(json.dumps(installed(), indent=2))
        return
    use_writable_cache()
    try:
        if arguments.command == "bands":
            from .studies.bands import report

            report(arguments.scene, arguments.random, arguments.out, Progress())
            return
        if arguments.command == "cost":
            from .studies.cost import report_cost

            report_cost(arguments.scene, arguments.out)
            return
        if arguments.command == "speed":
            from .studies.speed import SIZES, report_speed

            report_speed(arguments.scene, tuple(arguments.dofs) or SIZES, arguments.out)
            return
        if arguments.command == "rebound":
            from .studies.rebound import report_rebound

            report_rebound(arguments.out, Progress())
            return
        if arguments.command == "flights":
            try:
                from .flight.cases import report_flights
            except ImportError as error:
                message = (
                    f"{error}; install it by `make setup` and run target/python-tools/bin/python"
                )
                raise SolverError(f"a Python module is missing: {message}") from error
            report_flights(arguments.out, arguments.number, Progress())
            return
        if arguments.command == "yielding":
            from .studies.yielding import report_yielding

            report_yielding(arguments.out, Progress())
            return
        document = read_document(arguments.scene)
        commands = commands_of(document)
        if arguments.command not in commands:
            name = document["kind"]
            raise SceneError(f"{arguments.command} is not for scenes of kind {name!r}")
        if arguments.command == "solve":
            from .common.output import require_replaceable

            require_replaceable(arguments.out, document, arguments.replace)
        commands[arguments.command](document, arguments)
    except ImportError as error:
        raise SolverError(
            f"a Python module is missing: {error}; `impactcheck doctor` says what installs it"
        ) from error


def _unexpected(error: Exception) -> str:
    """A sentence with the place in this package; the traceback follows on standard error."""
    here = [f for f in traceback.extract_tb(error.__traceback__) if "fem_reference" in f.filename]
    place = f"{Path(here[-1].filename).name}, line {here[-1].lineno}" if here else "start"
    return f"unexpected {type(error).__name__} ({place}): {error}"


def main() -> int:
    """Run; returns the exit status."""
    end_with_parent()
    end_by_signal()
    arguments = _parser().parse_args()
    # FFCx and its compiler driver log through the root logger.
    logging.disable(logging.WARNING)
    try:
        _run(arguments)
    except RunError as error:
        return _failed(arguments, error)
    except MemoryError as error:
        return _failed(arguments, SolverError(f"the memory is used up: {error or 'no more left'}"))
    except EndedBySignalError as ended:
        # as the signal would have ended it
        os.kill(os.getpid(), ended.args[0])
    except Exception as error:
        if arguments.command == "solve":
            Progress().error(_unexpected(error))
        raise
    return 0


def _failed(arguments: argparse.Namespace, error: RunError) -> int:
    """Say why a command failed; the exit status."""
    if arguments.command == "solve":
        Progress().error(str(error))
    print(f"error: {error}", file=sys.stderr)
    return error.exit_status


if __name__ == "__main__":
    sys.exit(main())
