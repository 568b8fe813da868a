"""What yielding leaves in bodies: plastic strain, the field at rest under it, locked-in energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..axisymmetric.statics import Rest
from ..axisymmetric.system import INNER, OUTER, PLATE, AxisymmetricSystem
from ..common.arrays import Floats, Ints
from ..explicit.plastic import PlasticState
from .motion import SIDES, Yielded


@dataclass(frozen=True)
class Memory:
    """All that bodies that yield know of earlier impacts."""

    strain: Floats
    """(m, 4, 4) plastic, as `PlasticState.strain`."""
    accumulated: Floats
    """(m, 4) equivalent plastic strain."""

    def with_fresh_spheres(self, bodies: Ints) -> Memory:
        """The same if both spheres are hit where they have not yielded; ``bodies`` (m,) of each."""
        same = np.asarray(bodies == PLATE, dtype=np.float64)
        return Memory(self.strain * same[:, None, None], self.accumulated * same[:, None])


class Dents:
    """Of the bodies in a loop.

    Args:
        system: bodies.
        state: of its elements that may yield.

    Attributes:
        bodies: (m,) body of each of these elements.
    """

    def __init__(self, system: AxisymmetricSystem, state: PlasticState) -> None:
        self._system, self._state, self._statics = system, state, Rest(system)
        self._rest: tuple[float, Floats] = (0.0, np.zeros_like(state.force))
        self._before = np.zeros(state.work.size)
        first = state.plasticity.nodes[:, 0]
        self.bodies = np.searchsorted(system.first, first, side="right") - 1

    def at_rest(self) -> Floats:
        """(2n,) displacement that the plastic strain leaves, of a free body zero in the mean, m."""
        # Nothing flows without work.
        work = float(self._state.work.sum())
        if self._rest[0] != work:
            self._rest = work, self._statics.displacement(self._state.force)
        return self._rest[1]

    def locked_in(self) -> Floats:
        """(m,) elastic energy left at rest by element, J."""
        return self._state.locked_in(self.at_rest())

    def locked_in_bodies(self) -> Floats:
        """(3,) by body, J."""
        return np.asarray(np.bincount(self.bodies, self.locked_in(), 3), dtype=np.float64)

    def yielded(self) -> Yielded:
        """Energy that went into yielding since the run began."""
        contact = self._state.plasticity.contact
        work = np.bincount(contact, self._state.work, 2)
        gained = np.bincount(contact, self.locked_in() - self._before, 2)
        return Yielded((work[0], work[1]), (gained[0], gained[1]))

    def profiles(self) -> Floats:
        """(n, 5) of the nodes that may touch: radius, and heights at rest over virgin surfaces, m.

        Of outer body, both of the plate's faces and inner body, out of each body; of spheres
        against their mean displacement.
        """
        axial, (outer, inner) = self.at_rest()[1::2], self._system.matched
        heights = [-axial[outer.candidates], axial[outer.opposite]]
        heights += [-axial[inner.opposite], axial[inner.candidates]]
        radii = max(outer.radii, inner.radii, key=len)
        # a body that is too small to touch out to there has no dent there
        padded = [np.pad(height, (0, radii.size - height.size)) for height in heights]
        return np.column_stack([radii, *padded])

    def plastic_strain(self, cells: Ints) -> Floats:
        """(k,) accumulated, the mean of each of the system's ``cells`` (k, 4 nodes)."""
        weights, nodes = self._state.plasticity.weights, self._state.plasticity.nodes
        means = (weights * self._state.accumulated).sum(axis=1) / weights.sum(axis=1)
        yielding = dict(zip(map(frozenset, nodes.tolist()), means, strict=True))
        return np.array([yielding.get(frozenset(cell), 0.0) for cell in cells.tolist()])

    def memory(self, fresh_spheres: bool) -> Memory:
        """What the next impact has to know, on the same spots or on fresh ones of both spheres."""
        memory = Memory(self._state.strain.copy(), self._state.accumulated.copy())
        return memory.with_fresh_spheres(self.bodies) if fresh_spheres else memory

    def reach_the_edge(self) -> bool:
        """Whether elements yield beside ones that may not."""
        return self._state.at_the_edge()

    def lay(self, memory: Memory, gaps: tuple[float, float]) -> Floats:
        """(2n,) displacement at rest of bodies with a memory, ``gaps`` (m) from touching."""
        self._state.remember(memory.strain, memory.accumulated)
        self._rest = 0.0, self._statics.displacement(self._state.force)
        self._before = self.locked_in()
        laid = self._rest[1].copy()
        for number, body in enumerate((OUTER, INNER)):
            shift = gaps[number] - self.clearance(number)
            laid[self._system.body(body)][1::2] += SIDES[number] * shift
        return laid

    def clearance(self, contact: int) -> float:
        """Least gap of a contact's nodes at rest, both bodies where they lie in the mesh, m."""
        pairs, axial = self._system.matched[contact], self.at_rest()[1::2]
        opened = axial[pairs.candidates] - axial[pairs.opposite]
        return float((pairs.gaps + SIDES[contact] * opened).min())
