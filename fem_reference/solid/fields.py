"""Fields over time: frames kept while the run goes on, then .vtu files and a .pvd series."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from ..common.arrays import Floats
from ..common.output import write_series
from .elasticity import STRESS_COMPONENTS, cell_stress, von_mises
from .loop import Loop
from .model import Model


class Frames:
    """Keeps the displacement at chosen instants as files that survive a killed run.

    Args:
        folder: for the files.
        count: at least so many frames, evenly over the run, at most twice as many; 0: none.
        times: or at the samples nearest to these instants, s.
        interval: sampling interval of the run, s.
    """

    def __init__(self, folder: Path, count: int, times: tuple[float, ...], interval: float) -> None:
        self.folder, self.count, self.interval = folder, count, interval
        self.samples = {round(t / interval) for t in times}

    def _stride(self, sample: int) -> int:
        """Samples per frame at a sample: doubles whenever there are twice too many frames."""
        return int(2 ** max(0, math.ceil(math.log2(max(1, sample) / (2 * self.count)))))

    def _wanted(self, sample: int) -> bool:
        if sample in self.samples:
            return True
        return self.count > 0 and sample % self._stride(sample) == 0

    def __call__(self, sample: int, loop: Loop) -> None:
        """Keep the frame of a sample if it is wanted."""
        if not self._wanted(sample):
            return
        displacement = loop.gather(loop.u)
        if loop.comm.rank != 0:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        np.save(self.folder / f"frame-{sample:08d}.npy", displacement)
        for kept in self._files():
            number = int(kept.stem.split("-")[1])
            if self.count and number not in self.samples and number % self._stride(sample):
                kept.unlink(missing_ok=True)

    def _files(self) -> list[Path]:
        return sorted(self.folder.glob("frame-*.npy"))

    def frames(self) -> list[tuple[float, Floats]]:
        """Instant (s) and displacement (N, 3) of all frames."""
        return [
            (self.interval * int(file.stem.split("-")[1]), np.load(file)) for file in self._files()
        ]


def _grid(model: Model, **data: Any) -> meshio.Mesh:
    points = np.vstack([body.mesh.points for body in model.elastic])
    cells = np.vstack(
        [body.mesh.cells + first for body, first in zip(model.elastic, model.first, strict=False)]
    ).astype(np.int32)
    kind = "tetra" if cells.shape[1] == 4 else "tetra10"
    number = np.concatenate(
        [np.full(b.mesh.cells.shape[0], i, np.int32) for i, b in enumerate(model.elastic)]
    )
    cell_data = {"body": [number], **data.pop("cell_data", {})}
    return meshio.Mesh(points, [(kind, cells)], cell_data=cell_data, **data)


def write_mesh(path: Path, model: Model) -> None:
    """All elastic bodies as one .vtu; cell data "body" is the number of the body in the model."""
    meshio.vtu.write(path, _grid(model), binary=True, compression=None)


def write_frame(path: Path, model: Model, displacement: Floats, comm: Any) -> None:
    """Displacement (nodes), stress and von Mises stress (elements' midpoints) as .vtu."""
    parts = []
    for body, first in zip(model.elastic, model.first, strict=False):
        local = displacement[first : first + body.mesh.points.shape[0]]
        parts.append(cell_stress(body.mesh, body.material, local, comm))
    stress = np.vstack(parts)
    cell_data = {"von_mises": [von_mises(stress)]}
    for name, column in zip(STRESS_COMPONENTS, stress.T, strict=True):
        cell_data[name] = [column]
    grid = _grid(model, point_data={"displacement": displacement}, cell_data=cell_data)
    meshio.vtu.write(path, grid, binary=True, compression=None)


def write_frames(
    folder: Path, model: Model, frames: list[tuple[float, Floats]], comm: Any
) -> list[float]:
    """A .vtu for each frame and `stress.pvd`; the instants, s."""
    names = []
    for number, (_, displacement) in enumerate(frames):
        names.append(f"stress_{number:03d}.vtu")
        write_frame(folder / names[-1], model, displacement, comm)
    times = [instant for instant, _ in frames]
    if names:
        write_series(folder / "stress.pvd", times, names)
    return times
