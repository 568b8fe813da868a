"""What a run says about its contacts: intervals and force peaks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats
from . import structures


@dataclass(frozen=True)
class ContactRecord:
    """What the time loop found out about one contact."""

    count: int
    """Separate contacts. Separations shorter than the chatter limit do not count."""
    end: float | None
    """End of the last one, s; None if they never touched."""
    intervals: tuple[tuple[float, float], ...]
    """First and last instant of each contact, s."""
    force_peak: float
    """N, averaged over the peak window."""
    impulse: float
    """Normal, N s."""
    outermost_radius: float
    """Largest radius of a pair that carried force, m."""


def peak_force(impulse: Floats, window: int, sample_interval: float) -> float:
    """Largest mean force (N) over any ``window`` consecutive sampling intervals.

    ``impulse`` is cumulative, (m,), or of several components (m, d), of which the magnitude counts.
    """
    if impulse.shape[0] <= window:
        return _largest(impulse[-1:] / (sample_interval * max(1, window)))
    return _largest((impulse[window:] - impulse[:-window]) / (window * sample_interval))


def _largest(forces: Floats) -> float:
    return float((forces if forces.ndim == 1 else np.linalg.norm(forces, axis=1)).max())


def intervals(record: structures.Record, time_step: float) -> tuple[tuple[float, float], ...]:
    """First and last instant of each contact, s."""
    # The multiplier of step n acts from t_n - dt/2 to t_n + dt/2.
    return tuple(
        (
            max(0.0, record.first_step[k] - 0.5) * time_step,
            (record.last_step[k] + 0.5) * time_step,
        )
        for k in range(min(record.intervals, structures.MAX_INTERVALS))
    )
