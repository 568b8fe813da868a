"""Command line: ``solve``, ``modes``, ``mesh``, ``versions`` and studies."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
import traceback
from pathlib import Path

from .common.arguments import count, instants
from .common.cache import use_writable_cache
from .common.decode import read_document
from .common.errors import RunError, SceneError, SolverError
from .common.parent import EndedBySignalError, end_by_signal, end_with_parent
from .common.progress import Progress
from .common.settings import SOLVERS
from .flight import FLIGHTS
from .kinds import commands_of, studies
from .records.command import COLUMNS
from .units.command import UNIT

RESOLUTION_NAMES = ("coarse", "paper", "fine")
STUDIES = {**studies(), "flights": FLIGHTS, "columns": COLUMNS, "unit": UNIT}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="fem_reference", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    solve = commands.add_parser("solve", help="solve a scene, write a result folder")
    solve.add_argument("--scene", type=Path, required=True, help="scene.json")
    solve.add_argument("--out", type=Path, required=True, help="result folder, made when complete")
    solve.add_argument(
        "--replace", action="store_true", help="even if OUT holds a solution of another scene"
    )
    solve.add_argument("--body", type=Path, metavar="FILE", help="shape of the scene's body")
    solve.add_argument("--resolution", choices=RESOLUTION_NAMES, default="paper")
    solve.add_argument(
        "--solver",
        choices=SOLVERS,
        default=SOLVERS[0],
        help="calculix: ccx, where the kind of scene has it",
    )
    solve.add_argument("--stress-at", type=instants, default=(), metavar="T1,T2", help="seconds")
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
        "--fields", type=count, default=0, metavar="N", help="fields at N or more instants"
    )
    solve.add_argument("--np", type=count, default=1, metavar="N", help="processes (solid only)")
    solve.add_argument(
        "--threads",
        type=count,
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
    modes = commands.add_parser("modes", help="eigenfrequencies of a scene's body")
    modes.add_argument("--scene", type=Path, required=True)
    modes.add_argument("--count", type=int, default=8)
    modes.add_argument(
        "--mesh", type=Path, metavar="FILE", help=".vtu, where the kind of scene reads one"
    )
    modes.add_argument(
        "--wet", action="store_true", help="also in the scene's fluid, by potential flow"
    )
    mesh = commands.add_parser("mesh", help="mesh of a scene's body as .vtu, and .json about it")
    mesh.add_argument("--scene", type=Path, required=True, help="scene.json")
    mesh.add_argument("--out", type=Path, required=True, help="FILE.vtu")
    mesh.add_argument("--resolution", choices=RESOLUTION_NAMES, default="paper")
    mesh.add_argument(
        "--size-factor", type=float, default=1.0, metavar="X", help="X times as large elements"
    )
    for name, study in STUDIES.items():
        study.arguments(commands.add_parser(name, help=study.help))
    versions = commands.add_parser("versions", help="versions of everything a result depends on")
    versions.add_argument("modules", nargs="*", help="of these modules alone, which is faster")
    return parser


def _run(arguments: argparse.Namespace) -> None:
    # Only `versions` must work without the finite-element modules: import late.
    if arguments.command == "versions":
        from .common.versions import installed, of_modules

        modules = arguments.modules
        print(json.dumps(of_modules(modules) if modules else installed(), indent=2))
        return
    use_writable_cache()
    try:
        if arguments.command in STUDIES:
            STUDIES[arguments.command].run(arguments)
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
    if arguments.command in ("solve", "mesh"):
        Progress().error(str(error))
    print(f"error: {error}", file=sys.stderr)
    return error.exit_status


if __name__ == "__main__":
    sys.exit(main())
