"""A squeeze film between two bodies, as the time loop solves for it (`film.c`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from . import kernel, structures


@dataclass(frozen=True)
class Viscosity:
    """Effective viscosity over the apparent rate of shear, 6 flow per width / gap^2."""

    rates: Floats
    """(k,) ascending in equal ratios, 1/s; of a Newtonian fluid a single one, whichever."""
    values: Floats
    """(k,) Pa s; held beyond both ends."""


@dataclass(frozen=True)
class Film:
    """Its nodes and what they move with."""

    radii: Floats
    """(n + 1,) ascending from 0 to the edge, where the pressure is 0, m."""
    areas: Floats
    """(n,) of the rings of all nodes but the last, m^2."""
    nodes: Ints
    """(p,) of the bodies, in the numbering of all nodes."""
    corners: Ints
    """(n, 3) among `nodes`: one above and two below each node of the film."""
    weights: Floats
    """(n, 3) of their axial motion in its opening; 1 above and -1 below in sum."""
    gap: float
    """On the axis at the start, m."""
    curvature: float
    """The gap grows by this times r^2, 1/m."""
    minimum_gap: float
    """Narrower ones resist as this one, m."""
    viscosity: Viscosity


def compiled(film: Film, arrays: kernel.Arrays) -> structures.Film:
    """The kernel's structure of a film at rest; ``arrays`` keeps what it points to."""
    made, viscosity = structures.Film(), film.viscosity
    made.count, made.places = film.areas.size, film.nodes.size
    made.node = arrays.pointer(film.nodes, np.int32)
    made.corner = arrays.pointer(film.corners, np.int32)
    for name, values in {
        "weight": film.weights,
        "radius": film.radii,
        "area": film.areas,
        "viscosity": viscosity.values,
    }.items():
        setattr(made, name, arrays.pointer(values, np.float64))
    for name in ("pressure", "flow", "load", "before"):
        setattr(made, name, arrays.pointer(np.zeros(film.areas.size), np.float64))
    made.gap, made.curvature, made.minimum_gap = film.gap, film.curvature, film.minimum_gap
    made.rates, made.first_rate = viscosity.rates.size, float(viscosity.rates[0])
    made.log_ratio = float(np.log(viscosity.rates[1] / viscosity.rates[0])) if made.rates > 1 else 1
    return made
