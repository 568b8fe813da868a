"""What CalculiX has printed of an impact on a body, as curves and as a run."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..calculix.contacts import contact_record, impulses
from ..calculix.deck import MILLI
from ..calculix.printed import Printed
from ..common.arrays import Floats
from ..common.settings import CHATTER_FRACTION
from ..explicit.records import ContactRecord
from ..impact.ending import Approach
from .calculix_model import BODY, MOTION, Model, scene_speed
from .ending import Softness
from .estimate import contact_radius
from .model import Side
from .run import Run
from .scene import Scene


@dataclass(frozen=True)
class Observed:
    """The curves of a run, in SI; the first row is the start."""

    times: Floats
    displacements: Floats
    """(m, sides) means of the spheres along their directions, m."""
    velocities: Floats
    """(m, sides) of the same, m/s."""
    motions: Floats
    """(m, motions) rigid motions of what is struck, m sqrt(kg)."""
    rates: Floats
    """(m, motions) of the same, m/s sqrt(kg)."""
    forces: Floats
    """(m, sides, 3) on the spheres, N."""
    energies: Floats
    """(m, 1 + sides) elastic and kinetic, of the bodies, J."""

    @staticmethod
    def of(printed: Printed, scene: Scene, made: Model, count: int) -> Observed:
        """The first ``count`` increments of what was printed."""
        sides = made.made.sides
        names = [side.name.upper() for side in sides]
        seen = [f"O{name}" for name in names]
        rigid = [f"O{MOTION}{k}" for k in range(made.motions)]

        def curves(what: str, of: list[str], start: Floats, unit: float) -> Floats:
            rows = [printed.curve(what, name, count) for name in of]
            return np.vstack([start, np.column_stack(rows) / unit])

        speeds = np.array([scene_speed(scene, side) for side in sides])
        none, still = np.zeros(len(sides)), np.zeros(made.motions)
        bodies = [f"E{name}" for name in (BODY, *names)]
        energies = sum(
            curves(what, bodies, np.zeros(len(bodies)), MILLI) for what in ("kinetic", "internal")
        )
        assert isinstance(energies, np.ndarray)
        energies[0, 1:] = 0.5 * np.array(made.masses[1:]) * speeds**2
        forces = np.stack([printed.table("force", f"S{name}", count) for name in names], axis=1)
        return Observed(
            np.insert(np.array(printed.times[:count]) / MILLI, 0, 0.0),
            curves("displacements", seen, none, MILLI),
            curves("velocities", seen, speeds, 1.0),
            curves("displacements", rigid, still, MILLI),
            curves("velocities", rigid, still, 1.0),
            np.concatenate([np.zeros((1, len(sides), 3)), forces]),
            energies,
        )

    def until(self, count: int) -> Observed:
        """The first ``count`` rows."""
        return Observed(*(getattr(self, each.name)[:count] for each in fields(self)))

    def compressive(self, made: Model) -> Floats:
        """(m, sides) forces of the contacts along their normals, N."""
        return np.asarray(np.einsum("msc,sc->ms", self.forces, _normals(made)))


def _normals(made: Model) -> Floats:
    return np.stack([side.strike.normal for side in made.made.sides])


def first_over(seen: Observed, made: Model, soft: list[list[Softness]], start: int) -> int:
    """First row from ``start`` on after which no further contact is possible; -1: there is none."""
    pressed = (seen.compressive(made) > 0.0).any(axis=1)
    for row in np.flatnonzero(~pressed[start:]) + start:
        if all(each.is_over() for each in _approaches(seen, made, soft, int(row))):
            return int(row)
    return -1


def _approaches(
    seen: Observed, made: Model, soft: list[list[Softness]], row: int
) -> list[Approach]:
    """Of all sides at an instant."""
    rates, energies = seen.rates[row], seen.energies[row]
    struck = energies[0] - (0.5 * float(rates @ rates) if made.is_free else 0.0)
    found = []
    for k, (side, moved) in enumerate(zip(made.made.sides, made.moved, strict=True)):
        outwards = float(side.along @ side.strike.normal)
        speed = float(seen.velocities[row, k])
        vibrating = energies[k + 1] - 0.5 * made.masses[k + 1] * speed**2
        found.append(
            Approach(
                side.gap
                + outwards * float(seen.displacements[row, k])
                - float(moved @ seen.motions[row]),
                outwards * speed - float(moved @ rates),
                tuple(
                    (energy, each.flexibility)
                    for energy, each in zip((struck, vibrating), soft[k], strict=True)
                ),
            )
        )
    return found


def run_of(scene: Scene, seen: Observed, made: Model, duration: float, seconds: float) -> Run:
    """The run that ``seen`` shows.

    Args:
        scene: what was solved.
        seen: its curves.
        made: the model.
        duration: Hertz's of the contact, s.
        seconds: that the run took.
    """
    sides, step = made.made.sides, float(seen.times[1] - seen.times[0])
    forces = seen.compressive(made)
    gained = impulses(forces, step)
    vectors = np.stack([impulses(seen.forces[:, k], step)[-1] for k in range(len(sides))])
    speeds = seen.velocities[-1]
    # translations come first; their modal mass is 1 kg
    momentum = np.sqrt(made.masses[0]) * seen.rates[-1, :3]
    support = momentum + vectors.sum(axis=0)
    misses = [*(np.abs(support) if made.is_free else ())]
    for k, side in enumerate(sides):
        change = made.masses[k + 1] * (float(speeds[k]) - scene_speed(scene, side))
        misses.append(abs(change - float(side.along @ vectors[k])))
    struck = momentum / made.masses[0] if made.is_free else np.zeros(3)
    total, start = float(seen.energies[-1].sum()), scene.initial_energy
    rows = [
        column
        for k in range(len(sides))
        for column in (seen.displacements[:, k], seen.velocities[:, k], gained[:, k])
    ]
    return Run(
        times=seen.times,
        rows=np.column_stack(rows),
        contacts=tuple(
            _record(scene, seen.times, forces[:, k], side, CHATTER_FRACTION * duration)
            for k, side in enumerate(sides)
        ),
        in_contact_at_end=bool((forces[-1] > 0.0).any()),
        time_step=step,
        steps=seen.times.size - 1,
        loop_seconds=seconds,
        processor_seconds=seconds,
        outer_velocity=float(speeds[0]),
        inner_velocity=float(speeds[1]) if speeds.size > 1 else None,
        struck_velocities=tuple(float(side.along @ struck) for side in sides),
        initial_energy=start,
        energy_residual=abs(total - start) / start,
        momentum_residual=max(misses) / (scene.outer.mass * scene.closing_speed),
        support_impulse=float(sides[0].strike.normal @ support),
    )


def _record(
    scene: Scene, times: Floats, forces: Floats, side: Side, chatter: float
) -> ContactRecord:
    def radius(force: float) -> float:
        return contact_radius(scene, side.name, force, side.strike.curvature)

    return contact_record(times, forces, chatter, radius)
