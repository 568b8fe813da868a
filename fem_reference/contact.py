"""Contact between a sphere and the plate: node pairs, intervals, and a bound on re-contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .mesh import Floats, Ints
from .scene import Sphere


@dataclass(frozen=True)
class ContactPairs:
    """Node pairs of one contact in the numbering of the whole system."""

    name: str
    normal: float
    """+1 if the sphere lies above the plate, else -1."""
    sphere_nodes: Ints
    plate_nodes: Ints
    radii: Floats
    gap: Floats
    """(n,) initial gap of each pair along z, m."""


def sphere_profile(radius: float, r: Floats) -> Floats:
    """Height of the undeformed sphere above its tangent plane: R - sqrt(R^2 - r^2), m.

    Written without the difference of two nearly equal numbers.
    """
    return np.asarray(r**2 / (radius + np.sqrt(radius**2 - r**2)))


def pair_nodes(
    name: str, normal: float, sphere_nodes: Ints, plate_nodes: Ints, radii: Floats,
    sphere: Sphere, gap: float,
) -> ContactPairs:
    """Node pairs with the exact gap of a sphere that stands ``gap`` (m) off the plate."""
    return ContactPairs(
        name, normal, sphere_nodes, plate_nodes, radii, gap + sphere_profile(sphere.radius, radii)
    )


@dataclass(frozen=True)
class ContactRecord:
    """What the time loop found out about one contact."""

    count: int
    """Separate contacts. Separations shorter than the chatter limit do not count."""
    end: float | None
    """End of the last one, s; None if they never touched."""
    intervals: tuple[tuple[float, float], ...]
    """First and last instant of each contact, s."""
    force_peak: float
    """N, averaged over the peak window."""
    impulse: float
    """N s"""
    work: float
    """Change of the discrete energy by the contact constraint, J: loss if negative."""
    outermost_radius: float
    """Largest radius of a pair that carried force, m."""


CHATTER_FRACTION = 0.005
"""Separations shorter than this share of the Hertz duration are chatter of single nodes."""

PEAK_WINDOW_FRACTION = 1.0 / 600.0
"""Window of the peak force over the Hertz contact duration (0.13 us for 78 us).

Node pairs close and open one by one; the force of a single step jumps by a percent. The
mean over a window much shorter than the contact removes that, and lowers the peak of a smooth
pulse by only (pi * fraction)^2 / 24 of itself, about 1e-6.
"""


def peak_force(cumulative_impulse: Floats, window: int, sample_interval: float) -> float:
    """Largest mean force (N) over any ``window`` consecutive sampling intervals."""
    if cumulative_impulse.size <= window:
        return float(cumulative_impulse[-1] / (sample_interval * max(1, window)))
    means = (cumulative_impulse[window:] - cumulative_impulse[:-window]) / (
        window * sample_interval
    )
    return float(means.max())


def no_further_contact(
    clearance: float, opening_speed: float, plate_energy: float, plate_flexibility: float,
    sphere_energy: float, sphere_flexibility: float,
) -> bool:
    """Whether a sphere and the plate can be proven never to touch again.

    A body of elastic energy E (kinetic and strain, rigid motion apart) displaces its contact
    patch by at most sqrt(2 E C), C = p^T K^-1 p the flexibility of the patch with the weights p
    (Cauchy's inequality in the norm of K: |p^T u| = |p^T K^-1 K u| <= sqrt(p^T K^-1 p)
    sqrt(u^T K u)). The weights are Hertz's pressure: a single node's flexibility grows without
    bound on finer meshes. Two bodies whose rigid motions part, and are further apart than both
    bounds, stay apart.

    Args:
        clearance: distance of the undeformed bodies in their rigid motion, m.
        opening_speed: rate of the clearance, m/s.
        plate_energy: J.
        plate_flexibility: larger static flexibility of the plate's two contact patches, m/N.
        sphere_energy: elastic energy of the sphere, J.
        sphere_flexibility: its inertia-relief flexibility, m/N.
    """
    reach = math.sqrt(2.0 * max(plate_energy, 0.0) * plate_flexibility) + math.sqrt(
        2.0 * max(sphere_energy, 0.0) * sphere_flexibility
    )
    return opening_speed >= 0.0 and clearance > reach
