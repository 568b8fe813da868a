"""The commands of ``fem_reference`` for scenes of kind plate-impact."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

from ..common.errors import SolverError
from ..common.settings import Options
from ..impact.command import print_modes, require_count, require_one_process, solve_scene
from .studies import STUDIES


def _modes(document: Any, arguments: argparse.Namespace) -> None:
    from ..axisymmetric.added_mass import wet_frequencies
    from ..axisymmetric.meshing import modal_plate_mesh
    from ..axisymmetric.modal import plate_modes
    from .scene import parse_scene

    scene = parse_scene(document)
    require_count(arguments.count)
    plate = scene.dry_plate
    mesh = modal_plate_mesh(plate)
    found = plate_modes(plate, mesh, arguments.count)
    modes = [{"frequency": mode.frequency, "longitudinal": mode.longitudinal} for mode in found]
    if not arguments.wet:
        print_modes(scene.name, modes)
        return
    if scene.fluid is None:
        raise SolverError("--wet asks for a plate in a fluid, but the scene has none: add [fluid]")
    wet = wet_frequencies(plate, mesh, arguments.count, scene.fluid.density)
    ratio = wet[0] / found[0].frequency
    answer = {"frequencies": wet.tolist(), "added_mass_frequency_ratio": ratio}
    print_modes(scene.name, modes, wet=answer)


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    from .scene import parse_scene

    scene, options = parse_scene(document), Options.of(arguments)
    if scene.geometry == "solid":
        require_one_process(scene.relaxing, arguments.np)
    else:
        if arguments.np > 1:
            raise SolverError(
                f"--np is {arguments.np}; an axisymmetric reference runs as one process"
            )
        from .estimate import field_times

        options = replace(options, frame_times=field_times(scene, options.frames), frames=0)

    def made(comm: Any) -> Any:
        from .result import solver

        return solver(scene, comm, options)

    solve_scene(arguments, options, made)


COMMANDS = {"solve": _solve, "modes": _modes}

__all__ = ["COMMANDS", "STUDIES"]
