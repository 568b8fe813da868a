"""Bodies whose materials are given by group."""

import json
import math
from pathlib import Path

import pytest
from bodies import made, run, scene

HALVES = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
boxes = [(3, gmsh.model.occ.addBox(x, 0, 0, 6, 12, 6)) for x in (0, 6)]
gmsh.model.occ.fragment(boxes[:1], boxes[1:])
gmsh.model.occ.synchronize()
for tag, name in ((1, "left"), (2, "right")):
    gmsh.model.addPhysicalGroup(3, [tag], name=name)
faces = [tag for _, tag in gmsh.model.getEntities(2)]
base = [tag for tag in faces if gmsh.model.occ.getCenterOfMass(2, tag)[2] == 0]
gmsh.model.addPhysicalGroup(2, base, name="base")
gmsh.option.setNumber("Mesh.MeshSizeMax", 1.6)
gmsh.model.mesh.generate(3)
gmsh.write("halves.msh")
gmsh.finalize()
"""


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a block of two groups, left and right of x = 6 mm."""
    folder = tmp_path_factory.mktemp("halves")
    made(folder, HALVES)
    return folder


HALF_MATERIALS = """
[materials.soft]
youngs_modulus = "3 GPa"
poisson_ratio  = 0.35
density        = "1200 kg/m^3"
[materials.same]
youngs_modulus = "210 GPa"
poisson_ratio  = 0.3
density        = "7780 kg/m^3"
"""


def of_halves(folder: Path, materials: str, at: str = "9 mm") -> str:
    """A scene in which a small sphere strikes the block of two halves."""
    body = f'file = "halves.msh"\nunit = "mm"\nfixed = ["base"]\n{materials}'
    outer = f'at = ["{at}", "6 mm", "6 mm"]'
    name = scene(folder, body, outer=outer, radius="1 mm", speed="50 mm/s")
    text = (folder / name).read_text().replace('[body]\nmaterial = "steel"', "[body]")
    (folder / name).write_text(text.replace("[body]", HALF_MATERIALS + "[body]"))
    return name


def test_a_body_has_materials_by_group(halves: Path) -> None:
    """Two halves of one material are one body; a soft half has the soft half's contact."""

    def result(materials: str, at: str = "9 mm") -> dict[str, float]:
        name = of_halves(halves, materials, at)
        return json.loads(run(halves, "-q", "reduced", name, "--json")[0])

    one = result('material = "steel"')
    two = result('materials = { left = "steel", right = "same" }')
    for key in ("outer_force_peak", "outer_restitution", "first_frequency", "mesh_error"):
        assert two[key] == pytest.approx(one[key], rel=1e-9), key
    # renaming changes nothing, another material does
    swapped = result('materials = { left = "same", right = "steel" }')
    soft = result('materials = { left = "steel", right = "soft" }')
    stiff = result('materials = { left = "steel", right = "soft" }', at="3 mm")
    assert swapped["scene_hash"] == two["scene_hash"] != soft["scene_hash"]

    # Hertz: F = k d^1.5, 2/5 k d^2.5 = m v^2/2
    def hertz(youngs_modulus: float, poisson_ratio: float) -> float:
        own = (1.0 - 0.3**2) / 210e9
        modulus = 1.0 / (own + (1.0 - poisson_ratio**2) / youngs_modulus)
        stiffness = 4.0 / 3.0 * modulus * math.sqrt(1e-3)
        mass = 7780.0 * 4.0 / 3.0 * math.pi * 1e-9
        return stiffness * (1.25 * mass * 0.05**2 / stiffness) ** 0.6

    assert soft["outer_force_peak"] == pytest.approx(hertz(3e9, 0.35), rel=0.02)
    assert stiff["outer_force_peak"] == pytest.approx(hertz(210e9, 0.3), rel=0.02)
    (halves / "sweep.toml").write_text(
        'scene = "part.toml"\n[[vary]]\nfield = "materials.soft.youngs_modulus"\n'
        'from = "3 GPa"\nto = "12 GPa"\ncount = 2\n'
    )
    of_halves(halves, 'materials = { left = "steel", right = "soft" }')
    run(halves, "study", "sweep", "sweep.toml", "--out", "swept")
    rows = (halves / "swept" / "sweep.csv").read_text().splitlines()
    column = next(k for k, head in enumerate(rows[0].split(",")) if "outer_force_peak" in head)
    forces = [float(row.split(",")[column]) for row in rows[1:]]
    assert forces == pytest.approx([hertz(3e9, 0.35), hertz(12e9, 0.35)], rel=0.02)


HALF_FAULTS = {
    "both keys": ('material = "steel"\nmaterials = { left = "steel" }', ["both", "materials"]),
    "neither key": ("", ["body.material", "body.materials"]),
    "unknown materials": ('materials = { left = "gold", right = "tin" }', ["gold", "tin"]),
    "no group": ("materials = {}", ["names no group"]),
    "a missing group": ('materials = { left = "steel", rigth = "soft" }', ["'rigth'", "'right'"]),
    "a group left out": ('materials = { left = "steel" }', ["without a material", "right"]),
}


@pytest.mark.parametrize("fault", HALF_FAULTS)
def test_materials_by_group_are_complete_and_known(halves: Path, fault: str) -> None:
    """Each fault is a sentence with status 3; both unknown names are in it."""
    materials, named = HALF_FAULTS[fault]
    said = run(halves, "reduced", of_halves(halves, materials), status=3)[1]
    assert all(word in said for word in named), said


def test_a_contact_next_to_another_material_is_refused(halves: Path) -> None:
    """Hertz's circle needs one material."""
    name = of_halves(halves, 'materials = { left = "steel", right = "soft" }', at="7 mm")
    said = run(halves, "reduced", name, status=3)[1]
    assert "outer.at" in said and "another material" in said, said


def test_a_body_of_several_materials_stays_elastic(halves: Path) -> None:
    """The law of plastic contacts knows one material of the body."""
    name = of_halves(halves, 'materials = { left = "steel", right = "soft" }')
    text = (halves / name).read_text()
    plastic = '"7780 kg/m^3"\nyield_strength = "300 MPa"\nhardening = "1 GPa"'
    (halves / name).write_text(text.replace('"7780 kg/m^3"', plastic, 1))
    said = run(halves, "reduced", name, status=3)[1]
    assert "body.materials" in said and "hardening" in said, said
