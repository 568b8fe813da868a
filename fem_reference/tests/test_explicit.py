"""The time loop: ledgers, stability limit, invariances, and the end of a run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fem_reference.axisymmetric import system as system_module
from fem_reference.axisymmetric.elasticity import BodyMatrices
from fem_reference.axisymmetric.statics import patch_flexibility
from fem_reference.axisymmetric.system import (
    INNER,
    OUTER,
    AxisymmetricSystem,
    critical_time_step,
)
from fem_reference.common.arrays import Ints
from fem_reference.common.errors import SolverError
from fem_reference.explicit.frames import Frames
from fem_reference.explicit.levels import LEVEL_MARGIN, MOST_LEVELS
from fem_reference.plate_impact import meshing as meshing_module
from fem_reference.plate_impact.axisymmetric_motion import (
    AxisymmetricMotion,
    integrate_axisymmetric,
)
from fem_reference.plate_impact.motion import observed_circle
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import document, integrate, make_loop, make_system


def test_balance_of_momentum_and_energy(run: Run, system: AxisymmetricSystem) -> None:
    """Momentum to round-off, energy to what the interfaces of the levels exchange."""
    loop = make_loop(system, run.time_step, MOST_LEVELS)
    assert len(loop.levels) > 2
    assert run.momentum_residual < 1e-9
    assert run.energy_residual < 1e-5
    # The constraint takes energy out when pairs close, little of it, and never adds any.
    assert 0.0 <= run.contact_loss < 1e-5


def test_energy_of_all_bodies_is_the_initial_energy(run: Run, scene: Scene) -> None:
    initial = 0.5 * scene.outer.mass * scene.speed**2
    assert run.initial_energy == pytest.approx(initial, rel=1e-12)
    assert run.energies.total == pytest.approx(initial, rel=1e-5)


def test_impulse_is_the_change_of_momentum(run: Run, scene: Scene) -> None:
    outer = scene.outer.mass * (run.outer_velocity + scene.speed)
    inner = -scene.inner.mass * run.inner_velocity
    assert run.contacts[0].impulse == pytest.approx(outer, rel=1e-9)
    assert run.contacts[1].impulse == pytest.approx(inner, rel=1e-9)
    assert run.rows[-1, 2] == pytest.approx(outer, rel=1e-9)


def test_spheres_from_both_sides_rebound_as_mirror_images() -> None:
    """Both strike at once: the plate stays, and each has its energy back but for waves."""
    scene = parse_scene(document(inner__speed=0.55, reference__elements_per_contact_radius=3))
    system, duration = make_system(scene)
    run = integrate(system, scene, duration)
    assert run.initial_energy == pytest.approx(scene.outer.mass * scene.speed**2, rel=1e-12)
    assert run.energy_residual < 1e-5
    assert run.momentum_residual < 1e-9
    assert run.inner_velocity == pytest.approx(-run.outer_velocity, rel=1e-9)
    assert 0.98 < run.outer_velocity / scene.speed <= 1.0
    assert np.abs(run.rows[:, 3]).max() < 1e-9 * np.abs(run.rows[:, 0]).max()
    assert run.rows[0, 6] == pytest.approx(0.55, rel=1e-2)


def test_a_receding_body_has_no_contact() -> None:
    scene = parse_scene(document(inner__speed=-2.0, reference__elements_per_contact_radius=3))
    system, duration = make_system(scene)
    run = integrate(system, scene, duration)
    assert run.contacts[1].count == 0
    assert run.inner_velocity == pytest.approx(-2.0, rel=1e-9)
    assert run.momentum_residual < 1e-9


def test_displacement_is_the_integral_of_velocity(run: Run) -> None:
    for displacement, velocity in ((0, 1), (3, 4), (5, 6)):
        mean = 0.5 * (run.rows[1:, velocity] + run.rows[:-1, velocity])
        moved = np.concatenate([[0.0], np.cumsum(mean * np.diff(run.times))])
        scale = np.abs(moved).max()
        assert np.abs(run.rows[:, displacement] - moved).max() < 2e-3 * scale


def test_time_step_above_the_critical_one_is_refused(
    system: AxisymmetricSystem, scene: Scene, duration: float
) -> None:
    critical = critical_time_step(system)
    with pytest.raises(SolverError, match=rf"{critical:.6g} s.*1\.01"):
        integrate(system, scene, duration, courant=1.01)
    for courant in (0.0, -0.5, float("nan")):
        with pytest.raises(SolverError, match="Courant"):
            integrate(system, scene, duration, courant=courant)


def test_critical_time_step_is_the_limit_of_stability(system: AxisymmetricSystem) -> None:
    """Free vibration from noise grows just above 2/omega_max and not just below it."""
    critical = critical_time_step(system)
    growth = {}
    for courant in (0.98, 1.003):
        loop = make_loop(system, courant * critical)
        noise = np.random.default_rng(3).standard_normal(loop.v.size)
        loop.v[:] = noise * (system.inverse_mass > 0.0)
        before = np.abs(loop.v).max()
        loop.drift(4000)
        growth[courant] = np.abs(loop.v).max() / before
    assert growth[0.98] < 100.0
    assert not growth[1.003] < 1e6


@pytest.mark.parametrize("courant", [0.5, 0.99])
def test_time_step_does_not_matter(
    run: Run, system: AxisymmetricSystem, scene: Scene, duration: float, courant: float
) -> None:
    other = integrate(system, scene, duration, courant=courant)
    assert other.inner_velocity == pytest.approx(run.inner_velocity, rel=1e-4)
    assert other.outer_velocity == pytest.approx(run.outer_velocity, rel=3e-4)
    for a, b in zip(other.contacts, run.contacts, strict=True):
        assert a.force_peak == pytest.approx(b.force_peak, rel=2e-3)
        assert a.end == pytest.approx(b.end, rel=2e-3)
        assert a.count == b.count


def test_sub_cycling_gives_the_answer_of_one_time_step(
    run: Run, system: AxisymmetricSystem, scene: Scene, duration: float
) -> None:
    single, motion = integrate_axisymmetric(system, scene, duration, most_levels=1)
    # One level: a central difference, whose discrete energy is exact but for the rounding of some
    # 1e5 steps (1.2e-9); with levels it is not (1e-6).
    assert motion.loop.levels == (system.mass.size,)
    assert single.energy_residual < 4e-9
    assert run.inner_velocity == pytest.approx(single.inner_velocity, rel=2e-4)
    assert run.outer_velocity == pytest.approx(single.outer_velocity, rel=5e-4)
    for a, b in zip(run.contacts, single.contacts, strict=True):
        assert a.force_peak == pytest.approx(b.force_peak, rel=1e-3)
        assert a.end == pytest.approx(b.end, rel=1e-3)


def test_levels_keep_their_distance(system: AxisymmetricSystem) -> None:
    """The parts sum up to K; no level is too fast for its elements, neighbours differ by one."""
    step = 0.9 * critical_time_step(system)
    level = make_loop(system, step).element_levels(step, MOST_LEVELS)
    assert np.all(2.0**level * step <= np.maximum(LEVEL_MARGIN * system.element_steps, step))
    for pairs in system.matched:
        for nodes in (pairs.candidates, pairs.opposite):
            assert not level[np.isin(system.element_nodes, nodes).any(axis=1)].any()
    lowest = np.full(system.mass.size, 99)
    highest = np.zeros(system.mass.size, dtype=int)
    for corner in range(4):
        np.minimum.at(lowest, system.element_nodes[:, corner], level)
        np.maximum.at(highest, system.element_nodes[:, corner], level)
    assert (highest - lowest).max() == 1
    parts = sum(system.part(level == k) for k in range(int(level.max()) + 1))
    assert abs(parts - system.stiffness).max() < 1e-12 * abs(system.stiffness).max()


@pytest.mark.parametrize("courant", [0.5, 0.8, 0.9, 0.95])
def test_levels_do_not_resonate(system: AxisymmetricSystem, courant: float) -> None:
    """Free vibration from noise stays bounded over thousands of the longest steps.

    With levels right up to the elements' critical step it grows by 1e40 at some of these steps.
    """
    loop = make_loop(system, courant * critical_time_step(system), MOST_LEVELS)
    noise = np.random.default_rng(3).standard_normal(loop.v.size)
    loop.v[:] = noise * (system.inverse_mass > 0.0)
    before = np.abs(loop.v).max()
    loop.drift(loop.meeting * 2000)
    assert np.abs(loop.v).max() / before < 300.0


def test_numbering_of_the_nodes_does_not_matter(
    run: Run, scene: Scene, duration: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def shuffled(matrices: BodyMatrices) -> Ints:
        return np.random.default_rng(7).permutation(matrices.mass.size)

    monkeypatch.setattr(meshing_module, "renumbering", shuffled)
    other = integrate(make_system(scene)[0], scene, duration)
    assert other.steps == run.steps
    assert other.inner_velocity == pytest.approx(run.inner_velocity, rel=1e-7)
    assert other.contacts[0].force_peak == pytest.approx(run.contacts[0].force_peak, rel=1e-5)


def test_impact_from_below_mirrors_the_impact_from_above(
    run: Run, system: AxisymmetricSystem, scene: Scene
) -> None:
    velocity = np.zeros_like(system.velocity)
    velocity[system.first[INNER] :, 1] = scene.speed
    motion = AxisymmetricMotion(replace(system, velocity=velocity))
    motion.loop.set_step(run.time_step, 1, MOST_LEVELS)
    mirrored = motion.sample(run.times.size - 1, round(run.times[1] / run.time_step))
    for above, below in ((0, 5), (1, 6), (3, 3), (4, 4), (5, 0), (6, 1)):
        scale = np.abs(run.rows[:, above]).max()
        assert np.abs(run.rows[:-1, above] + mirrored[:, below]).max() < 1e-4 * scale
    assert np.abs(run.rows[:-1, 2] - mirrored[:, 7]).max() < 1e-4 * run.rows[-1, 2]


def test_compiled_product_is_the_matrix_product(system: AxisymmetricSystem) -> None:
    loop = make_loop(system, 1e-9, MOST_LEVELS)
    x = np.random.default_rng(5).standard_normal(loop.u.size)
    expected = system.stiffness @ x
    assert np.allclose(loop.product(x), expected, rtol=0.0, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize(
    "changes",
    [
        {},
        pytest.param({"plate__edge": "free"}, marks=pytest.mark.evidence),
        pytest.param(
            {"plate__edge": "simply-supported", "outer__radius": 0.006},
            marks=pytest.mark.evidence,
        ),
        {"inner__gap": 5e-6},
        pytest.param({"plate__damping_ratio": 0.03}, marks=pytest.mark.evidence),
    ],
)
def test_no_contact_after_the_end_of_the_run(changes: dict[str, object]) -> None:
    """The run ends by itself; one twice as long changes none of its results."""
    scene = parse_scene(document(reference__elements_per_contact_radius=3, **changes))
    system, duration = make_system(scene)
    ended = integrate(system, scene, duration)
    end_time = 2.0 * float(ended.times[-1])
    longer = integrate(system, scene, duration, end_time=end_time)
    assert longer.times[-1] == pytest.approx(end_time, rel=1e-12)
    for a, b in zip(longer.contacts, ended.contacts, strict=True):
        assert a.count == b.count
        assert a.impulse == pytest.approx(b.impulse, rel=1e-5)
        assert (a.end is None) == (b.end is None)
        if a.end is not None and b.end is not None:
            assert a.end == pytest.approx(b.end, rel=1e-3)
    assert ended.momentum_residual < 1e-9


def test_run_cut_short_says_so(system: AxisymmetricSystem, scene: Scene, duration: float) -> None:
    cut = integrate(system, scene, duration, end_time=2e-5)
    assert cut.in_contact_at_end
    assert cut.times[-1] == pytest.approx(2e-5, rel=1e-12)


def test_field_is_the_state_at_its_time(
    system: AxisymmetricSystem, scene: Scene, duration: float, tmp_path: Path
) -> None:
    recorded: list[Frames] = []

    def fields(interval: float) -> Frames:
        recorded.append(Frames(tmp_path, 0, (0.0, 1e-5), interval))
        return recorded[-1]

    cut = integrate(system, scene, duration, end_time=2e-5, fields=fields)
    (start, still), (instant, moved) = recorded[0].frames()
    assert start == 0.0 and not still.any()
    assert instant == pytest.approx(1e-5, abs=float(cut.times[1]))
    index = int(np.argmin(np.abs(cut.times - instant)))
    rows = slice(int(system.first[OUTER]), int(system.first[OUTER + 1]))
    mean = system.mass[rows] @ moved[rows, 1] / system.mass[rows].sum()
    assert mean == pytest.approx(cut.rows[index, 0], rel=1e-12)
    nodes, shares = system.watched
    assert shares.sum() == pytest.approx(1.0, rel=1e-12)
    assert nodes.size > 4
    assert np.all(system.points[nodes, 0] < 1.2 * observed_circle(scene))
    assert np.all(np.abs(system.points[nodes, 1]) == pytest.approx(0.5 * scene.plate.thickness))
    assert shares @ moved[nodes, 1] == pytest.approx(cut.rows[index, 3], rel=1e-12)


def test_flexibility_of_a_free_sphere(scene: Scene) -> None:
    """That of the half-space under Hertz's pressure, 0.6 (1 - nu^2)/(E a), less 0.40/(E r).

    The second part, 5 % here, is what a free sphere of nu = 0.3 lacks against its half-space.
    """
    system, _ = make_system(scene, 4.0)
    pairs = system.matched[0]
    weights = system_module.hertz_weights(pairs.radii)
    found = patch_flexibility(system, OUTER, pairs.candidates, weights)
    half_space = 0.6 * (1.0 - 0.3**2) / (210e9 * pairs.radii[-1])
    assert found == pytest.approx(half_space - 0.40 / (210e9 * 0.01), rel=0.01)
