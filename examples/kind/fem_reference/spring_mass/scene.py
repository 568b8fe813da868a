"""The spring-mass scene, decoded from ``scene.json``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from ..common.bodies import Material
from ..common.decode import At
from ..common.hertz import effective_modulus, hertz_stiffness
from ..impact.scene import ImpactScene


@dataclass(frozen=True)
class StrikingSphere:
    """Rigid but for its contact."""

    mass: float
    """kg"""
    radius: float
    """m"""
    speed: float
    """Towards the mass, m/s."""
    material: Material


@dataclass(frozen=True)
class StruckMass:
    """At rest, on a spring."""

    mass: float
    """kg"""
    stiffness: float
    """N/m"""
    material: Material
    """Of its flat face."""


@dataclass(frozen=True, kw_only=True)
class SpringScene(ImpactScene):
    """A sphere and what it strikes."""

    kind: Literal["spring-mass"]
    sphere: StrikingSphere
    mass: StruckMass
    geometry: Annotated[Literal["axisymmetric"], At("reference.geometry")] = "axisymmetric"

    @property
    def contact_stiffness(self) -> float:
        """K in F = k delta^(3/2), N/m^(3/2)."""
        modulus = effective_modulus(self.sphere.material, self.mass.material)
        return hertz_stiffness(modulus, self.sphere.radius)
