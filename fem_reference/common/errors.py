"""Errors of the package; each knows the exit status of the process."""

from __future__ import annotations


class RunError(Exception):
    """Base of all errors that end a run with one sentence."""

    exit_status = 1


class SceneError(RunError):
    """The scene is invalid or asks for something this solver does not support."""

    exit_status = 3


class SolverError(RunError):
    """The solver failed: unstable step, divergence, degenerate element, missing program."""

    exit_status = 12


class DivergedError(SolverError):
    """The time loop's energy grew without bound."""
