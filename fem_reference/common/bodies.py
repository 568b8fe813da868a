"""Materials, plates, spheres and compact bodies: what scenes are made of."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Literal

import numpy as np

from .arrays import Floats
from .beam import Beam, Strike
from .decode import At
from .errors import SceneError

FIXED_POINT = 100
"""Iterations for the frequency of a mode that relaxes."""
Edge = Literal["clamped", "simply-supported", "free"]


@dataclass(frozen=True)
class Relaxation:
    """A term of a Prony series E(t) = E_0 (1 - sum ratio (1 - exp(-t/time)))."""

    ratio: float
    """Share of the instantaneous modulus that relaxes."""
    time: float
    """s"""


@dataclass(frozen=True)
class Yielding:
    """Von Mises yielding with linear isotropic hardening."""

    strength: float
    """Y, Pa"""
    hardening: float
    """Slope H of the yield stress over the plastic strain, Pa"""
    rate: float = 0.0
    """D of Cowper & Symonds: strain rate that doubles the yield stress, 1/s; 0: none does"""
    exponent: float = 1.0
    """q: the yield stress grows by 1 + (strain rate / D)^(1/q)"""


@dataclass(frozen=True)
class Material:
    """Linear isotropic material, up to where it yields if it does; bulk and shear relax alike."""

    name: str
    youngs_modulus: float
    """Instantaneous, Pa."""
    poisson_ratio: float
    density: float
    """kg/m^3"""
    yield_strength: float | None = None
    """Pa"""
    hardening: float | None = None
    """Pa; None: elastic whatever the stress."""
    rate: Annotated[float, At("rate.D")] = 0.0
    """See `Yielding`."""
    exponent: Annotated[float, At("rate.q")] = 1.0
    """See `Yielding`."""
    relaxation: tuple[Relaxation, ...] = ()
    """Empty: none."""

    @property
    def yielding(self) -> Yielding | None:
        """None: elastic whatever the stress.

        Raises:
            SceneError: there is hardening, but no yield strength.
        """
        if self.hardening is None:
            return None
        if self.yield_strength is None:
            raise SceneError(f"material {self.name!r} has hardening, but yield_strength is missing")
        return Yielding(self.yield_strength, self.hardening, self.rate, self.exponent)

    @property
    def lasting(self) -> float:
        """Share of the modulus that does not relax."""
        return 1.0 - sum(term.ratio for term in self.relaxation)

    def storage(self, frequency: float) -> float:
        """Storage modulus at a frequency (Hz) over the instantaneous one."""
        omega = 2.0 * math.pi * frequency
        return 1.0 - sum(t.ratio / (1.0 + (omega * t.time) ** 2) for t in self.relaxation)

    def vibrating(self, instantaneous: float) -> float:
        """Frequency of a mode with the storage modulus at it, Hz, from the instantaneous one's."""
        frequency = instantaneous
        for _ in range(FIXED_POINT if self.relaxation else 0):
            frequency = instantaneous * math.sqrt(self.storage(frequency))
        return frequency

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2), Pa: what a half-space or a plate in bending feels."""
        return self.youngs_modulus / (1.0 - self.poisson_ratio**2)

    @property
    def shear_modulus(self) -> float:
        """E / (2 (1 + nu)), Pa."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def lame_lambda(self) -> float:
        """First Lame parameter, Pa."""
        nu = self.poisson_ratio
        return self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))


@dataclass(frozen=True)
class Plate:
    """Circular plate of constant thickness."""

    radius: float
    thickness: float
    edge: Edge
    material: Material
    damping_ratio: float = 0.0
    """Of critical damping (Lehr), the same for every mode."""

    @property
    def bending_stiffness(self) -> float:
        """Kirchhoff bending stiffness D = E h^3 / (12 (1 - nu^2)), N m."""
        return self.material.plane_strain_modulus * self.thickness**3 / 12.0

    @property
    def surface_density(self) -> float:
        """Mass per area rho h, kg/m^2."""
        return self.material.density * self.thickness


@dataclass(frozen=True)
class Sphere:
    """Solid sphere."""

    RADIUS_KEY: ClassVar[str] = "radius"
    """Of its tip radius in a scene."""
    radius: float
    material: Material

    @property
    def volume(self) -> float:
        """4/3 pi r^3, m^3."""
        return 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self.material.density * self.volume

    @property
    def tip_radius(self) -> float:
        """Radius of curvature at the contact, m."""
        return self.radius


@dataclass(frozen=True)
class Compact:
    """Body that is rigid but for its spherical tip, which yields as a half-space does."""

    RADIUS_KEY: ClassVar[str] = "tip_radius"
    mass: float
    """kg"""
    tip_radius: float
    """m"""
    material: Material
    """Of the tip."""
    moment_of_inertia: float | None = None
    """kg m^2; no reference turns such a body."""


@dataclass(frozen=True)
class Bender:
    """Beam with a tip mass that is bent and released; its tip is that of a compact body."""

    RADIUS_KEY: ClassVar[str] = "tip_radius"
    beam: Annotated[Beam, At()]
    tip_radius: float
    """m"""
    material: Material
    """Of the tip."""
    speed: float
    """Of the tip at the strike, m/s."""
    discharge_time: float = 0.0
    """With which its moment decays after the release, s."""
    strike_at: float = 0.0
    """Deflection of the tip at the strike over that before the release."""

    @cached_property
    def strike(self) -> Strike:
        """The state in which it strikes."""
        return self.beam.strike(self.speed, self.discharge_time, self.strike_at)

    @property
    def offset(self) -> float:
        """Deflection of the tip at the strike, m."""
        return self.strike_at * self.strike.moment * self.beam.tip_deflection

    @property
    def mass(self) -> float:
        """That has its kinetic energy at the speed of its tip, kg."""
        return 2.0 * self.strike.kinetic_energy / self.speed**2


@dataclass(frozen=True)
class Supply:
    """A charged buffer behind a resistor."""

    resistance: float
    """Ohm"""
    buffer_capacitance: float | None = None
    """F; None: so large that its voltage stays."""

    @property
    def elastance(self) -> float:
        """Of the buffer, 1/F."""
        return 0.0 if self.buffer_capacitance is None else 1.0 / self.buffer_capacitance


@dataclass(frozen=True)
class Stack:
    """Round rod of piezo layers, fixed at its base; its tip is that of a compact body."""

    RADIUS_KEY: ClassVar[str] = "tip_radius"
    length: float
    """m"""
    area: float
    """Of the section, m^2."""
    stroke: float
    """Free, at `voltage`, m."""
    blocked_force: float
    """At `voltage`, N."""
    voltage: float
    """V"""
    capacitance: float
    """Free, F."""
    density: float
    """kg/m^3"""
    poisson_ratio: float
    tip_radius: float
    """m"""
    gap: float
    """Of the tip before the voltage is switched on, m."""
    drive: Supply | None
    """None: a source that holds the voltage."""
    material: Material
    """Of the tip."""

    @property
    def radius(self) -> float:
        """Of a round section, m."""
        return math.sqrt(self.area / math.pi)

    @property
    def force_per_voltage(self) -> float:
        """N/V, and charge per extension, C/m."""
        return self.blocked_force / self.voltage

    @property
    def stiffness(self) -> float:
        """At constant voltage, N/m."""
        return self.blocked_force / self.stroke

    @property
    def clamped_capacitance(self) -> float:
        """Of the stack held at its length, F."""
        return self.capacitance - self.force_per_voltage**2 / self.stiffness

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self.density * self.area * self.length

    @property
    def ceramic(self) -> Material:
        """What all of it is made of, so that its stiffness is `stiffness`."""
        modulus = self.stiffness * self.length / self.area
        return Material("stack", modulus, self.poisson_ratio, self.density)

    @property
    def step_speed(self) -> float:
        """Of the tip after a step of the voltage: stroke c / L, m/s."""
        wave_speed = math.sqrt(self.stiffness * self.length / (self.area * self.density))
        return self.stroke * wave_speed / self.length

    @property
    def energy(self) -> float:
        """Half of blocked force times stroke, the measure of what it can give, J."""
        return 0.5 * self.blocked_force * self.stroke


Body = Sphere | Compact | Bender | Stack


def sphere_profile(radius: float, r: Floats) -> Floats:
    """Height of the undeformed sphere above its tangent plane: R - sqrt(R^2 - r^2), m.

    Written without the difference of two nearly equal numbers.
    """
    return np.asarray(r**2 / (radius + np.sqrt(radius**2 - r**2)))
