"""Flexibility of the tip of a compact body: a half-space under pressure on rings.

A compact body is rigid but for its tip, which yields as the half-space of Hertz's law does. The
tip has no mass: all of it stands in the body. The pressure of each ring is even and its
displacement the mean over the ring, so that the flexibility is symmetric and positive definite
and the tip gives back the energy it takes.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import hyp2f1

from ..common.arrays import Floats
from ..common.bodies import Material


def _between_discs(c: Floats, d: Floats) -> Floats:
    """Displacement under unit pressure on a disc of radius c, summed over one of d, times E'.

    4 pi c d int_0^inf J_1(s c) J_1(s d) / s^2 ds by the Hankel transform of Boussinesq's solution
    (Johnson 1985, Contact Mechanics, ch. 3.4); the integral is Weber and Schafheitlin's (Watson
    1944, Theory of Bessel Functions, 13.4). c = d: 16/3 c^3.
    """
    low, high = np.minimum(c, d), np.maximum(c, d)
    ratio = np.divide(low, high, out=np.zeros_like(high), where=high > 0.0)
    return np.asarray(2.0 * math.pi * c * d * low * hyp2f1(0.5, -0.5, 2.0, ratio**2))


def ring_edges(radii: Floats) -> Floats:
    """(n + 1,) edges of the rings of nodes at ``radii`` (n,), midway between them, m."""
    return np.concatenate([[0.0], 0.5 * (radii[1:] + radii[:-1]), radii[-1:]])


def tip_flexibility(material: Material, radii: Floats) -> Floats:
    """(n, n) mean displacement of each ring under a unit force on each, m/N.

    Args:
        material: of the tip.
        radii: (n,) of the nodes in the middle of the rings, ascending from 0, m.
    """
    edges = ring_edges(radii)
    discs = _between_discs(edges[:, None], edges[None, :])
    rings = np.diff(np.diff(discs, axis=0), axis=1)
    areas = math.pi * np.diff(edges**2)
    return np.asarray(rings / (material.plane_strain_modulus * np.outer(areas, areas)))
