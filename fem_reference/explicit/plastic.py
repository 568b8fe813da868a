"""Elements that may yield, and what they remember, as the time loop steps them (`plastic.c`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from . import kernel, structures


@dataclass(frozen=True)
class Plasticity:
    """Axisymmetric elements of four corners and four Gauss points that may yield."""

    nodes: Ints
    """(m, 4) corners, in the numbering of all nodes."""
    gradients: Floats
    """(m, 12, 4) at the points: dN/dr of the corners, dN/dz, N/r, 1/m."""
    weights: Floats
    """(m, 4) 2 pi r dr dz, m^3."""
    shear: Floats
    """(m,) modulus, Pa."""
    yield_strength: Floats
    """(m,) Pa."""
    hardening: Floats
    """(m,) slope of the yield stress over the plastic strain, Pa."""
    rate: Floats
    """(m,) of strain that doubles the yield stress, 1/s; 0: it does not matter."""
    exponent: Floats
    """(m,) the yield stress grows by 1 + (rate / `rate`)^(1/exponent)."""
    contact: Ints
    """(m,) number of the contact they lie at."""
    edge: Mask
    """(m,) whether an element beside it may not yield."""

    def load(self, strain: Floats) -> Floats:
        """(m, 8) f_p = sum w B^T 2 mu eps_p of each element from ``strain`` (m, 4, 4), N."""
        scale = self.weights * self.shear[:, None]
        rr, tt, zz = (2.0 * scale * strain[:, k] for k in range(3))
        rz = scale * strain[:, 3]
        r, z, hoop = (self.gradients[:, 4 * k : 4 * k + 4] for k in range(3))

        def over(gradient: Floats, stress: Floats) -> Floats:
            return np.asarray(np.einsum("mag,mg->ma", gradient, stress))

        load = np.empty((self.nodes.shape[0], 8))
        load[:, 0::2] = over(r, rr) + over(hoop, tt) + over(z, rz)
        load[:, 1::2] = over(z, zz) + over(r, rz)
        return load


class PlasticState:
    """What the elements remember, in the kernel's structure.

    Args:
        plasticity: of the elements.
        nodes: of the system.

    Attributes:
        strain: (m, 4, 4) plastic rr, tt, zz and twice rz at the points.
        accumulated: (m, 4) equivalent plastic strain.
        work: (m,) plastic, since the run began, J.
        force: (2 nodes,) load of the plastic strain, N.
    """

    def __init__(self, plasticity: Plasticity, nodes: int) -> None:
        self.plasticity = plasticity
        count = plasticity.nodes.shape[0]
        self.strain, self.accumulated = np.zeros((count, 4, 4)), np.zeros((count, 4))
        self.work, self.force = np.zeros(count), np.zeros(2 * nodes)
        self._arrays = kernel.Arrays()
        pointer = self._arrays.pointer
        touched = np.unique(plasticity.nodes)
        self.structure = structures.Plastic()
        self.structure.elements, self.structure.nodes = count, touched.size
        self.structure.touched = pointer(touched, np.int32)
        self.structure.node = pointer(plasticity.nodes, np.int32)
        for name, values in {
            "gradient": plasticity.gradients,
            "weight": plasticity.weights,
            "shear": plasticity.shear,
            "yield_strength": plasticity.yield_strength,
            "hardening": plasticity.hardening,
            "rate": plasticity.rate,
            "exponent": plasticity.exponent,
            "strain": self.strain,
            "accumulated": self.accumulated,
            "work": self.work,
            "force": self.force,
        }.items():
            setattr(self.structure, name, pointer(values, np.float64))

    def remember(self, strain: Floats, accumulated: Floats) -> None:
        """Take over what elements of the same kind remember of an earlier run."""
        self.strain[:], self.accumulated[:] = strain, accumulated
        nodes, load = self.plasticity.nodes, self.plasticity.load(strain)
        rows = (2 * nodes[:, :, None] + np.arange(2)).reshape(-1)
        self.force[:] = np.bincount(rows, load.ravel(), self.force.size)

    def stored(self) -> Floats:
        """(m,) 1/2 eps_p 2 mu eps_p of each element, J."""
        square = (self.strain[:, :3] ** 2).sum(axis=1) + 0.5 * self.strain[:, 3] ** 2
        return np.asarray(self.plasticity.shear * (self.plasticity.weights * square).sum(axis=1))

    def locked_in(self, displacement: Floats) -> Floats:
        """(m,) share of each element in the elastic energy at rest, J.

        Args:
            displacement: (2 nodes,) at rest, K u = f_p, m.
        """
        nodes, load = self.plasticity.nodes, self.plasticity.load(self.strain)
        rows = (2 * nodes[:, :, None] + np.arange(2)).reshape(-1, 8)
        return np.asarray(self.stored() - 0.5 * (load * displacement[rows]).sum(axis=1))

    def at_the_edge(self) -> bool:
        """Whether elements yield that lie at the edge of those that may."""
        return bool(np.any(self.accumulated[self.plasticity.edge] > 0.0))
