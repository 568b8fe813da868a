"""The commands of ``fem_reference`` for scenes of kind plate-impact."""

from __future__ import annotations

import argparse
import json
from typing import Any

from ..common.errors import SolverError
from .scene import Scene, parse_scene


def _modes(document: Any, arguments: argparse.Namespace) -> None:
    from ..axisymmetric.meshing import modal_plate_mesh
    from ..axisymmetric.modal import plate_modes

    scene = parse_scene(document)
    if arguments.count < 1:
        raise SolverError(f"--count is {arguments.count}; it must be at least 1")
    found = plate_modes(scene.plate, modal_plate_mesh(scene.plate), arguments.count)
    modes = [{"frequency": mode.frequency, "longitudinal": mode.longitudinal} for mode in found]
    print(json.dumps({"schema_version": 1, "scene": scene.name, "modes": modes}, indent=2))


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    scene = parse_scene(document)
    if scene.geometry == "solid":
        _solve_solid(scene, arguments)
        return
    if arguments.np > 1:
        raise SolverError(f"--np is {arguments.np}; an axisymmetric reference runs as one process")
    from .axisymmetric_result import solve
    from .estimate import field_times

    solve(
        scene,
        arguments.out,
        arguments.resolution,
        courant=arguments.courant,
        stress_times=(*arguments.stress_at, *field_times(scene, arguments.fields)),
        target_error=arguments.target_error,
    )


def _solve_solid(scene: Scene, arguments: argparse.Namespace) -> None:
    from ..common.processes import in_processes

    def work(comm: Any) -> None:
        from ..common.series import Options
        from .solid_result import solve

        solve(scene, arguments.out, arguments.resolution, comm, Options.of(arguments))

    in_processes(arguments, work)


COMMANDS = {"solve": _solve, "modes": _modes}
