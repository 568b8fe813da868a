"""Flow resistance of a body that moves as a whole: F = -k U |U|."""

from __future__ import annotations

from .loop import Loop


class Drag:
    """Takes velocity from a body in a loop of one process, all of its nodes alike.

    Args:
        loop: bodies and contacts.
        rows: of the body's components.
        coefficient: k, N s^2/m^2.

    Attributes:
        dissipated: energy lost so far, J.
        impulse: on the body along the last axis so far, N s.
    """

    def __init__(self, loop: Loop, rows: slice, coefficient: float) -> None:
        axial = slice(rows.start + loop.components - 1, rows.stop, loop.components)
        self._loop, self._axial, self._coefficient = loop, axial, coefficient
        self._mass = loop.mass[rows.start // loop.components : rows.stop // loop.components]
        self.dissipated = self.impulse = 0.0

    def lose(self, interval: float) -> float:
        """Slow the body as in ``interval`` s of free motion; the change of its velocity, m/s.

        A rigid motion strains nothing: the discrete energy changes as a point mass's does.
        """
        velocity = self._loop.v[self._axial]
        total = float(self._mass.sum())
        mean = float(self._mass @ velocity) / total
        rate = self._coefficient * abs(mean) / total
        change = -mean * rate * interval / (1.0 + rate * interval)
        velocity += change
        self.dissipated -= total * change * (mean + 0.5 * change)
        self.impulse += total * change
        return change
