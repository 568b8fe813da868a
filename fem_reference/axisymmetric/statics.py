"""Bodies at rest: under a load, and as plastic strain leaves them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse.linalg

from ..common.arrays import Floats, Ints
from .system import AxisymmetricSystem


class Statics:
    """One body of a system under loads; a body that nothing supports is in equilibrium with them.

    Args:
        system: bodies.
        body: its number.
    """

    def __init__(self, system: AxisymmetricSystem, body: int) -> None:
        first, end = system.first[body], system.first[body + 1]
        self._system, self._rows = system, system.body(body)
        self.mass = system.mass[first:end]
        self.supported = bool(np.any((system.supports >= first) & (system.supports < end)))
        self.free = np.flatnonzero(system.inverse_mass[self._rows] > 0.0)
        if not self.supported:
            # One axial component pinned: the load is in equilibrium, so the pin carries nothing.
            self.free = self.free[self.free != 2 * self.mass.size - 1]

    @cached_property
    def _factors(self) -> Any:
        stiffness = self._system.stiffness[self._rows, self._rows].tocsc()
        return scipy.sparse.linalg.splu(stiffness[self.free][:, self.free])

    def solve(self, load: Floats) -> Floats:
        """(2n,) displacement under ``load`` (2n,) in N; without support its mean is zero, m."""
        solution = np.zeros_like(load)
        if self.free.size == 0:
            return solution
        solution[self.free] = self._factors.solve(load[self.free])
        if not self.supported:
            solution[1::2] -= self.mass @ solution[1::2] / self.mass.sum()
        return solution


def patch_flexibility(system: AxisymmetricSystem, body: int, nodes: Ints, weights: Floats) -> float:
    """Axial flexibility of a body over a patch, p^T K^-1 p, m/N.

    The mean displacement, weighted with ``weights``, under a unit axial force spread with the
    same weights over ``nodes``: static if the body is supported, otherwise that of the free
    body under the force and its own inertia, rigid motion apart (inertia relief).
    """
    statics = Statics(system, body)
    load = np.zeros(2 * statics.mass.size)
    load[2 * (nodes - system.first[body]) + 1] = weights
    patch = load.copy()
    if not statics.supported:
        load[1::2] -= statics.mass / statics.mass.sum()
    return float(patch @ statics.solve(load))


class Rest:
    """How a system lies when plastic strain is all that acts: K u = f_p."""

    def __init__(self, system: AxisymmetricSystem) -> None:
        self._system = system
        self._bodies = [Statics(system, body) for body in range(system.first.size - 1)]

    def displacement(self, force: Floats) -> Floats:
        """(2n,) under the plastic strain's load (2n,) in N; of a free body zero in the mean, m."""
        displacement = np.zeros_like(force)
        for number, statics in enumerate(self._bodies):
            rows = self._system.body(number)
            if np.any(force[rows]):
                displacement[rows] = statics.solve(force[rows])
        return displacement
