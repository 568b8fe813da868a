"""The commands of ``fem_reference`` for scenes of kind seal-seat."""

from __future__ import annotations

import argparse
import json
from typing import Any

from ..errors import SceneError, SolverError
from .scene import SeatScene, parse_seat_scene


def run(document: Any, arguments: argparse.Namespace) -> None:
    """Run a command for a decoded ``scene.json``.

    Raises:
        SceneError: the scene is not valid, or the command is not for this kind.
        RunError: the command failed.
    """
    scene = parse_seat_scene(document)
    if arguments.command == "mesh":
        from .mesh_file import write_seat_mesh

        write_seat_mesh(arguments.out, scene, arguments.resolution, arguments.size_factor)
        print(json.dumps({"mesh": str(arguments.out)}))
        return
    if arguments.command == "solve":
        _solve(scene, arguments)
        return
    if arguments.command == "modes":
        _modes(scene, arguments)
        return
    raise SceneError(f"{arguments.command} is not for scenes of kind 'seal-seat'")


def _modes(scene: SeatScene, arguments: argparse.Namespace) -> None:
    from .mesh_file import check_geometry
    from .meshing import seat_mesh
    from .modal import read_mesh, seat_modes

    if arguments.count < 1:
        raise SolverError(f"--count is {arguments.count}; it must be at least 1")
    if arguments.mesh:
        check_geometry(arguments.mesh, scene)
    mesh = read_mesh(arguments.mesh) if arguments.mesh else seat_mesh(scene)
    found = [{"frequency": float(f)} for f in seat_modes(scene, mesh, arguments.count)]
    print(json.dumps({"schema_version": 1, "scene": scene.name, "modes": found}, indent=2))


def _solve(scene: SeatScene, arguments: argparse.Namespace) -> None:
    from ..solid.command import in_processes

    def work(comm: Any) -> None:
        from ..solid.series import Options
        from .result import solve

        solve(scene, arguments.out, arguments.resolution, comm, Options.of(arguments))

    in_processes(arguments, work)
