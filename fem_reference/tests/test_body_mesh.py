"""Meshes of other programs as bodies: splitting of cells, decks, groups, fits, larger elements."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path
from typing import Any

import gmsh
import meshio
import numpy as np
import pytest

from fem_reference.body.abaqus import cell_of, read_abaqus
from fem_reference.body.body import Body, body_of, fixed_mask
from fem_reference.body.cells import HEX_EDGES, HEX_FACES, SOLIDS
from fem_reference.body.files import gmsh_session, read_mesh
from fem_reference.body.mesh_file import Meshed, groups_of, meshed, write_body_mesh
from fem_reference.body.remesh import remeshed
from fem_reference.body.scene import parse_body_scene
from fem_reference.body.source import MeshFile
from fem_reference.body.tets import qualities, volume
from fem_reference.common.arrays import Floats
from fem_reference.common.errors import SceneError
from fem_reference.tests.bodies import PLATE_FACES, document, plate, run_mesh, write_mesh

CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
)
INTO = {
    "hexahedron": [list(range(8))],
    "wedge": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]],
    "pyramid": [[*face[::-1], 8] for face in HEX_FACES],
    "tetra": [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]],
}
"""Cells that a cube is cut into; node 8 is its centre."""
CUBES = 2


def bent(points: Floats) -> Floats:
    """A map of second order that keeps volumes: quadratic cells follow it exactly."""
    return points + np.stack(
        [0.3 * points[:, 1] ** 2, 0.0 * points[:, 0], 0.2 * points[:, 0] ** 2], 1
    )


def grid_of(kinds: dict[int, str], curved: bool = False, shuffled: int = 1) -> MeshFile:
    """The unit cube of 2 x 2 x 2 cubes, along x of the ``kinds``, the nodes shuffled."""
    places: dict[tuple[float, ...], int] = {}
    rows: dict[str, list[list[int]]] = {}

    def node(place: Floats) -> int:
        return places.setdefault(tuple(np.round(place, 9)), len(places))

    for cube in itertools.product(range(CUBES), repeat=3):
        corner = np.vstack([CORNERS, [[0.5, 0.5, 0.5]]]) + cube
        kind = kinds[cube[0]]
        linear = "".join(c for c in kind if not c.isdigit())
        for cell in INTO[linear]:
            own = corner[cell]
            middles = [own[list(ends)].mean(axis=0) for ends in SOLIDS[kind].middles]
            rows.setdefault(kind, []).append([node(place) for place in [*own, *middles]])
    number = np.random.default_rng(shuffled).permutation(len(places))
    points = np.empty((len(places), 3))
    points[number] = np.array(list(places)) / CUBES
    blocks = [(kind, number[np.array(each)]) for kind, each in rows.items()]
    return MeshFile(bent(points) if curved else points, blocks, [], {})


def check_cube(body: Body, triangles: int) -> None:
    """Volume 1, no face open inside, all elements the right way round."""
    assert qualities(body.points, body.cells).min() > 0.0
    assert volume(body.points, body.cells) == pytest.approx(1.0, rel=1e-12)
    assert body.skin.faces.shape[0] == triangles


@pytest.mark.parametrize("kind", list(SOLIDS))
def test_cells_split_into_tetrahedra_that_match(kind: str) -> None:
    curved = SOLIDS[kind].quadratic
    source = grid_of(dict.fromkeys(range(CUBES), kind), curved)
    body = body_of(source, 1.0, "cube")
    # two triangles on each of the 4 squares of 6 faces
    check_cube(body, 48)
    corners = SOLIDS[kind].corners
    used = np.unique(np.concatenate([nodes[:, :corners] for _, nodes in source.solids]))
    assert np.unique(body.cells[:, :4]).size == used.size
    # all nodes, those put on new edges too, lie where the map puts the middles of the flat cube
    x, y, z = body.points.T
    if curved:
        x = x - 0.3 * y**2
        z = z - 0.2 * x**2
    sixteenths = 16.0 * np.stack([x, y, z])
    assert np.abs(sixteenths - np.round(sixteenths)).max() < 1e-9


@pytest.mark.parametrize("shuffled", [1, 2, 3])
def test_faces_of_different_cells_match(shuffled: int) -> None:
    for kinds in (("hexahedron", "wedge"), ("pyramid", "hexahedron"), ("hexahedron20", "wedge15")):
        curved = SOLIDS[kinds[0]].quadratic
        source = grid_of(dict(enumerate(kinds)), curved, shuffled)
        check_cube(body_of(source, 1.0, "cube"), 48)


ABAQUS = {
    "C3D4": "tetra", "C3D10M": "tetra10", "C3D8R": "hexahedron", "C3D8I": "hexahedron",
    "C3D20R": "hexahedron20", "C3D20": "hexahedron20", "C3D6": "wedge", "C3D15": "wedge15",
    "C3D10MH": "tetra10", "C3D4H": "tetra", "C3D10": "tetra10", "C3D8": "hexahedron",
}  # fmt: skip


FACES_OF_THE_MANUAL = {
    4: ("123", "142", "243", "341"),
    6: ("123", "465", "1452", "2563", "3641"),
    8: ("1234", "5876", "1562", "2673", "3784", "4851"),
}
"""Nodes of the faces S1, S2, ... by the number of corners (Abaqus Analysis User's Guide)."""


def deck(kind: str, source: MeshFile) -> str:
    """An input file: elements from 1, those of x < 1/2 in LEFT, nodes at z = 0 in Base."""
    ((_, nodes),) = source.solids
    lines = ["** written by a test", "*Heading", "a cube", "*Node, nset=Everything"]
    lines += [
        f"{10 * (k + 1)}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(source.points.tolist())
    ]
    lines += [f"*ELEMENT, type={kind.lower()},", "  ELSET=solid"]
    for k, row in enumerate(nodes, start=1):
        numbers = [str(10 * (each + 1)) for each in row]
        first, rest = numbers[:15], numbers[15:]
        lines += [f"{k}, " + ", ".join(first) + ("," if rest else "")]
        lines += [", ".join(rest)] if rest else []
    half = len(nodes) // 2
    lines += ["*Elset, elset=left, generate", f"1, {half}, 1", "*ELSET,ELSET=Right"]
    lines += [f"{k}," for k in range(half + 1, len(nodes) + 1)]
    lines += ["*elset, elset=BOTH", "Left, RIGHT", "*NSET, NSET=Base"]
    base = np.flatnonzero(np.abs(source.points[:, 2]) < 1e-9)
    lines += [", ".join(str(10 * (k + 1)) for k in base[i : i + 8]) for i in range(0, len(base), 8)]
    lines += ["*NSET, NSET=twice", "base, BASE"]
    for axis, side in itertools.product(range(3), range(2)):
        lines += [f"*Surface, type=ELEMENT, name=side{axis}{side}", *_side(source, axis, side)]
    return "\n".join([*lines, "*Solid Section, elset=both, material=steel"]) + "\n"


def _side(source: MeshFile, axis: int, side: int) -> list[str]:
    """Faces on a side of the cube by Abaqus's numbers of faces."""
    ((cell, nodes),) = source.solids
    found = []
    for k, row in enumerate(nodes, start=1):
        for face, numbers in enumerate(FACES_OF_THE_MANUAL[SOLIDS[cell].corners], start=1):
            corners = [int(number) - 1 for number in numbers]
            if np.allclose(source.points[row[corners], axis], side):
                found.append(f"{k}, S{face}")
    return found


@pytest.mark.parametrize("kind", list(ABAQUS))
def test_a_deck_gives_its_cells_and_sets(tmp_path: Path, kind: str) -> None:
    source = grid_of(dict.fromkeys(range(CUBES), ABAQUS[kind]))
    path = tmp_path / "cube.inp"
    path.write_text(deck(kind, source), encoding="utf-8")
    read = read_abaqus(path)
    ((cell, nodes),) = read.solids
    assert cell == ABAQUS[kind] and np.array_equal(nodes, source.solids[0][1])
    body = body_of(read, 1.0, path.name)
    check_cube(body, 48)
    kinds = {group.name: (group.kind, group.count()) for group in read.groups}
    count = len(nodes)
    assert kinds["LEFT"] == kinds["RIGHT"] == ("elements", count // 2)
    assert kinds["BOTH"] == kinds["SOLID"] == ("elements", count)
    assert kinds["EVERYTHING"] == ("nodes", len(source.points)) and kinds["TWICE"] == kinds["BASE"]
    # a surface's faces and a set's nodes fix what lies on that side of the cube
    on_side = np.abs(body.points[:, :, None] - np.arange(2)) < 1e-9
    assert np.array_equal(fixed_mask(body, ["Base"]), on_side[:, 2, 0])
    for axis, side in itertools.product(range(3), range(2)):
        fixed = fixed_mask(body, [f"Side{axis}{side}"])
        assert np.array_equal(fixed, on_side[:, axis, side])


def test_names_of_elements_are_read_with_their_variants() -> None:
    assert cell_of("C3D10HS") == "tetra10" and cell_of("S4R") is None
    with pytest.raises(ValueError, match="C3D27"):
        cell_of("C3D27")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("*INCLUDE, INPUT=other.inp\n", "line 1: *INCLUDE: files included are not read"),
        ("*NODE\n1,0,0,0\n1,1,0,0\n", "node 1 is defined twice"),
        ("*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n", "names node 2"),
        ("*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D10\n1,1,1,1,1\n2,1,1,1,1\n3,1,1,1\n", "C3D10 has 10"),
        ("*NODE\n1,x,0,0\n", "line 1: *NODE: could not convert"),
        ("*PART,NAME=a\n*END PART\n*PART,NAME=b\n*END PART\n", "several parts or instances"),
        ("*NODE\n1,0,0,0\n*NSET,NSET=a\nb\n*NSET,NSET=b\na\n", "contains itself"),
        ("*NODE\n1,0,0,0\n*NSET,NSET=a,GENERATE\n5,1,1\n", "cannot go from 5 to 1"),
        ("*NODE\n1,0,0,0\n*NSET\n1\n", "the parameter NSET is missing"),
    ],
)
def test_a_wrong_deck_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "wrong.inp"
    path.write_text(text, encoding="utf-8")
    assert message in refusal_of(path)


def refusal_of(path: Path) -> str:
    with pytest.raises(SceneError) as caught:
        read_mesh(path)
    return str(caught.value)


EDGES_OF_THE_MANUAL = {
    "tetra10": "12 23 13 14 24 34",
    "pyramid13": "12 23 34 41 15 25 35 45",
    "wedge15": "12 23 31 14 25 36 45 56 64",
    "hexahedron20": "12 23 34 41 15 26 37 48 56 67 78 85",
}
"""Edges of the midside nodes in their order (NX Nastran Quick Reference Guide)."""


def _nastran_order(kind: str) -> list[int]:
    """Positions, in VTK's order, of the nodes of a card."""
    cell = SOLIDS[kind]
    place = {frozenset(ends): cell.corners + k for k, ends in enumerate(cell.middles)}
    edges = EDGES_OF_THE_MANUAL.get(kind, "").split()
    pairs = [frozenset((int(edge[0]) - 1, int(edge[1]) - 1)) for edge in edges]
    return [*range(cell.corners), *(place[pair] for pair in pairs)]


def real(number: float) -> str:
    return f"{number:.9E}"


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20", "wedge15", "hexahedron", "pyramid13"])
@pytest.mark.parametrize("large", [False, True])
def test_bulk_data_of_nastran(tmp_path: Path, kind: str, large: bool) -> None:
    card = {"t": "CTETRA", "h": "CHEXA", "w": "CPENTA", "p": "CPYRAM"}[kind[0]]
    source = grid_of(dict.fromkeys(range(CUBES), kind), curved=SOLIDS[kind].quadratic)
    ((_, nodes),) = source.solids
    lines = ["SOL 101", "BEGIN BULK", "$ a comment"]
    for k, place in enumerate(source.points, start=1):
        if large:
            x, y, z = (f"{each:16.9E}" for each in place)
            lines += [f"GRID*   {k:16d}{'':16s}{x}{y}", f"*       {z}"]
        else:
            lines += [f"GRID,{k},,{','.join(map(real, place))}"]
    for k, row in enumerate(nodes, start=1):
        fields = [k, 7, *(row[_nastran_order(kind)] + 1)]
        for i in range(0, len(fields), 8):
            head = card if i == 0 else "+"
            lines.append(f"{head:8s}" + "".join(f"{each:8d}" for each in fields[i : i + 8]))
    ground = np.flatnonzero(np.abs(source.points[:, 2]) < 1e-6)
    lines += [f"SPC1,3,123,{node + 1}" for node in ground]
    path = tmp_path / "cube.bdf"
    path.write_text("\n".join([*lines, "ENDDATA"]), encoding="utf-8")
    read = read_mesh(path)
    assert [(g.name, g.kind, g.count()) for g in read.groups] == [
        ("7", "volume", len(nodes)),
        ("spc 3", "nodes", ground.size),
    ]
    body = body_of(read, 1.0, path.name)
    assert volume(body.points, body.cells) == pytest.approx(1.0, rel=1e-7)
    assert body.skin.faces.shape[0] == 48


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("SOL 101\nBEGIN BULK\n", "has no GRID points"),
        ("BEGIN BULK\nGRID,1,5,0.,0.,0.\n", "GRID 1: it uses coordinate system 5"),
        ("GRID,1,,0.,0.,0.\nCTETRA,1,1,1,1,1\n", "CTETRA 1: has 3 nodes; 4 or 10 are read"),
        ("INCLUDE 'more.bdf'\n", "files included are not read"),
    ],
)
def test_wrong_bulk_data_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "wrong.bdf"
    path.write_text(text, encoding="utf-8")
    assert message in refusal_of(path)


def result_of(path: Path, outer: object, factor: float = 1.0, **changes: Any) -> Meshed:
    return meshed(parse_body_scene(document(path, outer, unit=1e-3, **changes)), factor)


@pytest.fixture(scope="module")
def plate_msh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mesh")
    return write_mesh(folder / "plate.msh", plate, 3.0, 2, PLATE_FACES)


def test_a_mesh_is_taken_as_it_is(plate_msh: Path, tmp_path: Path) -> None:
    scene = document(plate_msh, "TOP", unit=1e-3, fixed=["rim"], materials={"all": "steel"})
    done = run_mesh(tmp_path, scene)
    assert done.returncode == 0, done.stderr
    about = json.loads((tmp_path / "body.json").read_text(encoding="utf-8"))
    grid, own = meshio.read(tmp_path / "body.vtu"), meshio.read(plate_msh)
    cells = grid.cells_dict["tetra10"]
    assert cells.shape == own.cells_dict["tetra10"].shape
    assert np.allclose(np.sort(grid.points[:, 0]), 1e-3 * np.sort(own.points[:, 0]), atol=1e-15)
    assert about["source"] == "mesh" and about["materials"] == ["steel"]
    assert about["volume"] == pytest.approx(math.pi * 0.033**2 * 0.002, rel=1e-5)
    radius = np.hypot(grid.points[:, 0], grid.points[:, 1])
    assert np.array_equal(grid.point_data["fixed"] == 1, radius > 0.033 * (1.0 - 1e-7))
    assert not np.any(grid.cell_data["material"][0])
    contact = about["contacts"]["outer"]
    assert np.allclose(contact["point"], (0.0, 0.0, 0.002), atol=1e-6)
    assert contact["curvature_source"] == "fit"
    assert np.allclose(contact["curvatures"], 0.0, atol=1e-6) and contact["layers"] == 1
    assert about["contacts"]["inner"] is None
    # what was written is a body too, with what is fixed as a set
    again = groups_of(tmp_path / "body.vtu", None)
    names = {each["name"]: each["kind"] for each in again["groups"]}
    assert names == {"fixed": "nodes", "material 0": "volume"}


def test_a_med_file_is_read_as_msh_is(plate_msh: Path, tmp_path: Path) -> None:
    med = tmp_path / "plate.med"
    with gmsh_session():
        gmsh.open(str(plate_msh))
        gmsh.write(str(med))
    ours, theirs = (result_of(path, "top", fixed=["rim"]) for path in (med, plate_msh))
    mine, other = (np.sort(each.body.points, axis=0) for each in (ours, theirs))
    assert np.allclose(mine, other, atol=1e-12)
    assert np.count_nonzero(ours.fixed) == np.count_nonzero(theirs.fixed) > 0
    at, there = ours.contacts["outer"], theirs.contacts["outer"]
    assert at is not None and there is not None
    assert np.allclose(at["point"], there["point"], atol=1e-8)
    assert at["edge_distance"] == pytest.approx(there["edge_distance"], rel=1e-6)


def test_linear_elements_get_straight_midside_nodes(tmp_path: Path) -> None:
    path = write_mesh(tmp_path / "plate.msh", plate, 4.0, 1, PLATE_FACES)
    body = result_of(path, "top", fixed=["rim"])
    own = meshio.read(path).cells_dict["tetra"]
    points, cells = body.body.points, body.body.cells
    assert cells.shape == (own.shape[0], 10)
    assert np.allclose(points[cells[:, 4]], 0.5 * (points[cells[:, 0]] + points[cells[:, 1]]))
    # the rim's midside nodes lie on chords and are fixed all the same
    skin = body.body.skin
    rim = (np.hypot(*points[skin.faces[:, :3], :2].transpose(2, 0, 1)) > 0.0329999).all(axis=1)
    assert np.array_equal(np.unique(skin.faces[rim]), np.flatnonzero(body.fixed))


def rod() -> None:
    gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 20, 6)


@pytest.mark.parametrize(("order", "tolerance"), [(1, 0.05), (2, 0.01)])
def test_curvature_is_fitted_to_a_mesh(tmp_path: Path, order: int, tolerance: float) -> None:
    path = write_mesh(tmp_path / "rod.msh", rod, 1.5, order)
    contact = result_of(path, [0.006, 0.0, 0.01]).contacts["outer"]
    assert contact is not None and contact["curvature_source"] == "fit"
    k1, k2 = contact["curvatures"]
    assert k1 == pytest.approx(1.0 / 0.006, rel=tolerance)
    assert abs(k2) < tolerance / 0.006
    assert abs(contact["directions"][1][2]) > 0.99
    assert np.allclose(contact["normal"], (1.0, 0.0, 0.0), atol=0.02)
    assert contact["wall"] == pytest.approx(0.012, rel=0.02)


def test_a_smooth_face_of_a_mesh_is_fixed_by_a_point(plate_msh: Path) -> None:
    by_point = result_of(plate_msh, "top", fixed=[[0.033, 0.0, 0.001]])
    by_name = result_of(plate_msh, "top", fixed=["rim"])
    assert np.array_equal(by_point.fixed, by_name.fixed)


@pytest.mark.parametrize(
    ("size", "order"),
    [
        pytest.param(2.0, 1, id="coarser-1"),
        pytest.param(0.5, 2, id="finer-2"),
        pytest.param(2.0, 2, id="coarser-2", marks=pytest.mark.evidence),
        pytest.param(0.5, 1, id="finer-1", marks=pytest.mark.evidence),
    ],
)
def test_another_mesh_keeps_the_body(tmp_path: Path, size: float, order: int) -> None:
    """The finer one is that of a plate with one layer of elements."""
    path = write_mesh(tmp_path / "plate.msh", plate, 5.0, order, PLATE_FACES)
    own = result_of(path, "top", fixed=["rim"])
    if size > 1.0:
        body, fixed, contacts = remeshed(own.body, own.fixed, own.contacts, size, "plate")
        assert 2.0 * body.cells.shape[0] < own.body.cells.shape[0]
    else:
        other = result_of(path, "top", 2.0, fixed=["rim"], materials={"all": "steel"})
        assert other.about["size_factor"] == size
        body, fixed, contacts = other.body, other.fixed, other.contacts
        assert body.cells.shape[0] == 8 * own.body.cells.shape[0]
    expected = volume(own.body.points, own.body.cells)
    assert volume(body.points, body.cells) == pytest.approx(expected, rel=1e-2)
    elements = {group.name: group.elements.size for group in body.groups}
    assert elements["all"] == body.cells.shape[0]
    radius = np.hypot(*body.points[:, :2].T)
    assert radius[fixed].min() > 0.0323
    # the whole rim, not more: all of the surface that is not flat at the top or the bottom
    faces = body.skin.faces
    rim = faces[np.ptp(body.points[faces[:, :3], 2], axis=1) > 1e-6]
    assert np.array_equal(np.flatnonzero(fixed), np.unique(rim))
    one, there = own.contacts["outer"], contacts["outer"]
    assert one is not None and there is not None
    assert np.allclose(one["point"], there["point"], atol=1e-6)
    assert (there["element_size"] / one["element_size"] > 1.3) == (size > 1.0)


def two_materials(path: Path) -> None:
    """Two boxes that share a face, each a group."""

    def build() -> None:
        boxes = [(3, gmsh.model.occ.addBox(x, 0, 0, 5, 5, 5)) for x in (0, 5)]
        gmsh.model.occ.fragment(boxes[:1], boxes[1:])
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], name="left")
        gmsh.model.addPhysicalGroup(3, [2], name="right")

    write_mesh(path, build, 1.0)


def test_groups_have_materials(tmp_path: Path) -> None:
    path = tmp_path / "boxes.msh"
    two_materials(path)
    done = run_mesh(
        tmp_path,
        document(
            path, [0.0025, 0.0025, 0.005], unit=1e-3, materials={"right": "gold", "left": "tin"}
        ),
    )
    assert done.returncode == 0, done.stderr
    about = json.loads((tmp_path / "body.json").read_text(encoding="utf-8"))
    grid = meshio.read(tmp_path / "body.vtu")
    centre = grid.points[grid.cells_dict["tetra10"][:, :4]].mean(axis=1)
    expected = np.where(centre[:, 0] > 0.005, "gold", "tin")
    assert np.array_equal(np.array(about["materials"])[grid.cell_data["material"][0]], expected)
    for materials, message in (
        ({"left": "tin"}, "elements without a material"),
        ({"left": "tin", "rigth": "gold"}, "'rigth', which the file does not have; it has 'right'"),
        ({"all": "tin", "left": "gold"}, "also in a group of another material"),
    ):
        scene = document(path, [0.0025, 0.0025, 0.005], unit=1e-3, materials=materials)
        with pytest.raises(SceneError, match=message):
            write_body_mesh(tmp_path / "body.vtu", parse_body_scene(scene), 1.0)


def test_hex_edges_are_those_of_the_faces() -> None:
    sides = {frozenset((f[k], f[k - 1])) for f in HEX_FACES for k in range(4)}
    assert sides == {frozenset(edge) for edge in HEX_EDGES}
