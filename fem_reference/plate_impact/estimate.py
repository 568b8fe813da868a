"""Contact radii, forces and duration estimated before any mesh exists.

Hertz's contact law for both contacts and Zener's equation for the plate: a point-loaded
infinite Kirchhoff plate answers a force F with the velocity F / (8 sqrt(rho h D)) of the
loaded point (Boussinesq; Zener 1941, Phys. Rev. 59, 669, eq. 10). The estimate sizes the
mesh and is verified after the run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ..common.bodies import Body, Material
from ..common.hertz import (
    effective_modulus,
    hertz_contact_radius,
    hertz_stiffness,
    hertz_time_scale,
)
from .scene import Scene

ACCEPTED_SHARE = 0.9
"""Least share of the requested elements per contact radius that is accepted."""
MOST_MESHES = 3
WAVE_FREQUENCY = 3.0
"""Highest frequency resolved, times the shorter Hertz contact duration.

The spectrum of Hertz's pulse (about a half sine to the power 3/2) is below 1 % of its value at
zero from there on.
"""

MINOR_FORCE = 0.05
"""A contact whose force stays below this share of the other one's does not refine the mesh."""


@dataclass(frozen=True)
class ContactEstimate:
    """What the mesh and the time loop need to know in advance."""

    outer_radius: float
    """Largest contact radius between outer body and plate, m."""
    inner_radius: float
    """The same for the inner body, m."""
    duration: float
    """Shorter of the two Hertz contact durations, s."""
    longest: float
    """The longer one."""


def estimate_contact(scene: Scene) -> ContactEstimate:
    """Integrate the two-sided Zener equation over the first contact."""
    plate = scene.plate
    bodies: tuple[Body, Body] = (scene.outer, scene.inner)
    effective = [effective_modulus(body.material, plate.material) for body in bodies]
    stiffness = [
        hertz_stiffness(e, body.tip_radius) for e, body in zip(effective, bodies, strict=True)
    ]
    mobility = 1.0 / (8.0 * math.sqrt(plate.surface_density * plate.bending_stiffness))
    scale = hertz_time_scale(scene.outer.mass, stiffness[0], scene.normal_speed)
    length = scene.normal_speed * scale

    def forces(y: NDArray[np.float64]) -> NDArray[np.float64]:
        # y = outer, its velocity, plate, inner, its velocity, in units of length and scale
        approach = length * np.array([y[2] - y[0], y[3] - y[2] - scene.gap / length])
        return np.asarray(np.array(stiffness) * np.maximum(approach, 0.0) ** 1.5)

    def rate(_: float, y: NDArray[np.float64]) -> list[float]:
        outer, inner = forces(y)
        unit = scale / scene.normal_speed
        return [
            y[1],
            unit * outer / scene.outer.mass,
            mobility * (inner - outer) / scene.normal_speed,
            y[4],
            -unit * inner / scene.inner.mass,
        ]

    # Until the plate's point has moved as far as the spheres can: four Hertz durations are ample.
    path = solve_ivp(
        rate,
        (0.0, 13.0),
        [0.0, -1.0, 0.0, -scene.gap / length, scene.inner_speed / scene.normal_speed],
        rtol=1e-6,
        atol=1e-9,
        max_step=0.05,
    )
    history = np.array([forces(y) for y in path.y.T])
    peak = history.max(axis=0)
    if peak[1] > 0.0:
        peak = np.maximum(peak, MINOR_FORCE * peak.max())
    radii = [
        hertz_contact_radius(force, e, body.tip_radius)
        for force, e, body in zip(peak, effective, bodies, strict=True)
    ]
    if peak[1] == 0.0:
        # Not reached in the first contact: the mesh is made for the other one, and verified.
        radii[1] = min(radii[0], 0.15 * scene.inner.tip_radius)
    speeds = (scene.normal_speed, max(scene.normal_speed, scene.inner_speed))
    radii = [
        max(radius, _dented_radius(radius, force, body, plate.material))
        for radius, force, body in zip(radii, peak, bodies, strict=True)
    ]
    durations = [
        3.218 * hertz_time_scale(body.mass, k, speed)
        for k, body, speed in zip(stiffness, bodies, speeds, strict=True)
    ]
    return ContactEstimate(radii[0], radii[1], min(durations), max(durations))


FULL_YIELDING = 2.8
"""Mean pressure of a fully developed dent over the yield strength (Johnson 1985, ch. 6.3)."""


def _dented_radius(radius: float, force: float, body: Body, plate: Material) -> float:
    """Radius in m of the dent that takes the energy of Hertz's contact at a peak; 0 if elastic.

    The energy is 2/5 F a^2/R; a dent under a constant pressure p takes pi p a^4 / (4 R).
    """
    laws = [law for law in (body.material.yielding, plate.yielding) if law is not None]
    if not laws:
        return 0.0
    pressure = FULL_YIELDING * min(law.strength for law in laws)
    return math.pow(1.6 * force * radius**2 / (math.pi * pressure), 0.25)


def shortest_wavelengths(scene: Scene, duration: float) -> tuple[float, float, float]:
    """Shortest wavelength that matters in outer sphere, plate and inner sphere, m.

    At the frequency f = `WAVE_FREQUENCY` / duration: shear sqrt(G/rho)/f, in the plate also
    bending sqrt(2 pi/f) (D/(rho h))^(1/4) (Kirchhoff).
    """
    frequency = WAVE_FREQUENCY / duration
    plate = scene.plate
    bending = (
        math.sqrt(2.0 * math.pi / frequency)
        * (plate.bending_stiffness / plate.surface_density) ** 0.25
    )

    def shear(material: Material) -> float:
        return math.sqrt(material.shear_modulus / material.density) / frequency

    return (
        shear(scene.outer.material),
        min(bending, shear(plate.material)),
        shear(scene.inner.material),
    )


FIELD_DURATIONS = 2.5
"""A run without end time is covered by fields over this many of the longer contact durations."""


def field_times(scene: Scene, count: int) -> tuple[float, ...]:
    """``count`` even instants over the run, s; those after its end are never reached."""
    if count == 0:
        return ()
    end = scene.end_time or FIELD_DURATIONS * estimate_contact(scene).longest
    return tuple(float(t) for t in np.linspace(0.0, end, count))
