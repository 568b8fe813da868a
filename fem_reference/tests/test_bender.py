"""Benders: the beam against closed forms, its release and strike, and impacts with it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy.integrate
import scipy.optimize

from fem_reference.axisymmetric.elasticity import beam_body
from fem_reference.common.beam import DEFLECTION, Beam
from fem_reference.common.errors import SceneError
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document, integrate, make_system

LENGTH, STIFFNESS, LINE_MASS, TIP = 13.7e-3, 2.14e-3, 0.0188, 128e-6
"""About the beam of section 4.3 of the paper."""


def beam(elements: int = 192, tip_mass: float = TIP) -> Beam:
    return Beam(LENGTH, STIFFNESS, LINE_MASS, tip_mass, elements)


def frequencies(mass_ratio: float, count: int) -> list[float]:
    """Of the cantilever with a mass at its tip (Blevins 1979, table 8-8), angular, rad/s."""

    def characteristic(x: float) -> float:
        bounded = math.cos(x) * math.tanh(x) - math.sin(x)
        return 1.0 / math.cosh(x) + math.cos(x) + mass_ratio * x * bounded

    roots = [
        scipy.optimize.brentq(characteristic, max(1e-9, k * math.pi), (k + 1) * math.pi)
        for k in range(count)
    ]
    unit = math.sqrt(STIFFNESS / LINE_MASS) / LENGTH**2
    return [root**2 * unit for root in roots]


@pytest.mark.parametrize("tip_mass", [1e-12, TIP, 20e-3])
def test_frequencies_of_the_cantilever(tip_mass: float) -> None:
    exact = np.array(frequencies(tip_mass / (LINE_MASS * LENGTH), 8))
    errors = [np.abs(beam(n, tip_mass).modes[0][:8] / exact - 1.0) for n in (48, 96, 192)]
    assert errors[-1].max() < 5e-4
    assert errors[-1][0] < 2e-5
    # Lumped inertia: of second order.
    assert errors[0][4] / errors[1][4] == pytest.approx(4.0, rel=0.05)


def test_elements_are_bent_as_the_beam_itself() -> None:
    made = beam(12)
    found = beam_body(made).stiffness.toarray()[2:, 2:] @ made.flexibility
    np.testing.assert_allclose(found, np.eye(24), atol=1e-8)


def test_bent_beam_is_a_parabola() -> None:
    """Under a uniform moment M the deflection is M x^2 / (2 E I), the energy M^2 L / (2 E I)."""
    made = beam(24)
    x = np.linspace(0.0, LENGTH, 25)[1:]
    np.testing.assert_allclose(made.bent[DEFLECTION::2], x**2 / (2.0 * STIFFNESS), rtol=1e-7)
    strike = made.strike(0.3)
    energy = strike.moment**2 * LENGTH / (2.0 * STIFFNESS)
    assert strike.strain_energy == pytest.approx(energy, rel=1e-7)
    # Released at once, it keeps all of it.
    assert strike.energy == pytest.approx(energy, rel=1e-7)


def test_heavy_tip_swings_as_a_mass_on_a_spring() -> None:
    """Massless beam, k = 3 E I / L^3: a quarter of a period, speed omega times deflection."""
    strike = Beam(LENGTH, STIFFNESS, 1e-9, 1e-3, 16).strike(0.5)
    omega = math.sqrt(3.0 * STIFFNESS / LENGTH**3 / 1e-3)
    assert strike.time == pytest.approx(0.5 * math.pi / omega, rel=1e-4)
    deflection = strike.moment * LENGTH**2 / (2.0 * STIFFNESS)
    assert pytest.approx(omega * deflection, rel=1e-4) == 0.5
    assert strike.momentum == pytest.approx(-1e-3 * 0.5, rel=1e-3)


def test_discharging_moment_moves_the_beam_as_a_runge_kutta_method_does() -> None:
    made, decay = beam(4), 2e-4
    root = np.repeat(np.sqrt(made.mass[1:]), 2)
    scaled = beam_body(made).stiffness.toarray()[2:, 2:] / np.outer(root, root)
    start = made.bent * root
    found = scipy.integrate.solve_ivp(
        lambda t, y: [*y[8:], *(scaled @ (start * math.exp(-t / decay) - y[:8]))],
        (0.0, 3e-4),
        [*start, *np.zeros(8)],
        method="DOP853",
        rtol=1e-10,
        atol=1e-14,
    )
    places, rates = made.swing(decay, 3e-4)
    shapes = made.modes[1] * root[:, None]
    np.testing.assert_allclose(shapes @ places, found.y[:8, -1], atol=1e-7 * np.abs(start).max())
    speeds = found.y[8:, -1]
    np.testing.assert_allclose(shapes @ rates, speeds, atol=1e-6 * np.abs(speeds).max())


def bender(**changes: Any) -> dict[str, Any]:
    """A bender of a scene."""
    return {
        "kind": "bender",
        "length": LENGTH,
        "bending_stiffness": STIFFNESS,
        "line_mass": LINE_MASS,
        "tip_mass": TIP,
        "tip_radius": 4e-3,
        "discharge_time": 5e-5,
        "material": STEEL,
        "speed": 0.3,
        **changes,
    }


def impact(**changes: Any) -> Scene:
    bodies = {
        "plate__radius": 4e-3,
        "plate__thickness": 4e-4,
        "inner__radius": 2e-3,
        "outer": bender(),
        "run__end_time": 4e-5,
    }
    return parse_scene(document(**{**bodies, **changes}))


def test_a_bender_without_its_required_keys_is_refused() -> None:
    assert impact().outer.tip_radius == 4e-3
    for change, field in (
        ({"run__end_time": None}, "run.end_time"),
        ({"reference__geometry": "solid"}, "reference.geometry"),
        ({"outer": bender(discharge_time=1e-3)}, "outer.discharge_time"),
        ({"outer": bender(tip_mass=None)}, "outer.tip_mass"),
        ({"inner": bender()}, "inner.kind"),
    ):
        with pytest.raises(SceneError, match=field):
            impact(**change)


@pytest.mark.parametrize("most_levels", [1, 4])
def test_balance_of_an_impact(most_levels: int) -> None:
    """Beam, plate and sphere: energy of all, momentum of all with both supports."""
    scene = impact()
    system, duration = make_system(scene)
    run = integrate(system, scene, duration, end_time=scene.end_time, most_levels=most_levels)
    assert run.contacts[0].count >= 1
    assert run.contacts[1].count == 1
    assert run.inner_velocity < -0.1
    assert run.energy_residual < (1e-7 if most_levels == 1 else 1e-5)
    assert run.momentum_residual < 1e-8
    assert run.rows[0, 1] == pytest.approx(-0.3, rel=1e-6)
    # The tip's displacement is the integral of its velocity.
    mean = 0.5 * (run.rows[1:, 1] + run.rows[:-1, 1])
    path = np.concatenate([[0.0], np.cumsum(mean * np.diff(run.times))])
    np.testing.assert_allclose(run.rows[:, 0], path, atol=1e-3 * np.abs(path).max())


def test_beam_that_meets_nothing_swings_on() -> None:
    """With the plate out of the way: the tip follows the beam's modes."""
    scene = impact(plate__edge="free", plate__thickness=2e-4, plate__radius=3e-3)
    system, duration = make_system(scene)
    for contact in system.matched:
        contact.gaps[:] = 1.0
    run = integrate(system, scene, duration, end_time=4e-5, most_levels=1)
    made, strike = scene.outer.beam, scene.outer.strike  # type: ignore[union-attr]
    frequencies_, shapes = made.modes
    weights = shapes * np.repeat(made.mass[1:], 2)[:, None]
    place, rate = (
        weights.T @ strike.displacement[1:].ravel(),
        weights.T @ strike.velocity[1:].ravel(),
    )
    phase = np.outer(run.times, frequencies_)
    tip = shapes[-2 + DEFLECTION]
    exact = np.cos(phase) @ (tip * place) + np.sin(phase) @ (tip * rate / frequencies_)
    np.testing.assert_allclose(run.rows[:, 0], exact, atol=1e-4 * np.abs(exact).max())
