"""The commands of ``fem_reference`` for scenes of kind plate-impact."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from typing import Any

from ..common.errors import SceneError, SolverError
from ..common.processes import in_processes
from ..common.settings import Options
from .scene import parse_scene


def _modes(document: Any, arguments: argparse.Namespace) -> None:
    from ..axisymmetric.added_mass import wet_frequencies
    from ..axisymmetric.meshing import modal_plate_mesh
    from ..axisymmetric.modal import plate_modes

    scene = parse_scene(document)
    if arguments.count < 1:
        raise SolverError(f"--count is {arguments.count}; it must be at least 1")
    plate = scene.dry_plate
    mesh = modal_plate_mesh(plate)
    found = plate_modes(plate, mesh, arguments.count)
    modes = [{"frequency": mode.frequency, "longitudinal": mode.longitudinal} for mode in found]
    answer: dict[str, Any] = {"schema_version": 1, "scene": scene.name, "modes": modes}
    if arguments.wet:
        if scene.fluid is None:
            raise SolverError(
                "--wet asks for a plate in a fluid, but the scene has none: add [fluid]"
            )
        wet = wet_frequencies(plate, mesh, arguments.count, scene.fluid.density)
        answer["wet"] = {
            "frequencies": wet.tolist(),
            "added_mass_frequency_ratio": wet[0] / found[0].frequency,
        }
    print(json.dumps(answer, indent=2))


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    scene = parse_scene(document)
    options = Options.of(arguments)
    if scene.geometry == "solid":
        relaxing = scene.relaxing
        if arguments.np > 1 and relaxing:
            raise SceneError(
                f"{relaxing[0]}.material.relaxation is given; solid geometry relaxes in one "
                f"process, --np is {arguments.np}; it must be 1"
            )
    else:
        if arguments.np > 1:
            raise SolverError(
                f"--np is {arguments.np}; an axisymmetric reference runs as one process"
            )
        from .estimate import field_times

        options = replace(options, frame_times=field_times(scene, options.frames), frames=0)

    def work(comm: Any) -> None:
        from .result import solve

        solve(scene, arguments.out, arguments.resolution, comm, options)

    in_processes(arguments, work)


COMMANDS = {"solve": _solve, "modes": _modes}
