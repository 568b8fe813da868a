"""What the scene of every kind of impact says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from ..common.decode import At

Rigid = Literal["none", "outer", "inner", "both"]
RIGID: dict[Rigid, tuple[str, ...]] = {
    "none": (),
    "outer": ("outer",),
    "inner": ("inner",),
    "both": ("outer", "inner"),
}
"""Names of the bodies that are rigid."""


@dataclass(frozen=True, kw_only=True)
class ImpactScene:
    """A scene as the program hands it over; SI units. A kind adds its bodies and a `kind`."""

    name: str
    description: str = ""
    scene_hash: str
    """Of the physics."""
    settings_hash: str
    """Of the reference's settings."""
    end_time: Annotated[float | None, At("run.end_time")] = None
    """s; None: until no further contact is possible."""
    raw: Annotated[dict[str, Any], At()]
    """The document as given, for the provenance."""


@dataclass(frozen=True, kw_only=True)
class TwoBodyScene(ImpactScene):
    """A scene with an outer and an inner body, which may be rigid in solid geometry."""

    rigid_bodies: Annotated[Rigid, At("reference.rigid")] = "none"

    @property
    def rigid(self) -> tuple[str, ...]:
        """Names of the bodies that are rigid, tip included."""
        return RIGID[self.rigid_bodies]
