"""A sphere in a chamber as MuJoCo's model.

Its own friction is the convex one, in which sliding lifts: at a slip of twice the speed of approach
and a coefficient of 0.3 a restitution of 0.8 becomes 0.6. So contacts are smooth to it, and
Coulomb's force is applied from the normal force of the step before.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np

from .chamber import Point, Wall

STEP = 5e-4
"""ms; with 1 us the times of touches are no better than that."""
CONTACT = 1e-2
"""Length of an undamped contact, ms: twenty steps, and no more than some um deep."""
THICKNESS = 0.02
"""Of the boxes behind the walls, mm: thin, so that none juts out of another's face."""
IMPEDANCE = 0.9999
"""The hardest that MuJoCo has."""
GIVEN_UP = 0.02
"""Of the saddle's energy: what a sphere has to lack before it is sure not to pass it."""
STOPS = 0.5 / 3.5
"""Of the force that would stop a slip within a step: what acts a step late must not overshoot."""


@dataclass(frozen=True)
class Case:
    """A sphere, its chamber and what acts on it; mm, ms, g, N."""

    walls: tuple[Wall, ...]
    radius: float
    mass: float
    gravity: Point
    """Acceleration by all that is constant, mm/ms^2."""
    spring: tuple[float, float]
    """Stiffness along z, N/mm, and z at which its force is none."""
    restitution: float
    friction: float
    step: float = STEP
    """ms"""


@dataclass(frozen=True)
class Flown:
    """What became of a flight."""

    place: Point
    """Where the sphere lies, mm."""
    time: float
    """ms"""
    first_contact: tuple[float, float, float] | None
    """Time in ms, x and z in mm."""
    rests: bool


def _box(number: int, wall: Wall) -> str:
    (x0, z0), (x1, z1) = wall
    length, angle = math.hypot(x1 - x0, z1 - z0), math.atan2(z1 - z0, x1 - x0)
    x = (x0 + x1) / 2 + THICKNESS / 2 * math.sin(angle)
    z = (z0 + z1) / 2 - THICKNESS / 2 * math.cos(angle)
    return (
        f'<geom name="w{number}" type="box" size="{length / 2!r} 5 {THICKNESS / 2!r}" '
        f'pos="{x!r} 0 {z!r}" axisangle="0 1 0 {-angle!r}"/>'
    )


def _xml(case: Case, damping: float) -> str:
    stiffness = (math.pi / CONTACT) ** 2
    inertia = 0.4 * case.mass * case.radius**2
    pairs = "".join(
        f'<pair geom1="s" geom2="w{k}" condim="1" solref="{-stiffness!r} {-damping!r}" '
        f'solimp="{IMPEDANCE} {IMPEDANCE} 1 0.5 1"/>'
        for k in range(len(case.walls))
    )
    return f"""<mujoco><compiler angle="radian" inertiafromgeom="false"/>
<option timestep="{case.step}" gravity="{case.gravity[0]!r} 0 {case.gravity[1]!r}"
 integrator="Euler" iterations="50" tolerance="1e-14"/>
<worldbody>{"".join(_box(k, wall) for k, wall in enumerate(case.walls))}
<body name="sphere"><inertial pos="0 0 0" mass="{case.mass!r}"
 diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
<joint type="slide" axis="1 0 0"/>
<joint type="slide" axis="0 0 1" stiffness="{case.spring[0]!r}" springref="{case.spring[1]!r}"/>
<joint type="hinge" axis="0 1 0"/>
<geom name="s" type="sphere" size="{case.radius!r}" contype="0" conaffinity="0"/></body>
</worldbody><contact>{pairs}</contact></mujoco>"""


@lru_cache(maxsize=4096)
def damping_of(restitution: float, step: float = STEP) -> float:
    """Damping with which a sphere that falls on a floor rebounds so, found by falls."""
    low, high = 0.0, 2 * math.pi / CONTACT
    for _ in range(40):
        middle = 0.5 * (low + high)
        if _rebound(middle, step) > restitution:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _rebound(damping: float, step: float) -> float:
    case = Case((((-5, 0), (5, 0)),), 1.5, 0.11, (0, 0), (0, 0), 0.5, 0, step)
    model = mujoco.MjModel.from_xml_string(_xml(case, damping))
    data = mujoco.MjData(model)
    # no touch at a step's very begin
    data.qpos[1], data.qvel[1] = 1.5 + 1.3e-4, -1.0
    mujoco.mj_step(model, data, int(10 * CONTACT / step))
    return float(data.qvel[1])


class Sphere:
    """A sphere that moves in a chamber."""

    def __init__(self, case: Case):
        damping = damping_of(case.restitution, case.step)
        self.case = case
        self.model = mujoco.MjModel.from_xml_string(_xml(case, damping))
        self.data = mujoco.MjData(self.model)
        self.gravity = np.array(case.gravity)

    def start(self, place: Point, velocity: Point, spin: float) -> None:
        """Place in mm, velocity in mm/ms, spin in 1/ms, counterclockwise with z up.

        Velocities are kept half a step early: MuJoCo's steps (first the velocity, with it the
        place) are the leapfrog's then, of second order and exact on a parabola.
        """
        stiffness, at = self.case.spring
        pull = (self.gravity[0], self.gravity[1] + stiffness * (at - place[1]) / self.case.mass)
        self.data.qpos[:] = [*place, 0.0]
        self.data.qvel[:] = [
            *(v - self.case.step / 2 * a for v, a in zip(velocity, pull, strict=True)),
            -spin,
        ]

    def step(self) -> None:
        """One step, with friction by the contacts of the last one."""
        data, case = self.data, self.case
        data.qfrc_applied[:] = 0.0
        for contact in data.contact if case.friction > 0 and data.ncon else ():
            if contact.efc_address < 0:
                continue
            # from the sphere into the wall; the tangent points to the right on a floor
            into = contact.frame
            along = (-into[2], into[0])
            slip = data.qvel[0] * along[0] + data.qvel[1] * along[1] - case.radius * data.qvel[2]
            pressed = case.friction * data.efc_force[contact.efc_address]
            stops = STOPS * abs(slip) * case.mass / case.step
            force = -math.copysign(min(pressed, stops), slip)
            data.qfrc_applied[0] += force * along[0]
            data.qfrc_applied[1] += force * along[1]
            data.qfrc_applied[2] -= case.radius * force
        mujoco.mj_step(self.model, data)

    def fly(self, end: float) -> Flown:
        """Until the sphere lies still, at latest ``end`` ms."""
        first = self._first_contact(end)
        still = 0
        last = self._place()
        while self.data.time < end and still < 3:
            for _ in range(2000):
                self.step()
            place, speed = self._place(), float(np.linalg.norm(self.data.qvel[:2]))
            moved = math.dist(place, last)
            still = still + 1 if moved < 5e-3 and speed < 0.01 else 0
            last = place
        return Flown(last, self.data.time, first, still >= 3)

    def _first_contact(self, end: float) -> tuple[float, float, float] | None:
        """To the first touch after the seat is left: back from where it is found, by its depth."""
        left = False
        while self.data.time < end:
            time, (x, z) = self.data.time, self._place()
            # of the way that led there, since velocities are half a step early
            vx, vz = (float(v) for v in self.data.qvel[:2])
            self.step()
            in_contact = self.data.ncon > 0
            if in_contact and left:
                # the contact is found where the step began; its normal goes into the wall
                contact = min(self.data.contact, key=lambda contact: contact.dist)
                approach = vx * contact.frame[0] + vz * contact.frame[2]
                early = float(contact.dist / approach)
                return time + early, x + early * vx, z + early * vz
            left = left or not in_contact
        return None

    def passes(
        self, saddle: Point, duration: float, end: float, shaken: Callable[[float], Point]
    ) -> bool:
        """Whether the sphere passes ``saddle`` in x while its chamber accelerates as ``shaken``.

        A sphere that just passes may take any time: given up is one that, after the ``duration``
        of the shaking in ms, has clearly too little energy, or is still before it after ``end``.
        """
        data, model = self.data, self.model
        needed = self._potential(saddle)
        sure = needed - GIVEN_UP * (needed - self._potential(self._place()))
        while data.time < end:
            # at the time of the place, in the middle between two velocities
            acceleration = shaken(data.time)
            model.opt.gravity[0] = self.gravity[0] - acceleration[0]
            model.opt.gravity[2] = self.gravity[1] - acceleration[1]
            self.step()
            if data.qpos[0] > saddle[0]:
                return True
            if data.time > duration and self._energy() < sure:
                return False
        return False

    def _potential(self, place: Point) -> float:
        """Of all that is constant and the spring, per mass, mm^2/ms^2."""
        stiffness, at = self.case.spring
        pull = float(self.gravity @ place)
        return stiffness / self.case.mass * (place[1] - at) ** 2 / 2 - pull

    def _energy(self) -> float:
        vx, vz, spin = self.data.qvel
        kinetic = float(vx**2 + vz**2 + 0.4 * (self.case.radius * spin) ** 2) / 2
        return kinetic + self._potential(self._place())

    def _place(self) -> Point:
        return float(self.data.qpos[0]), float(self.data.qpos[1])
