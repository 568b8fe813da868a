"""Rigid motions of a body in space that no support hinders, and its flexibility without them."""

from __future__ import annotations

import math

import numpy as np

from ..common.arrays import Floats
from .loop import Loop
from .spectrum import CG_TOLERANCE, Precondition, conjugate_gradients, free_components

RELIEVED_TOLERANCE = 1e-4
"""Of the static solution of a free body."""


class FreeMotions:
    """Of three translations and three rotations those that no support or plane of symmetry hinders.

    Attributes:
        motions: (3 n,) each, orthogonal to each other in the norm of the mass, each with the modal
            mass 1 kg.
    """

    def __init__(self, loop: Loop, body: int) -> None:
        self._loop, self._mass = loop, np.repeat(loop.mass, 3)
        place = loop.system.points[loop.system.owned]
        inside = np.where(loop.body == body, loop.mass, 0.0)
        place = place - loop.total(inside @ place) / float(loop.body_masses()[body])
        self.motions: list[tuple[Floats, float]] = []
        axes = np.eye(3)
        whole_motions = [np.broadcast_to(axis, place.shape) for axis in axes]
        whole_motions += [np.cross(axis, place) for axis in axes]
        for motion in whole_motions:
            whole = (motion * (loop.body == body)[:, None]).ravel()
            weight = loop.dot(whole, self._mass * whole)
            free = whole * (loop.inverse > 0.0)
            if loop.dot(free, self._mass * free) < (1.0 - 1e-9) * weight:
                continue
            vector = self.out_of_motion(free)
            self.motions.append((vector / math.sqrt(loop.dot(vector, self._mass * vector)), 1.0))

    def coordinates(self, x: Floats) -> Floats:
        """(k,) share of each motion in a displacement or velocity (3 n,)."""
        return np.array([self._loop.dot(rigid, self._mass * x) for rigid, _ in self.motions])

    def along(self, load: Floats) -> Floats:
        """(k,) what each motion moves in the direction of a load (3 n,) of sum 1."""
        return np.array([self._loop.dot(rigid, load) for rigid, _ in self.motions])

    def out_of_motion(self, x: Floats) -> Floats:
        """A motion without them."""
        for rigid, _ in self.motions:
            x = x - rigid * self._loop.dot(rigid, self._mass * x)
        return x

    def out_of_force(self, force: Floats) -> Floats:
        """A force without what accelerates them."""
        for rigid, _ in self.motions:
            force = force - self._mass * rigid * self._loop.dot(rigid, force)
        return force


def static_shape(
    loop: Loop,
    body: int,
    load: Floats,
    floating: FreeMotions,
    precondition: Precondition | None = None,
) -> Floats:
    """Displacement (3 n,) of a body under a load (3 n,), rigid motions apart , m."""
    free = free_components(loop, body)
    tolerance = RELIEVED_TOLERANCE if floating.motions else CG_TOLERANCE
    return floating.out_of_motion(
        conjugate_gradients(
            loop,
            floating.out_of_force(load * free),
            free,
            floating.out_of_force,
            tolerance=tolerance,
            precondition=precondition,
        )
    )


def flexibility(
    loop: Loop,
    body: int,
    load: Floats,
    floating: FreeMotions | None = None,
    precondition: Precondition | None = None,
) -> float:
    """Static flexibility p^T K^-1 p of a body, of the part modelled, m/N.

    Args:
        loop: the assembled system.
        body: number of the elastic body.
        load: (3 n,) p, whose components sum up to a force of 1 N.
        floating: its free motions, if they are known.
        precondition: see `conjugate_gradients`.
    """
    floating = floating or FreeMotions(loop, body)
    relieved = floating.out_of_force(load * free_components(loop, body))
    return loop.dot(relieved, static_shape(loop, body, load, floating, precondition))
