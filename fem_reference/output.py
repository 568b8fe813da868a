"""The result folder: complete or not there at all."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

import meshio
import numpy as np

from .elasticity import STRESS_COMPONENTS, cell_stress, von_mises
from .errors import SolverError
from .explicit import Snapshot
from .mesh import Floats
from .meshing import ImpactMesh
from .scene import Scene
from .system import System

CHECKSUMS = "checksums.sha256"
PROVENANCE = "provenance.json"
PARTIAL_PREFIX = ".partial-"
SAMPLES = 2000
"""About how many samples a history has."""

HISTORY_COLUMNS = (
    "time",
    "outer_displacement",
    "outer_velocity",
    "outer_force",
    "plate_displacement",
    "plate_velocity",
    "inner_displacement",
    "inner_velocity",
    "inner_force",
)


def require_replaceable(target: Path, document: Any, replace: bool) -> None:
    """Refuse to put the result of ``document`` (a decoded scene.json) where something else lies.

    A result of the same scene with the same settings is computed again without asking; another
    result only if ``replace``; what is no result, never.

    Raises:
        SolverError: naming what is there.
    """
    if not target.exists() or (target.is_dir() and not any(target.iterdir())):
        return
    if not (target / PROVENANCE).is_file():
        raise SolverError(
            f"the output {target} exists and is no result folder (it has no {PROVENANCE}); "
            "choose another --out"
        )
    if replace:
        return
    try:
        there = json.loads((target / PROVENANCE).read_text(encoding="utf-8"))
        name = there["scene"]["name"]
        same = all(there[key] == document.get(key) for key in ("scene_hash", "settings_hash"))
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise SolverError(
            f"the output folder {target} holds a {PROVENANCE} that cannot be read ({error}); "
            "choose another --out, or give --replace"
        ) from error
    if not same:
        raise SolverError(
            f"the output folder {target} holds a solution of another scene or with other settings "
            f"(scene {name!r}, scene_hash {there['scene_hash'][:12]}); choose another --out, or "
            "give --replace"
        )


@contextmanager
def result_folder(target: Path) -> Iterator[Path]:
    """A temporary sibling of ``target`` that takes its place when the block succeeds.

    Whatever is at ``target`` already is replaced then. If the process dies, at most a folder
    ``.partial-*`` is left.
    """
    parent = target.absolute().parent
    try:
        parent.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=f"{PARTIAL_PREFIX}{target.name}-", dir=parent))
        partial.chmod(0o755)
    except OSError as error:
        raise SolverError(f"the output folder {target} cannot be made: {error}") from error
    try:
        yield partial
        _write_checksums(partial)
        old = None
        if target.exists():
            old = Path(tempfile.mkdtemp(prefix=f"{PARTIAL_PREFIX}{target.name}-old-", dir=parent))
            target.replace(old / target.name)
        partial.replace(target)
        if old is not None:
            shutil.rmtree(old, ignore_errors=True)
    except OSError as error:
        raise SolverError(f"the output folder {target} cannot be written: {error}") from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _write_checksums(folder: Path) -> None:
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
        for path in sorted(folder.iterdir())
    ]
    with (folder / CHECKSUMS).open("w", encoding="ascii") as stream:
        stream.writelines(lines)
        stream.flush()
        os.fsync(stream.fileno())


def write_json(path: Path, document: dict[str, Any]) -> None:
    """Indented JSON; NaN and infinity are refused."""
    path.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", encoding="utf-8")


class Sampled(Protocol):
    """What a history is made of: `explicit.Run`, or a solid run."""

    @property
    def times(self) -> Floats:
        """(m,) raw sampling instants, s."""

    @property
    def rows(self) -> Floats:
        """(m, 8) as `explicit.Run.rows`."""


def history(run: Sampled) -> tuple[Floats, float]:
    """Table (samples, 9) of `HISTORY_COLUMNS`, and the sampling interval, s.

    Forces are impulse over interval, the interval centred on the sample; at both ends only its
    half inside the run counts.
    """
    raw = run.times.size - 1
    # An even number of raw intervals, so that the middle between two samples is one of them.
    stride = max(2, 2 * round(raw / SAMPLES / 2))
    keep = np.arange(0, run.times.size, stride)
    interval = float(stride * (run.times[1] - run.times[0]))
    table = np.empty((keep.size, len(HISTORY_COLUMNS)))
    table[:, 0] = run.times[keep]
    for column, source in ((1, 0), (2, 1), (4, 3), (5, 4), (6, 5), (7, 6)):
        table[:, column] = run.rows[keep, source]
    low = np.maximum(keep - stride // 2, 0)
    high = np.minimum(keep + stride // 2, raw)
    for column, source in ((3, 2), (8, 7)):
        impulse = run.rows[high, source] - run.rows[low, source]
        table[:, column] = impulse / (run.times[high] - run.times[low])
    return table, interval


def resampled(run: Sampled, times: Floats) -> Floats:
    """Table (samples, 9) of `HISTORY_COLUMNS` at ``times`` (evenly spaced, s) of another run."""
    table = np.empty((times.size, len(HISTORY_COLUMNS)))
    table[:, 0] = times
    for column, source in ((1, 0), (2, 1), (4, 3), (5, 4), (6, 5), (7, 6)):
        table[:, column] = np.interp(times, run.times, run.rows[:, source])
    half = 0.5 * (times[1] - times[0]) if times.size > 1 else 0.0
    low, high = np.maximum(times - half, times[0]), np.minimum(times + half, times[-1])
    for column, source in ((3, 2), (8, 7)):
        impulse = np.interp(high, run.times, run.rows[:, source])
        impulse -= np.interp(low, run.times, run.rows[:, source])
        table[:, column] = impulse / np.maximum(high - low, np.finfo(float).tiny)
    return table


def write_history(path: Path, table: Floats, bands: Floats | None = None) -> None:
    """Comma-separated: `HISTORY_COLUMNS`, then the half width of each band if known."""
    names, formats, rows = [*HISTORY_COLUMNS], ["%.10g"] * table.shape[1], table
    if bands is not None:
        names += [f"{name}_band" for name in HISTORY_COLUMNS[1:]]
        formats += ["%.3g"] * bands.shape[1]
        rows = np.column_stack([table, bands])
    np.savetxt(path, rows, fmt=formats, delimiter=",", header=",".join(names), comments="")


def _bodies(mesh: ImpactMesh) -> tuple[Floats, np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Points (n, 3), quads (m, 4) and body number (m,) of all bodies; z is the second axis."""
    points, quads, body = [], [], []
    offset = 0
    for number, part in enumerate((mesh.outer, mesh.plate, mesh.inner)):
        points.append(np.column_stack([part.points, np.zeros(part.points.shape[0])]))
        quads.append(part.quads + offset)
        body.append(np.full(part.quads.shape[0], number, dtype=np.int32))
        offset += part.points.shape[0]
    return np.vstack(points), np.vstack(quads).astype(np.int32), np.concatenate(body)


def write_mesh(path: Path, mesh: ImpactMesh) -> None:
    """All bodies as one uncompressed .vtu; x is r, y is z.

    Cell data "body": 0 outer, 1 plate, 2 inner.
    """
    points, quads, body = _bodies(mesh)
    grid = meshio.Mesh(points, [("quad", quads)], cell_data={"body": [body]})
    meshio.vtu.write(path, grid, binary=True, compression=None)


def write_stress(
    path: Path, scene: Scene, mesh: ImpactMesh, system: System, snapshot: Snapshot
) -> None:
    """Displacement (nodes) and stress (elements' midpoints) of one instant as .vtu."""
    points, quads, body = _bodies(mesh)
    parts = (mesh.outer, mesh.plate, mesh.inner)
    materials = (scene.outer.material, scene.plate.material, scene.inner.material)
    displacement, stress = [], []
    for part, material, numbers in zip(parts, materials, system.numbers, strict=True):
        local = snapshot.displacement[numbers]
        displacement.append(np.column_stack([local, np.zeros(local.shape[0])]))
        stress.append(cell_stress(part, material, local))
    stresses = np.vstack(stress)
    cell_data = {"body": [body], "von_mises": [von_mises(stresses)]}
    for name, column in zip(STRESS_COMPONENTS, stresses.T, strict=True):
        cell_data[name] = [column]
    grid = meshio.Mesh(
        points,
        [("quad", quads)],
        point_data={"displacement": np.vstack(displacement)},
        cell_data=cell_data,
        field_data={},
    )
    meshio.vtu.write(path, grid, binary=True, compression=None)


def write_series(path: Path, times: list[float], names: list[str]) -> None:
    """A .pvd file: the .vtu files ``names`` beside it at ``times`` (s), for ParaView."""
    entries = "".join(
        f'    <DataSet timestep="{instant:.10g}" part="0" file="{name}"/>\n'
        for instant, name in zip(times, names, strict=True)
    )
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" '
        f'byte_order="LittleEndian">\n  <Collection>\n{entries}  </Collection>\n</VTKFile>\n',
        encoding="ascii",
    )
