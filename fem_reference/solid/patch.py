"""Where a contact can be on a body: its nodes, and the load that stands for the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from ..explicit.loop import Loop


@dataclass(frozen=True)
class Patch:
    """Candidates of a contact."""

    nodes: Ints
    areas: Floats
    """(n,) m^2"""
    normals: Floats
    """(n, 3) unit normals, out of the body."""
    reach: float
    """m"""
    distances: Floats
    """(n,) from where the contact begins, m, ascending."""

    def load(self, loop: Loop, body: int) -> Floats:
        """(3 n,) unit load along the normals that falls off parabolically with the distance."""
        load = np.zeros((loop.system.mass.size, 3))
        first = int(loop.system.first[body])
        load[first + self.nodes] = self.weights()[:, None] * self.normals
        return loop.own(load)

    def weights(self) -> Floats:
        """(n,) shares of the nodes in that load."""
        weights = self.areas * np.maximum(0.0, 1.0 - (self.distances / self.reach) ** 2)
        return np.asarray(weights / weights.sum())
