"""A model as what the loop steps: numbered for memory and processes, lumped masses."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..common.arrays import Floats, Ints
from ..explicit.elements import Tetrahedra
from ..explicit.levels import least_at_nodes
from ..explicit.loop import Loop, SerialLoop
from ..explicit.parallel import ParallelLoop
from ..explicit.partition import owners
from ..explicit.problem import contact_nodes
from ..explicit.stiffness import worthwhile
from .elasticity import lumped_mass
from .elements import element_time_steps, tetrahedra
from .model import Model


class SolidSystem:
    """See `explicit.system.System`; the bodies of ``model`` in the processes of ``comm``."""

    def __init__(self, model: Model, comm: Any) -> None:
        bodies = model.elastic
        self.model, self.comm, self.first = model, comm, model.first
        self.rigid, self.contacts, self.matched = model.rigid, model.contacts, ()
        self.film = self.plasticity = None
        self.relaxations = tuple(body.material.relaxation for body in bodies)
        self.free_axes = (0, 1, 2)
        self.points = np.concatenate([body.mesh.points for body in bodies])
        self.mass = np.concatenate([lumped_mass(b.mesh, b.material.density) for b in bodies])
        self.inverse_mass = np.repeat(1.0 / self.mass, 3)
        for body, offset in zip(bodies, self.first, strict=False):
            self.inverse_mass[body.fixed + 3 * offset] = 0.0
        self.velocity = np.concatenate(
            [np.tile(body.velocity, (body.mesh.points.shape[0], 1)) for body in bodies]
        )
        self.supported = np.ones(self.mass.size, dtype=bool)
        self.element_nodes = np.concatenate(
            [body.mesh.cells + offset for body, offset in zip(bodies, self.first, strict=False)]
        )
        self._steps: Floats | None = None
        self.element_owner = self._owners()
        owner = least_at_nodes(self.element_owner, self.element_nodes, self.mass.size)
        order = _order(self.element_nodes, self.mass.size)
        place = np.empty_like(order)
        place[order] = np.arange(order.size)
        mine = np.flatnonzero(self.element_owner == comm.rank)
        self._mine = mine[np.argsort(place[self.element_nodes[mine]].min(axis=1), kind="stable")]
        present = np.zeros(order.size, dtype=bool)
        present[self.element_nodes[mine]] = True
        own = owner == comm.rank
        self.owned, self.ghosts = order[own[order]], order[(present & ~own)[order]]

    def _owners(self) -> Ints:
        """(m,) process of each element."""
        if self.comm.size == 1:
            return np.zeros(self.element_nodes.shape[0], dtype=np.int64)
        near = contact_nodes(self.contacts, self.first)
        steps = self.element_time_steps()
        return owners(self.points, self.element_nodes, steps, near, self.comm.size)

    def element_time_steps(self) -> Floats:
        """(m,) critical time step of each element alone, s."""
        if self._steps is None:
            steps = [element_time_steps(b.mesh, b.material) for b in self.model.elastic]
            self._steps = np.concatenate(steps)
        return self._steps

    def operator(self) -> Tetrahedra:
        """K of this process' elements."""
        local_nodes = np.concatenate([self.owned, self.ghosts])
        number = np.empty(self.mass.size, dtype=np.int64)
        number[local_nodes] = np.arange(local_nodes.size)
        bodies = np.searchsorted(self._first_element(), self._mine, side="right") - 1
        materials = [body.material for body in self.model.elastic]
        lame, shear = (
            np.array([getattr(material, name) for material in materials])[bodies]
            for name in ("lame_lambda", "shear_modulus")
        )
        nodes = self.element_nodes[self._mine]
        return tetrahedra(self.points, nodes, number, (lame, shear), self._mine)

    def _first_element(self) -> Ints:
        """(bodies) number of each elastic body's first element."""
        counts = [body.mesh.cells.shape[0] for body in self.model.elastic]
        return np.cumsum([0, *counts[:-1]])


def _order(elements: Ints, count: int) -> Ints:
    """(N,) nodes so that neighbours are close in memory (reverse Cuthill-McKee)."""
    size = elements.shape[1]
    at = scipy.sparse.csr_matrix(
        (np.ones(elements.size, np.int32), elements.ravel(), size * np.arange(len(elements) + 1)),
        shape=(len(elements), count),
    )
    return np.asarray(reverse_cuthill_mckee((at.T @ at).tocsr(), symmetric_mode=True), np.int64)


def make_loop(model: Model, comm: Any, threads: int = 1) -> Loop:
    """The loop for the number of processes in ``comm``, each with at most so many threads."""
    system = SolidSystem(model, comm)
    threads = worthwhile(threads, 3 * system.owned.size)
    if comm.size == 1:
        return SerialLoop(system, comm, threads)
    return ParallelLoop(system, comm, threads)
