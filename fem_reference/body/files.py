"""Mesh files of other programs: gmsh's and MED by gmsh, VTK's by meshio, decks by readers here."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import meshio
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SceneError
from ..common.mesher import start_gmsh
from .abaqus import read_abaqus
from .cells import FACET_CORNERS, GMSH_NODES, GMSH_TYPES, SOLIDS
from .nastran import read_nastran
from .source import Group, MeshFile

CAD = (".step", ".stp", ".brep", ".iges", ".igs")
BY_GMSH = (".msh", ".med")
DECKS = {".inp": read_abaqus, ".bdf": read_nastran, ".nas": read_nastran, ".fem": read_nastran}
"""Formats that meshio reads only in part, or never ends to read."""
KNOWN = (*CAD, *BY_GMSH, *DECKS, ".vtu", ".vtk")
LARGEST = 2_000_000_000
"""Bytes of a file that is read."""
KINDS = {3: "volume", 2: "surface", 1: "curve", 0: "point"}
MOST_VALUES = 100
"""Distinct values of a cell array whose values are taken for groups."""


def checked(path: Path) -> str:
    """The suffix of a file that can be read.

    Raises:
        SceneError: it is missing, empty, too large, or of a format that is not known.
    """
    suffix = path.suffix.lower()
    if suffix not in KNOWN:
        raise SceneError(
            f"body.file {path.name} has the extension {suffix or 'none'!r}; "
            f"known are {', '.join(KNOWN)}"
        )
    try:
        if not path.is_file():
            raise SceneError(f"body.file {path} is no file; check the path")
        size = path.stat().st_size
        with path.open("rb"):
            pass
    except OSError as error:
        raise SceneError(f"body.file {path} cannot be read: {error}") from error
    if size == 0:
        raise SceneError(f"body.file {path} is empty (0 bytes); export it again")
    if size > LARGEST:
        raise SceneError(
            f"body.file {path} has {size / 1e9:.2f} GB; at most {LARGEST / 1e9:g} GB are read; "
            "export a coarser mesh"
        )
    return suffix


def read_mesh(path: Path) -> MeshFile:
    """The content of a mesh file.

    Raises:
        SceneError: it cannot be read.
    """
    suffix = checked(path)
    try:
        if suffix in DECKS:
            return DECKS[suffix](path)
        return _by_gmsh(path) if suffix in BY_GMSH else _by_meshio(path)
    except (SceneError, ImportError, MemoryError):
        raise
    except BaseException as error:  # meshio ends the process for some faults
        if isinstance(error, (KeyboardInterrupt, GeneratorExit)):
            raise
        raise SceneError(f"body.file {path} cannot be read as {suffix}: {_first(error)}") from error


def _first(error: BaseException) -> str:
    """The first line of an error's text."""
    if isinstance(error, SystemExit):
        return "it is damaged or of another format"
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__


@contextmanager
def gmsh_session() -> Iterator[None]:
    """Run gmsh on one thread, so that a mesh is the same every time."""
    start_gmsh()
    try:
        gmsh.option.setNumber("General.NumThreads", 1)
        yield
    finally:
        gmsh.finalize()


def _by_gmsh(path: Path) -> MeshFile:
    with gmsh_session():
        gmsh.open(str(path))
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        at = np.full(int(tags.max(initial=0)) + 1, -1, dtype=np.int64)
        at[tags.astype(np.int64)] = np.arange(tags.size)
        counts: dict[str, int] = {}
        solids: dict[str, list[Ints]] = {}
        first: dict[tuple[str, int], tuple[int, int]] = {}
        for dimension, entity in gmsh.model.getEntities():
            for name, nodes in _elements(dimension, entity, at):
                counts[name] = counts.get(name, 0) + nodes.shape[0]
                if dimension == 3:
                    if name not in SOLIDS:
                        raise SceneError(f"{path.name} has {name}, which is not covered")
                    before = sum(each.shape[0] for each in solids.get(name, []))
                    first[name, entity] = (before, before + nodes.shape[0])
                    solids.setdefault(name, []).append(nodes)
        blocks = [(name, np.concatenate(parts)) for name, parts in solids.items()]
        groups = [
            _physical(dimension, tag, at, blocks, first)
            for dimension, tag in gmsh.model.getPhysicalGroups()
        ]
    return MeshFile(coordinates.reshape(-1, 3), blocks, groups, counts)


def _elements(dimension: int, entity: int, at: Ints) -> Iterator[tuple[str, Ints]]:
    """Kinds and nodes of the elements of one of gmsh's entities, in VTK's order."""
    types, _, connectivity = gmsh.model.mesh.getElements(dimension, entity)
    for kind, flat in zip(types, connectivity, strict=True):
        title, _, _, count, _, _ = gmsh.model.mesh.getElementProperties(int(kind))
        name = GMSH_TYPES.get(int(kind), title)
        nodes = at[flat.astype(np.int64)].reshape(-1, count)
        yield name, nodes[:, GMSH_NODES.get(name, range(count))]


def _physical(
    dimension: int,
    tag: int,
    at: Ints,
    blocks: list[tuple[str, Ints]],
    first: dict[tuple[str, int], tuple[int, int]],
) -> Group:
    name = gmsh.model.getPhysicalName(dimension, tag).strip() or str(tag)
    entities = [int(each) for each in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)]
    if dimension == 3:
        elements, offset = [np.zeros(0, dtype=np.int64)], 0
        for kind, nodes in blocks:
            ranges = [first[kind, each] for each in entities if (kind, each) in first]
            elements += [offset + np.arange(a, b) for a, b in ranges]
            offset += nodes.shape[0]
        return Group(name, "volume", elements=np.concatenate(elements))
    node_tags, _ = gmsh.model.mesh.getNodesForPhysicalGroup(dimension, tag)
    facets = [
        nodes[:, : FACET_CORNERS[kind]]
        for each in entities
        for kind, nodes in _elements(dimension, each, at)
        if kind in FACET_CORNERS
    ]
    return Group(name, KINDS[dimension], nodes=at[node_tags.astype(np.int64)], facets=facets)


def _by_meshio(path: Path) -> MeshFile:
    # it prints warnings on standard output, which is JSON's
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        mesh = meshio.read(path)
    points = np.asarray(mesh.points, dtype=np.float64)
    counts: dict[str, int] = {}
    for block in mesh.cells:
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
    solid = [k for k, block in enumerate(mesh.cells) if block.type in SOLIDS]
    solids = [(mesh.cells[k].type, np.asarray(mesh.cells[k].data, np.int64)) for k in solid]
    return MeshFile(points, solids, [*_cell_groups(mesh, solid), *_node_groups(mesh)], counts)


def _cell_groups(mesh: meshio.Mesh, solid: list[int]) -> Iterator[Group]:
    """Values of cell arrays of whole numbers, as "material 2"."""
    for array, blocks in mesh.cell_data.items():
        data = [np.asarray(each) for each in blocks]
        if not all(each.dtype.kind in "iu" and each.ndim == 1 for each in data):
            continue
        values = np.unique(np.concatenate(data)) if data else np.zeros(0)
        if values.size > MOST_VALUES:
            continue
        inside = np.concatenate([data[k] for k in solid] or [np.zeros(0)])
        for value in values:
            name = f"{array} {value}"
            elements = np.flatnonzero(inside == value)
            if elements.size:
                yield Group(name, "volume", elements=elements)
            facets = [
                np.asarray(block.data[each == value], np.int64)[:, : FACET_CORNERS[block.type]]
                for block, each in zip(mesh.cells, data, strict=True)
                if FACET_CORNERS.get(block.type, 0) > 2 and np.any(each == value)
            ]
            if facets:
                yield Group(name, "surface", facets=facets)


def _node_groups(mesh: meshio.Mesh) -> Iterator[Group]:
    """Point arrays that are 0 or 1 everywhere, and point sets."""
    for array, data in mesh.point_data.items():
        values: Floats = np.asarray(data)
        if values.ndim == 1 and values.dtype.kind in "iub" and np.isin(values, (0, 1)).all():
            yield Group(array, "nodes", nodes=np.flatnonzero(values))
    for name, nodes in mesh.point_sets.items():
        yield Group(name, "nodes", nodes=np.asarray(nodes, np.int64))
