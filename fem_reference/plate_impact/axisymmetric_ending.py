"""When a run may end: the proof that no further contact is possible.

Without contact the plate's lowest modes move as known oscillations, and what is left of its
energy bounds the rest of its motion. A body of elastic energy E (kinetic and strain, rigid motion
apart) displaces its contact patch by at most sqrt(2 E C), C = p^T K^-1 p the flexibility of the
patch with the weights p (Cauchy's inequality in the norm of K: |p^T u| = |p^T K^-1 K u| <=
sqrt(p^T K^-1 p) sqrt(u^T K u)); without the lowest modes, E and C are those of the others. The
weights are Hertz's pressure: a single node's flexibility grows without bound on finer meshes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..axisymmetric.modal import elastic_modes
from ..axisymmetric.system import INNER, OUTER, PLATE, System, hertz_weights, patch_flexibility
from ..common.arrays import Floats
from ..explicit.loop import Energies, Loop

MODES = 16
"""Modes of the plate that are followed."""
ENERGY_MARGIN = 1e-3
"""Share of the plate's energy added to that of the other modes: the time loop's frequencies and
energies are those of its time step."""
MOST_INSTANTS = 20000


def least_clearance(
    clearance: float, opening_speed: float, amplitudes: Floats, frequencies: Floats
) -> float:
    """Lower bound of clearance + opening_speed t - Re sum A_k exp(i omega_k t) over t >= 0, m.

    Args:
        clearance: m.
        opening_speed: m/s.
        amplitudes: (k,) complex A_k, m.
        frequencies: (k,) omega_k, rad/s.
    """
    reach = float(np.abs(amplitudes).sum())
    if clearance > reach and opening_speed >= 0.0:
        return float(clearance - reach)
    if not opening_speed > 0.0:
        return -math.inf
    # From here on the oscillations cannot follow any more.
    last = (reach - clearance) / opening_speed
    step = 2.0 * math.pi / float(frequencies.max()) / 40.0
    count = math.ceil(last / step) + 1
    if count > MOST_INSTANTS:
        return -math.inf
    t = np.linspace(0.0, last, count + 1)
    plate = (amplitudes[:, None] * np.exp(1j * frequencies[:, None] * t)).real.sum(axis=0)
    # Between two instants a curve lies below its chord by at most its curvature times step^2/8.
    curvature = float((np.abs(amplitudes) * frequencies**2).sum())
    sag = curvature * (t[1] - t[0]) ** 2 / 8.0
    return float((clearance + opening_speed * t - plate).min() - sag)


@dataclass(frozen=True)
class PlatePatch:
    """How one contact patch of the plate moves with its modes."""

    shares: Floats
    """(k,) mean of each mode's axial displacement over the patch, 1/sqrt(kg)."""
    rest: float
    """Flexibility of the patch without these modes, m/N."""


class EndCheck:
    """Whether any further contact is possible."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.free_plate = system.supports.size == 0
        self.frequencies, self.modes = elastic_modes(system, MODES)
        start = int(system.first[PLATE])
        self.patches, self.sphere_flexibility = [], []
        for body, pairs in zip((OUTER, INNER), system.contacts, strict=True):
            weights = hertz_weights(pairs.radii)
            shares = weights @ self.modes[2 * (pairs.plate_nodes - start) + 1]
            whole = patch_flexibility(system, PLATE, pairs.plate_nodes, weights)
            rest = whole - float(np.sum((shares / self.frequencies) ** 2))
            self.patches.append(PlatePatch(shares, max(rest, 0.0)))
            flexibility = patch_flexibility(system, body, pairs.sphere_nodes, weights)
            self.sphere_flexibility.append(flexibility)

    def __call__(self, loop: Loop, energies: Energies) -> bool:
        """Whether the state allows no further contact."""
        system, rows = self.system, self.system.body(PLATE)
        if any(contact.force > 0.0 for contact in loop.state.contact):
            return False
        mass = np.repeat(system.mass, 2)[rows]
        position = self.modes.T @ (mass * loop.u[rows])
        velocity = self.modes.T @ (mass * loop.v[rows])
        modal = 0.5 * (velocity**2 + (self.frequencies * position) ** 2)
        # Of exp(i omega t) the real part counts: q cos + (dq/dt / omega) sin.
        motion = position - 1j * velocity / self.frequencies
        elastic = energies.total[PLATE]
        plate_position = plate_velocity = 0.0
        if self.free_plate:
            elastic -= energies.rigid[PLATE]
            plate_position = loop.mean_axial(loop.u, PLATE)
            plate_velocity = loop.mean_axial(loop.v, PLATE)
        rest = max(elastic - float(modal.sum()), 0.0) + ENERGY_MARGIN * elastic
        for body, pairs, patch, flexibility in zip(
            (OUTER, INNER), system.contacts, self.patches, self.sphere_flexibility, strict=True
        ):
            vibration = max(energies.total[body] - energies.rigid[body], 0.0)
            reach = math.sqrt(2.0 * rest * patch.rest) + math.sqrt(2.0 * vibration * flexibility)
            opened = loop.mean_axial(loop.u, body) - plate_position
            opening = loop.mean_axial(loop.v, body) - plate_velocity
            least = least_clearance(
                float(pairs.gap.min()) + pairs.normal * opened - reach,
                pairs.normal * opening,
                pairs.normal * patch.shares * motion,
                self.frequencies,
            )
            if not least > 0.0:
                return False
        return True
