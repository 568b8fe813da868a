"""What the commands of every kind of scene do."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from ..common.errors import SceneError, SolverError
from ..common.processes import in_processes
from ..common.settings import Options

if TYPE_CHECKING:
    from .result import ImpactSolver


def solve_scene(
    arguments: argparse.Namespace, options: Options, solver: Callable[[Any], ImpactSolver[Any]]
) -> None:
    """``solve``: the scene on a series of meshes, in so many processes.

    Args:
        arguments: of the command line.
        options: what the user asks for.
        solver: how the scene is solved, from the communicator of the processes.

    Raises:
        RunError: see `result.solve`.
    """

    def work(comm: Any) -> None:
        from .result import solve

        solve(solver(comm), arguments.out, arguments.resolution, comm, options)

    in_processes(arguments, work)


def require_one_process(relaxing: Iterable[str], processes: int) -> None:
    """Refuse several processes for bodies that relax, in solid geometry.

    Raises:
        SceneError: naming the first of them.
    """
    for body in relaxing:
        if processes > 1:
            raise SceneError(
                f"{body}.material.relaxation is given; solid geometry relaxes in one process, "
                f"--np is {processes}; it must be 1"
            )


def require_count(count: int) -> None:
    """A number of modes.

    Raises:
        SolverError: it is not positive.
    """
    if count < 1:
        raise SolverError(f"--count is {count}; it must be at least 1")


def print_modes(scene: str, modes: list[dict[str, Any]], **more: Any) -> None:
    """``modes``: the answer for the scene of this name."""
    answer = {"schema_version": 1, "scene": scene, "modes": modes, **more}
    print(json.dumps(answer, indent=2))
