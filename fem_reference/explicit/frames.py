"""Fields over time: displacements kept while the run goes on."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

from ..common.arrays import Floats
from ..common.settings import Settings
from .loop import Loop


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

    def _is_due(self, sample: int) -> bool:
        if sample in self.samples:
            return True
        return self.count > 0 and sample % self._stride(sample) == 0

    def __call__(self, sample: int, loop: Loop) -> None:
        """Keep the frame of a sample if it is wanted."""
        if not self._is_due(sample):
            return
        displacement = loop.gather(loop.u)
        if loop.springs is not None:
            displacement = np.hstack([displacement, loop.gather(loop.effective)])
        if loop.comm.rank != 0:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        np.save(self.folder / f"frame-{sample:08d}.npy", displacement)
        for path in self._files():
            number = int(path.stem.split("-")[1])
            if self.count and number not in self.samples and number % self._stride(sample):
                path.unlink(missing_ok=True)

    def following(self, sample: int) -> int:
        """The next sample whose frame is wanted, or one far away."""
        later = [chosen for chosen in self.samples if chosen > sample]
        if self.count > 0:
            stride = self._stride(sample + 1)
            later.append((sample // stride + 1) * stride)
        return min(later, default=sys.maxsize)

    def _files(self) -> list[Path]:
        return sorted(self.folder.glob("frame-*.npy"))

    def frames(self) -> list[tuple[float, Floats]]:
        """Instant (s) and displacement (N, C) of all frames.

        Where bodies relax (N, 2 C): the displacement that strains stands behind it.
        """
        return [
            (self.interval * int(file.stem.split("-")[1]), np.load(file)) for file in self._files()
        ]


class Recorder:
    """Makes the recorder of a run's fields once its sampling interval is known.

    Args:
        settings: of the run.
        suffix: for the name of its folder.
    """

    def __init__(self, settings: Settings, suffix: str = "") -> None:
        self.settings, self.suffix = settings, suffix
        self.made: Frames | None = None

    def __call__(self, interval: float) -> Frames:
        """Recorder for a run sampled at ``interval`` s."""
        settings = self.settings
        folder = settings.folder / f"{settings.label}{self.suffix}-frames"
        self.made = Frames(folder, settings.frames, settings.frame_times, interval)
        return self.made

    def frames(self) -> list[tuple[float, Floats]]:
        """Instant (s) and displacement (N, C) of all fields kept."""
        return self.made.frames() if self.made else []
