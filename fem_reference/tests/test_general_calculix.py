"""CalculiX on bodies: deck, refusals, frequencies, a small impact against the explicit solver."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
import pytest
from mpi4py import MPI

from fem_reference.calculix.deck import Steps
from fem_reference.calculix.tets import Tetrahedra, nodal_volumes
from fem_reference.common.errors import SceneError, SolverError
from fem_reference.common.settings import Options, Settings
from fem_reference.general_impact import calculix, solve
from fem_reference.general_impact.calculix_model import (
    Model,
    model,
    require_supported,
    rigid_motions,
)
from fem_reference.general_impact.ending import Bodies
from fem_reference.general_impact.estimate import Sizes, estimate
from fem_reference.general_impact.model import impact_model
from fem_reference.general_impact.result import quantities
from fem_reference.general_impact.scene import Scene, parse_scene
from fem_reference.solid.mesh import TetMesh, surface, tetrahedra
from fem_reference.solid.system import make_loop

from .bodies import write_cad
from .conftest import STEEL

SPHERE = {"kind": "sphere", "radius": 0.004, "material": STEEL}
WEDGE = TetMesh("tet", np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]]))


def cuboid(*lengths: float) -> Callable[[], object]:
    """A block with a corner at the origin; mm."""
    return lambda: gmsh.model.occ.addBox(0, 0, 0, *lengths)


def document(file: Path, at: list[list[float]], fixed: list[list[float]], **more: Any) -> Any:
    """A scene of a body of steel that a sphere strikes; a second one lies at a second place."""
    inner = {**SPHERE, "gap": 0.0, "speed": 0.0} if len(at) > 1 else None
    return {
        "kind": "impact",
        "name": "small",
        "description": "",
        "scene_hash": "",
        "settings_hash": "",
        "outer": {**SPHERE, "speed": 0.5},
        "body": {
            "content": hashlib.sha256(file.read_bytes()).hexdigest(),
            "unit": None,
            "material": STEEL,
            "fixed": fixed,
            "element_size": None,
            "at": at,
            "damping_ratio": 0.0,
        },
        "wall": None,
        "plate": None,
        "inner": inner,
        "reference": {"geometry": "solid", "elements_per_contact_radius": 3.0},
        "run": {"end_time": None},
        **more,
    }


def on_mesh(scene: Scene, file: Path, factor: float) -> Model:
    """The deck on a mesh for the contact radii on a half-space."""
    first = estimate(scene)
    return model(
        scene,
        impact_model(
            scene, Sizes(scene, first.radii, first.duration, factor, calculix.STEEPEST), file
        ),
    )


def test_nodal_volumes_are_those_of_curved_elements() -> None:
    """Of a straight element by Gauss' rule; of a sphere's skin the exact ball."""
    tet = tetrahedra("tet", WEDGE.points, WEDGE.cells, 2)
    volumes = nodal_volumes(tet)
    assert volumes == pytest.approx([*[-1 / 120] * 4, *[1 / 30] * 6], rel=1e-12)
    assert volumes @ tet.points / volumes.sum() == pytest.approx([0.25] * 3, rel=1e-12)
    bulged = replace(tet, points=tet.points.copy())
    middle = int(tet.cells[0, 5])
    # the edge between (1, 0, 0) and (0, 1, 0) moves out of two faces
    bulged.points[middle] += [0.1, 0.1, 0.0]
    moved = 0.1 * (volumes[middle] - volumes[0]) / (1 / 6)
    assert nodal_volumes(bulged).sum() > 1 / 6 + 0.1 * moved
    bulged.points[middle] -= [0.9, 0.9, 0.0]
    with pytest.raises(SolverError, match="curved element that is inverted"):
        nodal_volumes(bulged)


def test_faces_have_the_nodes_that_calculix_says() -> None:
    """S1 to S4 of C3D10 are 1 2 3, 1 4 2, 2 4 3, 3 4 1 in its manual."""
    named = {"S1": {1, 2, 3}, "S2": {1, 4, 2}, "S3": {2, 4, 3}, "S4": {3, 4, 1}}
    tet = Tetrahedra(tetrahedra("tet", WEDGE.points, WEDGE.cells, 2), 1, 7)
    (_, nodes) = tet.elements["C3D10"][0]
    for facet in surface(tet.mesh):
        ((element, face),) = tet.faces(facet[None])
        assert element == 7
        assert {nodes[k - 1] for k in named[face]} == set((facet[:3] + 1).tolist())


def test_rigid_motions_are_orthonormal_and_contain_all_of_them() -> None:
    random = np.random.default_rng(3)
    points, masses = random.standard_normal((20, 3)), random.uniform(0.5, 2.0, 20)
    motions = rigid_motions(points, masses, 6)
    products = np.einsum("inc,n,jnc->ij", motions, masses, motions)
    assert products == pytest.approx(np.eye(6), abs=1e-12)
    turned = np.cross([0.3, -0.2, 0.9], points) + np.array([1.0, 2.0, 3.0])
    coordinates = np.einsum("inc,n,nc->i", motions, masses, turned)
    assert np.einsum("i,inc->nc", coordinates, motions) == pytest.approx(turned, abs=1e-12)


def test_the_deck_moves_spheres_along_the_normals_and_holds_the_fixed_face(tmp_path: Path) -> None:
    """Struck on x = 10 mm, the other sphere on y = 0: the normals are not collinear."""
    file = write_cad(tmp_path / "block.step", cuboid(10, 10, 10))
    at = [[0.01, 0.005, 0.006], [0.005, 0.0, 0.006]]
    scene = parse_scene(document(file, at, [[0.005, 0.005, 0.0]]))
    made = on_mesh(scene, file, 0.4)
    text = made.deck.impact(Steps(1e-7, 1e-6, -0.05, 0.02))
    assert "*CONTROLS, PARAMETERS=CONTACT\n0.02,0.1,100,60\n*DYNAMIC" in text
    assert "NOUTER,1,-0.5" in text.split("\n")
    assert not re.search(r"^N(INNER|BODY),", text, re.MULTILINE)
    body, outer, inner = made.deck.parts
    held = {node for node, _ in body.held}
    assert held == {number for number, x in body.nodes if abs(x[2]) < 1e-12}
    assert made.masses[1] == pytest.approx(scene.outer.mass, rel=1e-12)
    for part, centre in ((outer, [0.014, 0.005, 0.006]), (inner, [0.005, -0.004, 0.006])):
        away = np.array([x for _, x in part.nodes]) - centre
        distance = np.linalg.norm(away, axis=1)
        assert distance.max() == pytest.approx(0.004, rel=1e-9)
        # the mean of the sphere's displacement along its direction
        of_part = next(o for o in made.deck.observers if o.name == part.name)
        weights = dict.fromkeys((1, 2, 3), 0.0)
        for _, direction, weight in of_part.terms:
            weights[direction] += weight
        along = {1: 1.0} if part is outer else {2: 1.0}
        assert weights == pytest.approx({1: 0.0, 2: 0.0, 3: 0.0, **along}, abs=1e-12)
    # the ball has its volume without a correction of the density
    assert outer.material.density == pytest.approx(STEEL["density"], rel=5e-3)


def refused(scene: Scene, message: str, processes: int = 1, **options: Any) -> None:
    with pytest.raises(SceneError, match=re.escape(message)):
        require_supported(scene, Options(solver="calculix", **options), processes)


def test_what_the_deck_does_not_describe_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "any.step"
    file.write_text("")
    at = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.1]]
    whole = document(file, at, [])
    scene = parse_scene(whole)
    require_supported(scene, Options(solver="calculix"), 1)
    refused(scene, "fields are requested", stress_times=(1e-6,))
    refused(scene, "fields are requested", frames=3)
    refused(scene, "--np is 2; it must be 1", processes=2)
    about = whole["reference"]
    rigid = {**whole, "reference": {**about, "rigid": "inner"}}
    refused(parse_scene(rigid), "reference.rigid is 'inner'; it must be 'none'")
    linear = {**whole, "reference": {**about, "element_order": 1}}
    refused(parse_scene(linear), "reference.element_order is 1; it must be 2")
    compact = {"kind": "compact", "mass": 0.01, "tip_radius": 0.01, "material": STEEL}
    heavy = {**whole, "outer": {**compact, "speed": 0.5}}
    heavy["reference"] = {**about, "rigid": "outer"}
    refused(parse_scene(heavy), "outer.kind is 'compact'; it must be 'sphere'")
    wall = {**whole, "body": None, "wall": {"material": STEEL}, "inner": None}
    refused(parse_scene(wall), "wall is given; it must be absent")
    two = {**whole, "body": None}
    refused(parse_scene(two), "body is missing")


@pytest.mark.parametrize("opposite", [False, True])
@pytest.mark.parametrize(
    "program", ["explicit", pytest.param("CalculiX", marks=pytest.mark.calculix)]
)
def test_the_first_frequency_is_one_that_the_contact_excites(
    program: str, opposite: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A free beam, 3 mm wide and 5 mm high, struck from above: not its lateral mode.

    A body that lies below the first contact does not hinder the mode that moves both.

    Bernoulli's frequency with the correction for shear and rotary inertia of ASTM E1876.
    """
    length, width, height = 0.06, 0.003, 0.005
    file = write_cad(tmp_path / "beam.step", cuboid(60, 3, 5))
    at = [0.5 * length, 0.5 * width, height]
    below = [[at[0], at[1], 0.0]] if opposite else []
    scene = parse_scene(document(file, [at, *below], []))
    made = on_mesh(scene, file, 0.4)
    if program == "CalculiX":
        # the lateral mode alone is not enough
        monkeypatch.setattr(calculix, "MODES", (1, 16))
        found = calculix.first_frequency(made, tmp_path)
    else:
        loop = make_loop(made.made.model, MPI.COMM_SELF, 1)
        found = Bodies(loop, made.made).first_frequency()
    steel = scene.outer.material
    nu, slender = steel.poisson_ratio, (height / length) ** 2
    shear = 1.0 + 6.338 * (1.0 + 0.1408 * nu + 1.536 * nu**2) * slender
    factor = 1.0 + 6.585 * (1.0 + 0.0752 * nu + 0.8109 * nu**2) * slender - 0.868 * slender**2
    factor -= 8.340 * (1.0 + 0.2023 * nu + 2.173 * nu**2) * slender**2 / shear
    mass = steel.density * length * width * height
    stiffness = steel.youngs_modulus * width * height**3 / (0.9465 * length**3 * factor)
    assert found == pytest.approx(math.sqrt(stiffness / mass), rel=5e-3)


@pytest.mark.calculix
@pytest.mark.evidence
def test_a_small_impact_keeps_its_balances_and_agrees_with_the_explicit_solver(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sphere on a block that stands on a face, on one coarse mesh each."""
    file = write_cad(tmp_path / "block.step", cuboid(6, 6, 4))
    scene = parse_scene(document(file, [[0.003, 0.003, 0.004]], [[0.003, 0.003, 0.0]]))
    monkeypatch.setattr(calculix, "STEPS", 100.0)
    found = {}
    for by in (calculix, solve):
        settings = Settings(0.9, tmp_path / by.__name__, 0.0, "test")
        solution = by.compute(scene, file, 0.4, settings, MPI.COMM_SELF, lambda *_: None)
        found[by] = quantities(scene, solution)
        run = solution.run
        assert run.momentum_residual < 2e-3
        assert run.energy_residual < 5e-3
        assert not run.in_contact_at_end
        assert run.contacts[0].count == 1
    within = {"outer_force_peak": 0.02, "outer_contact_end": 0.02, "outer_restitution": 0.003}
    for name, share in within.items():
        assert found[calculix][name] == pytest.approx(found[solve][name], rel=share), name
