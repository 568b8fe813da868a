"""Supervision of a run: step, sampling, divergence, end, checkpoints; the same for every scene."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.errors import DivergedError, SolverError
from ..solid.fields import Frames
from ..solid.loop import Energies, Loop
from .checkpoint import Checkpoint
from .contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from .spectrum import critical_time_step

CHUNK_SAMPLES, CHUNK_STEPS = 16, 200
"""At least so many samples and steps between two looks at energy, end and clock."""

Sample = Callable[[int], Floats]
"""Advances by so many steps; the row of the first of them."""
Ended = Callable[[Energies], bool]
"""Whether no further contact is possible."""


@dataclass(frozen=True)
class Plan:
    """What the scene says about its run."""

    duration: float
    """Estimated duration of the contact that sets the scale, s."""
    longest: float
    """Longest run over ``duration``, where no end is given."""
    window_samples: int
    """Samples in the window of the force peaks."""
    end_time: float | None
    """s; None: as soon as no further contact is possible."""
    initial_energy: float
    """Of the part modelled, J."""


@dataclass(frozen=True)
class Course:
    """What a run leaves, apart from the state of its bodies."""

    rows: Floats
    """(m, columns) samples, the last at the end."""
    interval: float
    """Between samples, s."""
    critical_time_step: float
    loop_seconds: float

    @property
    def times(self) -> Floats:
        """(m,) instants of the samples, s."""
        return self.interval * np.arange(self.rows.shape[0])


def supervise(
    loop: Loop,
    plan: Plan,
    sample: Sample,
    make_ended: Callable[[], Ended],
    *,
    courant: float,
    most_levels: int,
    fields: Callable[[float], Frames] | None,
    checkpoint: Checkpoint | None,
    on_progress: Callable[[float, str], None],
) -> Course:
    """Step from the first touch to the plan's end, or until no further contact is possible.

    Args:
        loop: bodies and contacts at the start.
        plan: see there.
        sample: see `Sample`.
        make_ended: called once the step is set, if the plan has no end.
        courant: time step over the critical one.
        most_levels: of sub-cycling; 1: every element at every step. A run with a given end, which
            may cut a contact, has one level: only then can its energy be read.
        fields: makes the recorder of fields from the sampling interval.
        checkpoint: a run whose checkpoint holds a state goes on from there.
        on_progress: gets the share done and a message.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    saved: dict[str, Any] = (checkpoint.load() if checkpoint else None) or {}
    critical = float(saved["critical"]) if saved else critical_time_step(loop)
    time_step, stride, wanted = _steps(plan, courant * critical, critical)
    levels = 1 if plan.end_time is not None else min(most_levels, stride.bit_length())
    loop.set_step(time_step, max(1, round(CHATTER_FRACTION * plan.duration / time_step)), levels)
    # Samples fall on steps at which all levels meet.
    stride = loop.meeting * max(1, round(stride / loop.meeting))
    interval = stride * time_step
    frames = fields(interval) if fields is not None else None
    ended = make_ended() if plan.end_time is None else None
    rows: list[Floats] = []
    seconds = 0.0
    if saved:
        loop.u[:] = loop.own(saved["u"])
        loop.v[:] = loop.own(saved["v"])
        loop.problem.restore(saved["problem"])
        rows = list(saved["rows"])
        seconds = float(saved["seconds"])
    chunk = max(CHUNK_SAMPLES, math.ceil(CHUNK_STEPS / stride))
    started = time.perf_counter()
    while len(rows) < wanted:
        chunk_started = time.perf_counter()
        for _ in range(min(chunk, wanted - len(rows))):
            if frames is not None:
                frames(len(rows), loop)
            rows.append(sample(stride))
        seconds += time.perf_counter() - chunk_started
        now = len(rows) * interval
        energies = loop.energies()
        if not energies.total <= 10.0 * plan.initial_energy:
            raise DivergedError(
                f"the solution diverged at {now:.4g} s: energy {energies.total:.3g} J, at the "
                f"start {plan.initial_energy:.3g} J"
            )
        done = now / plan.end_time if plan.end_time else 1.0 - math.exp(-now / plan.duration)
        on_progress(done, f"{now * 1e6:.1f} us, {time.perf_counter() - started:.1f} s")
        if ended is not None and ended(energies):
            break
        if checkpoint is not None and checkpoint.due(loop.comm):
            checkpoint.save(loop, critical=critical, rows=np.array(rows), seconds=seconds)
    else:
        if ended is not None:
            raise SolverError(
                f"a further contact is still possible at {len(rows) * interval:.4g} s; "
                "set run.end_time"
            )
    rows.append(sample(loop.meeting))
    return Course(np.array(rows), interval, critical, seconds)


def _steps(plan: Plan, time_step: float, critical: float) -> tuple[float, int, int]:
    """Time step in s, steps per sample, most samples."""
    if not 0.0 < time_step <= critical:
        raise SolverError(
            f"the time step {time_step:.6g} s is not between 0 and the critical time step "
            f"{critical:.6g} s; the Courant factor must be in (0, 1], it is "
            f"{time_step / critical:g}"
        )
    window = PEAK_WINDOW_FRACTION * plan.duration
    stride = max(1, round(window / plan.window_samples / time_step))
    if plan.end_time is None:
        return time_step, stride, math.ceil(plan.longest * plan.duration / (stride * time_step))
    # The last sample falls exactly on the end.
    wanted = max(1, math.ceil(plan.end_time / (stride * time_step) - 1e-9))
    return plan.end_time / (wanted * stride), stride, wanted
