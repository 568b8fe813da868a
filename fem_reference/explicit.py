"""Explicit time integration: set-up, supervision and ledger of the compiled loop."""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse

from . import kernel
from .contact import (
    CHATTER_FRACTION,
    PEAK_WINDOW_FRACTION,
    ContactRecord,
    no_further_contact,
    peak_force,
)
from .errors import SolverError
from .mesh import Floats
from .system import BODIES, System, critical_time_step, hertz_weights, patch_flexibility

PEAK_WINDOW_SAMPLES = 4
"""Raw sampling intervals in the window of the peak force."""

CHUNK_SAMPLES = 64
"""Raw samples between two looks at progress, energy and the end of the run."""

LONGEST_RUN = 400.0
"""A run without end time is given up after this many Hertz contact durations."""

_OUTER, _PLATE, _INNER = range(3)


@dataclass(frozen=True)
class Energies:
    """Discrete energy of each body (1/2 v_{n+1/2} M v_{n+1/2} + 1/2 u_n K u_{n+1}), J.

    Central differences without contact conserve it exactly (e.g. Hairer, Lubich & Wanner,
    Geometric Numerical Integration).
    """

    total: tuple[float, float, float]
    rigid: tuple[float, float, float]
    """Share of the axial rigid motion."""


@dataclass(frozen=True)
class Snapshot:
    """Displacement of all nodes at one instant."""

    time: float
    displacement: Floats
    """(n, 2), system numbering, m."""


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
    snapshots: tuple[Snapshot, ...]


def _upper_blocks(stiffness: scipy.sparse.csr_matrix) -> scipy.sparse.bsr_matrix:
    """The 2x2 blocks on and above the diagonal, the diagonal one first in each row."""
    blocks = stiffness.tobsr((2, 2))
    blocks.sort_indices()
    rows = np.repeat(np.arange(blocks.indptr.size - 1), np.diff(blocks.indptr))
    upper = blocks.indices >= rows
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows[upper]))])
    return scipy.sparse.bsr_matrix(
        (blocks.data[upper], blocks.indices[upper], indptr), shape=blocks.shape
    )


class _Loop:
    """The compiled loop's state together with the arrays it points to."""

    def __init__(self, system: System, time_step: float, speed: float, split: int) -> None:
        self.system = system
        blocks = _upper_blocks(system.stiffness)
        nodes = system.mass.size
        self._keep: list[object] = []
        self.u = np.zeros(2 * nodes)
        self.v = np.zeros(2 * nodes)
        self.v[1 : 2 * int(system.first[1]) : 2] = -speed
        state = kernel.State()
        state.nodes = nodes
        state.row = self._pointer(blocks.indptr, np.int64)
        state.column = self._pointer(blocks.indices, np.int32)
        state.block = self._pointer(blocks.data.transpose(0, 2, 1), np.float64)
        state.inverse = self._pointer(system.inverse_mass, np.float64)
        state.mass = self._pointer(system.mass, np.float64)
        state.u = self._pointer(self.u, np.float64)
        state.v = self._pointer(self.v, np.float64)
        state.f = self._pointer(np.zeros(2 * nodes), np.float64)
        state.dt = time_step
        state.supports = system.supports.size
        state.support = self._pointer(system.supports, np.int32)
        state.first[:] = system.first.tolist()
        state.centre[:] = list(system.centre)
        state.velocity_before = self._pointer(
            np.zeros(sum(pairs.radii.size for pairs in system.contacts)), np.float64
        )
        state.contacts = len(system.contacts)
        for contact, pairs in zip(state.contact, system.contacts, strict=True):
            inverse = (
                system.inverse_mass[2 * pairs.sphere_nodes + 1]
                + system.inverse_mass[2 * pairs.plate_nodes + 1]
            )
            contact.pairs = pairs.radii.size
            contact.sphere = self._pointer(pairs.sphere_nodes, np.int32)
            contact.plate = self._pointer(pairs.plate_nodes, np.int32)
            contact.gap = self._pointer(pairs.gap, np.float64)
            contact.compliance = self._pointer(1.0 / inverse, np.float64)
            contact.normal = pairs.normal
            contact.last = -1
            contact.outermost = -1
            contact.split = split
        self.state = state
        self._kernel = kernel.load()

    def _pointer(self, array: object, dtype: type) -> object:
        # np.asarray keeps u and v themselves where type and layout already fit.
        contiguous = np.ascontiguousarray(np.asarray(array, dtype=dtype))
        self._keep.append(contiguous)
        types = {np.int32: ctypes.c_int32, np.int64: ctypes.c_int64, np.float64: ctypes.c_double}
        return contiguous.ctypes.data_as(ctypes.POINTER(types[dtype]))

    def run(self, samples: int, stride: int) -> Floats:
        """Advance by samples * stride steps; (samples, 8) rows of the strides' first steps."""
        rows = np.empty((samples, 8))
        self._kernel.run(
            ctypes.byref(self.state), samples, stride,
            rows.ctypes.data_as(ctypes.POINTER(ctypes.c_double)),
        )
        return rows

    def energies(self) -> Energies:
        """Discrete energies between u_n and u_{n+1}."""
        product = np.empty_like(self.u)
        pointer = ctypes.POINTER(ctypes.c_double)
        self._kernel.stiffness_product(
            ctypes.byref(self.state), self.u.ctypes.data_as(pointer),
            product.ctypes.data_as(pointer),
        )
        system = self.system
        mass = np.repeat(system.mass, 2)
        before = self.u - self.state.dt * self.v
        density = 0.5 * mass * self.v**2 + 0.5 * before * product
        axial = mass * self.v
        total, rigid = [], []
        for body in range(3):
            rows = system.body(body)
            total.append(float(density[rows].sum()))
            rigid.append(float(axial[rows][1::2].sum()) ** 2 / (2.0 * system.body_mass(body)))
        return Energies((total[0], total[1], total[2]), (rigid[0], rigid[1], rigid[2]))

    def mean_axial(self, values: Floats, body: int) -> float:
        """Mass average of the axial component over a body."""
        rows = self.system.body(body)
        mass = self.system.mass[self.system.first[body] : self.system.first[body + 1]]
        return float(mass @ values[rows][1::2] / mass.sum())


class _EndCheck:
    """Whether any further contact is possible (see `contact.no_further_contact`)."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.free_plate = system.supports.size == 0
        self.plate_flexibility = max(
            patch_flexibility(system, _PLATE, pairs.plate_nodes, hertz_weights(pairs.radii))
            for pairs in system.contacts
        )
        self.sphere_flexibility = [
            patch_flexibility(system, body, pairs.sphere_nodes, hertz_weights(pairs.radii))
            for body, pairs in zip((_OUTER, _INNER), system.contacts, strict=True)
        ]

    def __call__(self, loop: _Loop, energies: Energies) -> bool:
        plate_energy = energies.total[_PLATE]
        plate_position = plate_velocity = 0.0
        if self.free_plate:
            plate_energy -= energies.rigid[_PLATE]
            plate_position = loop.mean_axial(loop.u, _PLATE)
            plate_velocity = loop.mean_axial(loop.v, _PLATE)
        for body, pairs, contact, flexibility in zip(
            (_OUTER, _INNER), self.system.contacts, loop.state.contact, self.sphere_flexibility,
            strict=True,
        ):
            if contact.force > 0.0:
                return False
            position = loop.mean_axial(loop.u, body) - plate_position
            velocity = loop.mean_axial(loop.v, body) - plate_velocity
            if not no_further_contact(
                clearance=float(pairs.gap.min()) + pairs.normal * position,
                opening_speed=pairs.normal * velocity,
                plate_energy=plate_energy,
                plate_flexibility=self.plate_flexibility,
                sphere_energy=energies.total[body] - energies.rigid[body],
                sphere_flexibility=flexibility,
            ):
                return False
        return True


def integrate(
    system: System,
    speed: float,
    contact_duration: float,
    *,
    end_time: float | None = None,
    courant: float = 0.9,
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
    stride = max(
        1, round(PEAK_WINDOW_FRACTION * contact_duration / PEAK_WINDOW_SAMPLES / time_step)
    )
    if end_time is not None:
        # The last sample falls exactly on the end: the step shrinks by less than one part in 1000.
        samples_wanted = max(1, math.ceil(end_time / (stride * time_step) - 1e-9))
        time_step = end_time / (samples_wanted * stride)
    else:
        samples_wanted = math.ceil(LONGEST_RUN * contact_duration / (stride * time_step))
    interval = stride * time_step
    split = max(1, round(CHATTER_FRACTION * contact_duration / time_step))
    loop = _Loop(system, time_step, speed, split)
    ended = _EndCheck(system) if end_time is None else None
    initial_energy = 0.5 * system.body_mass(_OUTER) * speed**2
    initial_momentum = -system.body_mass(_OUTER) * speed
    pending = sorted({max(0, round(t / interval)) for t in snapshot_times})
    snapshots: list[Snapshot] = []
    rows: list[Floats] = []
    samples = 0
    started = time.perf_counter()
    seconds = 0.0
    while True:
        while pending and pending[0] == samples:
            pending.pop(0)
            snapshots.append(Snapshot(samples * interval, loop.u.reshape(-1, 2).copy()))
        if samples >= samples_wanted:
            break
        count = min(CHUNK_SAMPLES, samples_wanted - samples)
        if pending:
            count = min(count, pending[0] - samples)
        chunk_started = time.perf_counter()
        rows.append(loop.run(count, stride))
        seconds += time.perf_counter() - chunk_started
        samples += count
        energies = loop.energies()
        total = sum(energies.total)
        if not total <= 10.0 * initial_energy:
            raise SolverError(
                f"the solution diverged at {samples * interval:.4g} s: energy {total:.3g} J, "
                f"at the start {initial_energy:.3g} J"
            )
        now = samples * interval
        done = now / end_time if end_time is not None else 1.0 - math.exp(-now / contact_duration)
        on_progress(done, f"{now * 1e6:.1f} us, {time.perf_counter() - started:.1f} s")
        if ended is not None and ended(loop, energies):
            break
    else:
        raise AssertionError
    if ended is not None and samples >= samples_wanted:
        raise SolverError(
            f"after {samples * interval:.4g} s a further contact is still possible; set run.end_time"
        )
    last_rows = loop.run(1, 1)
    return _result(
        loop, np.vstack([*rows, last_rows]), interval, critical, seconds, initial_energy,
        initial_momentum, snapshots,
    )


def _result(
    loop: _Loop, rows: Floats, interval: float, critical: float, seconds: float,
    initial_energy: float, initial_momentum: float, snapshots: list[Snapshot],
) -> Run:
    system, state = loop.system, loop.state
    energies = loop.energies()
    work = sum(contact.work for contact in state.contact)
    momenta = [
        loop.mean_axial(loop.v, body) * system.body_mass(body) for body in range(len(BODIES))
    ]
    # Three independent balances: all bodies against the support, each sphere against its contact.
    misses = [
        sum(momenta) - initial_momentum - state.support_impulse,
        momenta[_OUTER] - initial_momentum - state.contact[0].impulse,
        momenta[_INNER] + state.contact[1].impulse,
    ]
    records = tuple(
        _record(contact, pairs.radii, state.dt, rows[:, column], interval)
        for contact, pairs, column in zip(state.contact, system.contacts, (2, 7), strict=True)
    )
    return Run(
        times=interval * np.arange(rows.shape[0]),
        rows=rows,
        contacts=(records[0], records[1]),
        in_contact_at_end=any(contact.force > 0.0 for contact in state.contact),
        time_step=state.dt,
        critical_time_step=critical,
        steps=state.step,
        loop_seconds=seconds,
        outer_velocity=loop.mean_axial(loop.v, _OUTER),
        inner_velocity=loop.mean_axial(loop.v, _INNER),
        energies=energies,
        initial_energy=initial_energy,
        energy_residual=abs(sum(energies.total) - initial_energy - work) / initial_energy,
        contact_loss=-work / initial_energy,
        momentum_residual=max(abs(miss) for miss in misses) / abs(initial_momentum),
        support_impulse=state.support_impulse,
        snapshots=tuple(snapshots),
    )


def _record(
    contact: kernel.Contact, radii: Floats, time_step: float, impulse: Floats, interval: float
) -> ContactRecord:
    stored = min(contact.intervals, kernel.MAX_INTERVALS)
    # The multiplier of step n acts from t_n - dt/2 to t_n + dt/2.
    intervals = tuple(
        (max(0.0, contact.first_step[k] - 0.5) * time_step, (contact.last_step[k] + 0.5) * time_step)
        for k in range(stored)
    )
    return ContactRecord(
        count=int(contact.intervals),
        end=intervals[-1][1] if intervals else None,
        intervals=intervals,
        force_peak=peak_force(impulse, PEAK_WINDOW_SAMPLES, interval),
        impulse=contact.impulse,
        work=contact.work,
        outermost_radius=float(radii[contact.outermost]) if contact.outermost >= 0 else 0.0,
    )
