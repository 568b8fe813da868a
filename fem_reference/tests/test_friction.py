"""Coulomb friction between matching nodes: its law, its balance, and what it does to an impact."""

from __future__ import annotations

import ctypes
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fem_reference.common.errors import SceneError
from fem_reference.common.fenicsx import alone
from fem_reference.explicit import kernel
from fem_reference.explicit.contact import RigidBody, SphereContact
from fem_reference.explicit.problem import ContactProblem
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import parse_scene
from fem_reference.seal_seat.meshing import seat_mesh, sphere_mesh
from fem_reference.seal_seat.model import seat_model
from fem_reference.seal_seat.run import integrate as launch_seat
from fem_reference.seal_seat.scene import parse_seat_scene
from fem_reference.solid.system import make_loop as make_solid_loop
from fem_reference.tests.seal_seat_scenes import seat_document

from .conftest import STEEL, document, integrate, make_loop, make_system

POLYMER = {"name": "polymer", "youngs_modulus": 2.6e9, "poisson_ratio": 0.38, "density": 1320.0}
CORK = {"name": "cork", "youngs_modulus": 20e9, "poisson_ratio": 0.0, "density": 7780.0}
RIGID = {"name": "rigid", "youngs_modulus": 2e12, "poisson_ratio": 0.3, "density": 77800.0}
"""A hundred times as stiff as cork."""


def test_friction_is_for_spheres() -> None:
    assert parse_scene(document()).friction == 0.0
    assert parse_scene(document(friction=0.3)).friction == 0.3
    compact = {"kind": "compact", "mass": 1e-3, "tip_radius": 1e-2, "material": STEEL, "gap": 0.0}
    with pytest.raises(SceneError, match=r"friction is 0\.3"):
        parse_scene(document(friction=0.3, inner=compact))


def test_every_pair_obeys_coulombs_law() -> None:
    """It sticks with less than the bound, or slides against it with exactly the bound."""
    friction = 0.3
    system, _ = make_system(parse_scene(document(friction=friction)))
    pairs = system.matched[0]
    loop = make_loop(system, 1e-9)
    seen = set()
    for seed in range(5):
        random = np.random.default_rng(seed)
        loop.u[:] = 0.0
        loop.u[2 * pairs.candidates + 1] = -2e-5 * random.random(pairs.radii.size)
        loop.v[:] = 2e3 * random.standard_normal(loop.v.size) * (loop.inverse > 0.0)
        velocity = loop.v - loop.dt * loop.inverse * loop.product(loop.u)
        loop.advance(1)
        change = (loop.v - velocity).reshape(-1, 2)[pairs.candidates]
        inverse = loop.inverse.reshape(-1, 2)[pairs.candidates]
        normal = change[:, 1] / (loop.dt * inverse[:, 1])
        off_axis = inverse[:, 0] > 0.0
        shear = np.zeros_like(normal)
        shear[off_axis] = change[off_axis, 0] / (loop.dt * inverse[off_axis, 0])
        bound = friction * normal
        sliding = loop.v[2 * pairs.candidates] - loop.v[2 * pairs.opposite]
        assert normal.min() >= -1e-9 * normal.max()
        assert np.abs(shear).max() > 0.0
        assert np.all(np.abs(shear) <= bound + 1e-9 * normal.max())
        slides = (np.abs(sliding) > 1e-12) & (normal > 1e-9 * normal.max()) & off_axis
        np.testing.assert_allclose(
            shear[slides], -np.sign(sliding[slides]) * bound[slides], rtol=1e-6
        )
        sticks = (normal > 1e-9 * normal.max()) & off_axis & ~slides
        seen |= {name for name, any_ in (("slides", slides), ("sticks", sticks)) if any_.any()}
    assert seen == {"slides", "sticks"}
    assert loop.problem.matched[0].rubbed < 0.0


def peak(friction: float, **changes: Any) -> Run:
    scene = parse_scene(document(friction=friction, **changes))
    system, duration = make_system(scene)
    run = integrate(system, scene, duration, end_time=scene.end_time, most_levels=1)
    assert run.energy_residual < 1e-5
    assert run.momentum_residual < 1e-9
    return run


def test_friction_hardly_matters_between_equals_and_little_between_others() -> None:
    """Equal half-spaces displace their faces alike (Johnson 1985, ch. 4.2): nothing slides."""

    def change(**scene: Any) -> tuple[float, float]:
        smooth, rough = peak(0.0, **scene), peak(0.3, **scene)
        assert smooth.losses is None
        assert rough.losses is not None
        assert rough.losses.contacts[0] > 0.0
        force = rough.contacts[0].force_peak / smooth.contacts[0].force_peak
        return abs(force - 1.0), rough.losses.contacts[0] / rough.initial_energy

    thick = {
        "plate__radius": 0.02,
        "plate__thickness": 0.012,
        "run__end_time": 5e-5,
        "reference__elements_per_contact_radius": 3,
    }
    equal, rubbed_equal = change(**thick)
    unlike, rubbed_unlike = change(**{**thick, "run__end_time": 2e-4}, plate__material=POLYMER)
    assert equal < 5e-4
    assert rubbed_equal < 1e-5
    assert 3.0 * equal < unlike < 0.02
    assert rubbed_unlike > 10.0 * rubbed_equal


def test_rough_contact_is_stiffer_as_much_as_a_punch_that_sticks() -> None:
    """A rigid sphere on a plate without lateral contraction: rough beyond sliding.

    A flat punch that sticks is stiffer by (1 - nu) ln(3 - 4 nu) / (1 - 2 nu) than a smooth one
    (Johnson 1985, eq. 3.40), by ln 3 here; a sphere, whose patch grows, by somewhat less. The peak
    of an impact goes with the power 2/5.
    """
    scene = {
        "outer__material": RIGID,
        "plate__material": CORK,
        "plate__radius": 0.02,
        "plate__thickness": 0.016,
        "plate__edge": "free",
        "inner__gap": 1e-3,
        "outer__speed": 0.1,
        # after the peak
        "run__end_time": 2.5e-4,
        "reference__elements_per_contact_radius": 4,
    }
    ratio = peak(100.0, **scene).contacts[0].force_peak / peak(0.0, **scene).contacts[0].force_peak
    assert 1.0 + 0.5 * (math.log(3.0) ** 0.4 - 1.0) < ratio < math.log(3.0) ** 0.4


@pytest.mark.parametrize(("friction", "rolls"), [(0.05, False), (1.0, True)])
def test_a_ball_that_strikes_a_wall_obliquely_slides_or_rolls(friction: float, rolls: bool) -> None:
    """Sliding takes mu times the normal impulse, rolling 2/7 of the velocity along the wall.

    The multipliers stop what approaches; the ball's inertia is 2/5 m r^2.
    """
    mass, radius, along, towards = 2.0, 0.1, 3.0, 1.0
    turning = np.diag([0.0, 1.0 / (0.4 * mass * radius**2), 0.0])
    ball = RigidBody("ball", mass, velocity=(along, 0.0, -towards), turning=turning)
    wall = SphereContact("wall", 0, np.array([0]), 0, (0.0, 0.0, radius), radius, None, friction)
    system: Any = SimpleNamespace(
        points=np.zeros((1, 3)),
        inverse_mass=np.zeros(3),
        first=np.array([0, 1]),
        contacts=(wall,),
        rigid=(ball,),
        matched=(),
        film=None,
        plasticity=None,
    )
    problem = ContactProblem(system)
    step = 1e-9
    problem.set_step(step, 1)
    kernel.load(3).contact_step(ctypes.byref(problem.state))
    moved = problem.rigids[0]
    lost = 2.0 / 7.0 * along if rolls else friction * towards
    assert list(moved.v) == pytest.approx([along - lost, 0.0, 0.0], abs=1e-6)
    assert list(moved.spin) == pytest.approx([0.0, 2.5 * lost / radius, 0.0], abs=1e-5)
    assert (radius * moved.spin[1] == pytest.approx(moved.v[0], abs=1e-6)) == rolls
    gained = 0.5 * mass * (moved.v[0] ** 2 + 0.4 * (radius * moved.spin[1]) ** 2 - along**2)
    assert problem.contacts[0].rubbed == pytest.approx(gained, rel=1e-6)
    assert problem.state.reaction[0] == pytest.approx(-mass * lost, rel=1e-6)


def test_friction_hardly_depends_on_the_time_step() -> None:
    """Though the normal multipliers of a step know nothing of its friction."""
    design = parse_seat_scene(
        seat_document(reference__element_order=1, friction=0.3, run={"end_time": 40e-6})
    )
    model = seat_model(design, seat_mesh(design, 0.4), None)
    whole, half = (
        launch_seat(make_solid_loop(model.model, alone()), model, design, courant=courant)
        for courant in (0.9, 0.45)
    )
    assert whole.losses is not None
    assert min(whole.losses.contacts) > 1e-5 * design.initial_energy
    change = np.subtract(whole.sphere_velocity, half.sphere_velocity)
    assert np.linalg.norm(change) < 3e-4 * np.linalg.norm(half.sphere_velocity)


def test_a_ball_leaves_a_rough_seat_as_an_elastic_one_does() -> None:
    """The elastic ball turns by itself: its elements know no spin."""
    mesh = seat_mesh(parse_seat_scene(seat_document(reference__element_order=1)), 0.4)
    states = []
    for body, friction in (("rigid", 0.0), ("rigid", 0.3), ("elastic", 0.3)):
        design = parse_seat_scene(
            seat_document(
                reference__element_order=1,
                sphere__body=body,
                friction=friction,
                run={"end_time": 40e-6},
            )
        )
        sphere = sphere_mesh(design, 0.4) if design.sphere_elastic else None
        model = seat_model(design, mesh, sphere)
        run = launch_seat(make_solid_loop(model.model, alone()), model, design)
        assert run.energy_residual < 1e-12
        assert run.momentum_residual < 1e-12
        if friction > 0.0:
            assert run.losses is not None
            assert min(run.losses.contacts) > 1e-5 * design.initial_energy
        else:
            assert run.losses is None
        states.append(run.sphere_velocity)
    smooth, rigid, elastic = np.array(states)
    speed = np.linalg.norm(smooth)
    assert np.linalg.norm(elastic - rigid) < 0.01 * speed
    assert np.linalg.norm(rigid - smooth) > 0.03 * speed
