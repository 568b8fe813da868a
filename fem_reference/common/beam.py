"""Piezo bender: a cantilever of Hermite cubics with lumped mass, bent, released, striking.

Euler-Bernoulli, clamped at its first node, a point mass at its last. A piezo layer's uniform
bending moment is a moment at the tip, which the cubics bear exactly. Masses are lumped after
Hinton, Rock & Zienkiewicz (1976, Earthquake Eng. Struct. Dyn. 4, 245): at each end half of an
element's mass, and 1/78 of it times its length squared as rotary inertia. Rotations are scaled by
the radius of gyration of their node, so that both components of a node have one mass: the beam
steps like any other body.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.optimize

from .arrays import Floats

ELEMENTS = 192
"""Of the beam: with a tip as heavy as that of section 4.3 of the paper the first frequency is then
off by 5e-6, the tenth by 3e-4."""
ROTARY = 1.0 / 78.0
INSTANTS = 4000
"""In the first period, at which the tip's passage is looked for."""
ROTATION, DEFLECTION = range(2)


@dataclass(frozen=True)
class Strike:
    """The beam at the instant at which its tip, released, passes its straight position."""

    time: float
    """Since the release, s."""
    moment: float
    """Before the release, N m."""
    displacement: Floats
    """(n, 2) scaled rotation and deflection, away from the plate, m."""
    velocity: Floats
    """(n, 2) m/s"""
    strain_energy: float
    """Before the release, J."""
    energy: float
    """At the strike, J."""
    kinetic_energy: float
    """At the strike, J."""
    moment_left: float
    """Share of the moment that is left."""
    momentum: float
    """Along the deflection, kg m/s."""


@dataclass(frozen=True)
class Beam:
    """Clamped at the first node, with a mass at the last one."""

    length: float
    """m"""
    bending_stiffness: float
    """E I, N m^2"""
    line_mass: float
    """rho A, kg/m"""
    tip_mass: float
    """kg"""
    elements: int = ELEMENTS

    @property
    def element_length(self) -> float:
        """Between two nodes, m."""
        return self.length / self.elements

    @cached_property
    def mass(self) -> Floats:
        """(n,) of the nodes, kg."""
        mass = np.full(self.elements + 1, self.line_mass * self.element_length)
        mass[[0, -1]] *= 0.5
        mass[-1] += self.tip_mass
        return mass

    @cached_property
    def gyration(self) -> Floats:
        """(n,) radius by which each node's rotation is scaled, m."""
        ends = np.full(self.elements + 1, 2.0)
        ends[[0, -1]] = 1.0
        inertia = ROTARY * self.line_mass * self.element_length**3 * ends
        return np.asarray(np.sqrt(inertia / self.mass))

    @cached_property
    def element_stiffness(self) -> Floats:
        """(m, 4, 4) scaled rotation and deflection of both ends, N/m."""
        h = self.element_length
        cubics = np.array(
            [
                [4.0 * h * h, 6.0 * h, 2.0 * h * h, -6.0 * h],
                [6.0 * h, 12.0, 6.0 * h, -12.0],
                [2.0 * h * h, 6.0 * h, 4.0 * h * h, -6.0 * h],
                [-6.0 * h, -12.0, -6.0 * h, 12.0],
            ]
        )
        scale = np.ones((self.elements, 4))
        scale[:, 0], scale[:, 2] = 1.0 / self.gyration[:-1], 1.0 / self.gyration[1:]
        return np.asarray(
            self.bending_stiffness / h**3 * cubics * scale[:, :, None] * scale[:, None, :]
        )

    @cached_property
    def flexibility(self) -> Floats:
        """(2n - 2, 2n - 2) displacements under unit forces, the clamped node left out, m/N.

        Of the beam itself, since cubics are what point loads bend it to: inverting the stiffness
        would cost low modes of fine beams half their digits.
        """
        x, g = self.element_length * np.arange(1, self.elements + 1), self.gyration[1:]
        near, far = np.minimum.outer(x, x), np.maximum.outer(x, x)
        turned = g[:, None] * near * (2.0 * x - near) / 2.0
        flexibility = np.empty((2 * x.size,) * 2)
        flexibility[ROTATION::2, ROTATION::2] = near * np.outer(g, g)
        flexibility[ROTATION::2, DEFLECTION::2] = turned
        flexibility[DEFLECTION::2, ROTATION::2] = turned.T
        flexibility[DEFLECTION::2, DEFLECTION::2] = near**2 * (3.0 * far - near) / 6.0
        return flexibility / self.bending_stiffness

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Angular frequencies (k,), rad/s, ascending, and shapes (2n - 2, k) of unit modal mass."""
        root = np.repeat(np.sqrt(self.mass[1:]), 2)
        squares, shapes = scipy.linalg.eigh(self.flexibility * np.outer(root, root))
        return 1.0 / np.sqrt(squares[::-1]), shapes[:, ::-1] / root[:, None]

    @property
    def bent(self) -> Floats:
        """(2n - 2,) displacement under a uniform bending moment of 1 N m."""
        return np.asarray(self.flexibility[:, -2 + ROTATION] / self.gyration[-1])

    @property
    def tip_deflection(self) -> float:
        """Under a uniform bending moment of 1 N m, m."""
        return float(self.bent[-2 + DEFLECTION])

    def swing(self, decay: float, time: float) -> tuple[Floats, Floats]:
        """Modal displacements and velocities after a release from 1 N m.

        q'' + omega^2 q = omega^2 q_0 exp(-t/decay): the moment decays as a piezo layer discharges.

        Args:
            decay: time constant, s; 0: the moment is gone at once.
            time: since the release, s.
        """
        frequencies, shapes = self.modes
        start = shapes.T @ (np.repeat(self.mass[1:], 2) * self.bent)
        left = math.exp(-time / decay) if decay > 0.0 else 0.0
        lag = frequencies * decay
        forced = start * lag**2 / (1.0 + lag**2)
        # Free motion from what the forced one lacks at the start: q_0 - forced, and forced / decay.
        free = start / (1.0 + lag**2) * (1.0 - 1j * lag) * np.exp(1j * frequencies * time)
        rate = (1j * frequencies * free).real
        return free.real + forced * left, rate - (forced * left / decay if decay > 0.0 else 0.0)

    def strike(self, speed: float, decay: float = 0.0, at: float = 0.0) -> Strike:
        """Released from the moment with which the tip strikes at ``speed`` m/s; see `swing`.

        Args:
            speed: m/s
            decay: see `swing`.
            at: deflection at the strike over that before the release.
        """
        frequencies, shapes = self.modes
        tip = shapes[-2 + DEFLECTION]

        def place(time: float) -> float:
            return float(tip @ self.swing(decay, time)[0]) - at * self.tip_deflection

        times = np.linspace(0.0, 2.0 * math.pi / frequencies[0] + 10.0 * decay, INSTANTS)
        after = next(t for t in times if place(t) < 0.0)
        time = float(scipy.optimize.brentq(place, after - times[1], after, xtol=1e-16))
        places, rates = self.swing(decay, time)
        moment = -speed / float(tip @ rates)
        displacement, velocity = np.zeros((2, self.elements + 1, 2))
        displacement[1:].flat = moment * (shapes @ places)
        velocity[1:].flat = moment * (shapes @ rates)
        kinetic = 0.5 * moment**2 * float(rates @ rates)
        slope = float(self.bent[-2 + ROTATION] / self.gyration[-1])
        return Strike(
            time=time,
            moment=moment,
            displacement=displacement,
            velocity=velocity,
            strain_energy=0.5 * moment**2 * slope,
            energy=kinetic + 0.5 * moment**2 * float(((frequencies * places) ** 2).sum()),
            kinetic_energy=kinetic,
            moment_left=math.exp(-time / decay) if decay > 0.0 else 0.0,
            momentum=float(self.mass @ velocity[:, DEFLECTION]),
        )
