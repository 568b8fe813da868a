"""A scene on a series of meshes: bands, refinement towards a target, what is kept."""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fem_reference.common.errors import SceneError, SolverError
from fem_reference.common.output import result_folder
from fem_reference.common.progress import MeshOfSeries, Progress, Report
from fem_reference.common.settings import Options, Settings
from fem_reference.impact import series
from fem_reference.impact.series import MeshResult, MeshSolver, Target, solve_series

EXACT = 3.0
VALUE = (Target("value"),)
LARGE = 5.0
"""Factor beyond which the leading mesh of `Convergent` differs in what the others depend on."""


class Alone:
    """The communicator of one process, without MPI."""

    rank, size = 0, 1

    def barrier(self) -> None:
        """Nobody to wait for."""

    def bcast(self, value: Any) -> Any:
        """Nobody to tell."""
        return value


class Convergent:
    """A method of known order; keeps the factors that were requested."""

    def __init__(
        self, order: float, leads: bool = False, revision: int = 1, cut: bool = False
    ) -> None:
        self.order, self.leads, self.revision, self.cut = order, leads, revision, cut
        self.led_by: list[float | None] = []
        self.factors: list[float] = []
        self.meshes: list[MeshResult] = []

    def compute(self, factor: float, settings: Settings, report: Report, lead: Any) -> Any:
        """A value whose error falls with the order."""
        assert settings.courant == 0.5
        self.factors.append(factor)
        report("mesh", 0.0, "meshing")
        for done in (0.0, 0.5, 1.0):
            report("stepping", done, "half")
        row = np.full((3, 1), EXACT + 0.1 * factor**-self.order)
        run = SimpleNamespace(
            times=np.arange(3.0),
            rows=row,
            steps=2,
            loop_seconds=0.0,
            energy_residual=0.0,
            in_contact_at_end=self.cut,
        )
        self.led_by.append(lead.factor if lead is not None else None)
        return SimpleNamespace(run=run, dofs=21, factor=factor)

    def write(self, folder: Path, solution: Any, meshes: list[MeshResult]) -> None:
        """The finest value."""
        self.meshes = meshes
        np.savetxt(folder / "value.txt", solution.run.rows)

    def solver(self) -> MeshSolver[Any]:
        """To be solved on meshes."""
        return MeshSolver(
            method=[self.revision, {"scene": 1}],
            end_time=2.0,
            ratio=0.8,
            targeted=VALUE,
            compute=self.compute,
            quantities=lambda solution: {"value": float(solution.run.rows[0, 0])},
            dimension=2 if self.leads else 3,
            leads=(lambda solution: [solution.factor > LARGE]) if self.leads else None,
        )


@pytest.fixture
def solve(tmp_path: Path) -> Callable[..., Convergent]:
    def solve(
        order: float = 2.0,
        leads: bool = False,
        revision: int = 1,
        cut: bool = False,
        **options: Any,
    ) -> Convergent:
        method = Convergent(order, leads, revision, cut)
        requested = Options(courant=0.5, checkpoint=tmp_path / "kept", **options)
        solve_series(method.solver(), method.write, tmp_path / "out", 1.0, Alone(), requested)
        return method

    return solve


def test_the_band_holds_the_error_and_the_extrapolation_removes_it(
    solve: Callable[..., Convergent],
) -> None:
    found = series.estimates(solve(1.5).meshes)["value"]
    assert found.extrapolated == pytest.approx(EXACT, abs=1e-5)
    assert 0.1 <= found.band <= 0.11


def test_a_run_cut_during_a_contact_has_no_band_to_refine_to(
    solve: Callable[..., Convergent],
) -> None:
    solve(cut=True)
    with pytest.raises(SceneError, match=r"run\.end_time"):
        solve(cut=True, target_error=0.02)


def test_refinement_ends_as_soon_as_the_target_is_met(
    solve: Callable[..., Convergent], tmp_path: Path
) -> None:
    target = 0.02
    method = solve(target_error=target)
    assert series.relative_error(method.meshes, VALUE) <= target
    # Every mesh once, the coarsest first.
    assert len(set(method.factors)) == len(method.factors)
    assert method.factors == sorted(method.factors)
    factors = [mesh.factor for mesh in method.meshes]
    assert factors == pytest.approx([factors[0] * 0.8**k for k in range(series.MESHES)])
    written = np.loadtxt(tmp_path / "out" / "value.txt")
    assert written[0] == pytest.approx(EXACT + 0.1 * factors[0] ** -2.0)


@pytest.mark.parametrize("target", [0.03, 0.02, 0.01])
@pytest.mark.parametrize("order", [1.5, 2.0])
def test_refinement_stops_at_the_first_mesh_that_is_fine_enough(
    solve: Callable[..., Convergent], order: float, target: float
) -> None:
    meshes = solve(order, target_error=target).meshes
    assert series.relative_error(meshes, VALUE) <= target
    coarser = [0.8 * mesh.factor for mesh in meshes]
    values = {factor: {"value": EXACT + 0.1 * factor**-order} for factor in coarser}
    before = [MeshResult(f, v, np.zeros(1), np.zeros(1), {}) for f, v in values.items()]
    assert series.relative_error(before, VALUE) > target


def test_what_passes_on_little_of_the_impact_needs_not_be_known_to_more_digits() -> None:
    values = [{"force": 100.0, "minor": value} for value in (1.0, 1.4, 0.8, 1.3, 0.7)]
    meshes = [MeshResult(0.8**k, row, np.zeros(1), np.zeros(1), {}) for k, row in enumerate(values)]
    band = series.estimates(meshes)["minor"].band
    alone = series.relative_error(meshes, (Target("minor"),))
    with_minor = series.relative_error(meshes, (Target("minor", small=0.05, of="force"),))
    assert (alone, with_minor) == pytest.approx((band, band / 5.0))
    assert Target("minor", small=0.005, of="force").scale(values[0]) == 1.0


def test_a_mesh_that_is_fine_enough_is_not_refined(solve: Callable[..., Convergent]) -> None:
    assert max(solve(target_error=0.1).factors) == 1.0


def test_where_the_finest_mesh_leads_it_comes_first(
    solve: Callable[..., Convergent], tmp_path: Path
) -> None:
    method = solve(leads=True)
    assert method.factors == sorted(method.factors, reverse=True)
    assert [mesh.factor for mesh in method.meshes] == method.factors
    assert method.led_by == [None, 1.0, 1.0, 1.0, 1.0]
    # What one leading mesh has found is of use under another one that agrees with it.
    with pytest.raises(SolverError):
        solve(leads=True, target_error=1e-5)
    stored = sorted(path.stem for path in (tmp_path / "kept").glob("mesh*.json"))
    assert len(stored) > series.MESHES
    assert solve(leads=True).factors == [1.0]


def test_a_target_out_of_reach_is_an_error_and_leaves_no_result(
    solve: Callable[..., Convergent], tmp_path: Path
) -> None:
    with pytest.raises(SolverError, match="1e-05 is requested"):
        solve(target_error=1e-5)
    assert not (tmp_path / "out").exists()
    with pytest.raises(SceneError, match="--target-error is 2"):
        solve(target_error=2.0)
    with pytest.raises(SceneError, match="--stress-at is 3 s"):
        solve(stress_times=(3.0,))


def test_meshes_of_a_failed_series_are_used_by_the_same_method_only(
    solve: Callable[..., Convergent],
) -> None:
    with pytest.raises(SolverError):
        solve(target_error=1e-5)
    # Only the finest is run again: its state at the end is what the result is written from.
    assert solve().factors == [1.0]
    with pytest.raises(SolverError):
        solve(target_error=1e-5)
    assert len(solve(revision=2).factors) == series.MESHES


def test_a_stored_mesh_that_was_edited_is_solved_again(
    solve: Callable[..., Convergent], tmp_path: Path
) -> None:
    with pytest.raises(SolverError):
        solve(target_error=1e-5)
    stored = tmp_path / "kept" / "mesh+1.json"
    text = stored.read_text(encoding="utf-8")
    value = json.loads(text)["quantities"]["value"]
    stored.write_text(text.replace(repr(value), repr(value + 0.1)), encoding="utf-8")
    method = solve()
    assert len(method.factors) == 2
    assert value in {mesh.values["value"] for mesh in method.meshes}
    with pytest.raises(SolverError):
        solve(target_error=1e-5)
    curves = stored.with_name(f"{stored.stem}-curves.npz")
    curves.write_bytes(curves.read_bytes()[:-20])
    assert len(solve().factors) == 2


def test_meshes_are_reported_as_one_series(tmp_path: Path) -> None:
    stream = io.StringIO()
    method = Convergent(2.0)
    options = Options(courant=0.5)
    solve_series(
        method.solver(), method.write, tmp_path / "out", 1.0, Alone(), options, Progress(stream)
    )
    lines = [json.loads(line) for line in stream.getvalue().splitlines()]
    ends = [line for line in lines if line["phase"] == "stepping" and line["done"] == 1.0]
    assert [line["message"] for line in ends] == [f"mesh {k} of 5: half" for k in range(1, 6)]
    # What a mesh adds is what its degrees of freedom and steps cost: coarse ones little.
    costs = np.array(method.factors) ** 4
    expected = np.cumsum(costs) / costs.sum()
    assert [line["series"] for line in ends] == pytest.approx(expected, abs=1e-4)
    shares = [line["series"] for line in lines]
    assert shares == sorted(shares) and shares[-1] == 1.0


def test_a_mesh_made_again_does_not_turn_the_series_back() -> None:
    stream = io.StringIO()
    mesh = MeshOfSeries(Progress(stream), 2, [1.0, 3.0])
    for phase, done in (("mesh", 0.0), ("stepping", 1.0), ("mesh", 0.0), ("stepping", 0.2)):
        mesh.report(phase, done, "")
    shares = [json.loads(line)["series"] for line in stream.getvalue().splitlines()]
    assert shares == [0.25, 1.0, 1.0, 1.0]


def test_a_full_disk_is_found_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = shutil.disk_usage(tmp_path)._replace(free=20_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: left)
    full = pytest.raises(SolverError, match=r"has 20 MB left; .* need 100 MB")
    with full, result_folder(tmp_path / "deep" / "result"):
        pytest.fail("the work began")
    assert not any((tmp_path / "deep").iterdir())
