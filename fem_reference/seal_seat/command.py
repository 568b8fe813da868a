"""The commands of ``fem_reference`` for scenes of kind seal-seat."""

from __future__ import annotations

import argparse
import json
from typing import Any

from ..common.errors import SceneError
from ..common.settings import SOLVERS, Options
from ..impact.command import print_modes, require_count, require_one_process, solve_scene


def _mesh(document: Any, arguments: argparse.Namespace) -> None:
    from .mesh_file import write_seat_mesh
    from .scene import parse_seat_scene

    scene = parse_seat_scene(document)
    write_seat_mesh(arguments.out, scene, arguments.resolution, arguments.size_factor)
    print(json.dumps({"mesh": str(arguments.out)}))


def _modes(document: Any, arguments: argparse.Namespace) -> None:
    from .mesh_file import check_geometry
    from .meshing import seat_mesh
    from .modal import read_mesh, seat_modes
    from .scene import parse_seat_scene

    scene = parse_seat_scene(document)
    require_count(arguments.count)
    if arguments.mesh:
        check_geometry(arguments.mesh, scene)
    mesh = read_mesh(arguments.mesh) if arguments.mesh else seat_mesh(scene)
    found = seat_modes(scene, mesh, arguments.count)
    print_modes(scene.name, [{"frequency": float(frequency)} for frequency in found])


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    from .scene import parse_seat_scene

    scene, options = parse_seat_scene(document), Options.of(arguments)
    if options.solver != SOLVERS[0]:
        raise SceneError(f"--solver is {options.solver}; of a seal seat it must be {SOLVERS[0]}")
    require_one_process(["seat"] if scene.seat.material.relaxation else [], arguments.np)

    def made(comm: Any) -> Any:
        from .result import solver

        return solver(scene, comm)

    solve_scene(arguments, options, made)


COMMANDS = {"solve": _solve, "modes": _modes, "mesh": _mesh}
