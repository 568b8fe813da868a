"""When a run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math

from .loop import Energies, Loop
from .system import INNER, OUTER, PLATE, System, hertz_weights, patch_flexibility


def no_further_contact(
    clearance: float,
    opening_speed: float,
    plate_energy: float,
    plate_flexibility: float,
    sphere_energy: float,
    sphere_flexibility: float,
) -> bool:
    """Whether a sphere and the plate can be proven never to touch again.

    A body of elastic energy E (kinetic and strain, rigid motion apart) displaces its contact
    patch by at most sqrt(2 E C), C = p^T K^-1 p the flexibility of the patch with the weights p
    (Cauchy's inequality in the norm of K: |p^T u| = |p^T K^-1 K u| <= sqrt(p^T K^-1 p)
    sqrt(u^T K u)). The weights are Hertz's pressure: a single node's flexibility grows without
    bound on finer meshes. Two bodies whose rigid motions part, and are further apart than both
    bounds, stay apart.

    Args:
        clearance: distance of the undeformed bodies in their rigid motion, m.
        opening_speed: rate of the clearance, m/s.
        plate_energy: J.
        plate_flexibility: larger static flexibility of the plate's two contact patches, m/N.
        sphere_energy: elastic energy of the sphere, J.
        sphere_flexibility: its inertia-relief flexibility, m/N.
    """
    reach = math.sqrt(2.0 * max(plate_energy, 0.0) * plate_flexibility) + math.sqrt(
        2.0 * max(sphere_energy, 0.0) * sphere_flexibility
    )
    return opening_speed >= 0.0 and clearance > reach


class EndCheck:
    """Whether any further contact is possible (see `no_further_contact`)."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.free_plate = system.supports.size == 0
        self.plate_flexibility = max(
            patch_flexibility(system, PLATE, pairs.plate_nodes, hertz_weights(pairs.radii))
            for pairs in system.contacts
        )
        self.sphere_flexibility = [
            patch_flexibility(system, body, pairs.sphere_nodes, hertz_weights(pairs.radii))
            for body, pairs in zip((OUTER, INNER), system.contacts, strict=True)
        ]

    def __call__(self, loop: Loop, energies: Energies) -> bool:
        """Whether the state allows no further contact."""
        plate_energy = energies.total[PLATE]
        plate_position = plate_velocity = 0.0
        if self.free_plate:
            plate_energy -= energies.rigid[PLATE]
            plate_position = loop.mean_axial(loop.u, PLATE)
            plate_velocity = loop.mean_axial(loop.v, PLATE)
        for body, pairs, contact, flexibility in zip(
            (OUTER, INNER),
            self.system.contacts,
            loop.state.contact,
            self.sphere_flexibility,
            strict=True,
        ):
            if contact.force > 0.0:
                return False
            position = loop.mean_axial(loop.u, body) - plate_position
            velocity = loop.mean_axial(loop.v, body) - plate_velocity
            if not no_further_contact(
                clearance=float(pairs.gap.min()) + pairs.normal * position,
                opening_speed=pairs.normal * velocity,
                plate_energy=plate_energy,
                plate_flexibility=self.plate_flexibility,
                sphere_energy=energies.total[body] - energies.rigid[body],
                sphere_flexibility=flexibility,
            ):
                return False
        return True
