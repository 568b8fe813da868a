"""Impacts in series: shakedown, what each finds of those before, and going on after a kill."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from fem_reference.axisymmetric.system import AxisymmetricSystem
from fem_reference.common.errors import SceneError, SolverError
from fem_reference.common.settings import Settings
from fem_reference.plate_impact import axisymmetric
from fem_reference.plate_impact.axisymmetric import Solution, compute
from fem_reference.plate_impact.dents import Dents
from fem_reference.plate_impact.repeated import has_shaken_down
from fem_reference.plate_impact.result import of_run, quantities, write_dents
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document

ELEMENTS = 4
FEW = 2
"""Where a series is compared with itself."""


def repeated(impacts: int, spot: str = "same", elements: float = ELEMENTS, **law: Any) -> Scene:
    """Table 1's scene with 10 mm spheres of steel that yields at 600 MPa."""
    steel = {**STEEL, "yield_strength": 600e6, "hardening": 2.1e9, **law}
    materials = {f"{body}__material": steel for body in ("plate", "outer", "inner")}
    return parse_scene(
        document(
            **materials,
            series={"impacts": impacts, "sphere_spot": spot},
            reference__elements_per_contact_radius=elements,
        )
    )


def solved(scene: Scene, folder: Path, like: Solution | None = None) -> Solution:
    return compute(scene, 1.0, Settings(0.9, folder, 0.0, "test"), lambda *_: None, like)


@pytest.fixture(scope="module")
def three(tmp_path_factory: pytest.TempPathFactory) -> Solution:
    return solved(repeated(3), tmp_path_factory.mktemp("three"))


@pytest.fixture(scope="module")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> Solution:
    return solved(repeated(3, elements=FEW), tmp_path_factory.mktemp("coarse"))


def efficiencies(scene: Scene, solution: Solution) -> list[float]:
    return [of_run(scene, run)["efficiency"] for run in solution.runs]


def test_efficiency_rises_as_dents_adapt(three: Solution) -> None:
    """Against 12 elements per contact radius, found outside this program: .570 .653 .682."""
    found = efficiencies(repeated(3), three)
    np.testing.assert_allclose(found, [0.570, 0.653, 0.682], rtol=0.01)
    yielded = [run.yielded for run in three.runs]
    work = [sum(each.work) for each in yielded if each is not None]
    assert work[0] > 2.0 * work[1] > 2.0 * work[2] > 0.0
    for run in three.runs:
        assert run.energy_residual < 1e-5
        assert run.momentum_residual < 1e-9
        assert not has_shaken_down(run)
        # each begins where it is: nothing has moved yet
        np.testing.assert_allclose(run.rows[0, [0, 3, 5]], 0.0, atol=1e-12)


def test_dents_deepen_and_their_strain_lies_below_the_contacts(
    three: Solution, tmp_path: Path
) -> None:
    profiles = [run.dents for run in three.runs if run.dents is not None]
    assert [profile.shape for profile in profiles] == 3 * [(profiles[0].shape[0], 5)]
    centre = np.array([profile[0, 1:] for profile in profiles])
    assert (np.diff(centre, axis=0) < 0.0).all()
    # micrometres, beside a rim that piles up
    assert (centre < -0.5e-6).all() and (centre > -3e-6).all()
    assert (profiles[-1][-1, 1:] > -0.1e-6).all()
    write_dents(tmp_path / "dents.csv", three.runs)
    table = np.loadtxt(tmp_path / "dents.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(table[table[:, 0] == 2, 1:], profiles[1], rtol=1e-5)
    three.write_fields(tmp_path, repeated(3))
    mesh = meshio.read(tmp_path / "mesh.vtu")
    (strain,), middle = (
        mesh.cell_data["plastic_strain"],
        mesh.points[mesh.cells[0].data].mean(axis=1),
    )
    plastic = three.system.plasticity
    assert plastic is not None
    assert np.count_nonzero(strain) <= plastic.nodes.shape[0]
    # at most some per cent, deepest below the middle of a contact (Johnson 1985, ch. 6.1)
    place = middle[strain.argmax()]
    assert 0.001 < strain.max() < 0.05
    assert place[0] < 4e-4 and 0.5e-4 < abs(abs(place[1]) - 1e-3) < 5e-4


def test_every_impact_has_its_quantities(three: Solution) -> None:
    found = quantities(repeated(3), three)
    assert found["efficiency"] == found["3/efficiency"]
    assert found["1/efficiency"] == pytest.approx(efficiencies(repeated(3), three)[0], rel=1e-15)
    assert {name.split("/")[0] for name in found if "/" in name} == {"1", "2", "3"}


def test_fresh_spots_leave_the_spheres_to_yield_again(coarse: Solution, tmp_path: Path) -> None:
    fresh = solved(repeated(2, "fresh", FEW), tmp_path)
    assert fresh.runs[0].inner_velocity == coarse.runs[0].inner_velocity
    first, second = efficiencies(repeated(2, elements=FEW), fresh)
    assert first < second < efficiencies(repeated(3, elements=FEW), coarse)[1]


def test_series_ends_when_nothing_yields(tmp_path: Path) -> None:
    """2.6 GPa: the first impact already leaves nothing."""
    solution = solved(repeated(5, elements=FEW, yield_strength=2.6e9), tmp_path)
    assert len(solution.runs) == 1
    assert has_shaken_down(solution.run)


def test_killed_series_goes_on_at_the_last_finished_impact(
    coarse: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = axisymmetric._Stepper.__call__
    made: list[int] = []

    def killed(self: Any, number: int, memory: Any) -> Any:
        if number == 2 and not made.count(2):
            made.append(2)
            raise SolverError("killed")
        made.append(number)
        return step(self, number, memory)

    monkeypatch.setattr(axisymmetric._Stepper, "__call__", killed)
    with pytest.raises(SolverError, match="killed"):
        solved(repeated(3, elements=FEW), tmp_path)
    again = solved(repeated(3, elements=FEW), tmp_path)
    assert made == [0, 1, 2, 2]
    for run, other in zip(again.runs, coarse.runs, strict=True):
        assert run.energies == other.energies
        assert run.contacts == other.contacts
        assert run.yielded == other.yielded
        assert np.array_equal(run.rows, other.rows)
        assert run.dents is not None and other.dents is not None
        assert np.array_equal(run.dents, other.dents)
    # another scene finds nothing here
    made.clear()
    assert len(solved(repeated(1, "fresh", FEW), tmp_path).runs) == 1
    assert made[0] == 0


def test_killed_series_goes_on_though_its_first_mesh_was_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each mesh tried keeps its own impacts; the first is refused at the second impact here."""
    step = axisymmetric._Stepper.__call__
    made: list[tuple[int, int]] = []

    def elements(system: AxisymmetricSystem) -> int:
        assert system.plasticity is not None
        return int(system.plasticity.nodes.shape[0])

    def killed(self: Any, number: int, memory: Any) -> Any:
        made.append((elements(self.system), number))
        if len(made) == 4:
            raise SolverError("killed")
        return step(self, number, memory)

    def refused(self: Any) -> bool:
        return made[-1] == (made[0][0], 1)

    monkeypatch.setattr(axisymmetric._Stepper, "__call__", killed)
    monkeypatch.setattr(Dents, "reach_the_edge", refused)
    with pytest.raises(SolverError, match="killed"):
        solved(repeated(2, elements=2), tmp_path)
    assert len(solved(repeated(2, elements=2), tmp_path).runs) == 2
    first, second = made[0][0], made[2][0]
    assert first < second
    assert made[:4] == [(first, 0), (first, 1), (second, 0), (second, 1)]
    assert made[4:] == [(first, 1), (second, 1)]


def test_impacts_are_not_a_fraction() -> None:
    with pytest.raises(SceneError, match=r"series\.impacts is 2\.5; .* whole"):
        repeated(2.5)  # type: ignore[arg-type]


def test_series_of_a_coarser_mesh_has_as_many_impacts(coarse: Solution, tmp_path: Path) -> None:
    scene = repeated(9, elements=FEW)
    coarser = compute(scene, 0.7, Settings(0.9, tmp_path, 0.0, "test"), lambda *_: None, coarse)
    assert len(coarser.runs) == 3
    for run, leading in zip(coarser.runs, coarse.runs, strict=True):
        assert run.times[-1] == pytest.approx(leading.times[-1], rel=1e-12)


def test_solid_geometry_has_no_series() -> None:
    with pytest.raises(SceneError, match="series is given"):
        parse_scene(
            document(series={"impacts": 3, "sphere_spot": "same"}, reference__geometry="solid")
        )
