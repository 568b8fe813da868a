"""CalculiX as the second program: its decks, its runs, what is read of them, and how it fails."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.axisymmetric.mesh import BodyMesh
from fem_reference.axisymmetric.meshing import mesh_plate
from fem_reference.axisymmetric.sizes import MeshSettings
from fem_reference.calculix import program
from fem_reference.calculix.contacts import contact_end, impulses
from fem_reference.calculix.deck import MILLI, Deck, Steps
from fem_reference.calculix.printed import Printed, frequencies
from fem_reference.calculix.wedge import SHARE, quadratic, wedge, wedge_part
from fem_reference.common.arrays import Floats
from fem_reference.common.bodies import Edge, Plate
from fem_reference.common.errors import SceneError, SolverError
from fem_reference.common.settings import Options, Settings
from fem_reference.plate_impact import calculix
from fem_reference.plate_impact.calculix_model import model, require_supported
from fem_reference.plate_impact.estimate import estimate_contact
from fem_reference.plate_impact.meshing import mesh_impact, mesh_settings
from fem_reference.plate_impact.result import of_run
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document, solve_once


def small(**changes: Any) -> Scene:
    """A small plate hit hard: about 60 steps of some hundred nodes."""
    requested = {"geometry": "axisymmetric", "elements_per_contact_radius": 8}
    sizes = {"plate__radius": 0.012, "outer__radius": 0.005, "inner__radius": 0.005}
    return parse_scene(
        document(**{"reference": requested, **sizes, "outer__speed": 2.0, **changes})
    )


def solved(scene: Scene, folder: Path, factor: float) -> calculix.Solution:
    settings = Settings(0.9, folder, 0.0, "test")
    return calculix.compute(scene, factor, settings, lambda phase, done, message: None)


def test_a_ring_of_quadratic_elements_has_its_volume_and_weights_its_nodes() -> None:
    points = np.array([[1.0, 0.0], [2.0, 0.0], [2.0, 3.0], [1.0, 3.0]])
    plane = quadratic(BodyMesh("ring", points, np.array([[0, 1, 2, 3]])))
    volumes = plane.nodal_volumes()
    assert volumes.sum() == pytest.approx(math.pi * 3.0 * (4.0 - 1.0), rel=1e-13)
    assert volumes @ plane.points[:, 1] / volumes.sum() == pytest.approx(1.5, rel=1e-13)


@pytest.mark.calculix
def test_the_deck_has_the_masses_of_spheres_and_plate(tmp_path: Path) -> None:
    """CalculiX's own mass of the wedges against closed forms."""
    scene = small()
    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius)
    made = model(scene, mesh_impact(scene, mesh_settings(scene, *radii, 0.15)))
    deck = made.deck.impact(Steps(1e-9, 1e-9, -0.05)).replace("ELSE,ELKE", "EMAS")
    text = program.run(deck, tmp_path / "job", lambda _: False).read_text()
    printed = re.findall(r" total mass for set E(\w+) and time[^\n]*\n\s*(\S+)", text)
    found = {name: 1e-3 * float(mass) / SHARE for name, mass in printed}
    plate = scene.plate
    volume = math.pi * plate.radius**2 * plate.thickness
    assert found["PLATE"] == pytest.approx(plate.material.density * volume, rel=1e-6)
    assert found["OUTER"] == pytest.approx(scene.outer.mass, rel=2e-4)
    assert found["INNER"] == pytest.approx(scene.inner.mass, rel=2e-4)
    assert made.masses == pytest.approx([found[n] for n in ("OUTER", "PLATE", "INNER")], rel=1e-4)


@pytest.mark.calculix
@pytest.mark.parametrize(("edge", "eigenvalue"), [("clamped", 10.2158), ("free", 9.0031)])
def test_a_thin_plate_vibrates_as_in_kirchhoffs_theory(
    tmp_path: Path, edge: Edge, eigenvalue: float
) -> None:
    """Lowest axisymmetric mode, omega R^2 sqrt(rho h / D) of a Kirchhoff plate with nu = 0.3."""
    steel = parse_scene(document()).plate.material
    plate = Plate(0.04, 0.0008, edge, steel)
    mesh = mesh_plate(plate, MeshSettings(0.0008, 1, 0.0008, 0.0004, 1.0, 1.0))
    plane = quadratic(mesh)
    rim = np.flatnonzero(plane.points[:, 0] > plate.radius * (1.0 - 1e-9))
    fixed = rim if edge == "clamped" else np.zeros(0, dtype=np.int64)
    deck = Deck([wedge_part("PLATE", wedge(plane, 1, 1), steel, fixed, fixed)])
    ran = program.run(deck.modes(2), tmp_path / "job", lambda _: False)
    found = MILLI * frequencies(ran)[1 if edge == "free" else 0]
    exact = eigenvalue / (2.0 * math.pi * plate.radius**2)
    exact *= math.sqrt(plate.bending_stiffness / plate.surface_density)
    # Shear and rotary inertia, which Kirchhoff leaves out, lower it by some (h/R)^2.
    assert found == pytest.approx(exact, rel=2e-3)


@pytest.mark.calculix
@pytest.mark.evidence
def test_a_coarse_impact_keeps_its_balances_and_agrees_with_explicit_elements(
    tmp_path: Path,
) -> None:
    scene = small()
    run = solved(scene, tmp_path, 0.6).run
    # Impulses from CalculiX's contact forces, momenta from its velocities.
    assert run.momentum_residual < 3e-4
    assert run.energy_residual < 3e-3
    assert not run.in_contact_at_end
    explicit = of_run(scene, solve_once(small(reference__elements_per_contact_radius=6)).run)
    found = of_run(scene, run)
    # One quadratic element per contact radius: the meshes of a real series begin where this ends.
    for name in set(found) - {"outer_velocity_final"}:
        assert found[name] == pytest.approx(explicit[name], rel=0.02), name
    assert found["outer_velocity_final"] == pytest.approx(
        explicit["outer_velocity_final"], abs=0.005 * scene.speed
    )


@pytest.mark.calculix
def test_the_momentum_of_a_free_plate_and_both_spheres_lasts(tmp_path: Path) -> None:
    scene = small(plate__edge="free", run={"end_time": 1.2e-5}, inner__gap=1e-6)
    solution = solved(scene, tmp_path, 0.3)
    assert solution.run.times[-1] == pytest.approx(1.2e-5, rel=1e-6)
    assert solution.run.contacts[1].force_peak > 0.0
    # What acts on all bodies together, which nothing supports.
    assert abs(solution.run.support_impulse) < 3e-4 * scene.outer.mass * scene.speed


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"friction": 0.3}, "friction is 0.3; it must be 0"),
        ({"plate__damping_ratio": 0.01}, "plate.damping_ratio is 0.01; it must be 0"),
        ({"series": {"impacts": 2, "sphere_spot": "same"}}, "series is given"),
        (
            {"inner": {"kind": "compact", "mass": 0.01, "tip_radius": 0.01, "material": STEEL,
                       "gap": 0.0}},
            "inner.kind is 'compact'; it must be 'sphere'",
        ),
        (
            {"plate__material": {**STEEL, "relaxation": [{"ratio": 0.1, "time": 1e-5}]}},
            "plate.material.relaxation is given",
        ),
        (
            {"outer__material": {**STEEL, "yield_strength": 1e9, "hardening": 0.0}},
            "a material yields",
        ),
        ({"reference__geometry": "solid"}, "reference.geometry is 'solid'"),
    ],
)  # fmt: skip
def test_what_the_deck_does_not_describe_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=re.escape(message)):
        require_supported(parse_scene(document(**changes)), Options(solver="calculix"))


def test_fields_are_refused_and_a_dry_elastic_scene_is_not() -> None:
    scene = parse_scene(document())
    require_supported(scene, Options(solver="calculix"))
    with pytest.raises(SceneError, match="fields are requested"):
        require_supported(scene, Options(stress_times=(1e-6,), solver="calculix"))


def pretended(folder: Path, monkeypatch: pytest.MonkeyPatch, does: str) -> None:
    """A program in CalculiX's place."""
    script = folder / "ccx"
    script.write_text(f'#!/bin/sh\n[ "$1" = -v ] && echo "This is Version 2.20" && exit\n{does}\n')
    script.chmod(0o755)
    monkeypatch.setenv(program.VARIABLE, str(script))


@pytest.mark.parametrize(
    ("does", "message"),
    [
        (
            'printf " actual total time=1.2e-3\\n *ERROR: solution seems to diverge;\\n        '
            'program stops\\n"; exit 201',
            r"status 201 at 0.0012 ms: \*ERROR: solution seems to diverge; program stops",
        ),
        ("kill -9 $$", r"ended by signal 9 \(SIGKILL\)"),
        ("exit 1", "status 1: it did not say why"),
    ],
)
def test_a_run_that_fails_states_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, does: str, message: str
) -> None:
    pretended(tmp_path, monkeypatch, does)
    assert program.version() == "2.20"
    with pytest.raises(SolverError, match=message):
        program.run("", tmp_path / "job", lambda _: False)


def test_a_run_that_prints_no_more_is_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pretended(tmp_path, monkeypatch, "exec sleep 60")
    monkeypatch.setattr(program, "STALLED", 0.5)
    with pytest.raises(SolverError, match=r"printed nothing new for 0\.5 s"):
        program.run("", tmp_path / "job", lambda _: False)


def test_a_missing_or_old_program_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(program.VARIABLE, str(tmp_path / "nowhere"))
    with pytest.raises(SolverError, match="is missing; on Debian `sudo apt-get install calculix"):
        program.version()
    pretended(tmp_path, monkeypatch, "")
    (tmp_path / "ccx").write_text("#!/bin/sh\necho This is Version 2.11\n")
    with pytest.raises(SolverError, match=r"is CalculiX 2\.11; at least 2\.18"):
        program.version()


BLOCKS = """
 displacements (vx,vy,vz) for set OOUTER and time  0.1000000E-02

        17  0.000000E+00  0.000000E+00  {u}

 total kinetic energy for set EOUTER and time  0.1000000E-02

        4.426022E-03

 statistics for slave set SOUTER, master set MOUTER and time  0.1000000E-02

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

   -5.4E-04 -9.5E-06  1.219698E-01  1.3E-04 -7.4E-03  9.0E-16

   center of gravity and mean normal

             NaN           NaN           NaN           NaN           NaN           NaN
"""


def test_what_is_printed_is_read_as_it_comes(tmp_path: Path) -> None:
    path = tmp_path / "job.dat"
    first = BLOCKS.format(u="-4.391813E-08")
    second = first.replace("0.1000000E-02", "0.2000000E-02")
    printed = Printed(path)
    assert printed.advance() == 0
    for upto in range(0, len(first + second), 50):
        path.write_text((first + second)[:upto])
        assert printed.advance() == int(upto > len(first) + 150)
    path.write_text(first + second)
    assert printed.advance(to_the_end=True) == 2
    assert printed.curve("displacements", "OOUTER") == pytest.approx([-4.391813e-8] * 2)
    assert printed.curve("kinetic", "EOUTER", 1) == pytest.approx([4.426022e-3])
    assert printed.table("force", "SOUTER")[:, 2] == pytest.approx([0.1219698] * 2)


def test_a_value_that_is_no_number_is_divergence(tmp_path: Path) -> None:
    path = tmp_path / "job.dat"
    path.write_text(BLOCKS.format(u="NaN"))
    with pytest.raises(SolverError, match="CalculiX diverged"):
        Printed(path).advance()


def test_the_end_of_a_contact_lies_between_its_samples() -> None:
    """Of a force like (t_end - t)^1.5, whatever the samples."""
    for step in (0.9e-6, 1.0e-6, 1.3e-6):
        times: Floats = step * np.arange(60.0)
        force: Floats = np.maximum(3.07e-5 - times, 0.0) ** 1.5
        force[:3] = 0.0
        assert contact_end(times, force) == pytest.approx(3.07e-5, rel=1e-9)
    assert contact_end(times, np.zeros(60)) is None


def test_impulses_are_those_of_the_implicit_steps() -> None:
    """A constant force: from the second step on it counts in full."""
    gained = impulses(np.full((5, 1), 2.0), 0.1)[:, 0]
    assert np.diff(gained)[1:] == pytest.approx([0.2] * 3)
