"""The commands of ``fem_reference`` for scenes of kind seal-seat."""

from __future__ import annotations

import argparse
import json
from typing import Any

from ..common.errors import SceneError, SolverError
from .scene import parse_seat_scene


def _mesh(document: Any, arguments: argparse.Namespace) -> None:
    from .mesh_file import write_seat_mesh

    scene = parse_seat_scene(document)
    write_seat_mesh(arguments.out, scene, arguments.resolution, arguments.size_factor)
    print(json.dumps({"mesh": str(arguments.out)}))


def _modes(document: Any, arguments: argparse.Namespace) -> None:
    from .mesh_file import check_geometry
    from .meshing import seat_mesh
    from .modal import read_mesh, seat_modes

    scene = parse_seat_scene(document)
    if arguments.count < 1:
        raise SolverError(f"--count is {arguments.count}; it must be at least 1")
    if arguments.mesh:
        check_geometry(arguments.mesh, scene)
    mesh = read_mesh(arguments.mesh) if arguments.mesh else seat_mesh(scene)
    found = [{"frequency": float(f)} for f in seat_modes(scene, mesh, arguments.count)]
    print(json.dumps({"schema_version": 1, "scene": scene.name, "modes": found}, indent=2))


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    from ..common.processes import in_processes

    scene = parse_seat_scene(document)
    if arguments.np > 1 and scene.seat.material.relaxation:
        raise SceneError(
            "seat.material.relaxation is given; solid geometry relaxes in one process, "
            f"--np is {arguments.np}; it must be 1"
        )

    def work(comm: Any) -> None:
        from ..common.settings import SOLVERS, Options
        from .result import solve

        options = Options.of(arguments)
        if options.solver != SOLVERS[0]:
            raise SceneError("kind is 'seal-seat': --solver calculix has plate impacts only")
        solve(scene, arguments.out, arguments.resolution, comm, options)

    in_processes(arguments, work)


COMMANDS = {"solve": _solve, "modes": _modes, "mesh": _mesh}
