"""Yielding: elements that do not lock, the return to the yield stress, spheres and their dents."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fem_reference.axisymmetric.elasticity import global_matrix
from fem_reference.axisymmetric.plastic import Box, mean_dilatation, plasticity, point_gradients
from fem_reference.axisymmetric.system import AxisymmetricSystem
from fem_reference.common.arrays import Floats
from fem_reference.common.bodies import Material, Yielding
from fem_reference.common.errors import SceneError
from fem_reference.explicit.plastic import PlasticState
from fem_reference.plate_impact.axisymmetric_motion import (
    AxisymmetricMotion,
    integrate_axisymmetric,
)
from fem_reference.plate_impact.dents import Dents
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import parse_scene
from fem_reference.plate_impact.studies.yielding import Wall, first_yield, rebound

from .conftest import STEEL, document, make_loop, make_system

YIELDS = {**STEEL, "yield_strength": 600e6, "hardening": 2.1e9}


def rectangle(inner: float, width: float, height: float, across: int, up: int) -> tuple[Any, Any]:
    """Points and elements (in the order of `ElementMatrices.nodes`) of a ring's cross-section."""
    r, z = np.meshgrid(
        np.linspace(inner, inner + width, across + 1), np.linspace(0, height, up + 1)
    )
    corner = (np.arange(up)[:, None] * (across + 1) + np.arange(across)).ravel()
    quads = corner[:, None] + np.array([0, 1, across + 1, across + 2])
    return np.stack([r.ravel(), z.ravel()], axis=1), quads


def inner_displacement(count: int, stiffness_of: Any) -> float:
    """Of a long thick cylinder, radii 1 and 2, under unit pressure from inside, over the exact."""
    material = Material("rubber", 1.0, 0.4999, 1.0)
    points, quads = rectangle(1.0, 1.0, 0.1, count, 1)
    gradients, weights = point_gradients(points[quads])
    stiffness = global_matrix(quads, stiffness_of(gradients, weights, material), points.shape[0])
    load = np.zeros(2 * points.shape[0])
    load[0 :: 2 * (count + 1)] = 0.5 * 2.0 * math.pi * 0.1
    # plane strain: only u_r is free
    free = np.arange(0, 2 * points.shape[0], 2)
    found = np.linalg.solve(stiffness.toarray()[np.ix_(free, free)], load[free])
    nu = material.poisson_ratio
    exact = (1.0 + nu) / (4.0 - 1.0) * ((1.0 - 2.0 * nu) + 4.0)
    return float(found[0] / exact)


def plain(gradients: Floats, weights: Floats, material: Material) -> Floats:
    """(m, 8, 8) bilinear stiffness without the mean of the dilatation."""
    one = np.stack(
        [
            mean_dilatation(gradients[:, :, k : k + 1], weights[:, k : k + 1], material)
            for k in range(4)
        ]
    )
    return np.asarray(one.sum(axis=0))


def test_mean_dilatation_does_not_lock_where_plain_elements_do() -> None:
    free = [inner_displacement(count, mean_dilatation) for count in (2, 4, 8)]
    locked = [inner_displacement(count, plain) for count in (2, 4, 8)]
    np.testing.assert_allclose(free, [0.985, 0.996, 0.999], atol=6e-4)
    assert max(locked) < 0.02


def pulled(law: Yielding, time_step: float) -> tuple[PlasticState, Material]:
    """One element, a ring, stretched along z at constant volume: its state after one step."""
    law_of = (law.strength, law.hardening, law.rate, law.exponent)
    material = Material("steel", 210e9, 0.3, 7780.0, *law_of)
    points, quads = rectangle(0.01, 1e-4, 1e-4, 1, 1)
    made = plasticity(quads, points, material, Box(np.array([True]), np.array([0])))
    system = AxisymmetricSystem(
        stiffness=global_matrix(quads, np.zeros((1, 8, 8)), 4),
        points=points,
        mass=np.ones(4),
        inverse_mass=np.zeros(8),
        velocity=np.zeros((4, 2)),
        first=np.array([0, 4]),
        numbers=(np.arange(4),) * 3,
        supports=np.array([], dtype=np.int64),
        watched=(np.array([0]), np.array([1.0])),
        matched=(),  # type: ignore[arg-type]
        element_nodes=quads,
        element_stiffness=np.zeros((1, 8, 8)),
        element_steps=np.ones(1),
        plasticity=made,
    )
    loop = make_loop(system, time_step)
    strain = 0.01
    # u_r = c/r - strain r/2 keeps e_rr + e_tt = -strain; c = 0: e_rr = e_tt
    loop.u[0::2], loop.u[1::2] = -0.5 * strain * points[:, 0], strain * points[:, 1]
    loop.advance(1)
    assert loop.problem.plastic is not None
    return loop.problem.plastic, material


@pytest.mark.parametrize("rate", [0.0, 40.4])
def test_stress_returns_to_the_yield_stress(rate: float) -> None:
    """Uniaxial stress deviator: q = Y + H p without a rate, above by Cowper & Symonds with one."""
    law = Yielding(600e6, 2.1e9, rate, 5.0)
    step = 1e-4
    state, material = pulled(law, step)
    p = state.accumulated[0]
    np.testing.assert_allclose(p, p[0], rtol=1e-9)
    mu = material.shear_modulus
    # the deviator of a stretch e along z at constant volume: q = 3 mu e
    q = 3.0 * mu * (0.01 - p[0])
    factor = 1.0 + (p[0] / (step * rate)) ** (1.0 / 5.0) if rate else 1.0
    assert q == pytest.approx((law.strength + law.hardening * p[0]) * factor, rel=1e-9)
    assert state.work[0] == pytest.approx(state.plasticity.weights.sum() * q * p[0], rel=1e-9)
    np.testing.assert_allclose(state.strain[0, 2], p, rtol=1e-9)
    np.testing.assert_allclose(state.strain[0, :3].sum(axis=0), 0.0, atol=1e-15)
    # what the kernel adds up step by step is the load of the whole
    expected = state.plasticity.load(state.strain)[0]
    np.testing.assert_allclose(state.force, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def impact(most_levels: int = 5, /, **changes: Any) -> tuple[Run, Any, Any]:
    scene = parse_scene(document(**changes))
    system, duration = make_system(scene)
    run, motion = integrate_axisymmetric(
        system, scene, duration, end_time=scene.end_time, most_levels=most_levels
    )
    return run, motion, scene


STEELS: dict[str, Any] = {
    "plate__material": YIELDS,
    "outer__material": YIELDS,
    "inner__material": YIELDS,
}


def test_energy_of_an_impact_that_yields_is_accounted_for() -> None:
    run, motion, _ = impact(1, **STEELS, reference__elements_per_contact_radius=3)
    assert run.energy_residual < 1e-6
    assert run.momentum_residual < 1e-9
    assert run.yielded is not None
    assert run.losses is not None
    work, locked = (
        sum(part) / run.initial_energy for part in (run.yielded.work, run.yielded.locked_in)
    )
    assert 0.1 < work < 0.2
    assert 0.05 * work < locked < 0.2 * work
    assert sum(run.losses.contacts) == pytest.approx(
        (work + locked) * run.initial_energy, rel=1e-12
    )
    # the outer sphere is struck again by the plate, long after both have come off
    assert run.contacts[0].count == 2
    assert run.contacts[0].end == pytest.approx(177e-6, rel=0.02)
    assert not motion.dents.reach_the_edge()


@pytest.mark.parametrize(
    "change",
    [
        pytest.param({"plate__damping_ratio": 0.04}, marks=pytest.mark.evidence),
        {"friction": 0.3},
    ],
)
def test_balance_closes_with_plasticity_and_another_loss(change: dict[str, float]) -> None:
    run, motion, _ = impact(1, **STEELS, **change, reference__elements_per_contact_radius=3)
    assert run.energy_residual < 1e-6
    assert run.momentum_residual < 1e-9
    assert run.losses is not None and run.yielded is not None
    assert sum(run.yielded.work) > 0.1 * run.initial_energy
    rubbed = -sum(pairs.rubbed for pairs in motion.loop.problem.matched)
    assert (run.losses.plate_damping > 0.01 * run.initial_energy) == ("friction" not in change)
    assert (rubbed > 1e-5 * run.initial_energy) == ("friction" in change)


def test_dented_plate_at_rest_has_nothing_to_damp() -> None:
    _, dented, scene = impact(
        **STEELS, reference__elements_per_contact_radius=3, run__end_time=6e-5
    )
    assert dented.dents is not None
    motion = AxisymmetricMotion(make_system(scene)[0])
    motion.lay(dented.dents.memory(fresh_spheres=False), 0.0)
    motion.damp(0.04, 1e6)
    motion.loop.set_step(1e-8, 1)
    motion.loop.v[:] = 0.0
    assert motion.damping is not None
    motion.damping.lose(1.0)
    # The plastic load alone would do this to the velocities in half a step.
    plastic = motion.loop.problem.plastic
    assert plastic is not None
    half_step = 0.5 * motion.loop.dt * motion.loop.inverse * plastic.force
    assert np.abs(motion.loop.v).max() < 1e-9 * np.abs(half_step).max()


def test_strong_material_gives_the_elastic_impact() -> None:
    """Nothing yields, but the elements are other ones: the same within the error of the mesh."""
    strong = {**YIELDS, "yield_strength": 3e9}
    changes = dict.fromkeys(STEELS, strong)
    run, _, _ = impact(**changes, reference__elements_per_contact_radius=4)
    elastic, _, _ = impact(reference__elements_per_contact_radius=4)
    assert run.yielded is not None
    assert sum(run.yielded.work) == 0.0
    assert run.inner_velocity == pytest.approx(elastic.inner_velocity, rel=2e-3)
    assert run.contacts[0].force_peak == pytest.approx(elastic.contacts[0].force_peak, rel=5e-3)


def test_what_yields_at_the_edge_of_its_zone_is_seen() -> None:
    scene = parse_scene(document(**STEELS, run__end_time=3e-5))
    system, duration = make_system(scene)
    _, motion = integrate_axisymmetric(system, scene, duration, end_time=3e-5)
    assert motion.dents is not None
    assert not motion.dents.reach_the_edge()
    assert system.plasticity is not None
    plastic = motion.loop.problem.plastic
    assert plastic is not None
    small = replace(system.plasticity, edge=plastic.accumulated.max(axis=1) > 0)
    _, motion = integrate_axisymmetric(
        replace(system, plasticity=small), scene, duration, end_time=3e-5
    )
    assert motion.dents is not None
    assert motion.dents.reach_the_edge()


def test_rest_has_no_forces_and_the_next_impact_begins_in_it() -> None:
    _, motion, scene = impact(**STEELS, reference__elements_per_contact_radius=3)
    dents = motion.dents
    assert isinstance(dents, Dents)
    loop = motion.loop
    free = loop.inverse > 0.0
    left = (loop.product(dents.at_rest()) - loop.problem.plastic.force)[free]
    assert np.abs(left).max() < 1e-6 * np.abs(loop.problem.plastic.force).max()
    system, _ = make_system(scene)
    other = make_loop(system, 1e-9)
    fresh = Dents(system, other.problem.plastic)  # type: ignore[arg-type]
    laid = fresh.lay(dents.memory(fresh_spheres=False), (0.0, 0.0))
    for number, pairs in enumerate(system.matched):
        opened = laid[1::2][pairs.candidates] - laid[1::2][pairs.opposite]
        assert (pairs.gaps + (1, -1)[number] * opened).min() == pytest.approx(0.0, abs=1e-15)
    assert fresh.yielded().lost == (0.0, 0.0)
    spheres = dents.memory(fresh_spheres=True).accumulated[dents.bodies != 1]
    assert spheres.max() == 0.0
    assert np.array_equal(
        dents.memory(fresh_spheres=True).strain[dents.bodies == 1],
        dents.memory(fresh_spheres=False).strain[dents.bodies == 1],
    )


def test_yielding_is_for_dry_axisymmetric_geometry() -> None:
    with pytest.raises(SceneError, match=r"plate\.material yields"):
        parse_scene(document(plate__material=YIELDS, reference__geometry="solid"))
    with pytest.raises(SceneError, match="yield_strength is missing"):
        parse_scene(document(plate__material={**STEEL, "hardening": 1e9}))
    rated = parse_scene(document(plate__material={**YIELDS, "rate": {"D": 40.4, "q": 5}}))
    assert rated.plate.material.yielding == Yielding(600e6, 2.1e9, 40.4, 5.0)


def test_first_yield_lies_where_hertz_pressure_puts_it() -> None:
    """p0 = 1.60 Y for nu = 0.3: the force at the first plastic work."""
    assert first_yield(Wall(1.05), 4) == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize(
    ("ratio", "restitution", "within"),
    [
        (2.1, 0.975, 0.003),
        pytest.param(26.0, 0.730, 0.003, marks=pytest.mark.evidence),
        pytest.param(53.0, 0.654, 0.003, marks=pytest.mark.evidence),
        (105.0, 0.572, 0.008),
    ],
)
def test_rebound_from_a_rigid_wall(ratio: float, restitution: float, within: float) -> None:
    """As other finite elements, made without this program, have it.

    The last is between 0.575 and 0.581 on meshes of 5 to 18 elements. Half the step, wider boxes
    and a stiffer wall move it by less than 3e-4; hardening would add 0.014.
    """
    found = rebound(Wall(ratio), 5)
    assert found.energy_residual < 1e-5
    assert found.inside
    assert found.restitution == pytest.approx(restitution, abs=within)


def test_fully_developed_dent_has_the_pressure_of_a_hardness_test() -> None:
    """Mean pressure 2.65 Y at E* a/(Y R) = 37."""
    found = rebound(Wall(269.0), 10)
    assert found.inside
    assert found.depth == pytest.approx(37.0, rel=0.03)
    assert found.pressure == pytest.approx(2.65, rel=0.03)
