"""A run of an impact: plan, balances, contacts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.settings import PEAK_WINDOW_FRACTION
from ..explicit.energies import energies_of
from ..explicit.levels import MOST_LEVELS
from ..explicit.loop import Loop
from ..explicit.records import ContactRecord, intervals, peak_force
from ..explicit.spectrum import critical_time_step
from ..explicit.supervision import Course, Plan, supervise
from ..impact.run import ImpactRun
from .ending import impact_ending
from .model import STRUCK, ImpactModel, Side
from .motion import COLUMNS, Motion
from .scene import OUTER, Scene
from .struck import UP

PEAK_WINDOW_SAMPLES = 4
"""Raw sampling intervals, about, in the window of the peak force."""
LONGEST_RUN = 400.0
"""A run without end time is given up after this many Hertz durations."""


@dataclass(frozen=True, kw_only=True)
class Run(ImpactRun):
    """A run, its rows `COLUMNS` of outer and inner body, its contacts those of the sides."""

    outer_velocity: float
    """Along the normal at the contact, m/s."""
    inner_velocity: float | None
    """Along the inward normal at its contact, m/s; None: there is no inner body."""
    struck_velocities: tuple[float, ...]
    """Of the centre of mass of what is struck, along the direction of each side, m/s; 0 if held."""


def integrate(loop: Loop, made: ImpactModel, scene: Scene, duration: float, **options: Any) -> Run:
    """Step from the first touch to ``scene.end_time``, or until no further contact is possible.

    ``most_levels`` is that of sub-cycling; a run with a given end, which may cut a contact, has one
    level: only then can its energy be read. Further options are those of `supervise`.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    motion = Motion(loop, made, UP if scene.struck_is_inner else None)
    most_levels = options.pop("most_levels", MOST_LEVELS)
    plan = Plan(
        duration=duration,
        longest=LONGEST_RUN,
        window_samples=PEAK_WINDOW_SAMPLES,
        end_time=scene.end_time,
        initial_energy=made.share * scene.initial_energy,
        most_levels=1 if scene.end_time is not None else most_levels,
    )
    course = supervise(
        loop,
        plan,
        motion.sample,
        lambda: impact_ending(motion),
        lambda: critical_time_step(loop),
        **options,
    )
    return _result(motion, scene, course, duration)


def momentum_misses(motion: Motion, scene: Scene) -> Floats:
    """Momentum (N s, part modelled) that no impulse accounts for, of independent balances.

    Each partner against its contact, and all bodies against supports, guides and planes of
    symmetry along the normal of the outer contact.
    """
    loop, made = motion.loop, motion.made
    momenta, misses = loop.momenta(), []
    direction = made.sides[0].strike.normal
    total = -float(direction @ np.array(loop.problem.state.reaction))
    if made.has_struck:
        start = loop.body_masses()[STRUCK] * scene.struck_velocity
        total += float(direction @ momenta[STRUCK]) - start
    for side in made.sides:
        speed = -scene.speed if side.name == OUTER else scene.inner_speed
        mass = made.share * scene.partners()[side.name].mass
        now = mass * motion.of_side("v", side)
        gained = now - mass * speed * side.along
        total += float(direction @ gained)
        pushed = made.share * motion.compressive("impulse", side)
        misses.append(float(side.strike.normal @ gained) - pushed)
    return np.array([total, *misses])


def _result(motion: Motion, scene: Scene, course: Course, duration: float) -> Run:
    loop, made = motion.loop, motion.made
    problem = loop.problem
    energies, in_contact = energies_of(loop), loop.is_in_contact
    work = sum(record.work for record in problem.records())
    initial = made.share * scene.initial_energy
    momentum = made.share * scene.outer.mass * scene.closing_speed
    misses, speeds = momentum_misses(motion, scene), motion.speeds()
    struck = tuple(
        float(side.along @ motion.mean("v", STRUCK)) if _moves(scene) else 0.0
        for side in made.sides
    )
    impulses = [motion.compressive("impulse", side) for side in made.sides]
    # the last sample needs one more step, which leaves the levels at different times
    rows = np.vstack([course.rows, motion.sample(1, 1)])
    window = max(1, round(PEAK_WINDOW_FRACTION * duration / course.interval))
    contacts = [
        _record(loop, side, rows[:, COLUMNS * k + 2], impulses[k], course.interval, window)
        for k, side in enumerate(made.sides)
    ]
    return Run(
        times=course.times,
        rows=rows,
        contacts=tuple(contacts),
        in_contact_at_end=in_contact,
        time_step=loop.dt,
        critical_time_step=course.critical_time_step,
        steps=problem.state.step,
        loop_seconds=course.loop_seconds,
        processor_seconds=course.processor_seconds,
        outer_velocity=float(speeds[0]),
        inner_velocity=float(speeds[1]) if speeds.size > 1 else None,
        struck_velocities=struck,
        initial_energy=scene.initial_energy,
        energy_residual=abs(energies.total - initial - work) / initial,
        contact_loss=-work / initial,
        momentum_residual=float(np.abs(misses).max()) / momentum,
        support_impulse=float(made.sides[0].strike.normal @ np.array(problem.state.reaction))
        / made.share,
    )


def _moves(scene: Scene) -> bool:
    """Whether the centre of mass of what is struck may move."""
    return scene.struck_is_inner or scene.held is False


def _record(
    loop: Loop, side: Side, impulses: Floats, impulse: float, interval: float, window: int
) -> ContactRecord:
    record = loop.problem.contacts[side.contact].record
    spans = intervals(record, loop.dt)
    outermost = float(side.patch.distances[record.outermost]) if record.outermost >= 0 else 0.0
    return ContactRecord(
        count=int(record.intervals),
        end=spans[-1][1] if spans else None,
        intervals=spans,
        force_peak=peak_force(impulses, window, interval),
        impulse=impulse,
        outermost_radius=outermost,
    )
