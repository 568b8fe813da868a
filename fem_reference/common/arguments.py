"""Values on the command line, and studies: commands that take no scene of the program."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Study:
    """A command of its own."""

    help: str
    arguments: Callable[[argparse.ArgumentParser], None]
    """Adds them."""
    run: Callable[[argparse.Namespace], None]
    """Imports late what it needs: every call of the package reads what studies there are."""


def instants(text: str) -> tuple[float, ...]:
    """Times in s, separated by commas."""
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of seconds like 1e-5,2e-5"
        ) from None


def whole(text: str, least: int, most: int) -> int:
    """A whole number between bounds."""
    if not text.isdecimal() or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from {least} to {most}")
    return int(text)


def count(text: str) -> int:
    """How many of something."""
    return whole(text, 0, 100_000)
