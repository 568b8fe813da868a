"""A seal seat that relaxes: limits of very slow and very fast terms, ledger, resuming."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.common.fenicsx import alone
from fem_reference.explicit.checkpoint import Checkpoint
from fem_reference.impact.run import Losses
from fem_reference.seal_seat.meshing import seat_mesh
from fem_reference.seal_seat.model import seat_model
from fem_reference.seal_seat.run import SeatRun, integrate
from fem_reference.seal_seat.scene import SeatScene, parse_seat_scene
from fem_reference.solid.mesh import TetMesh
from fem_reference.solid.system import make_loop

from .cut_off import CutOffError, cut_off
from .seal_seat_scenes import seat_document

POLYMER = seat_document()["seat"]["material"]
SLOW, FAST = 10.0, 1e-13


def seat(terms: list[dict[str, float]], softer: float = 1.0) -> SeatScene:
    """The improved design on linear elements, its modulus ``softer`` times the polymer's."""
    modulus = softer * POLYMER["youngs_modulus"]
    material = POLYMER | {"youngs_modulus": modulus, "relaxation": terms}
    if not terms:
        del material["relaxation"]
    return parse_seat_scene(
        seat_document(
            True,
            seat__material=material,
            reference__element_order=1,
            run={"end_time": 60e-6},
        )
    )


@pytest.fixture(scope="module")
def mesh() -> TetMesh:
    return seat_mesh(seat([]), 0.4)


def launch(design: SeatScene, mesh: TetMesh, **options: Any) -> SeatRun:
    model = seat_model(design, mesh)
    return integrate(make_loop(model.model, alone()), model, design, **options)


def close(run: SeatRun, other: SeatRun, rel: float) -> None:
    """Whether two launches are one."""
    assert run.sphere_velocity == pytest.approx(other.sphere_velocity, rel=rel, abs=rel)
    assert run.actuator_velocity == pytest.approx(other.actuator_velocity, rel=rel)
    for contact, its in zip(run.contacts, other.contacts, strict=True):
        assert contact.force_peak == pytest.approx(its.force_peak, rel=rel)


def relaxed(run: SeatRun) -> float:
    """Energy that the seat lost, J; what else could lose nothing did not."""
    assert run.losses is not None and run.losses.bodies is not None
    assert run.losses == Losses(contacts=(), bodies=(0.0, run.losses.bodies[1], 0.0))
    return run.losses.bodies[1]


def test_a_very_slow_term_does_nothing_and_a_very_fast_one_softens(mesh: TetMesh) -> None:
    slow = launch(seat([{"ratio": 0.3, "time": SLOW}]), mesh)
    close(slow, launch(seat([]), mesh), 1e-4)
    fast = launch(seat([{"ratio": 0.3, "time": FAST}]), mesh)
    close(fast, launch(seat([], 0.7), mesh), 2e-4)
    assert relaxed(fast) >= 0.0 and relaxed(slow) >= 0.0
    assert abs(slow.sphere_velocity[0] - fast.sphere_velocity[0]) > 0.01


def test_a_seat_loses_what_its_balance_states(mesh: TetMesh, tmp_path: Path) -> None:
    """And a run that is cut off goes on from its checkpoint as if nothing had been."""
    design = seat([{"ratio": 0.05, "time": 1e-5}, {"ratio": 0.05, "time": 1e-4}])
    whole = launch(design, mesh)
    lost = relaxed(whole) / design.initial_energy
    assert 0.02 < lost < 0.5
    assert whole.energy_residual < 2e-3 * lost + 1e-5
    assert whole.momentum_residual < 1e-11
    checkpoint = Checkpoint(tmp_path / "run.npz", "x", 0.0)
    with pytest.raises(CutOffError):
        launch(design, mesh, checkpoint=checkpoint, on_progress=cut_off)
    resumed = launch(design, mesh, checkpoint=checkpoint)
    assert np.array_equal(resumed.rows, whole.rows)
    assert relaxed(resumed) == pytest.approx(relaxed(whole), rel=1e-12)
