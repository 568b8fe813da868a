"""Modal damping: chosen modes of a body lose their velocity at the rate 2 zeta omega.

q'' + 2 zeta omega q' + omega^2 q = f with one ratio zeta for all modes is no local law: in terms of
the nodes it is C = 2 zeta M (M^-1 K)^(1/2), a full matrix. Damping proportional to mass or
stiffness has the wanted ratio at one or two frequencies only. In terms of the modes it is exact:
the loop moves undamped, and in the middle of each interval the modes' velocities shrink by
exp(-2 zeta omega interval) at once (Strang's splitting). A mode so treated decays at the rate
zeta omega exactly, whatever the interval; its frequency and what a force does to it are exact to
second order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats
from .loop import Loop

LONGEST_ANGLE = 0.25
"""Phase of the fastest damped mode between two losses of velocity, rad."""


@dataclass(frozen=True)
class Modes:
    """Undamped modes of a body."""

    frequencies: Floats
    """(k,) angular, rad/s, ascending."""
    shapes: Floats
    """(C n, k) of unit modal mass, 1/sqrt(kg)."""


class ModalDamping:
    """Takes velocity from modes of a body in a loop of one process.

    Args:
        loop: bodies and contacts; its time step and levels are set before the first loss.
        rows: of the body's components.
        modes: that are damped.
        ratio: of critical damping (Lehr), the same for every mode.

    Attributes:
        dissipated: energy lost so far, J.
        impulse: on the body along the last axis so far, N s. It is the support's, which does not
            move: modes of a free body carry no momentum.
        interval: longest time between two losses, s.
    """

    def __init__(self, loop: Loop, rows: slice, modes: Modes, ratio: float) -> None:
        self._loop, self._rows, self._modes = loop, rows, modes
        self._rates = 2.0 * ratio * modes.frequencies
        self._weighted = np.repeat(loop.mass, loop.components)[rows, None] * modes.shapes
        self._momenta = self._weighted[loop.components - 1 :: loop.components].sum(axis=0)
        self._behind: Floats | None = None
        self.dissipated = self.impulse = 0.0
        self.interval = LONGEST_ANGLE / float(modes.frequencies[-1])

    def _half_step(self) -> Floats:
        """(C n, k) products whose transpose times u is what velocities lag behind, over dt/2.

        A level's impulse of a step is given at the step's start: velocities stand half a step of
        each level before the displacements.
        """
        if self._behind is None:
            loop, size = self._loop, self._loop.u.size
            self._behind = np.zeros_like(self._modes.shapes)
            for column, shape in enumerate(self._modes.shapes.T):
                x = np.zeros(size)
                x[self._rows] = shape
                for level in range(len(loop.levels)):
                    product = loop.level_product(level, x)[self._rows]
                    self._behind[:, column] += 2.0**level * product
        return self._behind

    def lose(self, interval: float) -> None:
        """What the modes lose in ``interval`` s, at an instant at which all levels meet."""
        loop, rows = self._loop, self._rows
        velocity = self._weighted.T @ loop.v[rows]
        impulse = self._half_step().T @ loop.effective[rows]
        if loop.problem.plastic is not None:
            impulse -= self._modes.shapes.T @ loop.problem.plastic.force[rows]
        velocity -= 0.5 * loop.dt * impulse
        change = velocity * np.expm1(-self._rates * interval)
        loop.v[rows] += self._modes.shapes @ change
        # Exactly the change of the loop's discrete energy if it has one level.
        self.dissipated -= float(change @ (velocity + 0.5 * change))
        self.impulse += float(self._momenta @ change)
