"""The loop with several threads: the solution of one, to rounding, whatever the machine gives."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.axisymmetric.system import AxisymmetricSystem
from fem_reference.axisymmetric.system import critical_time_step as axisymmetric_step
from fem_reference.common.fenicsx import alone
from fem_reference.common.groups import affinity, quota
from fem_reference.common.processes import threads_per_process
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.explicit.loop import SerialLoop
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.explicit.stiffness import DOFS_PER_THREAD, worthwhile
from fem_reference.plate_impact.axisymmetric_motion import AxisymmetricMotion
from fem_reference.plate_impact.scene import parse_scene
from fem_reference.plate_impact.studies import speed
from fem_reference.seal_seat.meshing import seat_mesh
from fem_reference.seal_seat.model import seat_model
from fem_reference.seal_seat.scene import parse_seat_scene
from fem_reference.solid.system import SolidSystem
from fem_reference.tests.conftest import STEEL, document, make_system
from fem_reference.tests.program import ROOT
from fem_reference.tests.seal_seat_scenes import seat_document

STEPS = 400

Make = Callable[[int], SerialLoop]


@pytest.fixture(scope="module")
def seat() -> Make:
    """The loop of a small seal seat: several levels, three contacts that close at once."""
    design = parse_seat_scene(seat_document(True, reference__element_order=1))
    model = seat_model(design, seat_mesh(design, 0.4)).model
    system = SolidSystem(model, alone())
    step = 0.9 * critical_time_step(SerialLoop(system, alone()))

    def make(threads: int) -> SerialLoop:
        loop = SerialLoop(system, alone(), threads)
        loop.set_step(step, 1, MOST_LEVELS)
        return loop

    return make


def stepped(make: Make, threads: int) -> SerialLoop:
    loop = make(threads)
    loop.advance(STEPS)
    return loop


def state(loop: SerialLoop) -> dict[str, Any]:
    problem = loop.problem
    return {
        "u": loop.u.copy(),
        "v": loop.v.copy(),
        "impulses": np.array([list(contact.impulse) for contact in problem.contacts]),
        "reaction": np.array(problem.state.reaction),
        "energy": np.array([energies_of(loop).total]),
        "product": loop.product(np.sin(np.arange(loop.u.size))),
    }


def agree(one: dict[str, Any], several: dict[str, Any], tolerance: float, noise: float) -> None:
    """All to the relative ``tolerance``, velocities to ``noise`` besides, m/s."""
    for name, values in one.items():
        allowed = tolerance * np.abs(values).max() + (noise if name == "v" else 0.0)
        assert np.abs(several[name] - values).max() <= allowed, name


@pytest.mark.parametrize("threads", [2, 3, 5])
def test_threads_step_as_one(seat: Make, threads: int) -> None:
    one, several = stepped(seat, 1), stepped(seat, threads)
    assert several.threads == threads and len(several.levels) > 1
    assert state(one)["impulses"].any(axis=1).all()
    assert several.divided.acting == one.divided.acting
    # Elements at nodes of two parts are there for both.
    assert 1.0 < several.divided.size / one.divided.size < 1.0 + 0.15 * threads
    # Only the supports' impulse is summed over the parts.
    for name, values in (found := state(one)).items():
        tolerance = 1e-12 if name == "reaction" else 0.0
        agree({name: values}, {name: state(several)[name]}, tolerance, 0.0)
    assert found["u"].any()


def test_threads_give_the_same_bits_every_time(seat: Make) -> None:
    agree(state(stepped(seat, 3)), state(stepped(seat, 3)), 0.0, 0.0)


def test_a_machine_with_fewer_threads_gives_the_same_bits(seat: Make, tmp_path: Path) -> None:
    code = """
import sys
import numpy as np
from fem_reference.tests import test_threads
make = test_threads.seat.__wrapped__()
np.savez(sys.argv[1], **test_threads.state(test_threads.stepped(make, 3)))
"""
    out = tmp_path / "state.npz"
    environment = {**os.environ, "OMP_THREAD_LIMIT": "1"}
    subprocess.run([sys.executable, "-c", code, str(out)], cwd=ROOT, env=environment, check=True)
    with np.load(out) as found:
        agree(state(stepped(seat, 3)), dict(found), 0.0, 0.0)


def test_axisymmetric_samples_are_those_of_one_thread(system: AxisymmetricSystem) -> None:
    rows = []
    for threads in (1, 3):
        motion = AxisymmetricMotion(system)
        motion.loop = SerialLoop(system, alone(), threads)
        motion.loop.set_step(0.9 * axisymmetric_step(system), 1, MOST_LEVELS)
        assert motion.loop.meeting > 1
        rows.append(motion.sample(20, 2 * motion.loop.meeting))
    one, three = rows
    assert np.all(one[-1, [2, 7]] > 0.0)
    assert np.all(np.abs(three - one).max(axis=0) <= 1e-12 * np.abs(one).max(axis=0))


def test_bodies_yield_with_threads_as_with_one() -> None:
    weak = {**STEEL, "yield_strength": 300e6, "hardening": 2.1e9}
    system, _ = make_system(parse_scene(document(outer__material=weak, plate__material=weak)))
    found = []
    for threads in (1, 3):
        loop = SerialLoop(system, alone(), threads)
        loop.set_step(0.9 * axisymmetric_step(system), 1, MOST_LEVELS)
        loop.advance(40 * loop.meeting)
        assert loop.problem.plastic is not None
        found.append({"u": loop.u.copy(), "work": loop.problem.plastic.work.copy()})
    assert found[0]["work"].max() > 0.0
    agree(found[0], found[1], 1e-12, 0.0)


def test_small_systems_have_one_thread(system: AxisymmetricSystem) -> None:
    assert system.inverse_mass.size < 2 * DOFS_PER_THREAD
    assert AxisymmetricMotion(system, 8).loop.threads == 1
    assert [worthwhile(8, n * DOFS_PER_THREAD) for n in (0, 1, 2, 8, 100)] == [1, 1, 2, 8, 8]


def test_cores_are_those_the_process_may_use() -> None:
    allowed = affinity()
    os.sched_setaffinity(0, {min(allowed)})
    try:
        assert threads_per_process(0, alone()) == 1
    finally:
        os.sched_setaffinity(0, allowed)
    assert threads_per_process(7, alone()) == 7


def test_control_groups_limit_the_cores(tmp_path: Path) -> None:
    assert quota(tmp_path) == np.inf
    (tmp_path / "proc/self").mkdir(parents=True)
    group = tmp_path / "sys/fs/cgroup/job/step"
    group.mkdir(parents=True)
    (tmp_path / "proc/self/cgroup").write_text("0::/job/step\n", encoding="ascii")
    (group / "cpu.max").write_text("max 100000\n", encoding="ascii")
    assert quota(tmp_path) == np.inf
    (group.parent / "cpu.max").write_text("350000 100000\n", encoding="ascii")
    assert quota(tmp_path) == 3.5
    older = tmp_path / "sys/fs/cgroup/cpu/batch"
    older.mkdir(parents=True)
    lines = "3:cpu,cpuacct:/batch\n4:memory:/\n"
    (tmp_path / "proc/self/cgroup").write_text(lines, encoding="ascii")
    (older / "cpu.cfs_period_us").write_text("100000\n", encoding="ascii")
    (older / "cpu.cfs_quota_us").write_text("-1\n", encoding="ascii")
    assert quota(tmp_path) == np.inf
    (older / "cpu.cfs_quota_us").write_text("200000\n", encoding="ascii")
    assert quota(tmp_path) == 2.0


def test_speed_is_measured_with_and_without_levels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(speed, "SECONDS", 0.01)
    design = parse_seat_scene(seat_document(True, reference__element_order=1))
    model = seat_model(design, seat_mesh(design, 0.4)).model
    whole, levels = speed.measure(model, 2, alone(), (1, MOST_LEVELS))
    assert (whole.levels, whole.threads, whole.processes) == (1, 2, 1)
    assert levels.levels > 1 and levels.bytes_per_second is None
    assert whole.dofs == 3 * sum(body.mesh.points.shape[0] for body in model.elastic)
    # The loop reads no faster than from a cache, a step is no shorter than its sums.
    assert whole.nanoseconds_per_dof_and_step > 0.02
    assert whole.bytes_per_second is not None and 0.0 < whole.bytes_per_second < 1e12
    rows = speed.table([whole, levels]).splitlines()
    assert len(rows) == 4 and all(row.count("|") == 9 for row in rows)
    assert rows[2].split("|")[6].strip() == "1.00"
