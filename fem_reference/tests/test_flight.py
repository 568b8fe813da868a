"""The partner of the reduced flight: MuJoCo's sphere against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

pytest.importorskip("mujoco", reason="MuJoCo has an environment of its own: make setup")

from fem_reference.flight import cases, model
from fem_reference.flight.model import Case, Sphere

FLOOR = ((-50.0, 0.0), (50.0, 0.0))
DOWN = 0.35
"""mm/ms^2"""


def yard(restitution: float, friction: float) -> Case:
    """A sphere over a floor."""
    return Case((FLOOR,), 1.5, 0.11, (0.0, -DOWN), (0.0, 0.0), restitution, friction)


def test_a_throw_has_its_contact_where_its_parabola_has() -> None:
    sphere = Sphere(yard(0.5, 0.0))
    sphere.start((0.0, 2.5), (0.7, 0.9), 0.0)
    contact = sphere.fly(40.0).first_contact
    assert contact is not None
    # 1 mm above the floor
    time = (0.9 + math.sqrt(0.9**2 + 2 * DOWN * 1.0)) / DOWN
    assert contact == pytest.approx((time, 0.7 * time, 1.5), abs=1e-8)


def test_a_spring_turns_the_sphere_after_half_a_period() -> None:
    case = replace(yard(0.5, 0.0), walls=(((-50, -9), (50, -9)),), gravity=(0.0, 0.0))
    sphere = Sphere(replace(case, spring=(0.02, 0.0)))
    sphere.start((0.0, 3.0), (0.0, 0.0), 0.0)
    half = math.pi * math.sqrt(0.11 / 0.02)
    while sphere.data.time < half:
        sphere.step()
    assert float(sphere.data.qpos[1]) == pytest.approx(-3.0, abs=1e-6)


@pytest.mark.parametrize("restitution", [0.3, 0.7])
@pytest.mark.parametrize("friction", [0.05, 0.5])
def test_a_contact_has_newton_s_and_coulomb_s_impulses(restitution: float, friction: float) -> None:
    case = replace(yard(restitution, friction), gravity=(0.0, 0.0))
    rebounds = []
    for part in (0.05, 0.26, 0.5, 0.75, 0.95):
        sphere = Sphere(case)
        sphere.start((0.0, 1.5 + (5 + part) * case.step), (0.8, -1.0), 0.0)
        while sphere.data.time < 0.1:
            sphere.step()
        vx, vz, turn = (float(v) for v in sphere.data.qvel)
        # at most what stops the sliding: then the sphere rolls
        dragged = min(friction * (1 + vz), 0.8 / 3.5)
        assert vx == pytest.approx(0.8 - dragged, abs=5e-3)
        assert turn * case.radius == pytest.approx(2.5 * dragged, abs=1e-2)
        rebounds.append(vz)
    # a contact is twenty steps long: what part of a step it begins in is worth so much
    assert rebounds[1] == pytest.approx(restitution, abs=1e-6)
    assert max(abs(found - restitution) for found in rebounds) < 0.04


def test_the_seats_hold_the_sphere_and_the_saddle_lies_between() -> None:
    flight = {**cases.draw(0), "seat": {}, "force": 0.037, "stiffness": 0.0}
    case, seat = cases.case_of(flight)
    for place in seat.seats():
        gaps = [_gap(wall, place) - case.radius for wall in case.walls]
        assert min(gaps) == pytest.approx(0.0, abs=1e-12)
        assert sorted(gaps)[1] == pytest.approx(0.0, abs=1e-12), "two flanks carry it"
    saddle = seat.saddle()
    assert min(_gap(wall, saddle) for wall in case.walls) == pytest.approx(case.radius, abs=1e-12)
    assert seat.seats()[0][0] < saddle[0] < 0 and saddle[1] > seat.seats()[0][1]


def _gap(
    wall: tuple[tuple[float, float], tuple[float, float]], place: tuple[float, float]
) -> float:
    (x0, z0), (x1, z1) = wall
    length2 = (x1 - x0) ** 2 + (z1 - z0) ** 2
    share = ((place[0] - x0) * (x1 - x0) + (place[1] - z0) * (z1 - z0)) / length2
    share = min(1.0, max(0.0, share))
    return math.dist(place, (x0 + share * (x1 - x0), z0 + share * (z1 - z0)))


def test_a_sphere_passes_the_saddle_with_its_energy_only() -> None:
    flight = {**cases.draw(0), "seat": {}, "force": 0.037, "stiffness": 0.0, "friction": 0.0}
    case, seat = cases.case_of(flight)
    (x, z), saddle = seat.seats()[0], seat.saddle()
    least = math.sqrt(2 * -case.gravity[1] * (saddle[1] - z))
    # along the flank, which rises by as much as the contact's normal leans
    slope = math.pi / 2 - seat.aperture_angle / 2 - seat.tilt

    def passes(speed: float) -> bool:
        sphere = Sphere(case)
        sphere.start((x, z), (speed * math.cos(slope), speed * math.sin(slope)), 0.0)
        return sphere.passes(saddle, 0.0, 60.0, lambda _: (0.0, 0.0))

    assert not passes(0.999 * least)
    assert passes(1.002 * least)


def test_damping_gives_the_restitution() -> None:
    for restitution in (0.2, 0.5, 0.85):
        found = model.damping_of(restitution)
        assert model._rebound(found, model.STEP) == pytest.approx(restitution, abs=1e-6)
