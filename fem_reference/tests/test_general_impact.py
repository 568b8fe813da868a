"""Impacts on walls, spheres and bodies from files against closed forms and balances."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import gmsh
import numpy as np
import pytest

from fem_reference.body.curvature import frame
from fem_reference.common.arrays import Floats
from fem_reference.common.errors import SceneError
from fem_reference.common.fenicsx import alone
from fem_reference.explicit.free_motions import FreeMotions, flexibility
from fem_reference.general_impact.ending import Bodies
from fem_reference.general_impact.estimate import Sizes, estimate
from fem_reference.general_impact.model import ImpactModel, impact_model
from fem_reference.general_impact.result import beyond_bands, quantities
from fem_reference.general_impact.scene import Scene, parse_scene
from fem_reference.general_impact.struck import pressure_wave_speed, wall_radius
from fem_reference.solid.elasticity import lumped_mass
from fem_reference.solid.system import make_loop
from fem_reference.tests.bodies import write_cad, write_mesh
from fem_reference.tests.general_scenes import SPHERE, STEEL, document, solved, struck

MODULUS = 210e9 / 0.91
MASS = 7780.0 * 4.0 / 3.0 * math.pi * 0.004**3
BLOCK = (14.0, 12.0, 5.0)
"""Sides, mm."""
BLOCK_MASS = 7780.0 * 1e-9 * math.prod(BLOCK)


def hertz(mass: float, modulus: float, radius: float, speed: float) -> tuple[float, float]:
    """Peak force (N) and duration (s) of Hertz's impact."""
    stiffness = 4.0 / 3.0 * modulus * math.sqrt(radius)
    approach = (1.25 * mass * speed**2 / stiffness) ** 0.4
    return stiffness * approach**1.5, 2.943275 * approach / speed


@pytest.mark.parametrize(
    ("changes", "mass", "modulus", "radius"),
    [
        ({"wall": {"material": None}}, MASS, MODULUS, 0.004),
        ({"inner": SPHERE | {"gap": 0.0, "speed": 0.2}}, 0.5 * MASS, 0.5 * MODULUS, 0.002),
    ],
    ids=["rigid wall", "two spheres"],
)
def test_spheres_as_hertz_has_them(
    changes: dict[str, Any], mass: float, modulus: float, radius: float
) -> None:
    scene, solution = solved(changes)
    found = quantities(scene, solution)
    force, duration = hertz(mass, modulus, radius, scene.closing_speed)
    # two elements per contact radius, and spheres that are no half-spaces
    assert found["outer_force_peak"] == pytest.approx(force, rel=0.03)
    assert found["outer_contact_end"] == pytest.approx(duration, rel=0.015)
    assert found["outer_restitution"] == pytest.approx(1.0, abs=3e-4)
    gained = MASS * (found["outer_velocity_final"] + 0.5)
    assert found["outer_impulse"] == pytest.approx(gained, rel=1e-9)
    assert solution.run.momentum_residual < 1e-10
    assert solution.run.energy_residual < 1e-5
    if "inner" in changes:
        # equal masses exchange their velocities
        assert found["inner_velocity_final"] == pytest.approx(-0.5, rel=1e-3)
        assert found["outer_velocity_final"] == pytest.approx(0.2, rel=1e-3)
        assert found["efficiency"] == pytest.approx(1.0, rel=2e-3)


def test_no_echo_of_a_wall_comes_back_during_the_contact() -> None:
    scene = parse_scene(document(wall={"material": STEEL}))
    material = scene.struck_material
    assert material is not None
    _, duration = hertz(MASS, 0.5 * MODULUS, 0.004, 0.5)
    expected = estimate(scene)
    assert expected.duration == pytest.approx(duration, rel=1e-3)
    way = pressure_wave_speed(material) * duration
    assert pressure_wave_speed(material) == pytest.approx(6028.0, rel=1e-3)
    assert 2.0 * wall_radius(material, expected.duration) > 1.25 * way


@pytest.mark.parametrize(("last", "warnings"), [(1.2, 0), (1.4, 1)])
def test_a_contact_that_outlasts_the_echo_of_the_wall_gets_a_warning(
    last: float, warnings: int
) -> None:
    scene = parse_scene(document(wall={"material": STEEL}))
    duration = estimate(scene).duration
    contact = SimpleNamespace(end=last * duration)
    run = SimpleNamespace(in_contact_at_end=False, contacts=[contact])
    sizes, made = SimpleNamespace(duration=duration), SimpleNamespace(kept=0.0)
    solution: Any = SimpleNamespace(run=run, sizes=sizes, made=made)
    assert sum("echo" in warning for warning in beyond_bands(scene, solution)) == warnings


@pytest.mark.parametrize(("size", "warnings"), [(3.0, 0), (0.6, 1)])
def test_elements_of_a_file_that_no_mesh_of_the_series_cuts_get_a_warning(
    tmp_path: Path, size: float, warnings: int
) -> None:
    path = write_mesh(tmp_path / "block.msh", lambda: gmsh.model.occ.addBox(0, 0, 0, 6, 6, 4), size)
    body = struck(path, [0.003, 0.003, 0.004], unit=1e-3)
    scene = parse_scene(document(body=body, reference__elements_per_contact_radius=1.0))
    expected = estimate(scene)
    sizes = Sizes(scene, expected.radii, expected.duration, 0.6)
    made = impact_model(scene, sizes, path)
    solution: Any = SimpleNamespace(run=None, made=made)
    found = list(beyond_bands(scene, solution))
    assert [f"{100.0 * made.kept:.0f} % of the body's volume" in each for each in found] == [
        True
    ] * warnings


def tilted_block(path: Path) -> tuple[Path, Floats, Floats, Floats]:
    """A turned block of `BLOCK` mm; middle (m) and normal of its upper face, middle below."""
    axis = np.array([1.0, 2.0, 0.5]) / math.sqrt(5.25)

    def build() -> None:
        length, width, height = BLOCK
        gmsh.model.occ.addBox(-0.5 * length, -0.5 * width, -height, *BLOCK)
        gmsh.model.occ.rotate([(3, 1)], 0, 0, 0, *axis, 0.7)

    cross = np.cross(np.eye(3), axis)
    turn = np.eye(3) + math.sin(0.7) * cross + (1.0 - math.cos(0.7)) * cross @ cross
    return write_cad(path, build), np.zeros(3), turn[:, 2], -1e-3 * BLOCK[2] * turn[:, 2]


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any], Floats]:
    """The file of a turned block, free, between two spheres; the outer contact's normal."""
    folder = tmp_path_factory.mktemp("block")
    path, top, normal, bottom = tilted_block(folder / "block.step")
    body = struck(path, top.tolist(), bottom.tolist())
    inner = SPHERE | {"gap": 2e-6, "speed": 0.0}
    return path, {"body": body, "inner": inner}, normal


@pytest.fixture(scope="module")
def made(block: tuple[Path, dict[str, Any], Floats]) -> tuple[Scene, ImpactModel]:
    """Its model."""
    scene = parse_scene(document(**block[1]))
    expected = estimate(scene)
    return scene, impact_model(
        scene, Sizes(scene, expected.radii, expected.duration, 1.0), block[0]
    )


def test_spheres_touch_at_the_points_along_the_normals(
    block: tuple[Path, dict[str, Any], Floats], made: tuple[Scene, ImpactModel]
) -> None:
    scene, model = made
    outer, inner = model.sides
    assert np.abs(outer.strike.normal - block[2]).max() < 1e-9
    assert np.abs(inner.strike.normal + block[2]).max() < 1e-9
    for side, gap in ((outer, 0.0), (inner, 2e-6)):
        contact = model.model.contacts[side.contact]
        nodes = model.model.elastic[0].mesh.points[side.patch.nodes]
        away = np.linalg.norm(nodes - side.strike.point, axis=1)
        exact = np.hypot(0.004 + gap, away) - 0.004
        assert np.abs(contact.gaps - exact).max() < 1e-12  # type: ignore[union-attr]
        assert away.min() < 1e-9
        assert side.body is not None
        sphere = model.model.elastic[side.body]
        start = np.array(sphere.velocity)
        speed = -scene.speed if side.name == "outer" else 0.0
        assert np.abs(start - speed * side.along).max() < 1e-12
        mass = lumped_mass(sphere.mesh, 1.0)
        centre = mass @ sphere.mesh.points / mass.sum()
        expected = side.strike.point + (0.004 + gap) * side.strike.normal
        assert np.abs(centre - expected).max() < 2e-5
        # the pole is where the candidate at the contact is, but for the gap
        pole = np.linalg.norm(sphere.mesh.points - side.strike.point, axis=1).min()
        assert pole == pytest.approx(gap, abs=1e-10)
    masses = [body.material.density * body.mesh.volume() for body in model.model.elastic]
    assert masses == pytest.approx([BLOCK_MASS, MASS, MASS], rel=1e-9)


def test_rigid_motions_of_a_free_body(made: tuple[Scene, ImpactModel]) -> None:
    loop = make_loop(made[1].model, alone())
    floating = FreeMotions(loop, 0)
    assert len(floating.motions) == 6
    axis = np.array([0.3, -1.0, 0.2])
    motion = np.array([1.0, 2.0, 3.0]) + np.cross(axis, loop.system.points)
    x = loop.own(motion) * np.repeat(loop.body == 0, 3)
    assert np.abs(floating.out_of_motion(x)).max() < 1e-9
    energy = 0.5 * loop.dot(x, np.repeat(loop.mass, 3) * x)
    assert 0.5 * float((floating.coordinates(x) ** 2).sum()) == pytest.approx(energy, rel=1e-9)
    assert np.abs(loop.product(x)).max() < 1e-6 * loop.diagonal.max()
    side = made[1].sides[0]
    load = side.patch.load(loop, 0)
    moved = float(floating.along(load) @ floating.coordinates(x))
    place = side.strike.point
    expected = (np.array([1.0, 2.0, 3.0]) + np.cross(axis, place)) @ side.strike.normal
    assert moved == pytest.approx(float(expected), abs=1e-4)
    assert flexibility(loop, 0, load, floating) > 0.0


@pytest.mark.parametrize("body", [0, pytest.param(1, marks=pytest.mark.evidence)])
def test_two_levels_solve_what_the_diagonal_solves_in_fewer_steps(
    made: tuple[Scene, ImpactModel], body: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A free body, and a free sphere: the same flexibility by a fraction of the products."""
    loop = make_loop(made[1].model, alone())
    side, bodies = made[1].sides[0], Bodies(loop, made[1])
    patch = side.patch if body == 0 else side.own
    assert patch is not None
    load, products, product = patch.load(loop, body), 0, loop.product

    def counted(x: Floats) -> Floats:
        nonlocal products
        products += 1
        return product(x)

    monkeypatch.setattr(loop, "product", counted)
    by_diagonal, steps = flexibility(loop, body, load, bodies.floating[body]), products
    products = 0
    assert bodies.flexibility(body, load) == pytest.approx(by_diagonal, rel=1e-6)
    assert 3 * products < steps


def test_a_free_body_keeps_the_momentum(
    block: tuple[Path, dict[str, Any], Floats],
) -> None:
    """What the sphere loses, the block's centre of mass has."""
    # a fast sphere has a large contact radius, thus large elements
    few = {"reference__elements_per_contact_radius": 1.0, "outer__speed": 10.0}
    scene, solution = solved({"body": block[1]["body"]} | few, block[0])
    found, mass = quantities(scene, solution), BLOCK_MASS
    assert solution.run.momentum_residual < 1e-10
    assert solution.run.energy_residual < 1e-5
    outer = MASS * (found["outer_velocity_final"] + scene.speed)
    assert found["outer_impulse"] == pytest.approx(outer, rel=1e-9)
    struck_velocity = found["outer_velocity_final"] - scene.speed * found["outer_restitution"]
    assert mass * struck_velocity == pytest.approx(-outer, rel=1e-6)
    assert "inner_force_peak" not in found


@pytest.mark.parametrize("suffix", [".step", ".msh"])
def test_a_curved_face_is_met_where_it_is(tmp_path: Path, suffix: str) -> None:
    """A sphere on a cylinder's side: candidates lie on it, and its mass is its own."""

    def build() -> None:
        gmsh.model.occ.addCylinder(0, 0, 0, 12, 0, 0, 8)

    write: Callable[..., Path] = write_cad
    path = tmp_path / f"rod{suffix}"
    path = write(path, build) if suffix == ".step" else write_mesh(path, build, 3.5)
    unit = None if suffix == ".step" else 1e-3
    body = struck(path, [0.006, 0.0, 0.008], unit=unit, fixed=[[0.0, 0.001, 0.0]])
    # fast: a large contact radius, thus large elements
    few = {"reference__elements_per_contact_radius": 1.0, "outer__speed": 5.0}
    scene = parse_scene(document(body=body, **few))
    expected = estimate(scene)
    model = impact_model(scene, Sizes(scene, expected.radii, expected.duration, 1.0), path)
    (side,) = model.sides
    assert np.abs(side.strike.normal - [0.0, 0.0, 1.0]).max() < 2e-3
    assert side.strike.curvature == pytest.approx(62.5, rel=1e-6 if unit is None else 0.1)
    off = np.abs(np.hypot(side.places[:, 1], side.places[:, 2]) - 0.008)
    assert off.max() < (1e-9 if unit is None else 2e-5)
    struck_body = model.model.elastic[0]
    exact = 7780.0 * math.pi * 0.008**2 * 0.012
    mass = struck_body.material.density * struck_body.mesh.volume()
    assert mass == pytest.approx(exact, rel=1e-9 if unit is None else 3e-3)
    if unit is None:
        # without moving its facets the polygon would lack much more
        assert struck_body.mesh.volume() == pytest.approx(math.pi * 0.008**2 * 0.012, rel=1e-3)
    held = np.unique(struck_body.fixed // 3)
    assert np.abs(struck_body.mesh.points[held, 0]).max() < 1e-6
    assert held.size > 20


def test_supports_on_one_line_are_refused(tmp_path: Path) -> None:
    path = write_mesh(tmp_path / "block.msh", lambda: gmsh.model.occ.addBox(0, 0, 0, 9, 9, 4), 3.0)
    body = struck(path, [0.0045, 0.0045, 0.004], unit=1e-3, fixed=["nowhere"])
    scene = parse_scene(document(body=body))
    expected = estimate(scene)
    sizes = Sizes(scene, expected.radii, expected.duration, 1.0)
    with pytest.raises(SceneError, match=r"body\.fixed"):
        impact_model(scene, sizes, path)
    with pytest.raises(SceneError, match="--body does not name its file"):
        impact_model(replace(scene), sizes, None)


def test_frames_turn_the_right_way_round() -> None:
    normal = np.array([0.2, -0.5, 0.7]) / np.linalg.norm([0.2, -0.5, 0.7])
    turn = np.vstack([frame(normal), normal])
    assert np.linalg.det(turn) == pytest.approx(1.0)
