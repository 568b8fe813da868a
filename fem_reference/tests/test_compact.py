"""Compact bodies: tips against closed forms of the half-space, impacts against Hertz and solids."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from fem_reference.axisymmetric.tip import tip_flexibility
from fem_reference.common.arrays import Floats
from fem_reference.common.bodies import Material
from fem_reference.common.errors import SceneError
from fem_reference.common.hertz import effective_modulus, hertz_stiffness, hertz_time_scale
from fem_reference.plate_impact.result import quantities
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document, integrate, make_loop, make_system, solve_once

RIGID = {"name": "rigid", "youngs_modulus": 210e13, "poisson_ratio": 0.3, "density": 7780e4}
"""Ten thousand times as stiff and heavy as steel."""
MASS = 7780.0 * 4.0 / 3.0 * math.pi * 1e-6
"""Of a steel sphere of 10 mm, kg."""


def compact(material: dict[str, Any] = STEEL, **more: float) -> dict[str, Any]:
    """A body of a scene with the mass and tip of a steel sphere of 10 mm."""
    return {"kind": "compact", "mass": MASS, "tip_radius": 0.01, "material": material, **more}


def test_scene_with_compact_bodies_is_read() -> None:
    scene = parse_scene(document(outer=compact(speed=1.0), inner=compact(gap=0.0)))
    assert scene.outer.mass == MASS
    assert scene.inner.tip_radius == 0.01
    for broken, field in (({"mass": "1 g"}, "outer.mass"), ({"radius": 0.01}, "outer.radius")):
        with pytest.raises(SceneError, match=field):
            parse_scene(document(outer={**compact(speed=1.0), **broken}))


def test_solid_geometry_has_rigid_tips_only() -> None:
    scene = document(outer=compact(speed=1.0), reference__geometry="solid")
    with pytest.raises(SceneError, match=r"outer\.kind.*reference\.rigid"):
        parse_scene(scene)
    scene["reference"]["rigid"] = "outer"
    assert parse_scene(scene).rigid == ("outer",)


def flexibility(nodes: int) -> tuple[Material, Floats, Floats]:
    """Material, radii from 0 to 1 mm, and the tip's flexibility there."""
    material = Material("steel", 210e9, 0.3, 7780.0)
    radii = np.linspace(0.0, 1e-3, nodes)
    return material, radii, tip_flexibility(material, radii)


def test_tip_is_symmetric_and_stores_energy() -> None:
    _, _, found = flexibility(40)
    np.testing.assert_allclose(found, found.T, rtol=1e-9)
    assert np.linalg.eigvalsh(found).min() > 0.0


def test_tip_under_hertz_pressure_deforms_as_the_half_space() -> None:
    """Hertz 1882: (pi p0 / (4 E' a)) (2 a^2 - r^2) under the pressure p0 sqrt(1 - (r/a)^2)."""
    errors = []
    for nodes in (11, 21, 41):
        material, radii, found = flexibility(nodes)
        a = radii[-1]
        edges = np.concatenate([[0.0], 0.5 * (radii[1:] + radii[:-1]), [a]])
        force = -np.diff((1.0 - (edges / a) ** 2) ** 1.5)
        # The mean of r^2 over a ring stands for r^2.
        square = 0.5 * (edges[1:] ** 2 + edges[:-1] ** 2)
        peak = 1.5 / (math.pi * a**2)
        exact = math.pi * peak / (4.0 * material.plane_strain_modulus * a) * (2.0 * a**2 - square)
        errors.append(float(np.abs(found @ force / exact - 1.0)[:-1].max()))
    assert errors[-1] < 0.01
    assert errors[2] < 0.6 * errors[1] < 0.36 * errors[0]


def test_tip_under_a_flat_punch_deforms_as_the_half_space() -> None:
    """A rigid punch of radius a takes the force 2 E' a per displacement (Boussinesq 1885)."""
    errors = []
    for nodes in (11, 21, 41):
        material, radii, found = flexibility(nodes)
        force = float(np.linalg.solve(found, np.ones(nodes)).sum())
        errors.append(abs(force / (2.0 * material.plane_strain_modulus * radii[-1]) - 1.0))
    assert errors[-1] < 3e-3
    assert errors[2] < 0.6 * errors[1] < 0.36 * errors[0]


def half_space_impact(elements: int, **bodies: Any) -> Scene:
    """A slow impact on a free plate."""
    return parse_scene(
        document(
            plate__edge="free",
            inner__gap=1e-3,
            run__end_time=1.2e-4,
            reference__elements_per_contact_radius=elements,
            **bodies,
        )
    )


def hertz(scene: Scene) -> tuple[float, float, float]:
    """Duration (s), peak force (N) and final velocity (m/s) of the impact on a free rigid plate."""
    effective = effective_modulus(scene.outer.material, scene.plate.material)
    stiffness = hertz_stiffness(effective, scene.outer.tip_radius)
    plate = scene.plate.surface_density * math.pi * scene.plate.radius**2
    reduced = scene.outer.mass * plate / (scene.outer.mass + plate)
    scale = hertz_time_scale(reduced, stiffness, scene.speed)
    force = 1.143263 * reduced * scene.speed / scale
    rebound = (plate - scene.outer.mass) / (plate + scene.outer.mass)
    return 2.943275 * 1.25**0.4 * scale, force, rebound * scene.speed


def test_elastic_tip_on_a_rigid_plate_hertz() -> None:
    """The tip alone yields: duration, force and rebound of Hertz 1882."""
    scene = half_space_impact(
        6,
        plate__material=RIGID,
        plate__radius=0.006,
        plate__thickness=0.003,
        outer=compact(speed=0.1),
    )
    system, duration = make_system(scene)
    run = integrate(system, scene, duration, end_time=scene.end_time, most_levels=1)
    end, force, velocity = hertz(scene)
    assert run.contacts[0].count == 1
    assert run.contacts[0].end == pytest.approx(end, rel=0.004)
    assert run.contacts[0].force_peak == pytest.approx(force, rel=0.004)
    assert run.outer_velocity == pytest.approx(velocity, rel=1e-6)
    assert run.energy_residual < 1e-9
    assert 0.0 <= run.contact_loss < 1e-7


def test_rigid_tip_on_a_thick_elastic_plate_hertz() -> None:
    """The plate alone yields; what its finite size adds is less than a percent."""
    scene = half_space_impact(
        4, plate__radius=0.02, plate__thickness=0.016, outer=compact(RIGID, speed=0.05)
    )
    system, duration = make_system(scene)
    run = integrate(system, scene, duration, end_time=scene.end_time, most_levels=1)
    end, force, velocity = hertz(scene)
    assert run.contacts[0].end == pytest.approx(end, rel=0.01)
    assert run.contacts[0].force_peak == pytest.approx(force, rel=0.01)
    assert run.outer_velocity == pytest.approx(velocity, rel=2e-3)
    assert run.energy_residual < 1e-9
    assert 0.0 <= run.contact_loss < 1e-6


def test_rigid_tips_are_those_of_the_solid_reference() -> None:
    """Two rigid steel spheres on the plate of Table 1 in three dimensions: 597 N, 496 N, 0.708."""
    scene = parse_scene(
        document(
            outer=compact(RIGID, speed=0.55),
            inner=compact(RIGID, gap=0.0),
            reference__elements_per_contact_radius=6,
        )
    )
    solution = solve_once(scene)
    found = quantities(scene, solution)
    assert found["efficiency"] == pytest.approx(0.708, abs=0.002)
    assert found["outer_force_peak"] == pytest.approx(597.0, rel=0.015)
    assert found["inner_force_peak"] == pytest.approx(496.0, rel=0.015)
    assert solution.run.momentum_residual < 1e-9
    assert solution.run.energy_residual < 1e-5
    assert 0.0 <= solution.run.contact_loss < 1e-6


YIELDS = {**STEEL, "yield_strength": 600e6, "hardening": 2.1e9}


def first_contact(outer: dict[str, Any], plate: dict[str, Any], end: float = 6e-5) -> Run:
    """The first contact of an outer body with the plate of Table 1."""
    scene = parse_scene(
        document(
            outer={**outer, "speed": 0.55},
            plate__material=plate,
            run__end_time=end,
            reference__elements_per_contact_radius=4,
        )
    )
    system, duration = make_system(scene)
    return integrate(system, scene, duration, end_time=scene.end_time, most_levels=1)


def test_compact_body_that_yields_is_the_sphere_of_its_mass_and_tip() -> None:
    sphere = first_contact({"kind": "sphere", "radius": 0.01, "material": YIELDS}, STEEL)
    body = first_contact(compact(YIELDS), STEEL)
    assert sphere.yielded is not None and body.yielded is not None
    assert body.yielded.work[0] == pytest.approx(sphere.yielded.work[0], rel=0.01)
    assert body.yielded.work[0] > 0.05 * body.initial_energy
    assert body.outer_velocity == pytest.approx(sphere.outer_velocity, abs=0.005 * 0.55)
    assert body.contacts[0].force_peak == pytest.approx(sphere.contacts[0].force_peak, rel=0.01)
    assert body.energy_residual < 1e-5
    assert body.momentum_residual < 1e-9


def test_light_compact_body_that_yields_keeps_its_mass() -> None:
    """A tenth of the sphere below its tip: the tip's density is lowered."""
    body = first_contact({**compact(YIELDS), "mass": 0.05 * MASS}, STEEL, 2.5e-5)
    assert body.initial_energy == pytest.approx(0.5 * 0.05 * MASS * 0.55**2, rel=1e-12)
    assert body.yielded is not None and body.yielded.work[0] > 0.0
    assert body.energy_residual < 1e-5
    assert body.momentum_residual < 1e-9


def test_mesh_of_a_tip_that_yields_has_the_points_that_the_summary_counts(tmp_path: Path) -> None:
    """The rigid part of the body is one node of the system and several points of the mesh."""
    scene = parse_scene(
        document(
            outer={**compact(YIELDS), "speed": 0.55},
            run__end_time=4e-5,
            reference__elements_per_contact_radius=3,
        )
    )
    solution = solve_once(scene)
    solution.write_fields(tmp_path, scene)
    report = solution.mesh_report()
    assert meshio.read(tmp_path / "mesh.vtu").points.shape[0] == report["points"] > report["nodes"]


def test_elastic_compact_body_dents_a_plate_that_yields() -> None:
    """As the sphere does, but for the waves in it."""
    sphere = first_contact({"kind": "sphere", "radius": 0.01, "material": STEEL}, YIELDS)
    body = first_contact(compact(), YIELDS)
    assert sphere.yielded is not None and body.yielded is not None
    assert body.yielded.work[0] == pytest.approx(sphere.yielded.work[0], rel=0.03)
    assert body.contacts[0].force_peak == pytest.approx(sphere.contacts[0].force_peak, rel=0.02)
    assert body.energy_residual < 1e-5


def test_multipliers_are_complementary_wherever_the_plate_bulges() -> None:
    """Nodes in any order touch: none pulls, lies inside the tip, or carries at a distance."""
    scene = parse_scene(document(outer=compact(speed=0.55)))
    system, _ = make_system(scene)
    loop = make_loop(system, 1e-9)
    pairs = system.matched[0]
    rows = 2 * pairs.opposite + 1
    assert pairs.flexibility is not None
    last, seen = np.zeros(pairs.radii.size), set()
    for seed in range(5):
        loop.u[rows] = 4e-6 * np.random.default_rng(seed).standard_normal(rows.size)
        loop.advance(1)
        force = np.array(loop.problem.matched[0].tip.contents.multipliers[: rows.size])
        distance = pairs.gaps + loop.u[2 * pairs.candidates + 1] - loop.u[rows]
        distance += pairs.flexibility @ (2.0 * force - last)
        assert force.min() >= 0.0
        assert force.max() > 0.0
        assert distance.min() > -1e-16
        assert np.abs(distance[force > 0.0]).max() < 1e-16
        seen.add(tuple(force > 0.0))
        last = force
    assert loop.problem.state.unconverged == 0
    assert any(np.any(np.diff(np.array(closed, dtype=int)) > 0) for closed in seen)


def test_extrapolated_force_is_stable_and_gives_back_what_it_takes() -> None:
    """A mass on tip and element: m u'' = lambda - k u, u + G (2 lambda_n - lambda_n-1) = 0.

    No root of the step's polynomial lies outside the unit circle, however stiff the tip; without
    the element the loss per radian falls with the third power of the step.
    """

    def growth(stiffness: float, element: float) -> float:
        # Both over m/dt^2, central differences stable up to an element of 4.
        c = 2.0 - element
        return float(np.abs(np.roots([stiffness + 2.0, -2.0 * c - 1.0, 2.0 + c, -1.0])).max())

    for stiffness in np.logspace(-8.0, 8.0, 33):
        assert max(growth(stiffness, element) for element in np.linspace(0.0, 3.99, 20)) < 1 + 1e-12
    losses = [(1.0 - growth(angle**2, 0.0)) / angle for angle in (0.02, 0.01)]
    assert losses[0] / losses[1] == pytest.approx(8.0, rel=0.01)
