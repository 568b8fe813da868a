"""Meshes and fields as .vtu files, and a .pvd series of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from .arrays import Floats, Ints

STATE = Path(__file__).parent / "paraview/paraview_state.py"
"""What ParaView loads to show a series: no module of this package, ParaView runs it."""


@dataclass(frozen=True)
class Fields:
    """The elastic bodies of a solution as ParaView and meshio see them."""

    kind: str
    """Of the cells, meshio's name."""
    bodies: list[tuple[Floats, Ints]]
    """Points (n, d), m, and cells of each body."""
    components: tuple[str, ...]
    """Names of the stresses."""
    stress: Callable[[int, Floats], Floats]
    """(m, k) of a body at its elements' midpoints, from its displacement (n, d), Pa."""
    von_mises: Callable[[Floats], Floats]
    """(m,) from the stress."""

    def write_mesh(self, path: Path, **cell_data: Floats) -> None:
        """All bodies as one uncompressed .vtu; cell data "body" is their number."""
        grid = self._grid({}, {name: [values] for name, values in cell_data.items()})
        meshio.vtu.write(path, grid, binary=True, compression=None)

    def write_frame(self, path: Path, displacements: list[Floats]) -> None:
        """Displacement (nodes), stress and von Mises stress (elements' midpoints) as .vtu.

        Args:
            path: of the file.
            displacements: (n, d) of each body, m, or (n, 2 d) if what strains is another: the
                effective displacement of a material that relaxes, behind it.
        """
        size = self.bodies[0][0].shape[1]
        stress = np.vstack([self.stress(k, u[:, -size:]) for k, u in enumerate(displacements)])
        cell_data = {"von_mises": [self.von_mises(stress)]}
        for name, column in zip(self.components, stress.T, strict=True):
            cell_data[name] = [column]
        point_data = {"displacement": np.vstack([_spatial(u[:, :size]) for u in displacements])}
        grid = self._grid(point_data, cell_data)
        meshio.vtu.write(path, grid, binary=True, compression=None)

    def write_frames(self, folder: Path, frames: list[tuple[float, list[Floats]]]) -> list[float]:
        """A .vtu for each instant (s), `stress.pvd`, and ParaView's state for it; the instants."""
        names = [f"stress_{number:03d}.vtu" for number in range(len(frames))]
        for name, (_, displacements) in zip(names, frames, strict=True):
            self.write_frame(folder / name, displacements)
        times = [instant for instant, _ in frames]
        if names:
            _write_series(folder / "stress.pvd", times, names)
            shutil.copyfile(STATE, folder / STATE.name)
        return times

    def _grid(self, point_data: dict[str, Any], cell_data: dict[str, Any]) -> meshio.Mesh:
        first = np.cumsum([0, *(points.shape[0] for points, _ in self.bodies)])
        points = np.vstack([_spatial(points) for points, _ in self.bodies])
        cells = [cells + offset for (_, cells), offset in zip(self.bodies, first, strict=False)]
        numbers = [np.full(c.shape[0], k, dtype=np.int32) for k, c in enumerate(cells)]
        return meshio.Mesh(
            points,
            [(self.kind, np.vstack(cells).astype(np.int32))],
            point_data=point_data,
            cell_data={"body": [np.concatenate(numbers)], **cell_data},
        )


def _spatial(vectors: Floats) -> Floats:
    """(n, 3) of (n, 2) or (n, 3); of an axisymmetric body x is r, y is z."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _write_series(path: Path, times: list[float], names: list[str]) -> None:
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
