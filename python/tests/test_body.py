"""Bodies from CAD and mesh files, from the command line: accuracy, faults, pages."""

import json
import math
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PROGRAM = os.environ["IMPACTCHECK_PROGRAM"]
# a Python that has gmsh
MESHER = os.environ["IMPACTCHECK_PYTHON"]

STEEL = """
[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio  = 0.3
density        = "7780 kg/m^3"
"""

PLATE = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
plate = gmsh.model.occ.addCylinder(0, 0, -1, 0, 0, 2, 33)
gmsh.model.occ.synchronize()
gmsh.write("plate.step")
gmsh.finalize()
"""

BLOCK = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
block = gmsh.model.occ.addBox(0, 0, 0, 10, 10, 5)
gmsh.model.occ.synchronize()
gmsh.model.addPhysicalGroup(3, [block], name="block")
gmsh.model.addPhysicalGroup(2, [5], name="base")
gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
gmsh.model.mesh.generate(2)
gmsh.write("surface.msh")
gmsh.model.mesh.generate(3)
gmsh.write("block.msh")
gmsh.finalize()
"""

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
gmsh.option.setNumber("Mesh.MeshSizeMax", 1.2)
gmsh.model.mesh.generate(3)
gmsh.write("halves.msh")
gmsh.finalize()
"""


def made(folder: Path, script: str) -> None:
    """Runs a script of gmsh in ``folder``."""
    done = subprocess.run(
        [MESHER, "-c", script], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def run(folder: Path, *arguments: str, status: int = 0) -> tuple[str, str]:
    """Standard output and error of the program; its exit status has to be ``status``."""
    environment = {**os.environ, "IMPACTCHECK_CACHE": str(folder / "cache")}
    done = subprocess.run(
        [PROGRAM, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, f"{arguments}: {done.returncode} {done.stdout}{done.stderr}"
    return done.stdout, done.stderr


def scene(
    folder: Path,
    body: str,
    outer: str = 'at = ["0 mm", "0 mm", "1 mm"]',
    inner: str = "",
    radius: str = "10 mm",
    speed: str = "550 mm/s",
) -> str:
    """Writes ``part.toml``; its name."""
    behind = f'[inner]\nkind = "sphere"\nradius = "{radius}"\nmaterial = "steel"\n{inner}\n'
    text = f"""
name = "part"
kind = "impact"
{STEEL}
[body]
material = "steel"
{body}
[outer]
kind     = "sphere"
radius   = "{radius}"
material = "steel"
speed    = "{speed}"
{outer}
{behind if inner else ""}
"""
    (folder / "part.toml").write_text(text)
    return "part.toml"


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with Table 1's plate as STEP."""
    folder = tmp_path_factory.mktemp("plate")
    made(folder, PLATE)
    return folder


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a block as a mesh of linear tetrahedra, and its surface alone."""
    folder = tmp_path_factory.mktemp("block")
    made(folder, BLOCK)
    return folder


@pytest.mark.parametrize(
    ("radius", "speed", "shipped"),
    [("10 mm", "550 mm/s", "scaled-plate-r10"), ("6.35 mm", "437 mm/s", "scaled-plate-r6.35")],
)
def test_a_plate_given_as_step_is_the_circular_plate(
    plate: Path, radius: str, speed: str, shipped: str
) -> None:
    """Model C of the plate impact, an independent axisymmetric discretisation, is the truth."""
    body = 'file = "plate.step"\nfixed = [["33 mm", "0 mm", "0 mm"]]'
    name = scene(plate, body, inner='at = ["0 mm", "0 mm", "-1 mm"]', radius=radius, speed=speed)
    ours = json.loads(run(plate, "-q", "reduced", name, "--json")[0])
    truth = json.loads(run(plate, "-q", "reduced", shipped, "--model", "C", "--json")[0])
    errors = {
        key: abs(ours[key] / truth[key] - 1.0)
        for key in ("efficiency", "outer_force_peak", "inner_force_peak")
    }
    assert errors["efficiency"] < 0.005, errors
    assert max(errors.values()) < 0.005, errors
    # what is stated is neither too small nor of another size
    assert ours["mesh_error"] < 0.02
    assert max(errors.values()) < 3.0 * ours["mesh_error"], (errors, ours["mesh_error"])
    assert ours["solve_seconds"] < 1.0
    assert abs(ours["first_frequency"] / truth["first_frequency"] - 1.0) < 0.005


def test_model_c_of_an_off_centre_impact_is_within_the_reference_s_uncertainty(
    tmp_path: Path,
) -> None:
    """The stored three-dimensional finite-element solution is independent of model C's mesh."""
    project = Path(__file__).parents[2]
    name = str(project / "scenes" / "validation" / "off-centre.toml")
    ours = json.loads(run(tmp_path, "-q", "reduced", name, "--model", "C", "--json")[0])
    stored = project / "fem_reference" / "solutions" / "off-centre" / "paper" / "summary.json"
    truth = json.loads(stored.read_text())
    assert ours["scene_hash"] == truth["scene_hash"]
    for key in ("efficiency", "outer_force_peak", "inner_force_peak", "outer_velocity_final"):
        assert abs(ours[key] - truth[key]) < truth["uncertainty"][key], key
    assert ours["model"] == "C" and 0.0 < ours["mesh_error"] < 0.01
    said = run(tmp_path, "reduced", name, "--model", "C", "--modes", "25", "--json", status=2)[1]
    assert "24 modes at most" in said, said


def test_model_c_of_an_off_centre_impact_needs_a_clamped_or_free_edge(tmp_path: Path) -> None:
    """A free plate keeps the momentum; a simply supported one is refused by name."""
    text = f"""
name = "beside"
kind = "plate-impact"
{STEEL}
[plate]
radius    = "16 mm"
thickness = "2 mm"
edge      = "EDGE"
material  = "steel"
[outer]
kind     = "sphere"
radius   = "6 mm"
material = "steel"
speed    = "550 mm/s"
offset   = "0.1 mm"
[inner]
kind     = "sphere"
radius   = "6 mm"
material = "steel"
"""
    (tmp_path / "beside.toml").write_text(text.replace("EDGE", "simply-supported"))
    said = run(tmp_path, "reduced", "beside.toml", "--model", "C", status=12)[1]
    assert "outer.offset" in said and "clamped or free" in said, said
    (tmp_path / "beside.toml").write_text(text.replace("EDGE", "free"))
    beside = json.loads(run(tmp_path, "-q", "reduced", "beside.toml", "--model", "C", "--json")[0])
    (tmp_path / "centred.toml").write_text(
        text.replace("EDGE", "free").replace('offset   = "0.1 mm"', "")
    )
    centred = json.loads(
        run(tmp_path, "-q", "reduced", "centred.toml", "--model", "C", "--json")[0]
    )
    # so near the centre it is the axisymmetric model C, another discretisation
    for key in ("efficiency", "outer_force_peak", "inner_force_peak"):
        assert beside[key] == pytest.approx(centred[key], rel=0.01), key
    assert beside["momentum_residual"] < 1e-9


def test_a_mesh_of_somebody_s_own_is_struck_seen_and_swept(block: Path) -> None:
    """Linear tetrahedra in mm, a named face; frequencies, page, sweep, uncertainty, restitution."""
    body = 'file = "block.msh"\nunit = "mm"\nfixed = ["base"]'
    at = 'at = ["5 mm", "5 mm", "0 mm"]'
    name = scene(block, body, outer=at, radius="2 mm", speed="100 mm/s")
    # gmsh's face 5 of a box is its lower one: struck there it is held, which has no residual
    said = run(block, "reduced", name, status=12)[1]
    assert "outer contact" in said and "held" in said, said
    name = scene(
        block, body, outer='at = ["5 mm", "5 mm", "5 mm"]', radius="2 mm", speed="100 mm/s"
    )
    with (block / name).open("a") as file:
        file.write("\n[reduced]\nfrequencies = 3\n")
    summary = json.loads(run(block, "-q", "reduced", name, "--page", "part.html", "--json")[0])
    assert len(summary["frequencies"]) == 3
    assert sorted(summary["frequencies"]) == summary["frequencies"]
    assert 0.9 < summary["outer_restitution"] < 1.0
    assert summary["inner_force_peak"] is None
    page = (block / "part.html").read_text()
    assert 'class="body-view"' in page and "mode 1" in page
    assert len(page) < 1_500_000
    (block / "sweep.toml").write_text(
        'scene = "part.toml"\n[[vary]]\nfield = "outer.speed"\n'
        'from = "50 mm/s"\nto = "200 mm/s"\ncount = 8\n'
    )
    run(block, "study", "sweep", "sweep.toml", "--out", "swept")
    rows = (block / "swept" / "sweep.csv").read_text().splitlines()
    assert len(rows) == 9 and all(",ok," in row for row in rows[1:])
    # the optimum lies in another folder and still finds its body
    run(block, "optimise", name, "--over", "outer.radius=1mm..3mm", "--out", "best")
    run(block, "reduced", "best/optimum.toml")
    run(block, "-q", "mesh", name, "--out", "part.vtu", "--page", "mesh.html")
    assert (block / "part.json").exists() and (block / "mesh.html").exists()


BEAM = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.occ.addBox(-100, -1, -2, 200, 2, 2)
gmsh.model.occ.synchronize()
gmsh.write("beam.step")
gmsh.finalize()
"""


def struck_beam(stiffness: float, mass: float, speed: float) -> tuple[float, float]:
    """Restitution and force peak of a Hertz contact at the middle of a clamped steel beam.

    Length 200 mm, 2 mm square; 24 symmetric modes of Euler and Bernoulli, slowed by Timoshenko's
    shear (coefficient 5/6) and rotary inertia.
    """
    length, side, youngs, density = 0.2, 2e-3, 210e9, 7780.0
    roots = (np.arange(0, 48, 2) + 1.5) * math.pi
    # cos x cosh x = 1; only the first root differs from its asymptote by more than 1e-7
    roots[0] = 4.730040745
    number, gyration = roots / length, side**2 / 12.0
    shear = 1.0 + 2.0 * 1.3 * 6.0 / 5.0
    omega = number**2 * math.sqrt(youngs * gyration / density)
    omega /= np.sqrt(1.0 + number**2 * gyration * shear)
    ratio = (np.cosh(roots) - np.cos(roots)) / (np.sinh(roots) - np.sin(roots))
    # cosh - ratio sinh at the middle, without the difference of large numbers
    decay = np.exp(-0.5 * roots) + (1.0 - ratio) * np.sinh(0.5 * roots)
    shape = decay - np.cos(0.5 * roots) + ratio * np.sin(0.5 * roots)
    shape /= math.sqrt(density * side**2 * length)
    place, own, moved, rate = 0.0, speed, np.zeros(24), np.zeros(24)
    step, peak = 5e-9, 0.0
    while True:
        approach = place - shape @ moved
        if approach < 0.0:
            return -own / speed, peak
        force = stiffness * approach**1.5
        peak = max(peak, force)
        own -= step * force / mass
        place += step * own
        rate += step * (shape * force - omega**2 * moved)
        moved += step * rate


def test_a_beam_under_impact_answers_as_the_modes_of_a_beam(tmp_path: Path) -> None:
    """A soft body, and a hard one so short in contact that the model's few modes do not suffice."""
    made(tmp_path, BEAM)
    body = 'file = "beam.step"\nfixed = [["-100 mm", "0 mm", "-1 mm"], ["100 mm", "0 mm", "-1 mm"]]'
    steel = (1.0 - 0.3**2) / 210e9

    def both(material: str, own: float, radius: float, mass: float) -> tuple[dict[str, float], Any]:
        outer = f'at = ["0 mm", "0 mm", "0 mm"]\nmass = {mass}\ntip_radius = {radius}'
        name = scene(tmp_path, body, outer=outer, speed="100 mm/s")
        text = (tmp_path / name).read_text()
        text = text.replace('kind     = "sphere"\nradius   = "10 mm"', 'kind = "compact"')
        head, tail = text.split("[outer]")
        (tmp_path / name).write_text(head + SOFT + "[outer]" + tail.replace('"steel"', material, 1))
        ours = json.loads(run(tmp_path, "-q", "reduced", name, "--json")[0])
        return ours, struck_beam(4.0 / 3.0 / (steel + own) * math.sqrt(radius), mass, 0.1)

    ours, (restitution, peak) = both('"soft"', (1.0 - 0.4**2) / 50e6, 4e-3, 3.217e-4)
    assert ours["outer_restitution"] == pytest.approx(restitution, rel=2e-3)
    assert ours["outer_force_peak"] == pytest.approx(peak, rel=2e-3)
    assert ours["truncation_error"] < 1e-3
    ours, (restitution, peak) = both('"steel"', steel, 1e-3, 3.259e-5)
    assert abs(ours["outer_restitution"] - restitution) < ours["truncation_error"]
    assert abs(ours["outer_force_peak"] / peak - 1.0) < ours["truncation_error"]
    assert any("higher modes" in warning for warning in ours["warnings"])


SOFT = """
[materials.soft]
youngs_modulus = "50 MPa"
poisson_ratio  = 0.4
density        = "1200 kg/m^3"
"""


def test_a_scene_is_begun_from_a_file(plate: Path) -> None:
    """Its faces are listed, and it runs as it stands but for the mesh, which is not made here."""
    (plate / "cad").mkdir(exist_ok=True)
    run(plate, "new", "cad/from-cad", "--from", "plate.step")
    text = (plate / "cad" / "from-cad.toml").read_text()
    assert "bounding box 66 x 66 x 2 mm" in text and '"face 1"' in text


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


FAULTS = {
    "no such file": ('file = "none.msh"', None, "none.msh"),
    "an ending that nobody knows": ('file = "part.toml"', None, ".toml"),
    "a surface without volume": ('file = "surface.msh"\nunit = "mm"', None, "surface"),
    "millimetres as metres": ('file = "block.msh"', None, "unit"),
    "a missing group": ('file = "block.msh"\nunit = "mm"\nfixed = ["bas"]', None, "'base'"),
    "a point inside": (
        'file = "block.msh"\nunit = "mm"',
        'at = ["5 mm", "5 mm", "2.5 mm"]',
        "outer.at",
    ),
    "a point far away": (
        'file = "block.msh"\nunit = "mm"',
        'at = ["50 mm", "5 mm", "5 mm"]',
        "outer.at",
    ),
    "a place without a body's": ('file = "block.msh"\nunit = "mm"', "", "outer.at"),
    "a unit that there is not": ('file = "block.msh"\nunit = "inch"', None, "body.unit"),
    "no file at all": ('unit = "mm"', None, "body.file"),
    "two coordinates": ('file = "block.msh"\nunit = "mm"', 'at = ["5 mm", "5 mm"]', "outer.at"),
    "an empty file": ('file = "empty.step"', None, "empty.step"),
    "no STEP inside": ('file = "text.step"', None, "text.step"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_a_sentence_with_status_3_and_leaves_nothing(block: Path, fault: str) -> None:
    """Field or file is named; no mesh is left half-written."""
    body, outer, named = FAULTS[fault]
    (block / "empty.step").write_text("")
    (block / "text.step").write_text("this is no part\n")
    top = 'at = ["5 mm", "5 mm", "5 mm"]'
    name = scene(block, body, outer=top if outer is None else outer, radius="2 mm")
    said = run(block, "reduced", name, status=3)[1]
    assert named in said, said
    assert "Traceback" not in said, said
    run(block, "mesh", name, "--out", "fault.vtu", status=3)
    assert not list(block.glob("fault.*"))
