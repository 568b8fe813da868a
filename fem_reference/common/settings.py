"""What every solution is made with: resolution, instants of fields, target error."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

from .errors import SceneError

RESOLUTIONS = {"coarse": 2.0 / 3.0, "paper": 1.0, "fine": 1.5}
"""Factor on the number of elements, in every direction and place."""

SOLVERS = ("explicit", "calculix")
"""This package's own time loop, and CalculiX."""

CHATTER_FRACTION = 0.005
"""Separations shorter than this share of the Hertz duration are chatter of single nodes."""

PEAK_WINDOW_FRACTION = 1.0 / 600.0
"""Window of the peak force over the Hertz contact duration (0.13 us for 78 us).

Node pairs close and open one by one; the force of a single step jumps by a percent. The
mean over a window much shorter than the contact removes that, and lowers the peak of a smooth
pulse by only (pi * fraction)^2 / 24 of itself, about 1e-6.
"""


def require_instants(instants: tuple[float, ...], end_time: float | None) -> None:
    """Instants for fields, s.

    Raises:
        SceneError: one lies outside the run.
    """
    for instant in instants:
        if not 0.0 <= instant < math.inf or (end_time and instant > end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")


def missed_instants(instants: tuple[float, ...], end: float) -> list[str]:
    """A sentence about each instant that lies behind the end of the run; both in s."""
    return [
        f"there are no fields at {instant:g} s: the run ended at {end:.4g} s, when no further "
        "contact was possible"
        for instant in instants
        if instant > end
    ]


def require_share(target_error: float | None) -> None:
    """A relative error to be reached.

    Raises:
        SceneError: it is not between 0 and 1.
    """
    if target_error is not None and not 0.0 < target_error < 1.0:
        raise SceneError(f"--target-error is {target_error:g}; it must lie between 0 and 1")


@dataclass(frozen=True)
class Options:
    """What a user asks of a solution, mesh apart."""

    courant: float = 0.9
    """Time step over the critical one."""
    stress_times: tuple[float, ...] = ()
    """Instants at which fields are written, s."""
    frames: int = 0
    """Fields are written at least so many times, evenly over the run; 0: not."""
    frame_times: tuple[float, ...] = ()
    """And at these instants, s, as far as the run comes."""
    checkpoint: Path | None = None
    """Folder; by default ``.checkpoint-<name>`` beside the result."""
    checkpoint_interval: float = 60.0
    """Wall-clock time between checkpoints, s."""
    target_error: float | None = None
    """Refine until the relative bands are that small."""
    threads: int = 1
    """Cores the time loop uses, all processes on a machine together; 0: those there are."""
    solver: str = SOLVERS[0]
    """One of `SOLVERS`."""

    @staticmethod
    def of(arguments: argparse.Namespace) -> Options:
        """From the command line."""
        return Options(
            arguments.courant,
            arguments.stress_at,
            arguments.fields,
            (),
            arguments.checkpoint,
            arguments.checkpoint_interval,
            arguments.target_error,
            arguments.threads,
            arguments.solver,
        )


@dataclass(frozen=True)
class Settings:
    """How one mesh of a series is solved."""

    courant: float
    folder: Path
    """For states and kept results."""
    checkpoint_interval: float
    label: str
    """Of this mesh, for the names of its files."""
    frames: int = 0
    frame_times: tuple[float, ...] = ()
    refinement: float = 1.0
    """Of the finest mesh of the series over this one, in every direction."""
    threads: int = 1
    """At most, per process."""
