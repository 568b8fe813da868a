"""Explicit time integration: set-up, supervision and ledger of the compiled loop."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..axisymmetric.system import BODIES, INNER, OUTER, System, critical_time_step
from ..common.arrays import Floats
from ..common.errors import DivergedError, SolverError
from ..explicit import kernel
from ..explicit.contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION, ContactRecord, peak_force
from ..explicit.levels import MOST_LEVELS, element_levels
from ..explicit.loop import Energies, Loop
from .axisymmetric_ending import EndCheck

RAW_SAMPLES = 4
"""Raw sampling intervals, about, in the window of the peak force."""

CHUNK_SAMPLES = 128
"""Raw samples between two looks at progress, energy and the end of the run."""

WINDOW = 1.1
"""A run lasts this many times as long as its last contact: the window in which curves are
compared. It must not depend on when the end of the run could be proven."""

LONGEST_RUN = 400.0
"""A run without end time is given up after this many Hertz contact durations."""


@dataclass(frozen=True)
class Snapshot:
    """Displacement of all nodes at one instant."""

    time: float
    displacement: Floats
    """(n, 2), system numbering, m."""


@dataclass(frozen=True)
class Balance:
    """Velocities at the end of a run, and the ledger of momentum and energy."""

    outer_velocity: float
    inner_velocity: float
    energies: Energies
    initial_energy: float
    energy_residual: float
    """Energy that the ledger misses over the initial energy."""
    contact_loss: float
    """Energy the contact constraint took out over the initial energy."""
    momentum_residual: float
    """Momentum that the ledger misses over the initial momentum."""
    support_impulse: float


@dataclass(frozen=True)
class Run:
    """Result of the time loop."""

    times: Floats
    """(m,) raw sampling instants, s."""
    rows: Floats
    """(m, 8) outer displacement, velocity, impulse so far; plate displacement, velocity;
    inner displacement, velocity, impulse so far."""
    contacts: tuple[ContactRecord, ContactRecord]
    in_contact_at_end: bool
    time_step: float
    critical_time_step: float
    steps: int
    loop_seconds: float
    processor_seconds: float
    """As `loop_seconds`, without the time other programs had the processor."""
    levels: tuple[int, ...]
    """Nodes whose elements of each level of sub-cycling act."""
    balance: Balance
    snapshots: tuple[Snapshot, ...]


def integrate(
    system: System,
    speed: float,
    contact_duration: float,
    *,
    end_time: float | None = None,
    courant: float = 0.9,
    most_levels: int = MOST_LEVELS,
    snapshot_times: tuple[float, ...] = (),
    on_progress: Callable[[float, str], None] = lambda done, message: None,
) -> Run:
    """Step from the first touch to ``end_time``, or until no further contact is possible.

    Args:
        system: the assembled bodies.
        speed: of the outer sphere towards the plate, m/s.
        contact_duration: Hertz's, s; sets sampling and the chatter limit.
        end_time: s.
        courant: time step over the critical one.
        most_levels: of sub-cycling (see `levels`); 1: every element at every step.
        snapshot_times: instants at which to keep all displacements, s.
        on_progress: called with the share done and a message.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    critical = critical_time_step(system)
    time_step = courant * critical
    if not 0.0 < time_step <= critical:
        raise SolverError(
            f"the time step {time_step:.6g} s is not between 0 and the critical time step "
            f"{critical:.6g} s; the Courant factor must be in (0, 1], it is {courant:g}"
        )
    # Samples fall on steps at which all levels meet.
    meeting = 2 ** int(element_levels(system, time_step, most_levels).max())
    window = PEAK_WINDOW_FRACTION * contact_duration
    stride = meeting * max(1, round(window / RAW_SAMPLES / time_step / meeting))
    if end_time is not None:
        # The last sample falls exactly on the end: the step shrinks by less than one part in 1000.
        samples_wanted = max(1, math.ceil(end_time / (stride * time_step) - 1e-9))
        time_step = end_time / (samples_wanted * stride)
    else:
        samples_wanted = math.ceil(LONGEST_RUN * contact_duration / (stride * time_step))
    interval = stride * time_step
    split = max(1, round(CHATTER_FRACTION * contact_duration / time_step))
    loop = Loop(system, time_step, speed, split, most_levels)
    ended = EndCheck(system) if end_time is None else None
    initial_energy = 0.5 * system.body_mass(OUTER) * speed**2
    initial_momentum = -system.body_mass(OUTER) * speed
    pending = sorted({max(0, round(t / interval)) for t in snapshot_times})
    snapshots: list[Snapshot] = []
    rows: list[Floats] = []
    samples = 0
    started = time.perf_counter()
    seconds = processor = 0.0
    while True:
        while pending and pending[0] == samples:
            pending.pop(0)
            snapshots.append(Snapshot(samples * interval, loop.u.reshape(-1, 2).copy()))
        if samples >= samples_wanted:
            break
        count = min(CHUNK_SAMPLES, samples_wanted - samples)
        if pending:
            count = min(count, pending[0] - samples)
        chunk_started = time.perf_counter(), time.process_time()
        rows.append(loop.run(count, stride))
        seconds += time.perf_counter() - chunk_started[0]
        processor += time.process_time() - chunk_started[1]
        samples += count
        energies = loop.energies()
        total = sum(energies.total)
        if not total <= 10.0 * initial_energy:
            raise DivergedError(
                f"the solution diverged at {samples * interval:.4g} s: energy {total:.3g} J, "
                f"at the start {initial_energy:.3g} J"
            )
        now = samples * interval
        done = now / end_time if end_time is not None else 1.0 - math.exp(-now / contact_duration)
        on_progress(done, f"{now * 1e6:.1f} us, {time.perf_counter() - started:.1f} s")
        if ended is not None and now >= _last_contact(loop) * WINDOW and ended(loop, energies):
            break
    else:
        raise AssertionError
    if ended is not None and samples >= samples_wanted:
        raise SolverError(
            f"a further contact is still possible at {samples * interval:.4g} s; set run.end_time"
        )
    balance = _balance(loop, initial_energy, initial_momentum)
    # The last sample needs one more step, which leaves the levels at different times.
    in_contact = any(contact.force > 0.0 for contact in loop.state.contact)
    all_rows = np.vstack([*rows, loop.run(1, 1)])
    state, peak_window = loop.state, max(1, round(window / interval))
    records = tuple(
        _record(contact, pairs.radii, state.dt, all_rows[:, column], interval, peak_window)
        for contact, pairs, column in zip(state.contact, system.contacts, (2, 7), strict=True)
    )
    return Run(
        times=interval * np.arange(all_rows.shape[0]),
        rows=all_rows,
        contacts=(records[0], records[1]),
        in_contact_at_end=in_contact,
        time_step=state.dt,
        critical_time_step=critical,
        steps=state.step,
        loop_seconds=seconds,
        processor_seconds=processor,
        levels=tuple(int(matrix.nodes.size) for matrix in loop.levels),
        balance=balance,
        snapshots=tuple(snapshots),
    )


def _last_contact(loop: Loop) -> float:
    """End of the last contact so far, s; 0 before the first."""
    return float(max(contact.last + 1 for contact in loop.state.contact) * loop.state.dt)


def _balance(loop: Loop, initial_energy: float, initial_momentum: float) -> Balance:
    system, state = loop.system, loop.state
    energies = loop.energies()
    work = sum(contact.work for contact in state.contact)
    velocity = [loop.mean_axial(loop.v, body) for body in range(len(BODIES))]
    momenta = [velocity[body] * system.body_mass(body) for body in range(len(BODIES))]
    # Three independent balances: all bodies against the support, each sphere against its contact.
    misses = [
        sum(momenta) - initial_momentum - state.support_impulse,
        momenta[OUTER] - initial_momentum - state.contact[0].impulse,
        momenta[INNER] + state.contact[1].impulse,
    ]
    return Balance(
        outer_velocity=velocity[OUTER],
        inner_velocity=velocity[INNER],
        energies=energies,
        initial_energy=initial_energy,
        energy_residual=abs(sum(energies.total) - initial_energy - work) / initial_energy,
        contact_loss=-work / initial_energy,
        momentum_residual=max(abs(miss) for miss in misses) / abs(initial_momentum),
        support_impulse=state.support_impulse,
    )


def _record(
    contact: kernel.Contact,
    radii: Floats,
    time_step: float,
    impulse: Floats,
    interval: float,
    peak_window: int,
) -> ContactRecord:
    stored = min(contact.intervals, kernel.MAX_INTERVALS)
    # The multiplier of step n acts from t_n - dt/2 to t_n + dt/2.
    intervals = tuple(
        (
            max(0.0, contact.first_step[k] - 0.5) * time_step,
            (contact.last_step[k] + 0.5) * time_step,
        )
        for k in range(stored)
    )
    return ContactRecord(
        count=int(contact.intervals),
        end=intervals[-1][1] if intervals else None,
        intervals=intervals,
        force_peak=peak_force(impulse, peak_window, interval),
        impulse=contact.impulse,
        work=contact.work,
        outermost_radius=float(radii[contact.outermost]) if contact.outermost >= 0 else 0.0,
    )
