"""A run of a plate impact: plan, ledger, contacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.bodies import Bender, Stack
from ..common.settings import PEAK_WINDOW_FRACTION
from ..explicit.energies import Energies, energies_of
from ..explicit.levels import MOST_LEVELS
from ..explicit.records import ContactRecord, intervals, peak_force
from ..explicit.supervision import Course, Ended, Plan, supervise
from ..impact.run import ImpactRun, Losses
from .motion import Motion, Sideways, Yielded
from .scene import Scene

PEAK_WINDOW_SAMPLES = 4
"""Raw sampling intervals, about, in the window of the peak force."""
LONGEST_RUN = 400.0
"""A run without end time is given up after this many Hertz contact durations."""


@dataclass(frozen=True, kw_only=True)
class Run(ImpactRun):
    """A run, its rows (m, 8) as `Motion.sample`, its contacts those of outer and inner body."""

    outer_velocity: float
    inner_velocity: float
    energies: Energies
    """At the end, of the part modelled."""
    yielded: Yielded | None
    """None: nothing that could yield."""
    sideways: Sideways | None = None
    """None: symmetry leaves no motion along the plate."""
    stack: tuple[float, float] | None = None
    """Energy that a stack took, and that it gave to the plate, J; None: no stack."""
    dents: Floats | None = None
    """As `Dents.profiles`; None of bodies that cannot have any."""


def integrate(
    motion: Motion,
    scene: Scene,
    contact_duration: float,
    make_ended: Callable[[], Ended],
    critical_time_step: Callable[[], float],
    *,
    end_time: float | None = None,
    most_levels: int = MOST_LEVELS,
    levels_within_samples: bool = True,
    chunk: int | None = None,
    **options: Any,
) -> Run:
    """Step from the first touch to ``end_time``, or until no further contact is possible.

    Args:
        motion: of the bodies at the start.
        scene: what they are.
        contact_duration: Hertz's, s; sets sampling and the chatter limit.
        make_ended: see `supervise`.
        critical_time_step: of the system, s.
        end_time: s.
        most_levels: of sub-cycling (see `levels`); 1: every element at every step.
        levels_within_samples: see `Plan`.
        chunk: samples between two looks at the energy and the end.
        options: further ones of `supervise`.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    plan = Plan(
        duration=contact_duration,
        longest=LONGEST_RUN,
        window_samples=PEAK_WINDOW_SAMPLES,
        end_time=end_time,
        initial_energy=motion.share * scene.initial_energy,
        most_levels=most_levels,
        levels_within_samples=levels_within_samples,
        chunk=chunk,
    )
    course = supervise(motion.loop, plan, motion.sample, make_ended, critical_time_step, **options)
    return _result(motion, scene, contact_duration, course)


def _result(motion: Motion, scene: Scene, duration: float, course: Course) -> Run:
    loop, share = motion.loop, motion.share
    problem = loop.problem
    energies, in_contact = energies_of(loop), loop.is_in_contact
    work = sum(record.work for record in motion.records)
    stored = sum(record.stored for record in motion.records)
    velocities, momenta = motion.velocities(), motion.momenta()
    impulses = [share * impulse for impulse in motion.impulses()]
    outer_start, inner_start = (share * momentum for momentum in scene.initial_momenta)
    initial_energy = share * scene.initial_energy
    support = problem.state.reaction[loop.components - 1]
    further = motion.further
    losses = further.losses
    if loop.ledger is not None:
        losses = replace(losses or Losses(), bodies=motion.by_role(energies.lost))
    vibration = energies.total - further.locked_in
    missed = vibration + (losses.total if losses else 0.0) - initial_energy - work
    missed -= further.supplied
    # Independent balances: all bodies against the supports, each free one against what acts on it.
    misses = [
        sum(momenta) - outer_start - inner_start - support - further.on_all,
        momenta[2] - inner_start + impulses[1] - further.on_inner,
    ]
    if not isinstance(scene.outer, Bender | Stack):
        misses.append(momenta[0] - outer_start - impulses[0])
    misses += further.sideways.misses if further.sideways else ()
    # The last sample needs one more step, which leaves the levels at different times.
    rows = np.vstack([course.rows, motion.sample(1, 1)])
    window = max(1, round(PEAK_WINDOW_FRACTION * duration / course.interval))
    records = [
        _record(motion, number, rows[:, column], course.interval, window)
        for number, column in enumerate((2, 7))
    ]
    return Run(
        times=course.times,
        rows=rows,
        contacts=(records[0], records[1]),
        in_contact_at_end=in_contact,
        time_step=loop.dt,
        critical_time_step=course.critical_time_step,
        steps=problem.state.step,
        loop_seconds=course.loop_seconds,
        processor_seconds=course.processor_seconds,
        outer_velocity=velocities[0],
        inner_velocity=velocities[1],
        energies=energies,
        initial_energy=initial_energy / share,
        energy_residual=abs(missed) / initial_energy,
        contact_loss=-(work + stored) / initial_energy,
        momentum_residual=max(abs(miss) for miss in misses) / abs(outer_start),
        support_impulse=support / share,
        losses=losses and losses.of_whole(share),
        yielded=further.yielded,
        sideways=further.sideways,
        stack=further.taken and (further.taken[0], further.taken[1] - energies.elastic[0]),
    )


def _record(
    motion: Motion, number: int, impulse: Floats, interval: float, window: int
) -> ContactRecord:
    record, radii = motion.records[number], motion.radii[number]
    spans = intervals(record, motion.loop.dt)
    return ContactRecord(
        count=int(record.intervals),
        end=spans[-1][1] if spans else None,
        intervals=spans,
        force_peak=peak_force(impulse, window, interval),
        impulse=motion.impulses()[number],
        outermost_radius=float(radii[record.outermost]) if record.outermost >= 0 else 0.0,
    )
