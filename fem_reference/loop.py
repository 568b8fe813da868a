"""State of the compiled time loop: what it points to, and its discrete energies."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse

from . import kernel
from .mesh import Floats
from .system import System


@dataclass(frozen=True)
class Energies:
    """Discrete energy of each body (1/2 v_{n+1/2} M v_{n+1/2} + 1/2 u_n K u_{n+1}), J.

    Central differences without contact conserve it exactly (e.g. Hairer, Lubich & Wanner,
    Geometric Numerical Integration).
    """

    total: tuple[float, float, float]
    rigid: tuple[float, float, float]
    """Share of the axial rigid motion."""


_C_TYPES: dict[type[np.generic], Any] = {
    np.int32: ctypes.c_int32,
    np.int64: ctypes.c_int64,
    np.float64: ctypes.c_double,
}


def _upper_blocks(stiffness: scipy.sparse.csr_matrix) -> scipy.sparse.bsr_matrix:
    """The 2x2 blocks on and above the diagonal, the diagonal one first in each row."""
    blocks = stiffness.tobsr((2, 2))
    blocks.sort_indices()
    rows = np.repeat(np.arange(blocks.indptr.size - 1), np.diff(blocks.indptr))
    upper = blocks.indices >= rows
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows[upper]))])
    return scipy.sparse.bsr_matrix(
        (blocks.data[upper], blocks.indices[upper], indptr), shape=blocks.shape
    )


class Loop:
    """The compiled loop's state together with the arrays it points to."""

    def __init__(self, system: System, time_step: float, speed: float, split: int) -> None:
        self.system = system
        blocks = _upper_blocks(system.stiffness)
        nodes = system.mass.size
        self._keep: list[object] = []
        self.u = np.zeros(2 * nodes)
        self.v = np.zeros(2 * nodes)
        self.v[1 : 2 * int(system.first[1]) : 2] = -speed
        state = kernel.State()
        state.nodes = nodes
        state.row = self._pointer(blocks.indptr, np.int64)
        state.column = self._pointer(blocks.indices, np.int32)
        state.block = self._pointer(blocks.data.transpose(0, 2, 1), np.float64)
        state.inverse = self._pointer(system.inverse_mass, np.float64)
        state.mass = self._pointer(system.mass, np.float64)
        state.u = self._pointer(self.u, np.float64)
        state.v = self._pointer(self.v, np.float64)
        state.f = self._pointer(np.zeros(2 * nodes), np.float64)
        state.dt = time_step
        state.supports = system.supports.size
        state.support = self._pointer(system.supports, np.int32)
        state.first[:] = system.first.tolist()
        state.centre[:] = list(system.centre)
        state.velocity_before = self._pointer(
            np.zeros(sum(pairs.radii.size for pairs in system.contacts)), np.float64
        )
        state.contacts = len(system.contacts)
        for contact, pairs in zip(state.contact, system.contacts, strict=True):
            inverse = (
                system.inverse_mass[2 * pairs.sphere_nodes + 1]
                + system.inverse_mass[2 * pairs.plate_nodes + 1]
            )
            contact.pairs = pairs.radii.size
            contact.sphere = self._pointer(pairs.sphere_nodes, np.int32)
            contact.plate = self._pointer(pairs.plate_nodes, np.int32)
            contact.gap = self._pointer(pairs.gap, np.float64)
            contact.compliance = self._pointer(1.0 / inverse, np.float64)
            contact.normal = pairs.normal
            contact.last = -1
            contact.outermost = -1
            contact.split = split
        self.state = state
        self._kernel = kernel.load()

    def _pointer(self, array: npt.ArrayLike, dtype: type[np.generic]) -> Any:
        # np.asarray keeps u and v themselves where type and layout already fit.
        contiguous = np.ascontiguousarray(np.asarray(array, dtype=dtype))
        self._keep.append(contiguous)
        return contiguous.ctypes.data_as(ctypes.POINTER(_C_TYPES[dtype]))

    def run(self, samples: int, stride: int) -> Floats:
        """Advance by samples * stride steps; (samples, 8) rows of the strides' first steps."""
        rows = np.empty((samples, 8))
        self._kernel.run(
            ctypes.byref(self.state),
            samples,
            stride,
            rows.ctypes.data_as(ctypes.POINTER(ctypes.c_double)),
        )
        return rows

    def product(self, x: Floats) -> Floats:
        """K x with the compiled kernel, (2n,)."""
        y = np.empty_like(x)
        pointer = ctypes.POINTER(ctypes.c_double)
        self._kernel.stiffness_product(
            ctypes.byref(self.state), x.ctypes.data_as(pointer), y.ctypes.data_as(pointer)
        )
        return y

    def energies(self) -> Energies:
        """Discrete energies between u_n and u_{n+1}."""
        product = self.product(self.u)
        system = self.system
        mass = np.repeat(system.mass, 2)
        before = self.u - self.state.dt * self.v
        density = 0.5 * mass * self.v**2 + 0.5 * before * product
        axial = mass * self.v
        total, rigid = [], []
        for body in range(3):
            rows = system.body(body)
            total.append(float(density[rows].sum()))
            rigid.append(float(axial[rows][1::2].sum()) ** 2 / (2.0 * system.body_mass(body)))
        return Energies((total[0], total[1], total[2]), (rigid[0], rigid[1], rigid[2]))

    def mean_axial(self, values: Floats, body: int) -> float:
        """Mass average of the axial component over a body."""
        rows = self.system.body(body)
        mass = self.system.mass[self.system.first[body] : self.system.first[body + 1]]
        return float(mass @ values[rows][1::2] / mass.sum())
