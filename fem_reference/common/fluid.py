"""The fluid behind a plate, as a scene has it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .bodies import Plate
from .reader import Reader


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
    shear_thinning: ShearThinning | None

    def wet(self, plate: Plate) -> Plate:
        """The plate that moves as ``plate`` does in the fluid.

        Its mass matrix is multiplied by one factor (section 3.5.3 of the paper): every frequency
        falls by the same ratio.
        """
        density = plate.material.density / self.added_mass_frequency_ratio**2
        heavy = replace(plate.material, density=density)
        return replace(plate, material=heavy, damping_ratio=self.plate_damping_ratio)


def read_fluid(reader: Reader) -> Fluid:
    """The fluid an object describes."""
    reader.allow(
        "viscosity",
        "density",
        "minimum_gap",
        "squeeze_film",
        "added_mass_frequency_ratio",
        "plate_damping_ratio",
        "drag_coefficient",
        "shear_thinning",
    )
    ratio = "(no unit)"
    thinning = reader.node.get("shear_thinning") is not None
    return Fluid(
        viscosity=reader.number("viscosity", "Pa s"),
        density=reader.number("density", "kg/m^3"),
        minimum_gap=reader.number("minimum_gap", "m"),
        squeeze_film=reader.flag("squeeze_film"),
        added_mass_frequency_ratio=reader.number(
            "added_mass_frequency_ratio", ratio, below=1.0 + 1e-15
        ),
        # From 1 on modes creep instead of oscillating, and the end of the run has no proof.
        plate_damping_ratio=reader.number("plate_damping_ratio", ratio, below=1.0, inclusive=True),
        drag_coefficient=reader.number("drag_coefficient", ratio, inclusive=True),
        shear_thinning=_read_thinning(reader.child("shear_thinning")) if thinning else None,
    )


def _read_thinning(reader: Reader) -> ShearThinning:
    reader.allow("infinite_shear_viscosity", "relaxation_time", "power_index")
    return ShearThinning(
        infinite_shear_viscosity=reader.number("infinite_shear_viscosity", "Pa s"),
        relaxation_time=reader.number("relaxation_time", "s"),
        power_index=reader.number("power_index", "(no unit)", below=1.0 + 1e-15),
    )
