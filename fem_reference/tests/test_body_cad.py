"""The mesh of a body from a CAD part: against closed forms of volume, curvature, wall."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gmsh
import meshio
import numpy as np
import pytest

from fem_reference.body.cad import struck_part
from fem_reference.body.files import gmsh_session
from fem_reference.body.mesh_file import Meshed, groups_of, meshed
from fem_reference.body.part import coarse_skin, load
from fem_reference.body.scene import parse_body_scene
from fem_reference.body.sizing import chosen_sizes, walls
from fem_reference.body.tets import volume
from fem_reference.common.errors import SceneError
from fem_reference.solid.mesh import EDGES
from fem_reference.tests.bodies import bracket, document, name_faces, plate, run_mesh, write_cad
from fem_reference.tests.program import run_program


@pytest.fixture(scope="module")
def plate_step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = write_cad(tmp_path_factory.mktemp("cad") / "plate.step", plate)
    return name_faces(path, ["rim", "top", "bottom"])


@pytest.fixture(scope="module")
def disc_step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A smaller plate, with less to mesh far from the contact."""
    path = write_cad(tmp_path_factory.mktemp("cad") / "disc.step", lambda: plate(12.0))
    return name_faces(path, ["rim", "top", "bottom"])


def made(path: Path, outer: object, factor: float = 4.0, **changes: Any) -> Meshed:
    return meshed(parse_body_scene(document(path, outer, **changes)), factor)


def outer_of(result: Meshed) -> dict[str, Any]:
    found = result.contacts["outer"]
    assert found is not None
    return found


def test_the_plate_is_meshed_with_its_rim_fixed(plate_step: Path, tmp_path: Path) -> None:
    scene = document(plate_step, "top", inner=[0.0, 0.0, 0.0], fixed=["rim"])
    done = run_mesh(tmp_path, scene, 2.0)
    assert done.returncode == 0, done.stderr
    assert not list(tmp_path.glob(".partial*"))
    about = json.loads((tmp_path / "body.json").read_text(encoding="utf-8"))
    assert about["sha256"] == hashlib.sha256((tmp_path / "body.vtu").read_bytes()).hexdigest()
    grid = meshio.read(tmp_path / "body.vtu")
    cells = grid.cells_dict["tetra10"]
    assert 20_000 < about["dofs"] == 3 * len(grid.points) < 60_000
    assert len(cells) == about["elements"] and about["min_quality"] > 0.05
    exact = math.pi * 0.033**2 * 0.002
    assert about["cad_volume"] == pytest.approx(exact, rel=1e-9)
    assert about["volume"] == pytest.approx(exact, rel=1e-5)
    # every node of the rim, midside nodes of curved edges too, and no other
    radius = np.hypot(grid.points[:, 0], grid.points[:, 1])
    assert np.array_equal(grid.point_data["fixed"] == 1, radius > 0.033 * (1.0 - 1e-7))
    assert about["fixed_nodes"] == np.count_nonzero(grid.point_data["fixed"])
    for node, (a, b) in enumerate(EDGES, start=4):
        middle = 0.5 * (grid.points[cells[:, a]] + grid.points[cells[:, b]])
        off = np.linalg.norm(grid.points[cells[:, node]] - middle, axis=1)
        assert off.max() < 0.1 * about["largest_element"]
    corners = grid.points[np.unique(cells[:, :4])]
    for name, z, up in (("outer", 0.002, 1.0), ("inner", 0.0, -1.0)):
        contact = about["contacts"][name]
        assert np.allclose(contact["point"], (0.0, 0.0, z), atol=1e-12)
        assert np.linalg.norm(corners - contact["point"], axis=1).min() < 1e-12
        assert contact["distance"] < 1e-12
        assert np.allclose(contact["normal"], (0.0, 0.0, up), atol=1e-12)
        assert np.allclose(contact["curvatures"], 0.0) and contact["curvature_source"] == "cad"
        assert contact["wall"] == pytest.approx(0.002, rel=1e-9) and contact["layers"] >= 2
        assert contact["edge_distance"] == pytest.approx(0.033, rel=1e-4)
        # twice 0.12 of the wall
        assert contact["element_size"] == pytest.approx(0.48e-3, rel=0.25)


def test_sharp_inner_corners_have_elements_half_as_large(tmp_path: Path) -> None:
    def angle() -> None:
        occ = gmsh.model.occ
        arms = [(3, occ.addBox(0, 0, 0, *size)) for size in ((12, 4, 2), (2, 4, 12))]
        occ.fuse(arms[:1], arms[1:])

    path = write_cad(tmp_path / "angle.step", angle)
    body = made(path, [0.0, 0.002, 0.009], 2.0, fixed=[[0.012, 0.002, 0.001]]).body
    corners = body.points[np.unique(body.cells[:, :4])]

    def between_nodes(x: float, z: float) -> float:
        along = np.all(np.abs(corners[:, [0, 2]] - (x, z)) < 1e-9, axis=1)
        return 0.004 / (np.count_nonzero(along) - 1)

    inner, outer = between_nodes(0.002, 0.002), between_nodes(0.0, 0.0)
    assert inner == pytest.approx(0.5 * outer, rel=0.25), "sharp, but convex"


def test_of_many_inner_corners_those_near_the_contact_count(tmp_path: Path) -> None:
    def pockets() -> None:
        occ = gmsh.model.occ
        plate = occ.addBox(0, 0, 0, 60, 6, 4)
        tools = [(3, occ.addBox(2 + 7 * k, 2, 2, 3, 2, 2)) for k in range(8)]
        occ.cut([(3, plate)], tools)

    def pipes() -> None:
        occ = gmsh.model.occ
        one, other = occ.addCylinder(-30, 0, 0, 60, 0, 0, 10), occ.addCylinder(0, 0, 0, 0, 0, 30, 8)
        occ.fuse([(3, one)], [(3, other)])

    for build, at, count in ((pockets, [0.059, 0.003, 0.0], 24), (pipes, [0.0, 0.0, 0.03], 2)):
        path = write_cad(tmp_path / f"{count}.step", build)
        with gmsh_session():
            part = struck_part(parse_body_scene(document(path, at)), path)
            found = part.singular_edges([], chosen_sizes(part.walls, [], None))
            boxes = [gmsh.model.getBoundingBox(1, curve) for curve, _ in found]
        # where one pipe joins the other it is sharp at its sides alone
        assert len(found) == count
        if build is pockets:
            assert min(box[0] for box in boxes) > 30.0


def test_a_mesh_is_the_same_every_time(disc_step: Path) -> None:
    first, again = (made(disc_step, "top", fixed=["rim"]) for _ in range(2))
    assert np.array_equal(first.body.points, again.body.points)
    assert np.array_equal(first.body.cells, again.body.cells)


def sphere() -> None:
    gmsh.model.occ.addSphere(0, 0, 0, 5)


def cylinder() -> None:
    gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 30, 5)


def torus() -> None:
    gmsh.model.occ.addTorus(0, 0, 0, 10, 2)


def tube() -> None:
    outer = gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 20, 8)
    bore = gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 20, 5)
    gmsh.model.occ.cut([(3, outer)], [(3, bore)])


@pytest.mark.parametrize(
    ("build", "at", "normal", "curvatures", "wall"),
    [
        pytest.param(
            sphere,
            (0.003, 0.0, 0.004),
            (0.6, 0.0, 0.8),
            (200.0, 200.0),
            0.01,
            marks=pytest.mark.evidence,
        ),
        (sphere, (0.0, 0.0, 0.005), (0.0, 0.0, 1.0), (200.0, 200.0), 0.01),
        pytest.param(
            cylinder,
            (0.0, 0.005, 0.015),
            (0.0, 1.0, 0.0),
            (200.0, 0.0),
            0.01,
            marks=pytest.mark.evidence,
        ),
        (cylinder, (0.005, 0.0, 0.015), (1.0, 0.0, 0.0), (200.0, 0.0), 0.01),
        (torus, (0.0, 0.008, 0.0), (0.0, -1.0, 0.0), (500.0, -125.0), 0.004),
        pytest.param(
            torus,
            (0.0, 0.012, 0.0),
            (0.0, 1.0, 0.0),
            (500.0, 1.0 / 0.012),
            0.004,
            marks=pytest.mark.evidence,
        ),
        (tube, (-0.005, 0.0, 0.01), (1.0, 0.0, 0.0), (0.0, -200.0), 0.003),
    ],
)
def test_normal_curvature_and_wall_are_those_of_the_closed_form(
    tmp_path: Path,
    build: Callable[[], None],
    at: tuple[float, float, float],
    normal: tuple[float, float, float],
    curvatures: tuple[float, float],
    wall: float,
) -> None:
    result = made(write_cad(tmp_path / "part.step", build), list(at), 2.0)
    contact = outer_of(result)
    # on the seam gmsh places a node to 1e-3 of an element only
    seam = build is cylinder and at[1] == 0.0
    assert np.allclose(contact["point"], at, atol=1e-3 * contact["element_size"] if seam else 1e-9)
    assert np.allclose(contact["normal"], normal, atol=1e-4)
    assert np.allclose(contact["curvatures"], curvatures, rtol=1e-6, atol=1e-6)
    assert contact["wall"] == pytest.approx(wall, rel=0.03)
    first, second = np.array(contact["directions"])
    assert abs(first @ second) < 1e-9 and abs(first @ normal) < 1e-4
    if build is cylinder:
        # no curvature along the axis
        assert abs(second[2]) == pytest.approx(1.0)
    if build is sphere:
        assert contact["edge_distance"] is None
        assert volume(result.body.points, result.body.cells) == pytest.approx(
            4.0 / 3.0 * math.pi * 0.005**3, rel=5e-3
        )


def test_a_contact_in_a_fillet_is_concave(tmp_path: Path) -> None:
    path = write_cad(tmp_path / "bracket.step", bracket)
    turn = 0.004 * (1.0 - math.sqrt(0.5))
    result = made(path, [0.002 + turn, 0.01, 0.003 + turn], fixed=[[0.015, 0.01, 0.0]])
    contact = outer_of(result)
    assert np.allclose(contact["normal"], (math.sqrt(0.5), 0.0, math.sqrt(0.5)), atol=1e-6)
    assert np.allclose(contact["curvatures"], (0.0, -250.0), atol=1e-6)
    # the fillet's smooth face goes on in both walls: the sides of the bracket are its edge
    assert contact["edge_distance"] == pytest.approx(0.01, rel=1e-3)
    assert np.array_equal(result.fixed, np.abs(result.body.points[:, 2]) < 1e-9)


def stepped() -> None:
    thin = gmsh.model.occ.addBox(0, 0, 0, 40, 20, 2)
    thick = gmsh.model.occ.addBox(0, 0, 0, 12, 20, 12)
    gmsh.model.occ.fuse([(3, thin)], [(3, thick)])


def test_walls_drive_the_sizes(tmp_path: Path) -> None:
    path = write_cad(tmp_path / "stepped.step", stepped)
    with gmsh_session():
        skin, _ = coarse_skin(load(path, None))
        found = walls(skin)
        sizes = chosen_sizes(found, [], None)
        bounded = chosen_sizes(found, [], 1.0)
        coarser = chosen_sizes(found, [], 0.5)
    top = (np.abs(found.places[:, 2] - 2.0) < 1e-6) & (found.places[:, 0] > 13.0)
    assert np.allclose(found.thickness[top], 2.0)
    thin, thick = sizes.at(np.array([[30.0, 10.0, 2.0], [6.0, 10.0, 12.0]])) / sizes.scale
    # two elements through a wall
    assert thin == pytest.approx(2.0 / 2, rel=0.02)
    assert 2.0 * thin < thick <= 12.0 / 2
    assert np.allclose(bounded.far, 1.0)
    # sizes that would take too many unknowns are made larger
    assert coarser.scale > 1.0 and coarser.dofs == pytest.approx(250_000, rel=0.07)


def test_a_rod_is_as_thick_as_its_diameter_where_its_end_is_struck(tmp_path: Path) -> None:
    path = write_cad(
        tmp_path / "rod.step", lambda: gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 100, 5)
    )
    end = outer_of(made(path, [0.0, 0.0, 0.1], 2.0))
    assert end["wall"] == pytest.approx(0.1) and end["layers"] > 10
    # twice 0.12 of the diameter and of what the elements grow over a radius
    assert 0.24 * 0.01 * 0.8 < end["element_size"] < 0.24 * 0.01 * 1.4


def test_circles_near_an_edge_get_smaller_elements(disc_step: Path) -> None:
    near = outer_of(made(disc_step, [0.0115, 0.0, 0.002], 1.0))
    assert near["edge_distance"] == pytest.approx(0.5e-3, rel=1e-4)
    assert near["element_size"] == pytest.approx(0.28 * 0.5e-3, rel=0.25)
    with pytest.raises(SceneError, match=r"outer.at is 0.0001 m away from the edge"):
        made(disc_step, [0.0119, 0.0, 0.002])


def test_a_step_file_knows_its_unit_and_its_faces(plate_step: Path, tmp_path: Path) -> None:
    done = run_program("groups", plate_step)
    assert done.returncode == 0, done.stderr
    about = json.loads(done.stdout)
    assert about["source"] == "cad" and about["unit"] == 1e-3
    assert np.allclose(about["bounding_box"], [[-0.033, -0.033, 0], [0.033, 0.033, 0.002]])
    rim, top, *_ = about["groups"]
    assert (rim["name"], rim["kind"], rim["count"], rim["shape"]) == (
        "rim",
        "surface",
        1,
        "cylinder",
    )
    assert top["area"] == pytest.approx(math.pi * 0.033**2)
    assert np.allclose(top["centre"], (0.0, 0.0, 0.002))
    # the same numbers, said to be centimetres
    text = plate_step.read_text(encoding="utf-8").replace(".MILLI.", ".CENTI.")
    other = tmp_path / "centi.step"
    other.write_text(text, encoding="utf-8")
    assert groups_of(other, None)["bounding_box"][1][0] == pytest.approx(0.33)
    assert groups_of(other, 1e-3)["bounding_box"][1][0] == pytest.approx(0.033)
    assert groups_of(other, 1e-3)["groups"][0]["name"] == "rim"


def test_names_of_faces_are_those_of_the_right_faces(tmp_path: Path) -> None:
    path = write_cad(tmp_path / "bracket.step", bracket)
    count = path.read_text(encoding="utf-8").count("ADVANCED_FACE(''")
    name_faces(path, [f"f{k}" for k in range(count)])
    by_name = {each["name"]: each for each in groups_of(path, None)["groups"]}
    records = dict(re.findall(r"#(\d+) = ([^;]*);", path.read_text(encoding="utf-8")))

    def vector(reference: str) -> list[float]:
        numbers = re.search(r"\(([^()]*)\)\)", records[reference])
        assert numbers is not None
        return [float(each) for each in numbers[1].split(",")]

    planes = 0
    for body in records.values():
        face = re.match(r"ADVANCED_FACE\('(f\d+)',.*#(\d+),", body, re.DOTALL)
        if face is None or not records[face[2]].startswith("PLANE"):
            continue
        placement = re.findall(r"#(\d+)", records[face[2]])[0]
        point, normal, _ = (vector(each) for each in re.findall(r"#(\d+)", records[placement]))
        # the centre of the face of that name lies in the plane of the file
        away = np.array(by_name[face[1]]["centre"]) / 1e-3 - point
        assert abs(away @ normal) < 1e-6
        planes += 1
    assert planes == 8
    fillet = [each for each in by_name.values() if each.get("shape") == "cylinder"]
    assert len(fillet) == 1
    assert fillet[0]["area"] == pytest.approx(math.pi / 2 * 0.004 * 0.02, rel=1e-6)


def test_brep_counts_in_the_unit_given(tmp_path: Path) -> None:
    path = write_cad(tmp_path / "plate.brep", plate)
    assert groups_of(path, 1e-3)["bounding_box"][1][0] == pytest.approx(0.033)
    with pytest.raises(SceneError, match="millimetres taken for metres"):
        made(path, [0.0, 0.0, 0.002])
    assert made(path, [0.0, 0.0, 0.002], unit=1e-3).body.cells.size > 0


def drilled() -> None:
    """A block with a blind hole of 6 mm, whose bottom is the cone of a drill."""
    occ = gmsh.model.occ
    block = occ.addBox(-15, -15, -20, 30, 30, 20)
    hole = occ.addCylinder(0, 0, -10, 0, 0, 11, 3)
    point = occ.addCone(0, 0, -10, 0, 0, -3 / math.tan(math.radians(59)), 3, 0)
    drill, _ = occ.fuse([(3, hole)], [(3, point)])
    occ.cut([(3, block)], drill)


def cone() -> None:
    gmsh.model.occ.addCone(0, 0, 0, 0, 0, 8, 8, 0)


@pytest.mark.parametrize(
    ("build", "at", "exact"),
    [
        pytest.param(
            drilled,
            [0.009, 0.0, 0.0],
            18_000 - 90 * math.pi - 9 * math.pi * 1.8026 / 3,
            marks=pytest.mark.evidence,
        ),
        (cone, [0.0, 0.0, 0.0], math.pi * 8**3 / 3),
    ],
)
def test_the_tip_of_a_cone_is_meshed(
    tmp_path: Path, build: Callable[[], None], at: list[float], exact: float
) -> None:
    """Curvature has no bound there: without a smallest element the surface's mesh never ends."""
    body = made(write_cad(tmp_path / "part.step", build), at, 3.0).body
    assert 500 < body.cells.shape[0] < 40_000
    assert volume(body.points, body.cells) == pytest.approx(1e-9 * exact, rel=3e-3)


def test_iges_is_read_as_step_is(tmp_path: Path) -> None:
    """IGES has faces alone, which are sewn to a solid."""
    fixed = [[0.012, 0.0, 0.001]]
    bodies = [
        made(
            write_cad(tmp_path / f"plate.{ending}", lambda: plate(12.0)),
            [0.0, 0.0, 0.002],
            fixed=fixed,
        )
        for ending in ("step", "iges")
    ]
    step, iges = ((each.body.points, each.body.cells) for each in bodies)
    assert volume(*iges) == pytest.approx(volume(*step), rel=1e-4)
    assert bodies[1].about["cad_volume"] == pytest.approx(math.pi * 12**2 * 2e-9, rel=1e-6)
    radius = np.hypot(*bodies[1].body.points[:, :2].T)
    assert np.array_equal(bodies[1].fixed, radius > 0.012 * (1.0 - 1e-7))
    assert outer_of(bodies[1])["wall"] == pytest.approx(0.002, rel=1e-6)
