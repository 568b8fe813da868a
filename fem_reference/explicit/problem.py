"""The compiled contact problem of a system, in the numbering of its contact surfaces."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..common.arrays import Floats, Ints
from . import kernel, structures
from .contact import Contact, MatchedContact, SphereContact
from .film import compiled
from .plastic import PlasticState
from .system import System

TOLERANCE = 1e-12
"""Change of a multiplier in the last Gauss-Seidel sweep, over the largest multiplier."""


def contact_nodes(contacts: Iterable[Contact], first: Ints) -> Ints:
    """Surface nodes that can touch; ``first`` node of each body."""
    parts: list[Ints] = []
    for contact in contacts:
        parts.append(contact.nodes + first[contact.body])
        if not isinstance(contact, SphereContact):
            parts.append(contact.facets.ravel() + first[contact.target])
            if contact.reachable is not None:
                parts.append(contact.reachable + first[contact.target])
    return np.unique(np.concatenate(parts)) if parts else np.zeros(0, np.int64)


class ContactProblem:
    """`structures.Problem` with its arrays.

    Attributes:
        nodes: (s,) surface nodes that can touch, the system's numbering, matching ones aside.
        u, predicted, before, force: (C s) work arrays of the kernel.
        contacts, matched, rigids, film: the kernel's structures.
        plastic: what elements that may yield remember.
    """

    def __init__(self, system: System) -> None:
        self.nodes = contact_nodes(system.contacts, system.first)
        components = system.points.shape[1]
        size = components * self.nodes.size
        self.u, self.predicted, self.before, self.force = (np.zeros(size) for _ in range(4))
        self._arrays = kernel.Arrays()
        self._tips: list[tuple[structures.Tip, Floats, Floats, Floats]] = []
        self.contacts = (structures.Contact * max(1, len(system.contacts)))()
        self.rigids = (structures.Rigid * max(1, len(system.rigid)))()
        self.matched = (structures.Pairs * max(1, len(system.matched)))()
        for rigid, body in zip(self.rigids, system.rigid, strict=False):
            rigid.mobility[:] = (body.directions / body.mass).ravel().tolist()
            rigid.turning[:] = body.turning.ravel().tolist()
            rigid.mass = body.mass
            rigid.v[:] = list(body.velocity)
        for structure, contact in zip(self.contacts, system.contacts, strict=False):
            self._fill(structure, contact, system)
        for pairs, matched in zip(self.matched, system.matched, strict=False):
            self._match(pairs, matched, system)
        state = structures.Problem()
        state.nodes = self.nodes.size
        rows = (components * self.nodes[:, None] + np.arange(components)).ravel()
        state.inverse = self._arrays.pointer(system.inverse_mass[rows], np.float64)
        for name in ("u", "predicted", "before", "force"):
            setattr(state, name, self._arrays.pointer(getattr(self, name), np.float64))
        state.contacts, state.rigids = len(system.contacts), len(system.rigid)
        state.matched = len(system.matched)
        state.contact = ctypes.cast(self.contacts, ctypes.POINTER(structures.Contact))
        state.rigid = ctypes.cast(self.rigids, ctypes.POINTER(structures.Rigid))
        state.pairs = ctypes.cast(self.matched, ctypes.POINTER(structures.Pairs))
        self.film: structures.Film | None = None
        if system.film is not None:
            self.film = compiled(system.film, self._arrays)
            state.film = ctypes.pointer(self.film)
        self.plastic: PlasticState | None = None
        if system.plasticity is not None:
            self.plastic = PlasticState(system.plasticity, system.mass.size)
            state.plastic = ctypes.pointer(self.plastic.structure)
        state.tolerance = TOLERANCE
        self.state = state

    def set_step(self, time_step: float, split: int) -> None:
        """Set the time step (s) and how many steps of separation divide two contacts."""
        self.state.dt = time_step
        for tip, matrix, flexibility, mobility in self._tips:
            matrix[:] = 2.0 * flexibility + time_step**2 * mobility
            tip.factored = 0
        for record in self.records():
            record.split = split

    def records(self) -> list[structures.Record]:
        """What each contact has done so far, matching ones first."""
        of_pairs = [pairs.record for pairs in self.matched[: self.state.matched]]
        return of_pairs + [contact.record for contact in self.contacts[: self.state.contacts]]

    def _match(self, structure: structures.Pairs, contact: MatchedContact, system: System) -> None:
        pointer = self._arrays.pointer
        axial = system.points.shape[1] - 1
        inverse = system.inverse_mass[axial :: axial + 1]
        structure.count = contact.radii.size
        structure.candidate = pointer(contact.candidates, np.int32)
        structure.opposite = pointer(contact.opposite, np.int32)
        structure.gap = pointer(contact.gaps, np.float64)
        both = inverse[contact.candidates] + inverse[contact.opposite]
        structure.compliance = pointer(1.0 / both, np.float64)
        structure.before = pointer(np.zeros(contact.radii.size), np.float64)
        structure.normal, structure.friction = contact.normal, contact.friction
        structure.sliding = pointer(np.zeros(contact.radii.size), np.float64)
        structure.record.last = structure.record.outermost = -1
        if contact.flexibility is not None:
            mobility = np.diag(inverse[contact.opposite]) + inverse[contact.candidates[0]]
            structure.tip = ctypes.pointer(self._tip(contact.flexibility, mobility))

    def _tip(self, flexibility: Floats, mobility: Floats) -> structures.Tip:
        """A tip; ``mobility`` (n, n) is of the nodes it stands between, 1/kg."""
        pointer, count = self._arrays.pointer, flexibility.shape[0]
        matrix, tip = np.zeros((count, count)), structures.Tip()
        self._tips.append((tip, matrix, flexibility, mobility))
        tip.flexibility = pointer(flexibility, np.float64)
        tip.matrix = pointer(matrix, np.float64)
        tip.multipliers = pointer(np.zeros(count), np.float64)
        tip.wanted = pointer(np.zeros(count), np.float64)
        tip.closed = pointer(np.zeros(count), np.int32)
        tip.factor = pointer(np.zeros((count, count)), np.float64)
        return tip

    def _fill(self, structure: structures.Contact, contact: Any, system: System) -> None:
        pointer, first = self._arrays.pointer, system.first
        count, components = contact.nodes.size, system.points.shape[1]
        structure.count = count
        structure.record.last = structure.record.outermost = -1
        nodes = contact.nodes + first[contact.body]
        structure.node = pointer(np.searchsorted(self.nodes, nodes), np.int32)
        structure.multipliers = pointer(np.zeros(count), np.float64)
        structure.compliance = pointer(np.zeros(count), np.float64)
        structure.active = pointer(np.zeros(count), np.int32)
        structure.friction = contact.friction
        if contact.friction > 0.0:
            structure.traction = pointer(np.zeros((count, components)), np.float64)
        if isinstance(contact, SphereContact):
            points = contact.places if contact.places is not None else system.points[nodes]
            structure.kind = kernel.AGAINST_SPHERE
            structure.normal = pointer(np.zeros((count, components)), np.float64)
            structure.gap = pointer(np.zeros(count), np.float64)
            structure.place = pointer(points - contact.centre, np.float64)
            structure.radius, structure.rigid = contact.radius, contact.rigid
            return
        facets = np.zeros((count, kernel.FACET_NODES), dtype=np.int64)
        weights = np.zeros((count, kernel.FACET_NODES))
        width = contact.facets.shape[1]
        facets[:, :width] = np.searchsorted(self.nodes, contact.facets + first[contact.target])
        weights[:, :width] = contact.weights
        structure.kind = kernel.AGAINST_SURFACE
        structure.facet = pointer(facets, np.int32)
        structure.weight = pointer(weights, np.float64)
        structure.normal = pointer(contact.normals, np.float64)
        structure.gap = pointer(contact.gaps.copy(), np.float64)

    def pair(
        self, number: int, target: int, facets: Ints, weights: Floats, normals: Floats, gaps: Floats
    ) -> None:
        """New pairs for a contact of two surfaces, as `SurfaceContact` has them.

        Args:
            number: of the contact.
            target: first node of the body the facets belong to, in the model's numbering.
            facets: (n, 3) or (n, 6), among the nodes the contact was made with or `reachable`.
            weights: shape functions.
            normals: (n, 3).
            gaps: (n,) such that gap + normal . (candidate's - facet's displacement) is the
                distance now, m.
        """
        contact = self.contacts[number]
        count, width = facets.shape
        shape = (count, kernel.FACET_NODES)
        numbers = np.ctypeslib.as_array(contact.facet, shape)
        numbers[:, :width] = np.searchsorted(self.nodes, facets + target)
        np.ctypeslib.as_array(contact.weight, shape)[:, :width] = weights
        np.ctypeslib.as_array(contact.normal, (count, 3))[:] = normals
        np.ctypeslib.as_array(contact.gap, (count,))[:] = gaps

    def multipliers(self, number: int) -> Floats:
        """Multipliers of a contact's candidates in the last step, N."""
        contact = self.contacts[number]
        if contact.count == 0:
            return np.zeros(0)
        return np.ctypeslib.as_array(contact.multipliers, (contact.count,)).copy()

    _RECORD = (
        *("force", "stored", "impulse", "work", "last", "intervals", "outermost"),
        *("first_step", "last_step"),
    )

    _TAKEN = ("impulse", "force", "rubbed")

    def checkpoint(self) -> dict[str, Any]:
        """Everything that a step depends on or adds to, as JSON values."""
        return {
            "step": self.state.step,
            "sweeps": self.state.sweeps,
            "unconverged": self.state.unconverged,
            "reaction": list(self.state.reaction),
            "rigid": [_read(r, ("u", "v", "spin")) for r in self.rigids[: self.state.rigids]],
            "contacts": [_read(c, self._TAKEN) for c in self.contacts[: self.state.contacts]],
            "records": [_read(r, self._RECORD) for r in self.records()],
        }

    def restore(self, saved: dict[str, Any]) -> None:
        """The reverse of `checkpoint`."""
        for name in ("step", "sweeps", "unconverged"):
            setattr(self.state, name, saved[name])
        self.state.reaction[:] = saved["reaction"]
        for group, key in (
            (self.rigids, "rigid"),
            (self.contacts, "contacts"),
            (self.records(), "records"),
        ):
            for structure, values in zip(group, saved[key], strict=False):
                _write(structure, values)


def _read(structure: ctypes.Structure, names: tuple[str, ...]) -> dict[str, Any]:
    values = {name: getattr(structure, name) for name in names}
    return {n: list(v) if isinstance(v, ctypes.Array) else v for n, v in values.items()}


def _write(structure: ctypes.Structure, values: dict[str, Any]) -> None:
    for name, value in values.items():
        if isinstance(value, list):
            getattr(structure, name)[:] = value
        else:
            setattr(structure, name, value)
