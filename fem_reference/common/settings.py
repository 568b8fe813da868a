"""What every solution is asked for: resolution, instants of fields, target error."""

from __future__ import annotations

import math

from .errors import SceneError

RESOLUTIONS = {"coarse": 2.0 / 3.0, "paper": 1.0, "fine": 1.5}
"""Factor on the number of elements, in every direction and place."""


def require_instants(instants: tuple[float, ...], end_time: float | None) -> None:
    """Instants for fields, s.

    Raises:
        SceneError: one lies outside the run.
    """
    for instant in instants:
        if not 0.0 <= instant < math.inf or (end_time and instant > end_time):
            raise SceneError(f"--stress-at is {instant:g} s; it must lie between 0 and the end")


def require_share(target_error: float | None) -> None:
    """A relative error to be reached.

    Raises:
        SceneError: it is not between 0 and 1.
    """
    if target_error is not None and not 0.0 < target_error < 1.0:
        raise SceneError(f"--target-error is {target_error:g}; it must lie between 0 and 1")
