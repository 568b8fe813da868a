"""Sub-cycling of the three-dimensional loop: levels, stability, and the answer of one time step."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse

from fem_reference.common.arrays import Ints
from fem_reference.common.errors import DivergedError
from fem_reference.common.fenicsx import alone
from fem_reference.explicit.checkpoint import Checkpoint
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.levels import BUFFER, LEVEL_MARGIN, MOST_LEVELS, least_at_nodes
from fem_reference.explicit.loop import Loop
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.explicit.supervision import LARGEST_ENERGY_RESIDUAL, Account, stable_run
from fem_reference.seal_seat.meshing import seat_mesh
from fem_reference.seal_seat.model import SeatModel, seat_model
from fem_reference.seal_seat.run import SeatRun, integrate
from fem_reference.seal_seat.scene import SeatScene, parse_seat_scene
from fem_reference.solid.elements import element_stiffness, element_time_steps
from fem_reference.solid.system import make_loop
from fem_reference.tests.cut_off import CutOffError, cut_off
from fem_reference.tests.seal_seat_scenes import seat_document


def scene(**changes: Any) -> SeatScene:
    return parse_seat_scene(seat_document(True, **changes))


def small(order: int) -> SeatModel:
    design = scene(reference__element_order=order)
    return seat_model(design, seat_mesh(design, {1: 0.4, 2: 0.35}[order]))


@pytest.fixture(scope="module", params=[1, 2])
def seat(request: pytest.FixtureRequest) -> SeatModel:
    return small(int(request.param))


@pytest.fixture(scope="module")
def linear() -> SeatModel:
    return small(1)


def stepped(seat: SeatModel, **options: Any) -> tuple[Loop, SeatRun]:
    loop = make_loop(seat.model, alone())
    return loop, integrate(loop, seat, scene(reference__element_order=1), **options)


@pytest.fixture(scope="module")
def runs(linear: SeatModel) -> dict[int, tuple[Loop, SeatRun]]:
    """With the levels there are, and with one."""
    return {most: stepped(linear, most_levels=most) for most in (MOST_LEVELS, 1)}


def test_stiffness_of_the_elements_is_that_of_the_body(seat: SeatModel) -> None:
    body = seat.model.elastic[0]
    mesh = body.mesh
    stiffness = element_stiffness(mesh.points, mesh.cells, body.material)
    dofs = (3 * mesh.cells[:, :, None] + np.arange(3)).reshape(mesh.cells.shape[0], -1)
    rows = np.repeat(dofs, dofs.shape[1], axis=1).ravel()
    columns = np.tile(dofs, (1, dofs.shape[1])).ravel()
    whole = scipy.sparse.coo_matrix((stiffness.ravel(), (rows, columns))).tocsr()
    loop = make_loop(seat.model, alone())
    u = np.random.default_rng(1).standard_normal((mesh.points.shape[0], 3))
    expected = loop.gather(loop.product(loop.own(u)))
    assert np.abs((whole @ u.ravel()).reshape(-1, 3) - expected).max() < 1e-12 * expected.max()


def test_no_body_has_a_smaller_critical_step_than_its_elements(seat: SeatModel) -> None:
    body = seat.model.elastic[0]
    steps = element_time_steps(body.mesh, body.material)
    critical = critical_time_step(make_loop(seat.model, alone()))
    assert steps.min() <= critical < 4.0 * steps.min()


def neighbours(near: Any, cells: Ints, layers: int) -> Any:
    """The elements around some elements."""
    for _ in range(layers):
        near = np.isin(cells, cells[near]).any(axis=1)
    return near


def test_levels_keep_their_distance_and_sum_up(seat: SeatModel) -> None:
    body = seat.model.elastic[0]
    cells = body.mesh.cells
    loop = make_loop(seat.model, alone())
    whole = loop.product
    step = 0.9 * critical_time_step(loop)
    level = loop.element_levels(step, MOST_LEVELS)
    node = least_at_nodes(level, cells, body.mesh.points.shape[0])
    assert level.max() >= 1
    steps = element_time_steps(body.mesh, body.material)
    assert np.all(2.0**level * step <= np.maximum(LEVEL_MARGIN * steps, step))
    assert not level[np.isin(cells, loop.problem.nodes).any(axis=1)].any()
    for upper in range(2, int(level.max()) + 1):
        assert not np.any(neighbours(level <= upper - 2, cells, BUFFER) & (level >= upper))
    assert np.array_equal(node, [level[(cells == n).any(axis=1)].min() for n in range(node.size)])
    u = np.random.default_rng(2).standard_normal(loop.u.size)
    expected = whole(u)
    loop.set_step(step, 1, MOST_LEVELS)
    assert len(loop.levels) == level.max() + 1 and sum(loop.levels) == node.size
    assert np.abs(loop.product(u) - expected).max() < 1e-12 * np.abs(expected).max()
    # Back to one level: the loop of before.
    loop.set_step(step, 1)
    assert loop.meeting == 1
    assert np.abs(loop.product(u) - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("courant", [0.5, 0.8, 0.9, 0.95])
def test_levels_do_not_resonate(linear: SeatModel, courant: float) -> None:
    """Free vibration from noise stays bounded, and its discrete energy too.

    White noise is the worst case of that energy: it swings by a share that motion slower than the
    longest step hardly has (1e-6 in a run).
    """
    loop = make_loop(linear.model, alone())
    loop.set_step(courant * critical_time_step(loop), 1, MOST_LEVELS)
    assert loop.meeting > 1
    noise = np.random.default_rng(3).standard_normal(loop.v.size)
    loop.v[:] = noise * (loop.inverse > 0.0)
    before, energy = np.abs(loop.v).max(), energies_of(loop).elastic[0]
    for _ in range(5):
        loop.drift(100 * loop.meeting)
        assert energies_of(loop).elastic[0] == pytest.approx(energy, rel=0.02)
    assert np.abs(loop.v).max() < 30.0 * before


def test_sub_cycling_gives_the_answer_of_one_time_step(
    runs: dict[int, tuple[Loop, SeatRun]],
) -> None:
    (loop, many), (single_loop, one) = runs[MOST_LEVELS], runs[1]
    assert loop.meeting > 1 and single_loop.meeting == 1
    assert many.sphere_velocity == pytest.approx(one.sphere_velocity, rel=1e-3)
    assert many.actuator_velocity == pytest.approx(one.actuator_velocity, rel=1e-3)
    for made, its in zip(many.contacts, one.contacts, strict=True):
        assert made.force_peak == pytest.approx(its.force_peak, rel=1e-3)
    assert many.flank_impulses == pytest.approx(one.flank_impulses, rel=1e-3)
    assert many.contacts[0].end == pytest.approx(one.contacts[0].end, rel=1e-3)
    # Momentum to round-off whatever the levels; energy to what is folded while bodies touch.
    assert many.momentum_residual < 1e-11
    assert one.energy_residual < 1e-11 < many.energy_residual < LARGEST_ENERGY_RESIDUAL


def test_a_run_with_levels_goes_on_from_its_checkpoint(
    linear: SeatModel, runs: dict[int, tuple[Loop, SeatRun]], tmp_path: Path
) -> None:
    checkpoint = Checkpoint(tmp_path / "run.npz", "x", 0.0)
    with pytest.raises(CutOffError):
        stepped(linear, checkpoint=checkpoint, on_progress=cut_off)
    shares: list[float] = []
    _, resumed = stepped(
        linear, checkpoint=checkpoint, on_progress=lambda done, message: shares.append(done)
    )
    whole = runs[MOST_LEVELS][1]
    assert shares[0] > 0.4
    assert resumed.steps == whole.steps
    assert np.array_equal(resumed.rows, whole.rows)


def test_a_given_end_has_one_level(linear: SeatModel) -> None:
    design = scene(reference__element_order=1, run={"end_time": 2e-6})
    loop = make_loop(linear.model, alone())
    assert integrate(loop, linear, design).energy_residual < 1e-11
    assert loop.meeting == 1


def test_resonance_is_stepped_again_without_levels(
    runs: dict[int, tuple[Loop, SeatRun]], capsys: pytest.CaptureFixture[str]
) -> None:
    def account(made: tuple[Loop, SeatRun]) -> Account:
        return Account(len(made[0].levels), made[1].energy_residual)

    assert stable_run(lambda most: runs[most], account)[1] is runs[MOST_LEVELS][1]
    assert capsys.readouterr().err == ""

    def diverges(most: int) -> tuple[Loop, SeatRun]:
        if most > 1:
            raise DivergedError("the solution diverged at 1 s")
        return runs[1]

    assert stable_run(diverges, account)[1] is runs[1][1]
    assert "diverged at 1 s; stepping again without" in capsys.readouterr().err
    gaining = 2.0 * LARGEST_ENERGY_RESIDUAL
    made = stable_run(
        lambda most: runs[most], lambda made: replace(account(made), residual=gaining)
    )
    assert made[1] is runs[1][1]
    assert "energy residual 2e-05 with sub-cycling" in capsys.readouterr().err
