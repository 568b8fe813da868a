"""Motion of axisymmetric bodies, and their run."""

from __future__ import annotations

import ctypes
import math
from typing import Any

import numpy as np

from ..axisymmetric.modal import elastic_modes, modes_up_to
from ..axisymmetric.statics import patch_flexibility
from ..axisymmetric.system import (
    INNER,
    OUTER,
    PLATE,
    AxisymmetricSystem,
    critical_time_step,
    hertz_weights,
)
from ..common.arrays import Floats, Ints
from ..common.fenicsx import alone
from ..explicit import kernel, structures
from ..explicit.damping import ModalDamping
from ..explicit.drag import Drag
from ..explicit.energies import Energies
from ..explicit.loop import SerialLoop
from ..explicit.stiffness import worthwhile
from ..impact.ending import Ending
from ..impact.run import Losses
from .dents import Dents, Memory
from .ending import Followed, Patch, plate_ending
from .estimate import WAVE_FREQUENCY
from .motion import SIDES, Further, State, Yielded
from .run import Run, integrate
from .scene import Scene

CHUNK_SAMPLES = 128
"""Raw samples between two looks at progress, energy and the end of the run."""
WINDOW = 1.1
"""A run lasts this many times as long as its last contact: the window in which curves are
compared. It must not depend on when the end of the run could be proven."""
FOLLOWED_MODES = 16
"""Modes of the plate that are followed."""
DAMPED_FREQUENCY = 8.0 * WAVE_FREQUENCY
"""Up to this frequency times the Hertz contact duration a damped plate's modes are damped. Those
above follow the force as under static load: next to no velocity, next to no loss."""
DRAG_INTERVAL = 1e-2
"""Longest time between two losses to drag, over the Hertz contact duration."""


class AxisymmetricMotion:
    """See `motion.Motion`."""

    share = 1.0

    def __init__(self, system: AxisymmetricSystem, threads: int = 1) -> None:
        threads = worthwhile(threads, system.inverse_mass.size)
        self.system, self.loop = system, SerialLoop(system, alone(), threads)
        self._bent = system.displacement is not None
        self._watched_before = 0.0
        if system.displacement is not None:
            self.loop.u[:] = self.loop.own(system.displacement)
            self.loop.strain()
        self.damping: ModalDamping | None = None
        self.drag: Drag | None = None
        self._interval, self._undamped = math.inf, 0.0
        first, second = system.matched
        self.radii = (first.radii, second.radii)
        self._masses = [system.body_mass(body) for body in (OUTER, PLATE, INNER)]
        bodies = (structures.Carried * 2)()
        for carried, body in zip(bodies, (OUTER, INNER), strict=True):
            carried.mass = self._masses[body]
            carried.start = float(system.velocity[system.first[body], 1])
            carried.node = -1
        self._outer_before = 0.0
        if system.tip is not None:
            bodies[0].node = system.tip
            self._outer_before = float(self.loop.u[2 * system.tip + 1])
        self.voltage: structures.Voltage | None = None
        if system.stack is not None and system.tip is not None:
            self.voltage = system.stack.voltage(system.tip)
            self.loop.problem.state.voltage = ctypes.pointer(self.voltage)
        self.dents: Dents | None = None
        if self.loop.problem.plastic is not None:
            self.dents = Dents(system, self.loop.problem.plastic)
        self._arrays = kernel.Arrays()
        self._bodies = bodies
        self._watched = self._watch(*system.watched)

    def lay(self, memory: Memory, gap: float) -> None:
        """Begin with the dents of earlier impacts, the inner sphere ``gap`` (m) from the plate."""
        if self.dents is not None:
            self.loop.u[:] = self.dents.lay(memory, (0.0, gap))
            nodes, shares = self.system.watched
            self._watched_before = float(shares @ self.loop.u[1::2][nodes])

    def _watch(self, nodes: Ints, shares: Floats) -> structures.Watched:
        watched = structures.Watched()
        watched.count = nodes.size
        watched.node = self._arrays.pointer(nodes, np.int32)
        watched.share = self._arrays.pointer(shares, np.float64)
        return watched

    def damp(self, ratio: float, frequency: float) -> None:
        """Damp the plate's modes up to an angular frequency (rad/s), from the start on."""
        modes = modes_up_to(self.system, frequency)
        self.damping = ModalDamping(self.loop, self.system.body(PLATE), modes, ratio)
        self._lose_every(self.damping.interval)

    def drag_inner(self, coefficient: float, interval: float) -> None:
        """Let the inner body feel F = -coefficient U |U| (N), at least every ``interval`` s."""
        self.drag = Drag(self.loop, self.system.body(INNER), coefficient)
        self._lose_every(interval)

    def _lose_every(self, interval: float) -> None:
        self._interval = min(interval, self._interval)
        # What is lost in an interval is lost in its middle.
        self._undamped = 0.5 * self._interval

    def _lose(self) -> None:
        """What was to be lost since the last time."""
        if self.damping is not None:
            self.damping.lose(self._undamped)
        if self.drag is not None:
            self._bodies[1].start += self.drag.lose(self._undamped)
        self._undamped = 0.0

    @property
    def further(self) -> Further:
        """See `Motion.further`."""
        damping, film, drag = self.damping, self.loop.problem.film, self.drag
        dents = self.dents
        outer, inner = self.loop.problem.matched[:2]
        yielded = dents.yielded() if dents else Yielded()
        losses = Losses(
            damping.dissipated if damping else 0.0,
            -film.work if film else 0.0,
            drag.dissipated if drag else 0.0,
            (yielded.lost[0] - outer.rubbed, yielded.lost[1] - inner.rubbed),
        )
        slowed = drag.impulse if drag else 0.0
        pushed, supplied, taken = self._supplied()
        return Further(
            losses if damping or film or drag or dents or outer.friction > 0.0 else None,
            slowed + pushed + (damping.impulse if damping else 0.0),
            slowed - (film.impulse if film else 0.0),
            yielded if dents else None,
            float(dents.locked_in().sum()) if dents else 0.0,
            supplied=supplied,
            taken=taken,
        )

    def _supplied(self) -> tuple[float, float, tuple[float, float] | None]:
        """Momentum (N s) and work (J) of a stack beyond their measures; `Further.taken`."""
        system, voltage = self.system, self.voltage
        if voltage is None or system.stack is None:
            return 0.0, 0.0, None
        first_contact, stack = system.stack.first_contact, system.stack.stack
        start = float(system.stack.matrices.mass @ first_contact.velocity[:, 1])
        work = first_contact.work + voltage.work
        extension = -float(self.loop.u[2 * voltage.node + 1])
        taken = system.stack.taken(voltage, extension)
        momentum = start + stack.mass * stack.step_speed + voltage.impulse
        return momentum, work - stack.energy, (taken, work)

    def by_role(self, of_bodies: tuple[float, ...]) -> tuple[float, float, float]:
        """See `Motion.by_role`."""
        outer, plate, inner = of_bodies
        return outer, plate, inner

    @property
    def records(self) -> list[structures.Record]:
        """Of the two contacts."""
        return self.loop.problem.records()

    def sample(self, samples: int, stride: int) -> Floats:
        """See `Motion.sample`; samples lie close, so that compiled code takes them."""
        rows = self._sample(samples, stride)
        rows[:, 0] -= self._outer_before
        rows[:, 3] -= self._watched_before
        return rows

    def _sample(self, samples: int, stride: int) -> Floats:
        if self._bent:
            self._fall_behind()
            self._bent = False
        if math.isinf(self._interval):
            return self.loop.run(self._bodies, self._watched, samples, stride)
        rows, length = [], stride * self.loop.dt
        while samples > 0:
            due = math.ceil((self._interval - self._undamped) / length)
            count = min(samples, max(1, due))
            rows.append(self.loop.run(self._bodies, self._watched, count, stride))
            samples -= count
            self._undamped += count * length
            if self._undamped >= self._interval:
                self._lose()
        return np.vstack(rows)

    def _fall_behind(self) -> None:
        """Take the velocities half a step back from the start, at which a bent body has forces."""
        loop, system = self.loop, self.system
        impulse = 0.5 * loop.impulse(loop.u)
        loop.v += loop.inverse * impulse
        if self.voltage is not None and system.stack is not None and system.tip is not None:
            axial = 2 * system.tip + 1
            force = system.stack.force(float(loop.u[axial]), float(self.voltage.charge))
            loop.v[axial] += 0.5 * loop.dt * loop.inverse[axial] * force
            self.voltage.impulse += 0.5 * loop.dt * force
        loop.problem.state.reaction[1] -= float(impulse[1::2][system.supports].sum())

    def velocities(self) -> tuple[float, float]:
        """Mean velocity of each body, of a bender its tip's, half a step late, m/s."""
        tip, v = self.system.tip, self.loop.v
        outer = self.mean_axial(v, OUTER) if tip is None else float(v[2 * tip + 1])
        return outer, self.mean_axial(v, INNER)

    def momenta(self) -> tuple[float, float, float]:
        """Of outer sphere, plate and inner sphere, kg m/s."""
        outer, plate, inner = (
            self.mean_axial(self.loop.v, body) * self._masses[body]
            for body in (OUTER, PLATE, INNER)
        )
        return outer, plate, inner

    def impulses(self) -> tuple[float, float]:
        """Compressive impulse of each contact so far, N s."""
        outer, inner = self.records
        return outer.impulse, inner.impulse

    def plate_energy(self, energies: Energies) -> float:
        """Elastic energy of the plate, rigid motion of a free one apart, J."""
        rigid = energies.rigid_motion[PLATE] if self._free else 0.0
        return energies.elastic[PLATE] - rigid - self._locked_in(PLATE)

    def _locked_in(self, body: int) -> float:
        """Energy of a body that does not vibrate, J."""
        return float(self.dents.locked_in_bodies()[body]) if self.dents else 0.0

    def strained(self) -> Floats:
        """(2n,) displacement but for what plastic strain leaves at rest, m."""
        return self.loop.u - self.dents.at_rest() if self.dents else self.loop.u

    def states(self, energies: Energies) -> tuple[State, State]:
        """Of each sphere against the plate in its rigid motion."""
        place = speed = 0.0
        strained = self.strained()
        if self._free:
            place = self.mean_axial(strained, PLATE)
            speed = self.mean_axial(self.loop.v, PLATE)

        def state(number: int, body: int) -> State:
            opened = self.mean_axial(strained, body) - place
            opening = self.mean_axial(self.loop.v, body) - speed
            dents = self.dents
            gap = dents.clearance(number) if dents else self.system.matched[number].gaps.min()
            vibration = energies.elastic[body] - energies.rigid_motion[body]
            vibration -= self._locked_in(body)
            return State(float(gap) + SIDES[number] * opened, SIDES[number] * opening, vibration)

        return state(0, OUTER), state(1, INNER)

    @property
    def _free(self) -> bool:
        return self.system.supports.size == 0

    def mean_axial(self, values: Floats, body: int) -> float:
        """Mass average of the axial component over a body."""
        system = self.system
        mass = system.mass[system.first[body] : system.first[body + 1]]
        return float(mass @ values[system.body(body)][1::2] / mass.sum())


def _ending(motion: AxisymmetricMotion, scene: Scene) -> Ending:
    system, loop, materials = motion.system, motion.loop, scene.materials
    modes = elastic_modes(system, FOLLOWED_MODES)
    frequencies, shapes = modes.frequencies, modes.shapes
    rows, start = system.body(PLATE), int(system.first[PLATE])
    mass = np.repeat(system.mass, 2)[rows]

    def patch(number: int, body: int) -> Patch:
        pairs = system.matched[number]
        weights = hertz_weights(pairs.radii)
        shares = weights @ shapes[2 * (pairs.opposite - start) + 1]
        whole = patch_flexibility(system, PLATE, pairs.opposite, weights)
        rest = whole - float(np.sum((shares / frequencies) ** 2))
        sphere = patch_flexibility(system, body, pairs.candidates, weights)
        # The stiffness that lasts bounds what an energy can displace.
        return Patch(max(rest, 0.0) / lasting[PLATE], sphere / lasting[body], shares)

    def coordinates() -> tuple[Floats, Floats, Floats]:
        position, velocity = (shapes.T @ (mass * x[rows]) for x in (motion.strained(), loop.v))
        springs = loop.springs
        if springs is None:
            return position, velocity, np.zeros((frequencies.size, 0))
        return position, velocity, shapes.T @ (mass[:, None] * springs.of_body(PLATE))

    lasting = [material.lasting for material in materials]
    patches = (patch(0, OUTER), patch(1, INNER))
    relaxation = materials[PLATE].relaxation
    followed = Followed(frequencies, scene.plate.damping_ratio, relaxation, coordinates)
    return plate_ending(motion, patches, WINDOW, followed)


def integrate_axisymmetric(
    system: AxisymmetricSystem,
    scene: Scene,
    contact_duration: float,
    memory: Memory | None = None,
    threads: int = 1,
    **options: Any,
) -> tuple[Run, AxisymmetricMotion]:
    """Step a system, with at most so many threads; see `run.integrate` for the options.

    ``memory`` is what yielding bodies know of earlier impacts.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    damping_ratio = scene.plate.damping_ratio
    motion = AxisymmetricMotion(system, threads)
    if memory is not None:
        motion.lay(memory, scene.gap)
    if damping_ratio > 0.0:
        motion.damp(damping_ratio, 2.0 * math.pi * DAMPED_FREQUENCY / contact_duration)
    if scene.drag > 0.0:
        motion.drag_inner(scene.drag, DRAG_INTERVAL * contact_duration)
    run = integrate(
        motion,
        scene,
        contact_duration,
        lambda: _ending(motion, scene),
        lambda: critical_time_step(system),
        levels_within_samples=False,
        chunk=CHUNK_SAMPLES,
        **options,
    )
    return run, motion
