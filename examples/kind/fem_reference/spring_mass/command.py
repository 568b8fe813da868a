"""The commands of ``fem_reference`` for scenes of kind spring-mass."""

from __future__ import annotations

import argparse
from typing import Any

from ..common.decode import decode
from ..common.settings import Options
from ..impact.command import solve_scene


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    from .scene import SpringScene

    scene = decode(SpringScene, document)

    def made(_: Any) -> Any:
        from .solve import solver

        return solver(scene)

    solve_scene(arguments, Options.of(arguments), made)


COMMANDS = {"solve": _solve}
