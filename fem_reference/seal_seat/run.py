"""A run of the seal seat: sampling, ledger."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SolverError
from ..common.hertz import hertz_stiffness
from ..explicit.energies import Energies, energies_of
from ..explicit.levels import MOST_LEVELS
from ..explicit.loop import Loop
from ..explicit.records import ContactRecord, intervals, peak_force
from ..explicit.spectrum import critical_time_step
from ..explicit.supervision import Course, Plan, supervise
from ..impact.run import ImpactRun, Losses
from .ending import seat_ending
from .model import FRACTION, LEFT, RIGHT, SEAT, SeatModel
from .motion import pair_again, sphere_motion
from .scene import SeatScene

PEAK_WINDOW_SAMPLES = 2
LONGEST_RUN = 100.0
"""Over the estimated duration of the actuator's contact."""

COLUMNS = (
    *("sphere_displacement_x", "sphere_displacement_z"),
    *("sphere_velocity_x", "sphere_velocity_z"),
    *("sphere_impulse_x", "sphere_impulse_z"),
    *("actuator_displacement", "actuator_velocity", "actuator_impulse"),
)
"""Of the raw samples: m, m/s and N s on the whole bodies; the actuator's impulse on the seat."""


@dataclass(frozen=True, kw_only=True)
class SeatRun(ImpactRun):
    """A run, its rows (m, 9) `COLUMNS`, its contacts those of sphere (both flanks) and actuator."""

    sphere_velocity: tuple[float, float]
    """Along x and z at the end, m/s."""
    actuator_velocity: float
    sphere_spin: float | None
    """About y at the end, rad/s, positive from z to x; none of an elastic sphere."""
    flank_impulses: tuple[float, float]
    """Normal impulse on the left and on the right flank, N s."""
    unconverged: int
    """Steps whose contact solver did not converge."""


def contact_duration(scene: SeatScene) -> float:
    """Duration of the actuator's contact if the seat were a heavy half-space (Hertz), s."""
    actuator = scene.actuator
    k = hertz_stiffness(scene.seat.material.plane_strain_modulus, actuator.tip_radius)
    k *= len(actuator.tip_positions)
    approach = (5.0 * actuator.mass * actuator.speed**2 / (4.0 * k)) ** 0.4
    return float(2.943275184 * approach / actuator.speed)


def integrate(loop: Loop, seat: SeatModel, scene: SeatScene, **options: Any) -> SeatRun:
    """Step from the first touch to ``scene.end_time``, or until no further contact is possible.

    ``most_levels`` is that of sub-cycling; 1: every element acts at every step. A run with a given
    end, which may cut a contact, has one level: only then can its energy be read. Further options
    are those of `supervise`.

    Raises:
        SolverError: time step above the critical one, divergence, no end found, or a contact that
            left the zone of candidates.
    """
    most_levels = options.pop("most_levels", MOST_LEVELS)
    plan = Plan(
        duration=contact_duration(scene),
        longest=LONGEST_RUN,
        window_samples=PEAK_WINDOW_SAMPLES,
        end_time=scene.end_time,
        initial_energy=FRACTION * scene.initial_energy,
        most_levels=1 if scene.end_time is not None else most_levels,
    )

    def sample(samples: int, stride: int) -> Floats:
        return np.array([_sample(loop, seat, scene, stride) for _ in range(samples)])

    course = supervise(
        loop,
        plan,
        sample,
        lambda: seat_ending(loop, seat, scene),
        lambda: critical_time_step(loop),
        **options,
    )
    _require_inside(loop, seat)
    rows = np.vstack([course.rows, sample(1, loop.meeting)])
    return _result(loop, seat, scene, course, rows)


def _sample(loop: Loop, seat: SeatModel, scene: SeatScene, stride: int) -> Floats:
    """Advance by ``stride`` steps; the row of the first step, see `COLUMNS`."""
    pair_again(loop, seat, scene)
    actuator = loop.problem.rigids[seat.actuator]
    place, speed = sphere_motion(loop, seat)
    places = np.array([place[0], place[2], actuator.u[2]])
    before = np.array([speed[0], speed[2], actuator.v[2]])
    loop.advance(1)
    _, speed = sphere_motion(loop, seat)
    speeds = 0.5 * (before + np.array([speed[0], speed[2], actuator.v[2]]))
    # The multiplier of a step acts half a step before and after its instant.
    half = 0.5 * loop.dt
    flanks, tips = (
        sum(
            (
                np.array(loop.problem.contacts[k].impulse)
                - half * np.array(loop.problem.contacts[k].force)
                for k in which
            ),
            start=np.zeros(3),
        )
        / FRACTION
        for which in ((LEFT, RIGHT), seat.tips)
    )
    loop.advance(stride - 1)
    # What the contacts do to the seat, the sphere gets with the opposite sign.
    return np.array(
        [*places[:2], *speeds[:2], -flanks[0], -flanks[2], places[2], speeds[2], tips[2]]
    )


def _outermost(loop: Loop, seat: SeatModel, number: int) -> float:
    """Largest distance at which a contact carried force, from the ring or from under the tip, m."""
    node = loop.problem.contacts[number].record.outermost
    return float(seat.patches[number].distances[node]) if node >= 0 else 0.0


def _require_inside(loop: Loop, seat: SeatModel) -> None:
    for number, (patch, definition) in enumerate(
        zip(seat.patches, seat.model.contacts, strict=True)
    ):
        distance = _outermost(loop, seat, number)
        if distance > 0.95 * patch.reach:
            raise SolverError(
                f"contact of the {definition.name} reached {distance:.3g} m, the end of the nodes "
                f"that are looked at ({patch.reach:.3g} m)"
            )


def _intervals(loop: Loop, numbers: tuple[int, ...]) -> tuple[tuple[float, float], ...]:
    """Contacts of a body that touches at several places: their union, s."""
    records = [loop.problem.contacts[n].record for n in numbers]
    spans = sorted(span for record in records for span in intervals(record, loop.dt))
    merged: list[tuple[float, float]] = []
    chatter = loop.dt * loop.problem.contacts[0].record.split
    for start, end in spans:
        if merged and start <= merged[-1][1] + chatter:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return tuple(merged)


def _contact(
    loop: Loop, seat: SeatModel, numbers: tuple[int, ...], impulse: Floats, interval: float
) -> ContactRecord:
    """Of a body that touches at several places, with the impulse on it at the samples (N s)."""
    spans = _intervals(loop, numbers)
    records = [loop.problem.contacts[number].record for number in numbers]
    return ContactRecord(
        count=len(spans),
        end=spans[-1][1] if spans else None,
        intervals=spans,
        force_peak=peak_force(impulse, PEAK_WINDOW_SAMPLES, interval),
        impulse=sum(record.impulse for record in records) / FRACTION,
        outermost_radius=max(_outermost(loop, seat, number) for number in numbers),
    )


def _losses(
    loop: Loop, scene: SeatScene, rubbed: tuple[float, float], relaxed: float
) -> Losses | None:
    """Of the whole bodies, from the gain by friction and the loss to relaxation of the half, J."""
    if scene.friction == 0.0 and loop.ledger is None:
        return None
    contacts = tuple(-gained / FRACTION for gained in rubbed) if scene.friction > 0.0 else ()
    bodies = None if loop.ledger is None else (0.0, relaxed / FRACTION, 0.0)
    return Losses(contacts=contacts, bodies=bodies)


def momentum_misses(loop: Loop, seat: SeatModel, scene: SeatScene) -> list[float]:
    """Momentum (N s, part modelled) that no impulse accounts for, of three independent balances.

    All bodies against supports and guides along x and z; sphere and actuator against contacts.
    """
    problem = loop.problem
    actuator = problem.rigids[seat.actuator]
    start = FRACTION * scene.actuator.mass * scene.actuator.speed
    momenta = loop.momenta()[SEAT]
    _, speed = sphere_motion(loop, seat)
    misses = []
    for axis in (0, 2):
        of_actuator = actuator.mass * actuator.v[axis]
        of_sphere = FRACTION * scene.sphere_mass * speed[axis]
        total = momenta[axis] + of_sphere + of_actuator - (start if axis == 2 else 0.0)
        misses.append(total - problem.state.reaction[axis])
        flanks = sum(problem.contacts[k].impulse[axis] for k in (LEFT, RIGHT))
        misses.append(of_sphere + flanks)
    tips = sum(problem.contacts[k].impulse[2] for k in seat.tips)
    misses.append(actuator.mass * actuator.v[2] - start + tips)
    return misses


def _result(loop: Loop, seat: SeatModel, scene: SeatScene, course: Course, rows: Floats) -> SeatRun:
    problem = loop.problem
    energies: Energies = energies_of(loop)
    relaxed = sum(energies.lost)
    work = sum(record.work for record in problem.records())
    tips, flanks = (
        sum(problem.contacts[k].rubbed for k in which) for which in (seat.tips, (LEFT, RIGHT))
    )
    _, speed = sphere_motion(loop, seat)
    initial = FRACTION * scene.initial_energy
    momentum = FRACTION * scene.actuator.mass * scene.actuator.speed
    left, right = (problem.contacts[k].record.impulse / FRACTION for k in (LEFT, RIGHT))
    return SeatRun(
        times=course.times,
        rows=rows,
        contacts=(
            _contact(loop, seat, (LEFT, RIGHT), rows[:, 4:6], course.interval),
            _contact(loop, seat, tuple(seat.tips), rows[:, 8], course.interval),
        ),
        in_contact_at_end=loop.is_in_contact,
        time_step=loop.dt,
        critical_time_step=course.critical_time_step,
        steps=problem.state.step,
        loop_seconds=course.loop_seconds,
        processor_seconds=course.processor_seconds,
        sphere_velocity=(float(speed[0]), float(speed[2])),
        actuator_velocity=problem.rigids[seat.actuator].v[2],
        sphere_spin=problem.rigids[0].spin[1] if seat.sphere_facets is None else None,
        flank_impulses=(left, right),
        initial_energy=scene.initial_energy,
        energy_residual=abs(energies.total + relaxed - initial - work - (tips + flanks)) / initial,
        contact_loss=-work / initial,
        momentum_residual=max(abs(m) for m in momentum_misses(loop, seat, scene)) / momentum,
        support_impulse=problem.state.reaction[2] / FRACTION,
        losses=_losses(loop, scene, (tips, flanks), relaxed),
        unconverged=problem.state.unconverged,
    )
