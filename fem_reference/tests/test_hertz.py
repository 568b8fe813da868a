"""Impacts with a closed form: Hertz on a rigid half-space, Zener on an infinite plate."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fem_reference.common.errors import SceneError
from fem_reference.common.hertz import effective_modulus, hertz_stiffness, hertz_time_scale
from fem_reference.explicit.records import peak_force
from fem_reference.plate_impact.estimate import estimate_contact, field_times
from fem_reference.plate_impact.scene import parse_scene

from .conftest import document, integrate, make_system, solve_once

RIGID = {"name": "rigid", "youngs_modulus": 210e13, "poisson_ratio": 0.3, "density": 7780e4}
"""Ten thousand times as stiff and heavy as steel, hence with its wave speed."""


def test_sphere_on_a_rigid_half_space_hertz() -> None:
    """Duration 2.9433 delta/v and force 1.1433 m v/T (Hertz 1882).

    At 20 mm/s the contact radius is 1 % of the sphere's, so that the half-space is a good
    picture of the sphere; what is left is discretisation.
    """
    scene = parse_scene(
        document(
            plate__material=RIGID,
            plate__edge="free",
            plate__radius=0.006,
            plate__thickness=0.003,
            outer__speed=0.02,
            inner__gap=1e-3,
            run__end_time=1.8e-4,
            reference__elements_per_contact_radius=5,
        )
    )
    system, duration = make_system(scene)
    run = integrate(system, scene, duration, end_time=scene.end_time)
    stiffness = hertz_stiffness(
        effective_modulus(scene.outer.material, scene.plate.material), scene.outer.tip_radius
    )
    scale = hertz_time_scale(scene.outer.mass, stiffness, scene.speed)
    contact = run.contacts[0]
    assert contact.count == 1
    assert contact.end == pytest.approx(2.943275 * 1.25**0.4 * scale, rel=0.01)
    force = 1.143263 * scene.outer.mass * scene.speed / scale
    assert contact.force_peak == pytest.approx(force, rel=0.01)
    # An elastic collision with a body of finite mass; next to nothing goes into waves.
    plate_mass = scene.plate.surface_density * math.pi * scene.plate.radius**2
    rebound = (plate_mass - scene.outer.mass) / (plate_mass + scene.outer.mass)
    assert run.outer_velocity == pytest.approx(rebound * scene.speed, rel=1e-4)
    assert run.contacts[1].count == 0
    assert run.contacts[1].end is None


def test_estimate_is_zeners_equation_with_a_light_plate() -> None:
    """The restitution of Zener 1941 through the estimate's forces: 0.714045 at lambda = 0.2."""
    # Inner sphere out of reach: the plate is loaded from one side.
    base = document(inner__gap=1e-2)
    scene = parse_scene(base)
    stiffness = hertz_stiffness(
        effective_modulus(scene.outer.material, scene.plate.material), scene.outer.tip_radius
    )
    scale = hertz_time_scale(scene.outer.mass, stiffness, scene.speed)
    # lambda = m / (8 sqrt(rho h D) T) is proportional to h^-2.
    inelasticity = scene.outer.mass / (
        8.0 * math.sqrt(scene.plate.surface_density * scene.plate.bending_stiffness) * scale
    )
    thickness = scene.plate.thickness * math.sqrt(inelasticity / 0.2)
    zener = parse_scene(document(inner__gap=1e-2, plate__thickness=thickness))
    # Largest s^(3/2) of s'' + (1 + lambda d/dtau) s^(3/2) = 0 at lambda = 0.2, from an independent
    # Runge-Kutta solution of the first-order system (s, s' + lambda s^(3/2)).
    s, p, step, largest = 0.0, 1.0, 1e-4, 0.0
    while s >= 0.0:
        k1 = (p - 0.2 * max(s, 0.0) ** 1.5, -(max(s, 0.0) ** 1.5))
        mid = s + 0.5 * step * k1[0], p + 0.5 * step * k1[1]
        k2 = (mid[1] - 0.2 * max(mid[0], 0.0) ** 1.5, -(max(mid[0], 0.0) ** 1.5))
        s, p = s + step * k2[0], p + step * k2[1]
        largest = max(largest, max(s, 0.0) ** 1.5)
    assert -p == pytest.approx(0.714045, abs=1e-4)
    force = largest * scene.outer.mass * scene.speed / scale
    radius = (
        0.75
        * force
        * scene.outer.tip_radius
        / effective_modulus(scene.outer.material, scene.plate.material)
    ) ** (1 / 3)
    assert estimate_contact(zener).outer_radius == pytest.approx(radius, rel=1e-3)


def test_a_light_inner_body_does_not_shorten_the_run_that_is_planned() -> None:
    """The run goes on to the end of the longer contact, and so do its fields."""
    light, equal = (parse_scene(document(inner__radius=radius)) for radius in (6e-4, 1e-2))
    assert estimate_contact(light).duration < 0.2 * estimate_contact(equal).duration
    assert field_times(light, 5)[-1] == pytest.approx(field_times(equal, 5)[-1])


def test_estimate_is_confirmed_by_the_run() -> None:
    solution = solve_once(parse_scene(document(reference__elements_per_contact_radius=3)))
    assert solution.meshes_tried == 1
    assert 0.9 * 3 <= min(solution.resolution.outer, solution.resolution.inner) < 3.6


def test_mesh_is_made_again_when_the_contact_is_smaller_than_estimated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from fem_reference.plate_impact import axisymmetric as solve
    from fem_reference.plate_impact.estimate import ContactEstimate
    from fem_reference.plate_impact.scene import Scene

    def too_large(scene: Scene) -> ContactEstimate:
        found = estimate_contact(scene)
        return ContactEstimate(
            1.5 * found.outer_radius, 1.5 * found.inner_radius, found.duration, found.longest
        )

    monkeypatch.setattr(solve, "estimate_contact", too_large)
    scene = parse_scene(document(reference__elements_per_contact_radius=3))
    solution = solve_once(scene)
    assert solution.meshes_tried == 2
    assert min(solution.resolution.outer, solution.resolution.inner) >= 2.7


def test_fast_heavy_sphere_is_outside_the_method() -> None:
    scene = parse_scene(document(outer__radius=0.002, inner__radius=0.002, outer__speed=300.0))
    with pytest.raises(SceneError, match="contact radius"):
        solve_once(scene)


def test_peak_force_of_a_constant_force() -> None:
    impulse = np.linspace(0.0, 10e-6, 6)
    assert peak_force(impulse, 4, 1e-7) == pytest.approx(20.0)
