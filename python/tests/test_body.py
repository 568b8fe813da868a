"""Bodies from CAD and mesh files, from the command line: accuracy, pages."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bodies import BLOCK, STEEL, made, run, scene

PLATES = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
for radius in (16, 33):
    gmsh.model.add("plate")
    gmsh.model.occ.addCylinder(0, 0, -1, 0, 0, 2, radius)
    gmsh.model.occ.synchronize()
    gmsh.write(f"plate-{radius}.step")
gmsh.finalize()
"""
SCENES = Path(__file__).parents[2] / "scenes"


@pytest.fixture(scope="module")
def plates(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the plate of Table 1 and a smaller one as STEP."""
    folder = tmp_path_factory.mktemp("plates")
    made(folder, PLATES)
    return folder


def circular_plate(folder: Path, radius: int, shipped: str) -> dict[str, float]:
    """Model C of a shipped scene whose plate has this radius (mm)."""
    text = (SCENES / f"{shipped}.toml").read_text().partition("[tolerances.A]")[0]
    (folder / "circular.toml").write_text(text.replace("33 mm", f"{radius} mm"))
    return json.loads(run(folder, "-q", "reduced", "circular.toml", "--model", "C", "--json")[0])


STRUCK = [("10 mm", "550 mm/s", "scaled-plate-r10"), ("6.35 mm", "437 mm/s", "scaled-plate-r6.35")]


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a block as a mesh of linear tetrahedra, and its surface alone."""
    folder = tmp_path_factory.mktemp("block")
    made(folder, BLOCK)
    return folder


@pytest.mark.parametrize("size", [16, pytest.param(33, marks=pytest.mark.evidence)])
@pytest.mark.parametrize(("radius", "speed", "shipped"), STRUCK)
def test_a_plate_given_as_step_is_the_circular_plate(
    plates: Path, size: int, radius: str, speed: str, shipped: str
) -> None:
    """Model C of the plate impact, an independent axisymmetric discretisation, is the truth."""
    body = f'file = "plate-{size}.step"\nfixed = [["{size} mm", "0 mm", "0 mm"]]'
    name = scene(plates, body, inner='at = ["0 mm", "0 mm", "-1 mm"]', radius=radius, speed=speed)
    ours = json.loads(run(plates, "-q", "reduced", name, "--json")[0])
    truth = circular_plate(plates, size, shipped)
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


def test_an_oblique_impact_on_a_plate_given_as_step_is_that_on_the_circular_plate(
    plates: Path,
) -> None:
    """The circular plate's model takes its surface as held; a free one as a rigid body."""
    shipped = (SCENES / "validation" / "oblique-friction.toml").read_text()
    for edge, bound in (("clamped", 0.005), ("free", 0.01)):
        (plates / "circular.toml").write_text(shipped.replace('"clamped"', f'"{edge}"'))
        held = 'fixed = [["16 mm", "0 mm", "0 mm"]]' if edge == "clamped" else ""
        name = scene(
            plates,
            f'file = "plate-16.step"\n{held}',
            outer='at = ["0 mm", "0 mm", "1 mm"]\nangle = "30 deg"\nfriction = 0.1',
            inner='at = ["0 mm", "0 mm", "-1 mm"]\nfriction = 0.1',
            radius="6 mm",
        )
        ours, truth = (
            json.loads(run(plates, "-q", "reduced", file, "--model", "C", "--json")[0])
            for file in (name, "circular.toml")
        )
        near = bound * 0.55 * math.sin(math.radians(30.0))
        for body in ("outer", "inner"):
            along, spin = f"{body}_tangential_velocity_final", f"{body}_spin_final"
            assert abs(ours[along] - truth[along]) < near, (edge, along)
            assert 6e-3 * abs(ours[spin] - truth[spin]) < near, (edge, spin)
        assert ours["friction_work"] == pytest.approx(truth["friction_work"], rel=bound), edge


@pytest.mark.evidence
@pytest.mark.parametrize(("radius", "speed", "shipped"), STRUCK)
def test_the_reference_of_a_plate_given_as_step_is_that_of_the_circular_plate(
    plates: Path, radius: str, speed: str, shipped: str
) -> None:
    """Solid elements of `coarse` against the stored axisymmetric ones, half an hour a plate."""
    body = 'file = "plate-33.step"\nfixed = [["33 mm", "0 mm", "0 mm"]]'
    name = scene(plates, body, inner='at = ["0 mm", "0 mm", "-1 mm"]', radius=radius, speed=speed)
    run(plates, "--store", shipped, "reference", name, "--resolution", "coarse")
    (solution,) = (plates / shipped).glob("*/coarse/summary.json")
    ours = json.loads(solution.read_text())
    solutions = SCENES.parent / "fem_reference" / "solutions"
    truth = json.loads((solutions / shipped / "paper" / "summary.json").read_text())
    for key in ("efficiency", "outer_force_peak", "inner_force_peak", "first_frequency"):
        both = math.hypot(*(each["uncertainty"][key] for each in (ours, truth)))
        assert abs(ours[key] - truth[key]) < both, key


ONE_LAYER = """
import gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
plate = gmsh.model.occ.addCylinder(0, 0, -1, 0, 0, 2, 16)
gmsh.model.occ.synchronize()
gmsh.model.addPhysicalGroup(3, [plate], name="plate")
gmsh.model.addPhysicalGroup(2, [1], name="rim")
field = gmsh.model.mesh.field
field.add("MathEval", 1)
field.setString(1, "F", "2 + 2.5 * Sqrt(x*x + y*y) / 33")
field.setAsBackgroundMesh(1)
for source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
    gmsh.option.setNumber("Mesh.MeshSize" + source, 0)
gmsh.model.mesh.generate(3)
gmsh.model.mesh.setOrder(2)
gmsh.write("plate.msh")
gmsh.finalize()
"""


def test_the_error_of_a_mesh_with_one_layer_is_that_of_a_finer_one(tmp_path: Path) -> None:
    """A coarser mesh has one layer too: what both miss would not show."""
    made(tmp_path, ONE_LAYER)
    body = 'file = "plate.msh"\nunit = "mm"\nfixed = ["rim"]'
    for radius, speed, shipped in STRUCK:
        behind = 'at = ["0 mm", "0 mm", "-1 mm"]'
        name = scene(tmp_path, body, inner=behind, radius=radius, speed=speed)
        ours = json.loads(run(tmp_path, "-q", "reduced", name, "--json")[0])
        truth = circular_plate(tmp_path, 16, shipped)
        keys = ("efficiency", "outer_force_peak", "inner_force_peak")
        error = max(abs(ours[key] / truth[key] - 1.0) for key in keys)
        assert error < ours["mesh_error"] < 3.0 * error, (shipped, error)
        assert any("one layer of elements" in warning for warning in ours["warnings"])


def test_model_c_of_an_off_centre_impact_is_within_the_reference_s_uncertainty(
    tmp_path: Path,
) -> None:
    """The stored three-dimensional finite-element solution is independent of model C's mesh."""
    project = Path(__file__).parents[2]
    name = str(SCENES / "validation" / "off-centre.toml")
    ours = json.loads(run(tmp_path, "-q", "reduced", name, "--model", "C", "--json")[0])
    stored = project / "fem_reference" / "solutions" / "off-centre" / "paper" / "summary.json"
    truth = json.loads(stored.read_text())
    assert ours["scene_hash"] == truth["scene_hash"]
    for key in ("efficiency", "outer_force_peak", "inner_force_peak", "outer_velocity_final"):
        assert abs(ours[key] - truth[key]) < truth["uncertainty"][key], key
    assert ours["model"] == "C" and 0.0 < ours["mesh_error"] < 0.01
    said = run(tmp_path, "reduced", name, "--model", "C", "--modes", "25", "--json", status=2)[1]
    assert "24 modes at most" in said, said


def test_an_oblique_off_centre_impact_with_friction_is_that_of_finite_elements(
    tmp_path: Path,
) -> None:
    """Along the surface C within 1, Kirchhoff's plate within 2 % of the incoming velocity there."""
    name = "off-centre-oblique"
    file = str(SCENES / "validation" / f"{name}.toml")
    project = Path(__file__).parents[2]
    stored = project / "fem_reference" / "solutions" / name / "paper" / "summary.json"
    truth = json.loads(stored.read_text())
    incoming = 0.55 * math.sin(math.radians(30.0))
    for model, share, error in (("B", 0.02, 0.01), ("C", 0.01, truth["uncertainty"]["efficiency"])):
        near = share * incoming
        ours = json.loads(run(tmp_path, "-q", "reduced", file, "--model", model, "--json")[0])
        for body in ("outer", "inner"):
            along, spin = f"{body}_tangential_velocity_final", f"{body}_spin_final"
            assert abs(ours[along] - truth[along]) < near, (model, along)
            assert 6e-3 * abs(ours[spin] - truth[spin]) < near, (model, spin)
        assert not any("bends or turns what is struck" in warning for warning in ours["warnings"])
        assert abs(ours["efficiency"] - truth["efficiency"]) < error, model


def test_model_c_of_an_off_centre_impact_needs_a_clamped_or_free_edge(tmp_path: Path) -> None:
    """A free plate keeps the momentum; a simply supported one is refused by name."""
    text = f"""
name = "beside"
kind = "plate-impact"
{STEEL}
[plate]
radius    = "10 mm"
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


def test_a_scene_is_begun_from_a_file(plates: Path) -> None:
    """Its faces are listed, and it runs as it stands but for the mesh, which is not made here."""
    (plates / "cad").mkdir(exist_ok=True)
    run(plates, "new", "cad/from-cad", "--from", "plate-16.step")
    text = (plates / "cad" / "from-cad.toml").read_text()
    assert "bounding box 32 x 32 x 2 mm" in text and '"face 1"' in text
