"""A run of the plate model: sampling, end, ledger."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats
from ..explicit.checkpoint import Checkpoint
from ..explicit.contact import ContactRecord, peak_force
from ..explicit.ending import no_further_contact
from ..explicit.levels import MOST_LEVELS
from ..explicit.spectrum import patch_flexibility
from ..explicit.supervision import Course, Plan, supervise
from ..solid import kernel
from ..solid.fields import Frames
from ..solid.loop import Energies, Loop
from .scene import Scene
from .solid_model import FRACTION, INNER, OUTER, PLATE, PlateModel

PEAK_WINDOW_SAMPLES = 4
LONGEST_RUN = 400.0
NAMES = (OUTER, INNER)


@dataclass(frozen=True)
class SolidRun:
    """Result of the time loop, of the whole bodies rather than the quarter."""

    times: Floats
    rows: Floats
    """(m, 8) as `explicit.Run.rows`."""
    contacts: tuple[ContactRecord, ContactRecord]
    in_contact_at_end: bool
    time_step: float
    critical_time_step: float
    steps: int
    loop_seconds: float
    outer_velocity: float
    inner_velocity: float
    initial_energy: float
    energy_residual: float
    contact_loss: float
    momentum_residual: float
    support_impulse: float
    sweeps_per_step: float
    unconverged: int


class _Bodies:
    """Positions and velocities along z of the spheres and the plate's centre."""

    def __init__(self, loop: Loop, plate: PlateModel) -> None:
        self.loop, self.plate = loop, plate
        masses = loop.body_masses()
        self.weights = np.zeros((3, loop.owned.size))
        for row, name in enumerate((OUTER, INNER)):
            if name in plate.elastic:
                number = plate.elastic[name]
                self.weights[row] = np.where(loop.body == number, loop.mass / masses[number], 0.0)
        first = int(loop.model.first[plate.elastic[PLATE]])
        self.weights[2] = 0.5 * np.isin(loop.owned, first + np.array(plate.centre))
        number = plate.elastic[PLATE]
        self.plate_weights = np.where(loop.body == number, loop.mass / masses[number], 0.0)

    def positions(self) -> Floats:
        """Outer, inner, plate's centre, m."""
        return self._values(self.loop.u, "u")

    def velocities(self) -> Floats:
        """The same half a step later, m/s."""
        return self._values(self.loop.v, "v")

    def plate_mean(self) -> tuple[float, float]:
        """Mass average of the plate's displacement and velocity."""
        u, v = (self.loop.total(self.plate_weights @ x[2::3]) for x in (self.loop.u, self.loop.v))
        return float(u), float(v)

    def _values(self, vector: Floats, name: str) -> Floats:
        values = self.loop.total(self.weights @ vector[2::3])
        for row, body in enumerate(NAMES):
            if body in self.plate.rigid:
                values[row] = getattr(self.loop.problem.rigids[self.plate.rigid[body]], name)[2]
        return values


def _impulse(contact: kernel.Contact, rigid: bool, side: float) -> float:
    """Compressive impulse so far on the whole bodies, N s."""
    # Candidates are the sphere's nodes, or the plate's if the sphere is rigid.
    sign = -side if rigid else side
    return float(sign * contact.impulse[2] / FRACTION)


def _force(contact: kernel.Contact, rigid: bool, side: float) -> float:
    sign = -side if rigid else side
    return float(sign * contact.force[2] / FRACTION)


class _Ending:
    """Whether any further contact is possible (see `ending.no_further_contact`)."""

    def __init__(self, loop: Loop, plate: PlateModel, scene: Scene, bodies: _Bodies) -> None:
        self.loop, self.plate, self.bodies = loop, plate, bodies
        self.free = scene.plate.edge == "free"
        self.gaps = (0.0, scene.gap)

        def flexibility(body: str, contact: str) -> float:
            nodes, areas = plate.patches[body, contact]
            points = loop.model.elastic[plate.elastic[body]].mesh.points[nodes]
            squares = (points[:, :2] ** 2).sum(axis=1) / plate.zone**2
            weights = areas * np.sqrt(np.maximum(0.0, 1.0 - squares))
            number = plate.elastic[body]
            return patch_flexibility(loop, number, nodes, weights / weights.sum())

        self.plate_flexibility = max(flexibility(PLATE, name) for name in NAMES)
        self.flexibility = {
            name: flexibility(name, name) if name in plate.elastic else 0.0 for name in NAMES
        }

    def __call__(self, energies: Energies) -> bool:
        number = self.plate.elastic[PLATE]
        plate_energy = energies.elastic[number]
        position = velocity = 0.0
        if self.free:
            plate_energy -= energies.rigid_motion[number]
            position, velocity = self.bodies.plate_mean()
        places, speeds = self.bodies.positions(), self.bodies.velocities()
        for row, (name, side, gap) in enumerate(zip(NAMES, (1.0, -1.0), self.gaps, strict=True)):
            if any(self.loop.problem.contacts[row].force):
                return False
            body = self.plate.elastic.get(name)
            energy = 0.0
            if body is not None:
                energy = energies.elastic[body] - energies.rigid_motion[body]
            if not no_further_contact(
                clearance=gap + side * (places[row] - position),
                opening_speed=side * (speeds[row] - velocity),
                plate_energy=plate_energy,
                plate_flexibility=self.plate_flexibility,
                sphere_energy=energy,
                sphere_flexibility=self.flexibility[name],
            ):
                return False
        return True


def integrate(
    loop: Loop,
    plate: PlateModel,
    scene: Scene,
    contact_duration: float,
    *,
    courant: float = 0.9,
    most_levels: int = MOST_LEVELS,
    fields: Callable[[float], Frames] | None = None,
    checkpoint: Checkpoint | None = None,
    on_progress: Callable[[float, str], None] = lambda done, message: None,
) -> SolidRun:
    """Step from the first touch to ``scene.end_time``, or until no further contact is possible.

    ``fields`` makes the recorder of fields from the sampling interval. A run whose ``checkpoint``
    holds a state goes on from there. ``most_levels`` is that of sub-cycling; 1: every element acts
    at every step.

    Raises:
        SolverError: time step above the critical one, divergence, or no end found.
    """
    bodies = _Bodies(loop, plate)
    plan = Plan(
        duration=contact_duration,
        longest=LONGEST_RUN,
        window_samples=PEAK_WINDOW_SAMPLES,
        end_time=scene.end_time,
        initial_energy=0.5 * FRACTION * scene.outer.mass * scene.speed**2,
    )
    course = supervise(
        loop,
        plan,
        lambda stride: _sample(loop, plate, bodies, stride),
        lambda: _Ending(loop, plate, scene, bodies),
        courant=courant,
        most_levels=most_levels,
        fields=fields,
        checkpoint=checkpoint,
        on_progress=on_progress,
    )
    return _result(loop, plate, scene, bodies, course)


SIDES = (1.0, -1.0)


def _sample(loop: Loop, plate: PlateModel, bodies: _Bodies, stride: int) -> Floats:
    """Advance by ``stride`` steps; the row of the first step, see `SolidRun.rows`."""
    places, before = bodies.positions(), bodies.velocities()
    loop.advance(1)
    speeds = 0.5 * (before + bodies.velocities())
    impulses = []
    for contact, name, side in zip(loop.problem.contacts, NAMES, SIDES, strict=False):
        rigid = name in plate.rigid
        # The multiplier of a step acts half a step before and after its instant.
        impulses.append(
            _impulse(contact, rigid, side) - 0.5 * loop.dt * _force(contact, rigid, side)
        )
    loop.advance(stride - 1)
    return np.array(
        [
            *(places[0], speeds[0], impulses[0]),
            *(places[2], speeds[2]),
            *(places[1], speeds[1], impulses[1]),
        ]
    )


def _result(
    loop: Loop,
    plate: PlateModel,
    scene: Scene,
    bodies: _Bodies,
    course: Course,
) -> SolidRun:
    problem = loop.problem
    energies = loop.energies()
    work = sum(contact.work for contact in problem.contacts)
    speeds = bodies.velocities()
    momenta = loop.momenta()[:, 2]
    of_body = [
        momenta[plate.elastic[name]]
        if name in plate.elastic
        else problem.rigids[plate.rigid[name]].mass * speeds[row]
        for row, name in enumerate(NAMES)
    ]
    initial = -FRACTION * scene.outer.mass * scene.speed
    total = sum(of_body) + momenta[plate.elastic[PLATE]]
    impulses = [
        FRACTION * _impulse(contact, name in plate.rigid, side)
        for contact, name, side in zip(problem.contacts, NAMES, SIDES, strict=False)
    ]
    # Three independent balances: all bodies against the support, each sphere against its contact.
    misses = [
        total - initial - problem.state.reaction[2],
        of_body[0] - initial - impulses[0],
        of_body[1] + impulses[1],
    ]
    initial_energy = 0.5 * FRACTION * scene.outer.mass * scene.speed**2
    records = tuple(
        _record(loop, plate, number, course.rows[:, column], course.interval)
        for number, column in enumerate((2, 7))
    )
    return SolidRun(
        times=course.times,
        rows=course.rows,
        contacts=(records[0], records[1]),
        in_contact_at_end=any(any(contact.force) for contact in problem.contacts),
        time_step=loop.dt,
        critical_time_step=course.critical_time_step,
        steps=problem.state.step,
        loop_seconds=course.loop_seconds,
        outer_velocity=float(speeds[0]),
        inner_velocity=float(speeds[1]),
        initial_energy=initial_energy / FRACTION,
        energy_residual=abs(energies.total - initial_energy - work) / initial_energy,
        contact_loss=-work / initial_energy,
        momentum_residual=max(abs(miss) for miss in misses) / abs(initial),
        support_impulse=problem.state.reaction[2] / FRACTION,
        sweeps_per_step=problem.state.sweeps / max(1, problem.state.step),
        unconverged=problem.state.unconverged,
    )


def _record(
    loop: Loop, plate: PlateModel, number: int, impulse: Floats, interval: float
) -> ContactRecord:
    contact = loop.problem.contacts[number]
    definition = loop.model.contacts[number]
    points = loop.model.elastic[definition.body].mesh.points[definition.nodes]
    radii = np.hypot(points[:, 0], points[:, 1])
    dt = loop.dt
    intervals = tuple(
        (max(0.0, contact.first_step[k] - 0.5) * dt, (contact.last_step[k] + 0.5) * dt)
        for k in range(min(contact.intervals, kernel.MAX_INTERVALS))
    )
    return ContactRecord(
        count=int(contact.intervals),
        end=intervals[-1][1] if intervals else None,
        intervals=intervals,
        force_peak=peak_force(impulse, PEAK_WINDOW_SAMPLES, interval),
        impulse=_impulse(contact, definition.name in plate.rigid, SIDES[number]),
        work=contact.work / FRACTION,
        outermost_radius=float(radii[contact.outermost]) if contact.outermost >= 0 else 0.0,
    )
