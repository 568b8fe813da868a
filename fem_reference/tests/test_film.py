"""Fluid behind the plate: squeeze film against closed forms, drag, added mass, ledgers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from fem_reference.axisymmetric.film import effective_viscosity
from fem_reference.axisymmetric.modal import first_frequency
from fem_reference.axisymmetric.system import INNER, PLATE, AxisymmetricSystem, critical_time_step
from fem_reference.common.errors import SceneError
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.explicit.loop import SerialLoop
from fem_reference.plate_impact.axisymmetric_motion import AxisymmetricMotion
from fem_reference.plate_impact.result import of_run
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document, integrate, make_loop, make_system

TITANIUM = {"name": "titanium", "youngs_modulus": 115e9, "poisson_ratio": 0.37, "density": 4430.0}
RADIUS, MU, SPEED = 1.5e-3, 1e-3, 0.1
WATER: dict[str, Any] = {
    "viscosity": MU,
    "density": 1000.0,
    "minimum_gap": 0.25e-6,
    "squeeze_film": True,
    "added_mass_frequency_ratio": 1.0,
    "plate_damping_ratio": 0.0,
    "drag_coefficient": 0.0,
}
THINNING = {"infinite_shear_viscosity": 1e-9, "relaxation_time": 1.0, "power_index": 0.6}
BODY = {
    "kind": "compact",
    "mass": 7780.0 * 4.0 / 3.0 * math.pi * RADIUS**3,
    "tip_radius": RADIUS,
    "material": STEEL,
    "gap": 0.0,
}


def valve(fluid: dict[str, Any] | None = None, **changes: Any) -> Scene:
    """The valve of section 4.2.2: a titanium plate between steel spheres of 1.5 mm."""
    plate = {"radius": 5.5e-3, "thickness": 0.3e-3, "edge": "clamped", "damping_ratio": 0.0}
    scene = document(
        **{
            "plate": {**plate, "material": TITANIUM},
            "outer__radius": RADIUS,
            "outer__speed": 0.5,
            "inner__radius": RADIUS,
            "fluid": {**WATER, **(fluid or {})},
            **changes,
        }
    )
    return parse_scene(scene)


def approaching(system: AxisymmetricSystem) -> AxisymmetricSystem:
    """The bodies at rest but the inner one, which approaches the plate."""
    velocity = np.zeros_like(system.velocity)
    velocity[system.first[INNER] :, 1] = SPEED
    return replace(system, velocity=velocity)


def force(scene: Scene, factor: float = 1.0, steps: int = 1) -> tuple[float, SerialLoop]:
    """Of the film on bodies that move as if rigid: in a step too short to stop them."""
    loop = make_loop(approaching(make_system(scene, factor)[0]), 1e-17)
    loop.advance(steps)
    assert loop.problem.film is not None
    return loop.problem.film.force, loop


def lubrication(gap: float) -> float:
    """Reynolds' equation between sphere and plate, p = 0 where the sphere is as wide as R, N."""
    edge = gap + 0.5 * RADIUS
    return 6.0 * math.pi * MU * RADIUS**2 * SPEED / gap * (1.0 - gap / edge) ** 2


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"viscosity": "1 mPa*s"}, r"fluid\.viscosity"),
        ({"squeeze_film": 1}, r"fluid\.squeeze_film"),
        ({"plate_damping_ratio": 1.0}, r"fluid\.plate_damping_ratio"),
        ({"shear_thinning": {**THINNING, "power_index": None}}, r"shear_thinning\.power_index"),
        ({"colour": "blue"}, r"fluid\.colour"),
    ],
)
def test_invalid_fluid_is_named(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(SceneError, match=field):
        valve(changes)


def test_solid_geometry_is_dry() -> None:
    with pytest.raises(SceneError, match=r"fluid.*axisymmetric"):
        valve(reference={"geometry": "solid", "elements_per_contact_radius": 3})


@pytest.mark.parametrize("inner", [{}, {"inner": {**BODY, "gap": 1e-6}}])
def test_rigid_approach_follows_reynolds_and_converges(inner: dict[str, Any]) -> None:
    scene = valve(**{"inner__gap": 1e-6, **inner})
    errors = [abs(force(scene, factor)[0] / lubrication(1e-6) - 1.0) for factor in (1.0, 2.0)]
    assert errors[0] < 0.035
    assert errors[1] < errors[0] / 3.0


def test_no_gap_resists_more_than_the_smallest() -> None:
    """dp/dr = -6 mu r v / h^3 of the least gap where there is less."""
    least = WATER["minimum_gap"]

    def moment(r: float) -> float:
        return float(
            6.0 * math.pi * MU * SPEED * r**3 / max(1e-9 + 0.5 * r**2 / RADIUS, least) ** 3
        )

    exact = quad(moment, 0.0, RADIUS, points=[math.sqrt(2.0 * RADIUS * least)], limit=200)[0]
    assert exact < 0.1 * lubrication(1e-9)
    assert force(valve(inner__gap=1e-9), 2.0)[0] == pytest.approx(exact, rel=0.03)


def test_film_brakes_as_the_logarithm_of_the_gap() -> None:
    """A body that nothing else acts on: m dv = -6 pi mu R^2 dln(1/h), over a fifth of its speed."""
    scene = valve({"viscosity": 0.04}, inner={**BODY, "gap": 4e-6})
    system, _ = make_system(scene)
    time_step = 0.9 * critical_time_step(system)
    loop = make_loop(approaching(system), time_step)
    loop.advance(round(3e-5 / time_step))
    body, pole = (2 * int(n) + 1 for n in (system.first[INNER], system.matched[1].opposite[0]))
    gap = 4e-6 - loop.u[body] + loop.u[pole]
    lost = 6.0 * math.pi * 0.04 * RADIUS**2 / scene.inner.mass * math.log(4e-6 / gap)
    assert 0.15 < 1.0 - loop.v[body] / SPEED < 0.5
    assert SPEED - loop.v[body] == pytest.approx(lost, rel=0.04)


def test_no_film_is_too_stiff_for_the_step() -> None:
    """A film that stops what it feels within 1e-6 steps only takes energy."""
    scene = valve({"viscosity": 1e5}, inner__gap=0.3e-6)
    loop = make_loop(approaching(make_system(scene)[0]), 1e-10)
    film = loop.problem.film
    assert film is not None
    last = start = energies_of(loop).total
    for _ in range(50):
        loop.advance(10)
        now = energies_of(loop).total
        assert now < last * (1.0 + 1e-9)
        assert now - film.work == pytest.approx(start, rel=1e-9)
        last = now
    assert last < 0.995 * start
    assert loop.problem.state.unconverged == 0


def test_viscosity_of_a_power_law_in_a_slit() -> None:
    """A power law: tau = K ((2 n + 1)/(3 n) 6 Q/h^2)^n, mu_0 at rest."""
    law = valve({"viscosity": 0.05, "shear_thinning": THINNING}).fluid
    assert law is not None
    found, n = effective_viscosity(law), 0.6
    assert found.values[0] == pytest.approx(0.05, rel=1e-5)
    for rate in (1e5, 1e7):
        wall = 0.05 * ((2.0 * n + 1.0) / (3.0 * n) * rate) ** n
        assert np.interp(rate, found.rates, found.values) == pytest.approx(wall / rate, rel=1e-3)


def test_film_of_a_power_law() -> None:
    """The fluid is squeezed out at Q = r v/2 per width, whatever resists it."""
    gap, n = 1e-6, 0.6
    thick = {"viscosity": 0.05, "shear_thinning": THINNING}

    def moment(r: float) -> float:
        h = gap + 0.5 * r**2 / RADIUS
        rate = (2.0 * n + 1.0) / (3.0 * n) * 3.0 * r * SPEED / h**2
        return float(math.pi * r**2 * 2.0 * 0.05 * rate**n / h)

    exact = quad(moment, 0.0, RADIUS, points=[1e-4], limit=200)[0]
    found = force(valve(thick, inner__gap=gap), 2.0, steps=20)[0]
    assert found == pytest.approx(exact, rel=0.01)


@pytest.fixture(scope="module")
def runs() -> dict[str, tuple[Scene, Run]]:
    """Impacts in water up to the same instant, all effects there in the last."""
    effects = {
        "viscosity": 0.01,
        "added_mass_frequency_ratio": 0.8,
        "plate_damping_ratio": 0.03,
        "drag_coefficient": 50.0,
        "shear_thinning": {**THINNING, "relaxation_time": 1e-6},
    }
    scenes = {
        "dry": valve({"squeeze_film": False}),
        "sphere": valve(),
        "compact": valve(inner=BODY),
        "all": valve(effects),
    }
    found = {}
    for name, scene in scenes.items():
        system, duration = make_system(scene)
        # balances of one level are exact; nobody looks at those of the dry run
        levels = MOST_LEVELS if name == "dry" else 1
        run = integrate(system, scene, duration, end_time=60e-6, most_levels=levels)
        found[name] = scene, run
    return found


@pytest.mark.parametrize("name", ["sphere", "compact", "all"])
def test_balances_close(runs: dict[str, tuple[Scene, Run]], name: str) -> None:
    _, run = runs[name]
    assert run.energy_residual < 1e-9
    assert run.momentum_residual < 1e-8
    assert run.losses is not None
    assert 0.01 < run.losses.squeeze_film / run.initial_energy < 0.3
    assert (run.losses.drag > 0.0) == (run.losses.plate_damping > 0.0) == (name == "all")


def test_impact_in_water_agrees_with_the_reduced_model(runs: dict[str, tuple[Scene, Run]]) -> None:
    """Model C, whose film sees bodies without dents: 0.7550, 7.570 N and 6.623 N, lost 0.250 uJ."""
    dry, wet, tip = (of_run(*runs[name]) for name in ("dry", "sphere", "compact"))
    assert wet["efficiency"] == pytest.approx(0.7550, abs=0.006)
    assert wet["outer_force_peak"] == pytest.approx(7.570, rel=0.015)
    assert wet["inner_force_peak"] == pytest.approx(6.623, rel=0.02)
    # The nearer a body is to what the model takes it for, the nearer is its film.
    assert 0.7550 < tip["efficiency"] < wet["efficiency"] < dry["efficiency"] - 0.01
    losses = runs["sphere"][1].losses
    assert losses is not None
    assert losses.squeeze_film == pytest.approx(0.205e-6, rel=0.03)


def test_levels_change_next_to_nothing(runs: dict[str, tuple[Scene, Run]]) -> None:
    scene, one = runs["sphere"]
    system, duration = make_system(scene)
    many = integrate(system, scene, duration, end_time=60e-6)
    assert many.energy_residual < 1e-5
    first, second = of_run(scene, one), of_run(scene, many)
    assert second["efficiency"] == pytest.approx(first["efficiency"], rel=1e-3)


def test_no_film_changes_no_bit() -> None:
    """A fluid with every effect off is none."""
    still = valve({"squeeze_film": False}, run={"end_time": 2e-6})
    dry = parse_scene({**still.raw, "fluid": None})
    rows = []
    for scene in (still, dry):
        system, duration = make_system(scene)
        rows.append(integrate(system, scene, duration, end_time=2e-6).rows)
    assert np.array_equal(rows[0], rows[1])


def test_drag_follows_its_square_law() -> None:
    """Of a free body: m dU/dt = -k U |U|: 1/U grows by k t / m."""
    fluid = {"squeeze_film": False, "drag_coefficient": 4e3}
    scene = valve(fluid, inner={**BODY, "gap": 1e-3})
    system = approaching(make_system(scene)[0])
    motion = AxisymmetricMotion(system)
    motion.loop.set_step(1e-9, 1)
    start = energies_of(motion.loop).total
    motion.drag_inner(scene.drag, 1e-7)
    rows = motion.sample(1000, 10)
    coefficient = 4e3 * 500.0 * math.pi * RADIUS**2
    assert scene.drag == pytest.approx(coefficient)
    velocity = motion.velocities()[1]
    assert 1.0 / velocity - 1.0 / SPEED == pytest.approx(
        coefficient * 1e-5 / scene.inner.mass, rel=0.01
    )
    assert rows[-1, 6] == pytest.approx(velocity, rel=1e-3)
    losses = motion.further.losses
    assert losses is not None
    assert start - energies_of(motion.loop).total == pytest.approx(losses.drag, rel=1e-9)
    assert motion.further.on_inner == pytest.approx(scene.inner.mass * (velocity - SPEED))


def test_added_mass_lowers_every_frequency_alike() -> None:
    frequencies = []
    for ratio in (1.0, 1.0 / 3.0):
        system, _ = make_system(valve({"added_mass_frequency_ratio": ratio}))
        frequencies.append((first_frequency(system), system.body_mass(PLATE)))
    assert frequencies[1][0] == pytest.approx(frequencies[0][0] / 3.0, rel=2e-3)
    assert frequencies[1][1] == pytest.approx(frequencies[0][1] * 9.0, rel=1e-9)
