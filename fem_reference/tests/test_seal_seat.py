"""The seal seat: mesh against the CAD model, contact geometry, ledgers, symmetry, resuming."""

from __future__ import annotations

import dataclasses
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.integrate

from fem_reference.common.arrays import Floats
from fem_reference.common.errors import SceneError, SolverError
from fem_reference.common.fenicsx import alone
from fem_reference.explicit.checkpoint import Checkpoint
from fem_reference.explicit.contact import SphereContact
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.impact.history import Sampling, columns, history
from fem_reference.seal_seat.meshing import seat_mesh, sphere_mesh
from fem_reference.seal_seat.modal import seat_modes
from fem_reference.seal_seat.model import ELASTIC_SPHERE, LEFT, RIGHT, SeatModel, seat_model
from fem_reference.seal_seat.motion import sphere_motion
from fem_reference.seal_seat.run import SeatRun, integrate
from fem_reference.seal_seat.scene import SeatScene, parse_seat_scene
from fem_reference.seal_seat.solve import CURVES, QUANTITIES, seat_frequency
from fem_reference.solid.mesh import TetMesh, surface
from fem_reference.solid.sphere_pairs import sphere_pairs
from fem_reference.solid.system import make_loop
from fem_reference.tests.cut_off import CutOffError, cut_off
from fem_reference.tests.program import run_program
from fem_reference.tests.seal_seat_scenes import DEGREE, seat_document


def scene(improved: bool = False, **changes: Any) -> SeatScene:
    return parse_seat_scene(seat_document(improved, **changes))


@pytest.fixture(scope="module")
def coarse() -> SeatModel:
    """A quadratic mesh of the improved design."""
    design = scene(True)
    return seat_model(design, seat_mesh(design, 0.45))


def launch(design: SeatScene, mesh: TetMesh, **options: Any) -> SeatRun:
    model = seat_model(design, mesh)
    return integrate(make_loop(model.model, alone()), model, design, **options)


@pytest.fixture(scope="module")
def launches() -> dict[bool, SeatRun]:
    """Both designs on linear elements, until no further contact is possible; one time step."""
    designs = {improved: scene(improved, reference__element_order=1) for improved in (False, True)}
    return {
        improved: launch(design, seat_mesh(design, 0.5), most_levels=1)
        for improved, design in designs.items()
    }


def test_nodes_of_the_ring_lie_on_the_sphere_and_nothing_penetrates(coarse: SeatModel) -> None:
    design = scene(True)
    ring, radius = design.ring(), design.sphere_radius
    in_contact = 0
    for contact, patch in zip(coarse.model.contacts[:2], coarse.patches[:2], strict=True):
        assert isinstance(contact, SphereContact) and contact.places is not None
        away = contact.places - np.array(ring.sphere_centre)
        gap = np.linalg.norm(away, axis=1) - radius
        on_ring = patch.distances < 1e-9 * radius
        assert np.abs(gap[on_ring]).max() < 1e-9 * radius
        assert gap.min() > -1e-12
        # The tangent cone: the gap grows with the square of the distance from the ring.
        expected = np.hypot(radius, patch.distances) - radius
        assert np.allclose(gap, expected, atol=1e-9 * radius)
        in_contact += int(np.count_nonzero(on_ring))
        # Normals are those of the sphere where it touches.
        normals = -away[on_ring] / radius
        assert np.allclose(patch.normals[on_ring], normals, atol=1e-9)
    # Corners and midside nodes of a half circle of edges.
    assert in_contact >= 13
    # The mesh itself has the midside nodes inside the cone by more than the contact yields.
    chord = ring.distance(coarse.mesh.points[coarse.model.contacts[RIGHT].nodes])
    assert chord.max() > 0.0 and np.any((chord > 1e-6) & (chord < 1e-4))


def test_supports_are_the_rim_and_the_plane_of_symmetry(coarse: SeatModel) -> None:
    body = coarse.model.elastic[0]
    nodes, direction = np.divmod(body.fixed, 3)
    place = body.mesh.points[nodes]
    rim = np.hypot(place[:, 0], place[:, 1]) > 0.97 * 8e-3
    symmetric = np.abs(place[:, 1]) == 0.0
    assert np.all(rim | (symmetric & (direction == 1)))
    x_fixed = direction == 0
    # A half rim of the membrane: all around, from its lower to its upper face.
    angles = np.arctan2(place[x_fixed, 1], place[x_fixed, 0])
    assert angles.min() == 0.0 and angles.max() == pytest.approx(math.pi)
    assert {0.0, 0.5e-3} <= set(np.round(place[x_fixed, 2], 12))
    flat = body.mesh.points[:, 1] == 0.0
    assert np.all(np.isin(3 * np.flatnonzero(flat) + 1, body.fixed))


def test_rigid_motions_cost_no_force(coarse: SeatModel) -> None:
    loop = make_loop(coarse.model, alone())
    x, y, z = coarse.mesh.points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    for motion in ((one, zero, zero), (zero, zero, one), (-y, x, zero), (z, zero, -x)):
        u = loop.own(np.stack(motion, axis=1))
        force = loop.product(u)
        assert np.abs(force).max() < 1e-11 * loop.diagonal.max() * np.abs(u).max()


def test_the_initial_design_misses_and_the_improved_one_hits(launches: dict[bool, SeatRun]) -> None:
    angles = {}
    for improved, run in launches.items():
        x, z = run.sphere_velocity
        angles[improved] = math.degrees(math.atan2(x, z))
        assert z > 0.5
        # The seat throws the sphere up and takes the actuator's speed.
        assert run.actuator_velocity < 0.0
        assert not run.in_contact_at_end
    # Linear elements, coarse: some degrees off, but the sense is clear.
    assert angles[False] < -4.0 and abs(angles[True] - 15.0) < 5.0


def test_balances_close(launches: dict[bool, SeatRun]) -> None:
    for run in launches.values():
        assert run.energy_residual < 1e-11
        assert run.momentum_residual < 1e-11
        # Closing a gap is a plastic impact of a node: it takes energy, little.
        assert 0.0 < run.contact_loss < 1e-3
        assert run.unconverged == 0


def test_impulses_on_the_flanks_launch_the_sphere(launches: dict[bool, SeatRun]) -> None:
    design = scene()
    ring = design.ring()
    for run in launches.values():
        x, z = run.sphere_velocity
        along = design.sphere_mass * (x * ring.axis[0] + z * ring.axis[2])
        # Every normal of the cone has the component sin(gamma / 2) along the axis.
        pressed = math.sin(ring.half_angle) * sum(run.flank_impulses)
        # Not more: the sphere slides a little up the flanks, and its normals turn.
        assert along == pytest.approx(pressed, rel=0.02)
        columns = run.rows[-1]
        assert columns[4] == pytest.approx(design.sphere_mass * x, rel=1e-9)
        assert columns[5] == pytest.approx(design.sphere_mass * z, rel=1e-9)
        assert columns[8] == pytest.approx(
            design.actuator.mass * (1.0 - run.actuator_velocity), rel=1e-9
        )


def test_history_is_consistent_with_itself(launches: dict[bool, SeatRun]) -> None:
    design = scene()
    run = launches[True]
    times = np.linspace(0.0, run.times[-1], 1001)
    table = history(CURVES, run, Sampling(times, times, times, times[1]).of_others())
    force, fx, fz = table[:, 5], table[:, 6], table[:, 7]
    assert np.allclose(force, np.hypot(fx, fz))
    for column, axis in ((fx, 0), (fz, 1)):
        gained = scipy.integrate.trapezoid(column, times)
        assert gained == pytest.approx(design.sphere_mass * run.sphere_velocity[axis], rel=1e-3)
    assert table[-1, 9] == pytest.approx(run.actuator_velocity, rel=1e-6)
    # After the end of the run bodies fly on.
    twice = 2.0 * times
    later = history(CURVES, run, Sampling(twice, twice, twice, twice[1]).of_others())
    flown = later[-1, 2] - table[-1, 2]
    assert flown == pytest.approx(run.sphere_velocity[1] * run.times[-1], rel=1e-6)


def mirrored(seat: SeatModel) -> SeatModel:
    """The same model at x -> -x."""
    flip = np.array([-1.0, 1.0, 1.0])
    body = seat.model.elastic[0]
    cells = body.mesh.cells.copy()
    # Exchanging two corners keeps the volumes positive; midside nodes go with their edges.
    cells[:, [0, 1]] = cells[:, [1, 0]]
    cells[:, [5, 6]] = cells[:, [6, 5]]
    cells[:, [7, 8]] = cells[:, [8, 7]]
    mesh = TetMesh(body.mesh.name, body.mesh.points * flip, cells)
    contacts = []
    for contact in seat.model.contacts:
        assert isinstance(contact, SphereContact)
        x, y, z = contact.centre
        places = None if contact.places is None else contact.places * flip
        contacts.append(dataclasses.replace(contact, centre=(-x, y, z), places=places))
    model = dataclasses.replace(
        seat.model, elastic=(dataclasses.replace(body, mesh=mesh),), contacts=tuple(contacts)
    )
    return SeatModel(model, seat.patches)


def test_a_mirrored_seat_throws_the_sphere_the_other_way(coarse: SeatModel) -> None:
    states = []
    for seat in (coarse, mirrored(coarse)):
        loop = make_loop(seat.model, alone())
        loop.set_step(0.8 * critical_time_step(loop), 1)
        loop.advance(1500)
        sphere, actuator = loop.problem.rigids
        states.append([*sphere.v, actuator.v[2], *sphere.u])
    first, second = np.array(states)
    assert abs(first[0]) > 1e-3 and first[2] > 0.1
    assert np.allclose(second, first * [-1, 1, 1, 1, -1, 1, 1], rtol=1e-6, atol=1e-12)


def test_a_run_that_is_cut_off_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    design = scene(True, reference__element_order=1, run={"end_time": 16e-6})
    mesh = seat_mesh(design, 0.4)
    whole = launch(design, mesh)

    checkpoint = Checkpoint(tmp_path / "run.npz", "x", 0.0)
    with pytest.raises(CutOffError):
        launch(design, mesh, checkpoint=checkpoint, on_progress=cut_off)
    assert checkpoint.path.is_file()
    first = []
    resumed = launch(
        design, mesh, checkpoint=checkpoint, on_progress=lambda done, message: first.append(done)
    )
    # It did go on from there.
    assert first[0] > 0.4
    assert resumed.steps == whole.steps and resumed.sphere_velocity == whole.sphere_velocity
    assert resumed.flank_impulses == whole.flank_impulses
    assert np.array_equal(resumed.rows, whole.rows)


def test_a_mesh_of_another_seat_is_refused(coarse: SeatModel) -> None:
    with pytest.raises(SolverError, match="cone around its contact ring"):
        seat_model(scene(True, seat__tilt=20.0 * DEGREE), coarse.mesh)
    with pytest.raises(SolverError, match="rim of its membrane"):
        seat_model(scene(True, seat__membrane_radius=9e-3), coarse.mesh)


def test_a_field_that_is_not_understood_is_named() -> None:
    for changes, words in (
        ({"seat__tilt": "15 deg"}, 'seat.tilt is "15 deg"; it must be a finite number'),
        ({"actuator__tip_positions": 0.0}, "actuator.tip_positions must be a list, not 0.0"),
        ({"actuator__tip_positions": [True]}, "actuator.tip_positions[0] is true"),
        ({"sphere__body": "soft"}, "sphere.body"),
        ({"reference__element_order": 3}, "reference.element_order is 3"),
        ({"seat__colour": 1}, "seat.colour is not a known field"),
    ):
        with pytest.raises(SceneError, match=re.escape(words)):
            scene(**changes)


def test_the_result_folder_is_complete(tmp_path: Path) -> None:
    document = seat_document(run={"end_time": 3e-6}, reference__element_order=1)
    document["reference"]["elements_per_ring_radius"] = 4.0
    path, out = tmp_path / "scene.json", tmp_path / "result"
    path.write_text(json.dumps(document), encoding="utf-8")
    done = run_program(
        "solve", "--scene", path, "--out", out, "--resolution", "coarse", "--fields", "2"
    )
    assert done.returncode == 0, done.stderr
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    # Cut during the contact: nothing of the impact is determined.
    assert summary["in_contact_at_end"] and set(summary["uncertainty"]) == {"first_frequency"}
    assert {name for name in QUANTITIES if summary[name] is not None} == {"first_frequency"}
    at_end = {name: summary["at_end"][name]["value"] for name in QUANTITIES}
    assert at_end["sphere_angle"] == pytest.approx(
        math.atan2(at_end["sphere_velocity_x"], at_end["sphere_velocity_z"])
    )
    header = (out / "history.csv").read_text(encoding="ascii").splitlines()[0].split(",")
    table = np.loadtxt(out / "history.csv", delimiter=",", skiprows=1)
    assert header[:11] == [*columns(CURVES)] and table.shape[1] == len(header) == 21
    assert 3e-6 - summary["sample_interval"] <= table[-1, 0] <= 3e-6
    assert (out / "stress.pvd").is_file() and (out / "mesh.vtu").is_file()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["result", "scene.json"]


def test_the_surface_of_the_mesh_is_closed(coarse: SeatModel) -> None:
    facets = surface(coarse.mesh)
    a, b, c = (coarse.mesh.points[facets[:, k]] for k in range(3))
    normals: Floats = 0.5 * np.cross(b - a, c - a)
    volume = ((a + b + c) / 3.0 * normals).sum() / 3.0
    assert volume == pytest.approx(coarse.mesh.volume(), rel=1e-12)
    for flank in (LEFT, RIGHT):
        assert coarse.patches[flank].areas.min() >= 0.0


def test_slepc_and_inverse_iteration_agree_on_the_first_frequency(coarse: SeatModel) -> None:
    frequencies = seat_modes(scene(True), coarse.mesh, 4)
    assert np.all(np.diff(frequencies) > 0.0)
    iterated = seat_frequency(make_loop(coarse.model, alone()), coarse)
    assert iterated == pytest.approx(frequencies[0], rel=1e-4)


def test_a_sphere_that_deforms_is_launched_like_a_rigid_one_the_more_the_stiffer_it_is() -> None:
    end = {"end_time": 12e-6}
    mesh = seat_mesh(scene(reference__element_order=1), 0.4)
    states = []
    for body, modulus in (("rigid", 210e9), ("elastic", 210e9), ("elastic", 5e9)):
        design = scene(
            reference__element_order=1,
            sphere__body=body,
            sphere__material__youngs_modulus=modulus,
            run=end,
        )
        sphere = sphere_mesh(design, 0.4) if design.sphere_elastic else None
        model = seat_model(design, mesh, sphere)
        run = integrate(make_loop(model.model, alone()), model, design)
        assert run.energy_residual < 1e-11 and run.momentum_residual < 1e-11
        assert run.unconverged == 0
        states.append([*run.sphere_velocity, run.actuator_velocity])
        if sphere is not None:
            assert sphere.volume() == pytest.approx(
                2.0 / 3.0 * math.pi * design.sphere_radius**3, rel=1e-12
            )
    rigid, steel, soft = np.array(states)
    speed = math.hypot(rigid[0], rigid[1])
    # Contact compliance of steel over that of the polymer: 1.3 %, and the seat bends much more.
    assert np.abs(steel - rigid)[:2].max() < 0.005 * speed
    assert np.abs(soft - rigid)[:2].max() > 0.01 * speed


def test_pairs_of_an_elastic_sphere_follow_it_as_it_slides() -> None:
    design = scene(
        True,
        reference__element_order=1,
        sphere__body="elastic",
        actuator__speed=2.0,
        run={"end_time": 40e-6},
    )
    sphere = sphere_mesh(design, 0.4)
    model = seat_model(design, seat_mesh(design, 0.4), sphere)
    loop = make_loop(model.model, alone())
    integrate(loop, model, design)
    facets, first = model.sphere_facets, int(loop.system.first[ELASTIC_SPHERE])
    assert facets is not None
    moved, (mean, _) = loop.gather(loop.u), sphere_motion(loop, model)
    gaps: list[float] = []
    slid: list[float] = []
    for flank in (LEFT, RIGHT):
        pressed = loop.problem.multipliers(flank) > 0.0
        nodes, places = model.patches[flank].nodes[pressed], model.places[flank][pressed]
        pairs = sphere_pairs(design.ball, sphere, facets, places, moved[first:], mean, moved[nodes])
        of_sphere = np.einsum("nk,nkd->nd", pairs.weights, moved[first:][pairs.facets])
        gaps += (pairs.gaps + ((moved[nodes] - of_sphere) * pairs.normals).sum(axis=1)).tolist()
        relative = moved[nodes] - mean
        normal = (relative * pairs.normals).sum(axis=1)
        slid += np.linalg.norm(relative - normal[:, None] * pairs.normals, axis=1).tolist()
    # By then the sphere has slid so far that its curvature alone would open the old pairs.
    assert max(slid) ** 2 / (2.0 * design.sphere_radius) > 1e-7
    assert np.abs(gaps).max() < 1e-10
