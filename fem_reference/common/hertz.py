"""Hertz's contact of a sphere with a half-space."""

from __future__ import annotations

import math

from .bodies import Material


def effective_modulus(a: Material, b: Material) -> float:
    """Hertz's E*, 1/E* = sum (1 - nu^2)/E, Pa."""
    return 1.0 / (1.0 / a.plane_strain_modulus + 1.0 / b.plane_strain_modulus)


def hertz_stiffness(effective: float, radius: float) -> float:
    """K in F = k delta^(3/2): 4/3 E* sqrt(R), N/m^(3/2)."""
    return 4.0 / 3.0 * effective * math.sqrt(radius)


def hertz_contact_radius(force: float, effective: float, radius: float) -> float:
    """Contact radius (3 F R / (4 E*))^(1/3), m."""
    return math.pow(3.0 * force * radius / (4.0 * effective), 1.0 / 3.0)


def hertz_approach(mass: float, speed: float, stiffness: float) -> float:
    """Largest approach (5 m v^2 / (4 k))^(2/5) in an impact on a rigid wall, m."""
    return float((1.25 * mass * speed**2 / stiffness) ** 0.4)


def hertz_time_scale(mass: float, stiffness: float, speed: float) -> float:
    """T = (m / (k sqrt v))^(2/5), s; a contact lasts 3.218 T, the force peaks at 1.1433 m v/T."""
    return float((mass / (stiffness * math.sqrt(speed))) ** 0.4)
