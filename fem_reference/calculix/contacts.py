"""What the forces that CalculiX prints say about a contact: impulse, end, intervals."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..common.arrays import Floats
from ..explicit.records import ContactRecord

DAMPING = -0.05
"""Alpha of the steps: keeps the contacts from chattering."""
OPEN = 2e-3
"""Share of a contact's largest force below which it does not show when the contact ends: single
points of integration are left then, which may even pull for a step."""


def impulses(forces: Floats, time_step: float) -> Floats:
    """Impulse so far of forces (m, k) as the steps count them, N s.

    M a_n = (1 + alpha) F_n - alpha F_(n-1), and Newmark's rule with gamma = 1/2 - alpha.
    """
    before = np.vstack([np.zeros_like(forces[:1]), forces[:-1]])
    acting = (1.0 + DAMPING) * forces - DAMPING * before
    gamma = 0.5 - DAMPING
    gained = time_step * ((1.0 - gamma) * acting[:-1] + gamma * acting[1:])
    return np.vstack([np.zeros_like(forces[:1]), np.cumsum(gained, axis=0)])


def contact_end(times: Floats, force: Floats) -> float | None:
    """End of the last contact, s: the approach, like F^(2/3), goes on to zero as it went before."""
    pressed = np.flatnonzero(force > OPEN * force.max())
    if pressed.size == 0:
        return None
    last = int(pressed[-1])
    if last in (0, times.size - 1) or not force[last - 1] > force[last]:
        return float(times[last])
    before, now = force[last - 1 : last + 1] ** (2.0 / 3.0)
    return float(times[last] + (times[last] - times[last - 1]) * now / (before - now))


def contact_record(
    times: Floats, force: Floats, chatter: float, radius: Callable[[float], float]
) -> ContactRecord:
    """What a run found out about one contact.

    Args:
        times: (m,) even instants, s.
        force: (m,) compressive, N.
        chatter: longest separation that does not divide a contact, s.
        radius: contact radius (m) under a force (N).
    """
    pressed = force > 0.0
    starts = np.flatnonzero(pressed & ~np.insert(pressed[:-1], 0, False))
    ends = np.flatnonzero(pressed & ~np.append(pressed[1:], False))
    spans: list[tuple[float, float]] = []
    for start, end in zip(starts, ends, strict=True):
        first = float(times[max(int(start) - 1, 0)])
        if spans and first - spans[-1][1] < chatter:
            first = spans.pop()[0]
        spans.append((first, float(times[end])))
    last = contact_end(times, force)
    if last is not None:
        spans[-1] = (spans[-1][0], last)
    peak = max(float(force.max()), 0.0)
    return ContactRecord(
        count=len(spans),
        end=last,
        intervals=tuple(spans),
        force_peak=peak,
        impulse=float(impulses(force[:, None], times[1] - times[0])[-1, 0]),
        outermost_radius=radius(peak),
    )
