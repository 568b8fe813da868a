"""The compiled contact problem of a model, in the numbering of its contact surfaces."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from ..common.arrays import Floats, Ints
from ..solid import kernel
from ..solid.model import Model, SphereContact

TOLERANCE = 1e-12
"""Change of a multiplier in the last Gauss-Seidel sweep, over the largest multiplier."""

_C_TYPES: dict[type[np.generic], Any] = {
    np.int32: ctypes.c_int32,
    np.int64: ctypes.c_int64,
    np.float64: ctypes.c_double,
}


class Arrays:
    """Keeps the arrays that C structures point to."""

    def __init__(self) -> None:
        self._kept: list[object] = []

    def pointer(self, array: npt.ArrayLike, dtype: type[np.generic]) -> Any:
        """Pointer to the array itself where type and layout fit, else to a copy."""
        contiguous = np.ascontiguousarray(np.asarray(array, dtype=dtype))
        self._kept.append(contiguous)
        return contiguous.ctypes.data_as(ctypes.POINTER(_C_TYPES[dtype]))


class ContactProblem:
    """`kernel.Problem` with its arrays.

    Attributes:
        nodes: (s,) surface nodes that can touch, the model's numbering.
        u, predicted, before, force: (3 s) work arrays of the kernel.
    """

    def __init__(self, model: Model, inverse_mass: Floats, time_step: float, split: int) -> None:
        first = model.first
        parts: list[Ints] = []
        for contact in model.contacts:
            parts.append(contact.nodes + first[contact.body])
            if not isinstance(contact, SphereContact):
                parts.append(contact.facets.ravel() + first[contact.target])
                if contact.reachable is not None:
                    parts.append(contact.reachable + first[contact.target])
        self.nodes: Ints = np.unique(np.concatenate(parts)) if parts else np.zeros(0, np.int64)
        size = 3 * self.nodes.size
        self.u, self.predicted, self.before, self.force = (np.zeros(size) for _ in range(4))
        self._arrays = Arrays()
        self.contacts = (kernel.Contact * max(1, len(model.contacts)))()
        self.rigids = (kernel.Rigid * max(1, len(model.rigid)))()
        for rigid, body in zip(self.rigids, model.rigid, strict=False):
            rigid.mobility[:] = (body.directions / body.mass).ravel().tolist()
            rigid.mass = body.mass
            rigid.v[:] = list(body.velocity)
        for structure, contact in zip(self.contacts, model.contacts, strict=False):
            self._fill(structure, contact, model)
            structure.split = split
        state = kernel.Problem()
        state.nodes = self.nodes.size
        rows = (3 * self.nodes[:, None] + np.arange(3)).ravel()
        state.inverse = self._arrays.pointer(inverse_mass[rows], np.float64)
        for name in ("u", "predicted", "before", "force"):
            setattr(state, name, self._arrays.pointer(getattr(self, name), np.float64))
        state.contacts, state.rigids = len(model.contacts), len(model.rigid)
        state.contact = ctypes.cast(self.contacts, ctypes.POINTER(kernel.Contact))
        state.rigid = ctypes.cast(self.rigids, ctypes.POINTER(kernel.Rigid))
        state.dt = time_step
        state.tolerance = TOLERANCE
        self.state = state

    def _fill(self, structure: kernel.Contact, contact: Any, model: Model) -> None:
        pointer = self._arrays.pointer
        count = contact.nodes.size
        structure.count = count
        structure.last = structure.outermost = -1
        nodes = np.searchsorted(self.nodes, contact.nodes + model.first[contact.body])
        structure.node = pointer(nodes, np.int32)
        structure.multipliers = pointer(np.zeros(count), np.float64)
        structure.compliance = pointer(np.zeros(count), np.float64)
        structure.active = pointer(np.zeros(count), np.int32)
        if isinstance(contact, SphereContact):
            points = contact.places
            if points is None:
                points = model.elastic[contact.body].mesh.points[contact.nodes]
            structure.kind = kernel.AGAINST_SPHERE
            structure.normal = pointer(np.zeros((count, 3)), np.float64)
            structure.gap = pointer(np.zeros(count), np.float64)
            structure.place = pointer(points - contact.centre, np.float64)
            structure.radius, structure.rigid = contact.radius, contact.rigid
            return
        facets = np.zeros((count, kernel.FACET_NODES), dtype=np.int64)
        weights = np.zeros((count, kernel.FACET_NODES))
        width = contact.facets.shape[1]
        facets[:, :width] = np.searchsorted(
            self.nodes, contact.facets + model.first[contact.target]
        )
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

    _SCALARS = ("normal_impulse", "work", "last", "intervals", "outermost")
    _LISTS = ("impulse", "force", "first_step", "last_step")

    def checkpoint(self) -> dict[str, Any]:
        """Everything that a step depends on or adds to, as JSON values."""
        return {
            "step": self.state.step,
            "sweeps": self.state.sweeps,
            "unconverged": self.state.unconverged,
            "reaction": list(self.state.reaction),
            "rigid": [
                {name: list(getattr(r, name)) for name in ("u", "v")}
                for r in self.rigids[: self.state.rigids]
            ],
            "contacts": [
                {name: getattr(c, name) for name in self._SCALARS}
                | {name: list(getattr(c, name)) for name in self._LISTS}
                for c in self.contacts[: self.state.contacts]
            ],
        }

    def restore(self, saved: dict[str, Any]) -> None:
        """The reverse of `checkpoint`."""
        for name in ("step", "sweeps", "unconverged"):
            setattr(self.state, name, saved[name])
        self.state.reaction[:] = saved["reaction"]
        for rigid, values in zip(self.rigids, saved["rigid"], strict=False):
            for name, value in values.items():
                getattr(rigid, name)[:] = value
        for contact, values in zip(self.contacts, saved["contacts"], strict=False):
            for name in self._SCALARS:
                setattr(contact, name, values[name])
            for name in self._LISTS:
                getattr(contact, name)[:] = values[name]
