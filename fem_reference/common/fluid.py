"""The fluid behind a plate, as a scene has it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .bodies import Plate


@dataclass(frozen=True)
class ShearThinning:
    """Carreau's law: mu = mu_inf + (mu_0 - mu_inf) (1 + (lambda rate)^2)^((n - 1)/2)."""

    infinite_shear_viscosity: float
    """mu_inf, Pa s; mu_0 is the fluid's viscosity."""
    relaxation_time: float
    """lambda, s"""
    power_index: float
    """n"""


@dataclass(frozen=True)
class Fluid:
    """Fluid on the inner side of a plate."""

    viscosity: float
    """Pa s; at rest, if it is shear-thinning."""
    density: float
    """kg/m^3"""
    minimum_gap: float
    """Gaps of the film resist as this one at least, m."""
    squeeze_film: bool
    added_mass_frequency_ratio: float
    """First wet over first dry eigenfrequency."""
    plate_damping_ratio: float
    """Of critical damping, of the wet plate."""
    drag_coefficient: float
    shear_thinning: ShearThinning | None = None

    def wet(self, plate: Plate) -> Plate:
        """The plate that moves as ``plate`` does in the fluid.

        Its mass matrix is multiplied by one factor (section 3.5.3 of the paper): every frequency
        falls by the same ratio.
        """
        density = plate.material.density / self.added_mass_frequency_ratio**2
        heavy = replace(plate.material, density=density)
        return replace(plate, material=heavy, damping_ratio=self.plate_damping_ratio)
