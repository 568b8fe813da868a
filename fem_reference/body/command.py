"""The commands of ``fem_reference`` for scenes of kind impact, and ``groups``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from ..common.arguments import Study

LEAST_GMSH = (4, 12)
"""Oldest release of gmsh whose CAD kernel and Python interface bodies need."""


def release_of(version: str) -> tuple[int, ...]:
    """Major and minor number of a version."""
    return tuple(int(part) for part in version.split(".")[:2])


def require_gmsh() -> None:
    """Refuse a gmsh that is too old.

    Raises:
        SolverError: it is older than `LEAST_GMSH`.
    """
    import gmsh

    from ..common.errors import SolverError

    if release_of(gmsh.__version__) < LEAST_GMSH:
        raise SolverError(
            f"gmsh is {gmsh.__version__}; a body from a file needs 4.12 or later: pip install gmsh"
        )


def _mesh(document: Any, arguments: argparse.Namespace) -> None:
    require_gmsh()
    from .mesh_file import write_body_mesh
    from .scene import parse_body_scene

    write_body_mesh(arguments.out, parse_body_scene(document), arguments.size_factor)
    print(json.dumps({"mesh": str(arguments.out)}))


def _metres(text: str) -> float:
    units = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "cm": 1e-2, "in": 0.0254}
    try:
        value = units[text] if text in units else float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e3:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no unit; known are {', '.join(units)}, or metres per number of the file"
        )
    return value


def _groups_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="CAD part or mesh of a body")
    parser.add_argument("--out", type=Path, help="file to write instead of standard output")
    parser.add_argument("--unit", type=_metres, help="of the file's numbers: mm, m, um, in, 0.001")


def _groups(arguments: argparse.Namespace) -> None:
    require_gmsh()
    from .mesh_file import groups_of

    text = json.dumps(groups_of(arguments.file, arguments.unit), allow_nan=False)
    if arguments.out:
        arguments.out.write_text(text, encoding="utf-8")
    else:
        print(text)


COMMANDS = {"mesh": _mesh}
STUDIES = {
    "groups": Study(
        "named groups, size and unit of a CAD part or a mesh", _groups_arguments, _groups
    )
}
