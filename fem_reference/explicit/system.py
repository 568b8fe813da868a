"""What a loop steps: discretised elastic bodies, rigid bodies and contacts, in one numbering."""

from __future__ import annotations

from typing import Protocol

from ..common.arrays import Floats, Ints, Mask
from ..common.bodies import Relaxation
from .contact import Contact, MatchedContact, RigidBody
from .film import Film
from .plastic import Plasticity
from .stiffness import Stiffness


class System(Protocol):
    """Elastic bodies one after the other, C components of displacement per node.

    Vectors of all nodes are ordered as component C * node + direction.
    """

    @property
    def points(self) -> Floats:
        """(N, C) places of the nodes, m."""

    @property
    def mass(self) -> Floats:
        """(N,) kg."""

    @property
    def inverse_mass(self) -> Floats:
        """(C N,) 1/kg, zero where the displacement is fixed."""

    @property
    def velocity(self) -> Floats:
        """(N, C) at the start, m/s."""

    @property
    def first(self) -> Ints:
        """(bodies + 1) first node of each body, then the number of nodes."""

    @property
    def owned(self) -> Ints:
        """(n,) nodes of this process, in the order in which a loop keeps them."""

    @property
    def ghosts(self) -> Ints:
        """Nodes of other processes at this one's elements."""

    @property
    def supported(self) -> Mask:
        """(N,) nodes whose forces count as the supports' where they are fixed."""

    @property
    def free_axes(self) -> tuple[int, ...]:
        """Directions in which a body can move without straining."""

    @property
    def element_nodes(self) -> Ints:
        """(m, k) nodes of all elements."""

    def element_time_steps(self) -> Floats:
        """(m,) critical time step of each element alone, s."""

    def operator(self) -> Stiffness:
        """K of this process' elements, at `owned` nodes and, behind them, `ghosts`."""

    @property
    def relaxations(self) -> tuple[tuple[Relaxation, ...], ...]:
        """Of the material of each elastic body."""

    @property
    def rigid(self) -> tuple[RigidBody, ...]:
        """Bodies that do not deform."""

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Of candidate nodes with spheres and surfaces."""

    @property
    def matched(self) -> tuple[MatchedContact, ...]:
        """Of surfaces whose nodes match."""

    @property
    def film(self) -> Film | None:
        """Between two of them."""

    @property
    def plasticity(self) -> Plasticity | None:
        """Of the elements that may yield."""
