"""The command ``unit``: simulates a unit and answers as a program of the user's does."""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import Any

from ..common.arguments import Study


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.description = "The question, with `unit`, comes on standard input as JSON."


def _unit(_: argparse.Namespace) -> None:
    """Answer on standard output.

    Raises:
        SceneError: the unit, its variables or start values are not what the scene says.
        SolverError: FMPy is missing, or the simulation fails.
    """
    from .simulate import answer

    question: dict[str, Any] = json.load(sys.stdin)
    # what a unit prints goes to standard error: it must not stand in the answer
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    with out:
        out.write(json.dumps(answer(question)))


UNIT = Study("simulates a Functional Mock-up Unit of a scene", _arguments, _unit)
