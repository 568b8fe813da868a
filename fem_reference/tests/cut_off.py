"""A run that is cut off on its way, for the tests of checkpoints."""

from __future__ import annotations


class CutOffError(Exception):
    """Raised by `cut_off`."""


def cut_off(done: float, message: str) -> None:
    """Report of progress that ends the run when half of it is done."""
    if done > 0.5:
        raise CutOffError
