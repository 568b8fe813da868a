"""Contact between a sphere and the plate: node pairs, intervals, and a bound on re-contact."""

from __future__ import annotations

from dataclasses import dataclass

from ..common.arrays import Floats


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
    """N s"""
    work: float
    """Change of the discrete energy by the contact constraint, J: loss if negative."""
    outermost_radius: float
    """Largest radius of a pair that carried force, m."""


CHATTER_FRACTION = 0.005
"""Separations shorter than this share of the Hertz duration are chatter of single nodes."""

PEAK_WINDOW_FRACTION = 1.0 / 600.0
"""Window of the peak force over the Hertz contact duration (0.13 us for 78 us).

Node pairs close and open one by one; the force of a single step jumps by a percent. The
mean over a window much shorter than the contact removes that, and lowers the peak of a smooth
pulse by only (pi * fraction)^2 / 24 of itself, about 1e-6.
"""


def peak_force(cumulative_impulse: Floats, window: int, sample_interval: float) -> float:
    """Largest mean force (N) over any ``window`` consecutive sampling intervals."""
    if cumulative_impulse.size <= window:
        return float(cumulative_impulse[-1] / (sample_interval * max(1, window)))
    means = (cumulative_impulse[window:] - cumulative_impulse[:-window]) / (
        window * sample_interval
    )
    return float(means.max())
