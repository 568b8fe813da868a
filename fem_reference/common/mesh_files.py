"""A mesh and its description: what they may replace."""

from __future__ import annotations

import json
from pathlib import Path

from .errors import SolverError


def require_replaceable(path: Path) -> None:
    """Refuse to put a mesh where files lie that are no mesh of this program with its description.

    Raises:
        SolverError: naming the file that would be lost.
    """
    there = next((file for file in (path, path.with_suffix(".json")) if file.exists()), None)
    if there is None:
        return
    try:
        described = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
        if {"sha256", "element_order"} <= described.keys():
            return
    except (OSError, ValueError, AttributeError):
        pass
    raise SolverError(
        f"{there} exists and is no mesh of this program with its description; choose another --out"
    )
