"""Progress as JSON lines on standard output, flushed and rate-limited."""

from __future__ import annotations

import json
import sys
import time
from typing import TextIO

INTERVAL = 0.2
"""Least time between two lines of the same phase, s."""


class Progress:
    """Writes ``{"phase", "done", "message"}`` lines; each phase's start and end among them."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream if stream is not None else sys.stdout
        self._last = -1.0
        self._phase = ""

    def report(self, phase: str, done: float, message: str) -> None:
        """Report ``done`` (0..1) of ``phase`` (mesh, assembly, stepping, writing)."""
        now = time.monotonic()
        if phase == self._phase and done < 1.0 and now - self._last < INTERVAL:
            return
        self._phase, self._last = phase, now
        done = round(min(max(done, 0.0), 1.0), 4)
        self._write({"phase": phase, "done": done, "message": message})

    def error(self, message: str) -> None:
        """Report the failure; the last line of a failed run."""
        self._write({"phase": "error", "message": message})

    def _write(self, line: dict[str, object]) -> None:
        self._stream.write(json.dumps(line) + "\n")
        self._stream.flush()
