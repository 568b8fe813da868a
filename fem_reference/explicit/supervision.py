"""Supervision of a run: step, levels, sampling, divergence, end, checkpoints; for every scene."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ..common.arrays import Floats
from ..common.errors import DivergedError, SolverError
from ..common.settings import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from . import structures
from .checkpoint import Checkpoint
from .energies import Energies, energies_of
from .frames import Frames
from .levels import MOST_LEVELS
from .loop import Loop

CHUNK_SAMPLES, CHUNK_STEPS = 16, 200
"""At least so many samples and steps between two looks at energy, end and clock."""

LARGEST_ENERGY_RESIDUAL = 1e-5
"""Of a run with sub-cycling; beyond it levels have resonated, and the run is made without them."""

LEDGER_ERROR = 2e-3
"""What the ledger of relaxing bodies may miss of the energy they lose: it looks at intervals."""
RELAXATION_LOOKS = 400
"""Looks of the ledger of what relaxes in the contact's duration."""
LEAST_PUSH = 1e-4
"""Share of the film's impulse so far that it gives within a sample, if it pushes."""

Sample = Callable[[int, int], Floats]
"""Advances by samples (first) of a stride of steps (second); a row of the first step of each."""
Ended = Callable[[Energies, float], bool]
"""Whether no further contact is possible at an instant, s."""
T = TypeVar("T")


@dataclass(frozen=True)
class Plan:
    """What the scene says about its run."""

    duration: float
    """Estimated duration of the contact that sets the scale, s."""
    longest: float
    """Longest run over ``duration``, where no end is given."""
    window_samples: int
    """Samples, about, in the window of the force peaks."""
    end_time: float | None
    """s; None: as soon as no further contact is possible."""
    initial_energy: float
    """Of the part modelled, J."""
    most_levels: int = MOST_LEVELS
    """Of sub-cycling; 1: every element at every step."""
    levels_within_samples: bool = True
    """Whether levels that would make the samples longer than requested are omitted."""
    chunk: int | None = None
    """Samples between two looks at energy, end and clock."""


@dataclass(frozen=True)
class Course:
    """What a run leaves, apart from the state of its bodies."""

    rows: Floats
    """(m, columns) samples up to the end, at which one more can be taken."""
    interval: float
    """Between samples, s."""
    critical_time_step: float
    loop_seconds: float
    processor_seconds: float
    """As `loop_seconds`, without the time other programs had the processor."""

    @property
    def times(self) -> Floats:
        """(m + 1,) instants of the samples and of the end, s."""
        return self.interval * np.arange(self.rows.shape[0] + 1)


@dataclass(frozen=True)
class Account:
    """What decides whether a run with sub-cycling stands."""

    levels: int
    residual: float
    """Energy the ledger misses over the initial one."""
    relaxed: float = 0.0
    """Energy lost to relaxation over the initial one."""


def supervise(
    loop: Loop,
    plan: Plan,
    sample: Sample,
    make_ended: Callable[[], Ended],
    critical_time_step: Callable[[], float],
    *,
    courant: float = 0.9,
    fields: Callable[[float], Frames] | None = None,
    checkpoint: Checkpoint | None = None,
    on_progress: Callable[[float, str], None] = lambda done, message: None,
) -> Course:
    """Step from the first touch to the plan's end, or until no further contact is possible.

    Args:
        loop: bodies and contacts at the start.
        plan: see there.
        sample: see `Sample`.
        make_ended: called once the step is set, if the plan has no end.
        critical_time_step: of the system, s.
        courant: time step over the critical one.
        fields: makes the recorder of fields from the sampling interval.
        checkpoint: a run whose checkpoint holds a state goes on from there.
        on_progress: gets the share done and a message.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    saved: dict[str, Any] = (checkpoint.load() if checkpoint else None) or {}
    critical = float(saved["critical"]) if saved else critical_time_step()
    time_step, stride, required, most = _steps(loop, plan, courant * critical, critical)
    split = max(1, round(CHATTER_FRACTION * plan.duration / time_step))
    loop.set_step(time_step, split, most)
    interval = stride * time_step
    frames = fields(interval) if fields is not None else None
    ended = make_ended() if plan.end_time is None else None
    rows: list[Floats] = []
    samples = 0
    seconds = processor = 0.0
    if saved:
        loop.u[:] = loop.own(saved["u"])
        loop.v[:] = loop.own(saved["v"])
        loop.problem.restore(saved["problem"])
        if loop.springs is not None:
            loop.springs.extension[:] = saved["extension"]
            loop.strain()
            loop.restore_ledger(saved)
        rows, samples = [saved["rows"]], len(saved["rows"])
        seconds = float(saved["seconds"])
    chunk = plan.chunk or max(CHUNK_SAMPLES, math.ceil(CHUNK_STEPS / stride))
    started = time.perf_counter()
    while samples < required:
        count = min(chunk, required - samples)
        if frames is not None:
            frames(samples, loop)
            count = min(count, frames.following(samples) - samples)
        chunk_started = time.perf_counter(), time.process_time()
        rows += _sampled(loop, sample, count, stride, plan.duration)
        seconds += time.perf_counter() - chunk_started[0]
        processor += time.process_time() - chunk_started[1]
        samples += count
        now = samples * interval
        energies = energies_of(loop)
        if not energies.total <= 10.0 * plan.initial_energy:
            raise DivergedError(
                f"the solution diverged at {now:.4g} s: energy {energies.total:.3g} J, at the "
                f"start {plan.initial_energy:.3g} J"
            )
        done = now / plan.end_time if plan.end_time else 1.0 - math.exp(-now / plan.duration)
        on_progress(done, f"{now * 1e6:.1f} us, {time.perf_counter() - started:.1f} s")
        if ended is not None and ended(energies, now):
            break
        if checkpoint is not None and checkpoint.due(loop.comm):
            checkpoint.save(loop, critical=critical, rows=np.vstack(rows), seconds=seconds)
    else:
        if ended is not None:
            raise SolverError(
                f"a further contact is still possible at {samples * interval:.4g} s; "
                "set run.end_time"
            )
    if frames is not None:
        frames(samples, loop)
    return Course(np.vstack(rows), interval, critical, seconds, processor)


def _sampled(
    loop: Loop, sample: Sample, samples: int, stride: int, duration: float
) -> list[Floats]:
    """``samples`` rows in parts between which the ledger of what relaxes looks."""
    if loop.ledger is None:
        return [sample(samples, stride)]
    film = loop.problem.film
    if film is not None:
        return _sampled_with_film(loop, film, sample, samples, stride)
    rows, part = [], max(1, round(duration / RELAXATION_LOOKS / (stride * loop.dt)))
    for first in range(0, samples, part):
        rows.append(sample(min(part, samples - first), stride))
        loop.look()
    return rows


def _sampled_with_film(
    loop: Loop, film: structures.Film, sample: Sample, samples: int, stride: int
) -> list[Floats]:
    """``samples`` rows; where the film pushes the ledger looks whenever all levels meet.

    A film moves its nodes within less than the interval of a sample.
    """
    rows, every = [], loop.meeting
    for _ in range(samples):
        before = film.impulse
        taken = []
        for _ in range(stride // every):
            taken.append(sample(1, every))
            loop.look()
        rows.append(taken[0])
        pushed = abs(film.impulse - before) > LEAST_PUSH * abs(film.impulse)
        every = loop.meeting if pushed else stride
    return rows


def _steps(
    loop: Loop, plan: Plan, time_step: float, critical: float
) -> tuple[float, int, int, int]:
    """Time step in s, steps per sample, most samples, most levels."""
    if not 0.0 < time_step <= critical:
        raise SolverError(
            f"the time step {time_step:.6g} s is not between 0 and the critical time step "
            f"{critical:.6g} s; the Courant factor must be in (0, 1], it is "
            f"{time_step / critical:g}"
        )
    window = PEAK_WINDOW_FRACTION * plan.duration
    wish, most = max(1, round(window / plan.window_samples / time_step)), plan.most_levels
    if plan.levels_within_samples:
        most = min(most, wish.bit_length())
    # Samples fall on steps at which all levels meet.
    meeting = 2 ** int(loop.element_levels(time_step, most).max())
    stride = meeting * max(1, round(wish / meeting))
    if plan.end_time is None:
        longest = math.ceil(plan.longest * plan.duration / (stride * time_step))
        return time_step, stride, longest, most
    # The last sample falls exactly on the end: the step shrinks by less than one part in 1000.
    required = max(1, math.ceil(plan.end_time / (stride * time_step) - 1e-9))
    return plan.end_time / (required * stride), stride, required, most


def stable_run(attempt: Callable[[int], T], account: Callable[[T], Account]) -> T:
    """A run with sub-cycling, or without where that diverges or its ledger cannot be read.

    Args:
        attempt: makes a run with at most so many levels.
        account: of a run.
    """
    try:
        run = attempt(MOST_LEVELS)
    except DivergedError as error:
        failed = str(error)
    else:
        found = account(run)
        allowed = LARGEST_ENERGY_RESIDUAL + LEDGER_ERROR * found.relaxed
        if found.levels == 1 or found.residual <= allowed:
            return run
        failed = f"energy residual {found.residual:.2g} with sub-cycling, {allowed:.2g} is allowed"
    print(f"{failed}; stepping again without sub-cycling", file=sys.stderr)
    return attempt(1)
