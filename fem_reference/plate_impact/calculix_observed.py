"""What CalculiX has printed of a plate impact, as curves and as a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..calculix.contacts import contact_record, impulses
from ..calculix.deck import MILLI
from ..calculix.printed import Printed
from ..calculix.wedge import SHARE
from ..common.arrays import Floats
from ..common.hertz import effective_modulus, hertz_contact_radius
from ..common.settings import CHATTER_FRACTION
from ..explicit.energies import Energies
from ..explicit.records import ContactRecord
from .calculix_model import BODIES, FACES
from .motion import SIDES
from .run import Run
from .scene import Scene


@dataclass(frozen=True)
class Observed:
    """The curves of a run, in SI and of the whole bodies; the first row is the start."""

    times: Floats
    displacements: Floats
    """(m, 4) mean of outer body, plate and inner body by mass, and of the plate's faces where they
    are watched, m."""
    velocities: Floats
    """(m, 4) of the same, m/s."""
    forces: Floats
    """(m, 2) compressive, of both contacts, N."""
    energies: Floats
    """(m, 3) elastic and kinetic, of the bodies, J."""

    @staticmethod
    def of(printed: Printed, scene: Scene, count: int) -> Observed:
        """The first ``count`` increments of what was printed."""

        def curves(what: str, names: tuple[str, ...]) -> Floats:
            return np.column_stack([printed.curve(what, name, count) for name in names])

        seen = tuple(f"O{name}" for name in (*BODIES, FACES))
        bodies = tuple(f"E{name}" for name in BODIES)
        kinetic, elastic = curves("kinetic", bodies), curves("internal", bodies)
        speeds = (scene.speed, 0.0, scene.inner_speed)
        masses = (scene.outer.mass, 0.0, scene.inner.mass)
        start = [0.5 * mass * speed**2 for mass, speed in zip(masses, speeds, strict=True)]
        pairs = [printed.table("force", name, count)[:, 2] for name in ("SOUTER", "SINNER")]
        forces = np.column_stack(pairs) * np.array(SIDES)
        return Observed(
            np.insert(np.array(printed.times[:count]) / MILLI, 0, 0.0),
            np.vstack([np.zeros(4), curves("displacements", seen) / MILLI]),
            np.vstack([[-scene.speed, 0.0, scene.inner_speed, 0.0], curves("velocities", seen)]),
            np.vstack([np.zeros(2), forces / SHARE]),
            np.vstack([start, (kinetic + elastic) / MILLI / SHARE]),
        )

    def until(self, count: int) -> Observed:
        """The first ``count`` rows."""
        curves = (self.displacements, self.velocities, self.forces, self.energies)
        u, v, forces, energies = (curve[:count] for curve in curves)
        return Observed(self.times[:count], u, v, forces, energies)

    @property
    def last_pressed(self) -> int:
        """Last row with a contact closed; 0: there is none."""
        pressed = np.flatnonzero(self.pressed.any(axis=1))
        return int(pressed[-1]) if pressed.size else 0

    @property
    def pressed(self) -> NDArray[np.bool_]:
        """(m, 2) whether the contacts are closed."""
        return np.asarray(self.forces > 0.0)


def _record(scene: Scene, observed: Observed, number: int, chatter: float) -> ContactRecord:
    body = (scene.outer, scene.inner)[number]
    modulus = effective_modulus(body.material, scene.plate.material)

    def radius(force: float) -> float:
        return hertz_contact_radius(force, modulus, body.tip_radius)

    return contact_record(observed.times, observed.forces[:, number], chatter, radius)


def run_of(
    scene: Scene,
    observed: Observed,
    masses: tuple[float, float, float],
    duration: float,
    seconds: float,
) -> Run:
    """The run that ``observed`` shows.

    Args:
        scene: what was solved.
        observed: its curves.
        masses: of the meshes of outer body, plate and inner body, kg.
        duration: Hertz's of the contact, s.
        seconds: that the run took.
    """
    times, speeds = observed.times, observed.velocities[-1]
    step = float(times[1] - times[0])
    chatter = CHATTER_FRACTION * duration
    outer, inner = (_record(scene, observed, number, chatter) for number in (0, 1))
    total, start = float(observed.energies[-1].sum()), scene.initial_energy
    struck, carried = scene.initial_momenta
    momenta = np.array(masses) * speeds[:3]
    support = float(momenta.sum()) - struck - carried
    misses = [
        float(momenta[0]) - struck - outer.impulse,
        float(momenta[2]) - carried + inner.impulse,
    ]
    if scene.plate.edge == "free":
        misses.append(support)
    gained, u, v = impulses(observed.forces, step), observed.displacements, observed.velocities
    rows = [u[:, 0], v[:, 0], gained[:, 0], u[:, 3], v[:, 3], u[:, 2], v[:, 2], gained[:, 1]]
    return Run(
        times=times,
        rows=np.column_stack(rows),
        contacts=(outer, inner),
        in_contact_at_end=bool(observed.pressed[-1].any()),
        time_step=step,
        critical_time_step=None,
        steps=times.size - 1,
        loop_seconds=seconds,
        processor_seconds=seconds,
        outer_velocity=float(speeds[0]),
        inner_velocity=float(speeds[2]),
        energies=Energies(tuple(observed.energies[-1].tolist()), (), (), ()),
        initial_energy=start,
        energy_residual=abs(total - start) / start,
        contact_loss=0.0,
        momentum_residual=max(abs(miss) for miss in misses) / abs(struck),
        support_impulse=support,
        losses=None,
        yielded=None,
    )
