"""What the scene of every kind of impact says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..common.decode import HERE, place


@dataclass(frozen=True, kw_only=True)
class ImpactScene:
    """A scene as the program hands it over; SI units. A kind adds its bodies and a `kind`."""

    name: str
    description: str = ""
    scene_hash: str
    """Of the physics."""
    settings_hash: str
    """Of the reference's settings."""
    end_time: float | None = place("run.end_time", None)
    """s; None: until no further contact is possible."""
    raw: dict[str, Any] = place(HERE)
    """The document as given, for the provenance."""
