"""Progress as JSON lines on standard output, flushed and rate-limited."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import TextIO

Report = Callable[[str, float, str], None]
"""Gets phase, share done, message."""
INTERVAL = 0.2
"""Least time between two lines of the same phase, s."""


class Progress:
    """Writes ``{"phase", "done", "message"}`` lines; each phase's start and end among them."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream if stream is not None else sys.stdout
        self._last = -1.0
        self._phase = ""

    def report(self, phase: str, done: float, message: str, series: float | None = None) -> None:
        """Report ``done`` (0..1) of ``phase`` (mesh, assembly, stepping, writing).

        A ``note`` is what a user should read and keep, whatever the run does.

        ``series`` is the share (0..1) of all meshes together, where there are several.
        """
        now = time.monotonic()
        if phase == self._phase and done < 1.0 and now - self._last < INTERVAL:
            return
        self._phase, self._last = phase, now
        done = round(min(max(done, 0.0), 1.0), 4)
        line: dict[str, object] = {"phase": phase, "done": done, "message": message}
        if series is not None:
            line["series"] = round(min(max(series, 0.0), 1.0), 4)
        self._write(line)

    def error(self, message: str) -> None:
        """Report the failure; the last line of a failed run."""
        self._write({"phase": "error", "message": message})

    def _write(self, line: dict[str, object]) -> None:
        self._stream.write(json.dumps(line) + "\n")
        self._stream.flush()


class MeshOfSeries(Progress):
    """Reports one of several meshes: which it is, and the share of all of them.

    Args:
        progress: where to report.
        number: of this mesh, from 1.
        costs: of all meshes in the order they are solved, in any unit.
    """

    def __init__(self, progress: Progress, number: int, costs: list[float]) -> None:
        super().__init__()
        self._progress, self._number, self._costs = progress, number, costs
        self._reached = 0.0

    def report(self, phase: str, done: float, message: str, series: float | None = None) -> None:
        """As `Progress.report`; the time loop is what counts of a mesh."""
        if phase == "stepping":
            # A mesh that is made again begins again; the series does not go back.
            self._reached = max(self._reached, done)
        before, own = sum(self._costs[: self._number - 1]), self._costs[self._number - 1]
        share = (before + own * self._reached) / sum(self._costs)
        label = "" if phase == "note" else f"mesh {self._number} of {len(self._costs)}: "
        self._progress.report(phase, done, label + message, share)
