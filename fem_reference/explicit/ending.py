"""When a solid run may end: the proof that no further contact is possible."""

from __future__ import annotations

import math


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
