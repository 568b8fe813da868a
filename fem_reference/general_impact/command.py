"""The commands of ``fem_reference`` for scenes of kind impact, and ``groups``."""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path
from typing import Any

from ..common.arguments import Study, count
from ..common.errors import SceneError, SolverError
from ..common.progress import Progress
from ..common.settings import Options
from ..impact.command import solve_scene

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

    if release_of(gmsh.__version__) < LEAST_GMSH:
        raise SolverError(
            f"gmsh is {gmsh.__version__}; a body from a file needs 4.12 or later: pip install gmsh"
        )


def _mesh(document: Any, arguments: argparse.Namespace) -> None:
    require_gmsh()
    from ..body.mesh_file import write_body_mesh
    from ..body.scene import parse_body_scene

    write_body_mesh(arguments.out, parse_body_scene(document), arguments.size_factor)
    print(json.dumps({"mesh": str(arguments.out)}))


def require_content(file: Path | None, content: str) -> None:
    """Refuse a file that is not the scene's.

    Raises:
        SceneError: it is not named, cannot be read, or has another content.
    """
    if file is None:
        raise SceneError("the scene has a body: --body FILE must name the file of its shape")
    try:
        with file.open("rb") as stream:
            found = hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise SceneError(f"--body {file} cannot be read: {error}") from error
    if found != content:
        raise SceneError(
            f"--body {file} has the SHA-256 {found}, the scene's body.content is {content}: it is "
            "another file, or it has changed"
        )


def _solve(document: Any, arguments: argparse.Namespace) -> None:
    from .scene import parse_scene

    scene, options = parse_scene(document), Options.of(arguments)
    if scene.body is not None:
        require_gmsh()
        require_content(arguments.body, scene.body.content)

    def made(comm: Any) -> Any:
        from .result import solver

        return solver(scene, arguments.body, comm, options)

    solve_scene(arguments, options, made)


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
    from ..body.mesh_file import groups_of

    text = json.dumps(groups_of(arguments.file, arguments.unit), allow_nan=False)
    if arguments.out:
        arguments.out.write_text(text, encoding="utf-8")
    else:
        print(text)


def _of_bands(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--random", type=count, default=8, metavar="N", help="random bodies")
    parser.add_argument(
        "--out", type=Path, required=True, help="folder of what is solved, and of body-bands.md"
    )


def _bands(arguments: argparse.Namespace) -> None:
    from .body_bands import report

    report(arguments.random, arguments.out, Progress())


COMMANDS = {"solve": _solve, "mesh": _mesh}
STUDIES = {
    "groups": Study(
        "named groups, size and unit of a CAD part or a mesh", _groups_arguments, _groups
    ),
    "body-bands": Study(
        "bands of random boxes and brackets compared with a finer mesh", _of_bands, _bands
    ),
}
