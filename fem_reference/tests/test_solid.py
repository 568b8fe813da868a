"""Three-dimensional elements, contact and loop against closed forms and conservation."""

from __future__ import annotations

import math
import resource
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
from scipy.optimize import brentq

from fem_reference.common.arrays import Floats, Ints
from fem_reference.common.bodies import Material, Sphere, sphere_profile
from fem_reference.common.errors import SolverError
from fem_reference.common.fenicsx import alone, petsc_rows
from fem_reference.common.hertz import effective_modulus, hertz_contact_radius, hertz_stiffness
from fem_reference.common.memory import SOLID, memory_free, require_memory
from fem_reference.explicit.contact import RigidBody, SphereContact, SurfaceContact, guided
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.loop import Loop
from fem_reference.explicit.spectrum import critical_time_step
from fem_reference.solid import meshing
from fem_reference.solid.elasticity import Assembly, cell_stress, lumped_mass, mass_form, von_mises
from fem_reference.solid.mesh import TetMesh, check_elements, surface, tetrahedra
from fem_reference.solid.meshing import RADIUS_STEP, SizeField, part_of_sphere, rounded
from fem_reference.solid.model import ElasticBody, Model, nodal_areas, project, symmetry_plane
from fem_reference.solid.system import make_loop

STEEL = Material("steel", 210e9, 0.3, 7780.0)
RADIUS = 0.01


def quarter(order: int, size: float, side: float = 1.0) -> TetMesh:
    field = SizeField(((0.0, 0.0, 0.0),), 1.3e-3, size, 0.4, 4e-3)
    return part_of_sphere("sphere", Sphere(RADIUS, STEEL), field, order, side)


@pytest.fixture(scope="module", params=[1, 2])
def mesh(request: pytest.FixtureRequest) -> TetMesh:
    return quarter(int(request.param), 0.8e-3)


def matrix(mesh: TetMesh, mass: bool = False) -> scipy.sparse.csr_matrix:
    """Stiffness or consistent mass in the mesh's numbering."""
    assembly = Assembly([mesh], [STEEL])
    if mass:
        form = mass_form(assembly.domain, assembly.domain.cell_constants(density_of(mesh)))
        petsc = assembly.domain.petsc_matrix(form)
    else:
        petsc = assembly.stiffness()
    rows = np.argsort(assembly.nodes)
    rows = (3 * rows[:, None] + np.arange(3)).ravel()
    return petsc_rows(petsc)[rows][:, rows]


def density_of(mesh: TetMesh) -> Floats:
    return np.full(mesh.cells.shape[0], STEEL.density)


def test_products_by_element_are_those_of_the_matrix(mesh: TetMesh) -> None:
    body = ElasticBody(mesh, STEEL, np.empty(0, dtype=np.int64))
    loop = make_loop(Model((body,), (), ()), alone())
    assembled = matrix(mesh)
    x = np.random.default_rng(3).standard_normal(mesh.points.shape)
    expected = (assembled @ x.ravel()).reshape(-1, 3)
    found = loop.gather(loop.product(loop.own(x)))
    assert np.abs(found - expected).max() < 1e-13 * np.abs(expected).max()
    diagonal = loop.gather(loop.diagonal).ravel()
    np.testing.assert_allclose(diagonal, assembled.diagonal(), rtol=1e-12)


def test_a_flat_element_is_avoided_by_slightly_smaller_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    requested = []

    def flat_at_first(name: str, build: object, size: SizeField) -> tuple[Floats, Ints]:
        requested.append((size.least, size.largest))
        points = np.vstack([np.zeros(3), np.eye(3)])
        points[3, 2] = 1e-3 if len(requested) == 1 else 1.0
        return points, np.array([[0, 1, 2, 3]])

    monkeypatch.setattr(meshing, "generate", flat_at_first)
    size = SizeField(((0.0, 0.0, 0.0),), 1.0, 0.2, 0.4, 0.5)
    points, _ = meshing._mended("plate", lambda: None, size)
    assert points[3, 2] == 1.0
    assert np.array(requested) == pytest.approx(np.array([(0.2, 0.5), (0.198, 0.495)]))
    meshing._mended("plate", lambda: None, size)
    assert len(requested) == 3


def test_rigid_motions_cost_no_force(mesh: TetMesh) -> None:
    stiffness = matrix(mesh)
    x, y, z = mesh.points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    motions = [(one, zero, zero), (zero, zero, one), (-y, x, zero), (zero, -z, y), (z, zero, -x)]
    scale = abs(stiffness).max()
    for motion in motions:
        u = np.stack(motion, axis=1).ravel()
        assert np.abs(stiffness @ u).max() < 1e-12 * scale * np.abs(u).max()


def test_a_linear_displacement_gives_its_stress_and_no_force_inside(mesh: TetMesh) -> None:
    gradient = np.array([[1.0, 0.3, -0.2], [0.5, -0.4, 0.1], [0.0, 0.7, 0.6]]) * 1e-4
    u = mesh.points @ gradient.T
    force = (matrix(mesh) @ u.ravel()).reshape(-1, 3)
    inside = np.setdiff1d(np.arange(mesh.points.shape[0]), np.unique(surface(mesh)))
    assert inside.size >= 5
    assert np.abs(force[inside]).max() < 1e-10 * np.abs(force).max()
    strain = 0.5 * (gradient + gradient.T)
    expected = STEEL.lame_lambda * np.trace(strain) * np.eye(3) + 2 * STEEL.shear_modulus * strain
    stress = cell_stress(mesh, STEEL, u)
    columns = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)]
    for column, (i, j) in enumerate(columns):
        assert np.allclose(stress[:, column], expected[i, j], rtol=1e-9, atol=1e-3)
    deviator = expected - np.trace(expected) / 3.0 * np.eye(3)
    assert np.allclose(von_mises(stress), math.sqrt(1.5 * (deviator**2).sum()), rtol=1e-9)


def test_lumped_masses_are_positive_and_in_proportion_to_the_consistent_diagonal(
    mesh: TetMesh,
) -> None:
    lumped = lumped_mass(mesh, STEEL.density)
    assert lumped.min() > 0.0
    exact = STEEL.density * math.pi / 3.0 * RADIUS**3
    assert lumped.sum() == pytest.approx(exact, rel=1e-12)
    diagonal = matrix(mesh, mass=True).diagonal()
    ratio = np.repeat(lumped, 3) / diagonal
    assert np.allclose(ratio, ratio[0], rtol=1e-9)


def test_an_inverted_element_is_refused_with_number_and_place(mesh: TetMesh) -> None:
    corners = mesh.corners.copy()
    corners[7, [0, 1]] = corners[7, [1, 0]]
    x, y, z = mesh.points[corners[7]].mean(axis=0)
    with pytest.raises(SolverError, match=r"element 7 of body 'sphere'.*inverted") as caught:
        check_elements(TetMesh("sphere", mesh.points, corners))
    assert f"x = {x:.6g} m, y = {y:.6g} m, z = {z:.6g} m" in str(caught.value)
    points = mesh.points.copy()
    points[corners[3, 3]] = points[corners[3, :3]].mean(axis=0)
    with pytest.raises(SolverError, match=r"degenerate|inverted"):
        check_elements(TetMesh("sphere", points, corners))


def test_the_surface_is_closed_and_its_nodal_areas_sum_to_it(mesh: TetMesh) -> None:
    facets = surface(mesh)
    a, b, c = (mesh.points[facets[:, k]] for k in range(3))
    normals = 0.5 * np.cross(b - a, c - a)
    assert np.abs(normals.sum(axis=0)).max() < 1e-12 * RADIUS**2
    # Gauss: the volume from the surface, outward normals.
    volume = ((a + b + c) / 3.0 * normals).sum() / 3.0
    assert volume == pytest.approx(mesh.volume(), rel=1e-12)
    areas = nodal_areas(mesh, facets)
    assert areas.min() >= 0.0
    assert areas.sum() == pytest.approx(np.linalg.norm(normals, axis=1).sum(), rel=1e-12)


def test_projection_finds_the_facet_and_interpolates_linear_fields(mesh: TetMesh) -> None:
    facets = surface(mesh)
    on_plane = facets[np.all(mesh.points[facets][:, :, 0] == 0.0, axis=1)]
    angle, radius = np.meshgrid([-1.0, 0.0, 0.9], [1e-3, 4e-3, 9e-3])
    points = np.zeros((9, 3))
    points[:, 1] = (radius * np.cos(angle)).ravel()
    points[:, 2] = RADIUS + (radius * np.sin(angle)).ravel()
    nodes, weights, place = project(points + np.array([2e-4, 0.0, 0.0]), mesh, on_plane)
    assert np.allclose(place, points, atol=1e-12)
    assert np.allclose(weights.sum(axis=1), 1.0, rtol=1e-12)
    assert np.allclose(np.einsum("nk,nkd->nd", weights, mesh.points[nodes]), points, atol=1e-12)
    with pytest.raises(SolverError, match="no facet"):
        project(np.array([[0.0, 3.0 * RADIUS, RADIUS]]), mesh, on_plane)


def body_of(mesh: TetMesh, speed: float) -> ElasticBody:
    fixed = np.concatenate([symmetry_plane(mesh, 0), symmetry_plane(mesh, 1)])
    return ElasticBody(mesh, STEEL, fixed, (0.0, 0.0, speed))


def near_pole(mesh: TetMesh, radius: float) -> tuple[Ints, Floats]:
    place = mesh.points
    distance = np.hypot(place[:, 0], place[:, 1])
    facets = surface(mesh)
    cut = np.all(place[facets][:, :, 0] == 0, axis=1) | np.all(place[facets][:, :, 1] == 0, axis=1)
    outside = np.unique(facets[~cut])
    near = (distance[outside] <= radius) & (np.abs(place[outside, 2]) < 0.5 * RADIUS)
    nodes = outside[near]
    return nodes, distance[nodes]


def collide(model: Model, sign: float, steps_limit: int = 40000) -> tuple[Loop, Floats]:
    """Step until the contact has opened for good; the force (N) of the whole bodies per step."""
    loop = make_loop(model, alone())
    loop.set_step(0.9 * critical_time_step(loop), 1)
    force: list[float] = []
    while len(force) < steps_limit:
        loop.advance(1)
        force.append(4.0 * sign * loop.problem.contacts[0].force[2])
        if len(force) > 500 and not any(force[-200:]):
            return loop, np.array(force)
    raise AssertionError("the bodies do not part")


def hertz(effective: float, radius: float, mass: float, spheres: int) -> tuple[float, float]:
    """Peak force (N) and duration (s) of a collision at `SPEED`.

    Hertz's contact plus what the half-spaces lack of free spheres: each is stiffer by the linear
    flexibility -0.40 / (E r) (inertia relief, Poisson's ratio 0.3; what model C takes from its own
    axisymmetric elements). Duration 2.943275184 delta / v, delta and v those of Hertz.
    """
    k = hertz_stiffness(effective, radius)
    residual = -0.40 * spheres / (STEEL.youngs_modulus * RADIUS)
    energy = 0.5 * mass * SPEED**2

    def surplus(force: float) -> float:
        stored = 0.4 * math.pow(force, 5.0 / 3.0) / math.pow(k, 2.0 / 3.0)
        return stored + 0.5 * residual * force**2 - energy

    approach = (5.0 * mass * SPEED**2 / (4.0 * k)) ** 0.4
    plain = k * approach**1.5
    return float(brentq(surplus, 0.5 * plain, 2.0 * plain)), 2.943275184 * approach / SPEED


SPEED = 2.0


def test_sphere_on_a_rigid_plane_is_hertz() -> None:
    effective = STEEL.plane_strain_modulus
    mass = Sphere(RADIUS, STEEL).mass
    peak, duration = hertz(effective, RADIUS, mass, 1)
    contact_radius = hertz_contact_radius(peak, effective, RADIUS)
    mesh = quarter(2, contact_radius / 2.5)
    nodes, distance = near_pole(mesh, 2.0 * contact_radius)
    # A sphere so large that it is a plane, and that does not move: the nodes' true distance from
    # the plane is that of the exact sphere.
    large = 1e4 * RADIUS
    places = mesh.points[nodes].copy()
    places[:, 2] = sphere_profile(RADIUS, distance)
    rigid = RigidBody("plane", 1.0, np.zeros((3, 3)))
    contact = SphereContact("plane", 0, nodes, 0, (0.0, 0.0, -large), large, places)
    loop, force = collide(Model((body_of(mesh, -SPEED),), (rigid,), (contact,)), 1.0)
    assert force.max() == pytest.approx(peak, rel=0.01)
    assert np.flatnonzero(force)[-1] * loop.dt == pytest.approx(duration, rel=0.02)
    momentum = 4.0 * loop.momenta()[0, 2]
    assert momentum == pytest.approx(mass * SPEED, rel=0.01)
    # What the sphere gains, the guide of the rigid body takes up.
    state = loop.problem.state
    assert momentum + mass * SPEED == pytest.approx(4.0 * state.reaction[2], rel=1e-11)
    assert state.unconverged == 0


def test_two_spheres_of_unlike_meshes_are_hertz_and_conserve() -> None:
    mass = Sphere(RADIUS, STEEL).mass
    effective = effective_modulus(STEEL, STEEL)
    peak, duration = hertz(effective, RADIUS / 2.0, mass / 2.0, 2)
    contact_radius = hertz_contact_radius(peak, effective, RADIUS / 2.0)
    upper, lower = quarter(2, contact_radius / 2.5), quarter(2, contact_radius / 2.1, side=-1.0)
    nodes, distance = near_pole(upper, 2.0 * contact_radius)
    facets = surface(lower)
    place = lower.points[facets]
    facing = np.all(place[:, :, 2] > -0.2 * RADIUS, axis=1)
    facing &= ~np.all(place[:, :, 0] == 0, axis=1) & ~np.all(place[:, :, 1] == 0, axis=1)
    below = upper.points[nodes].copy()
    below[:, 2] = -below[:, 2]
    opposite, weights, _ = project(below, lower, facets[facing])
    normals = np.tile([0.0, 0.0, 1.0], (nodes.size, 1))
    gaps = 2.0 * sphere_profile(RADIUS, distance)
    contact = SurfaceContact("pair", 0, nodes, 1, opposite, weights, normals, gaps)
    model = Model((body_of(upper, -SPEED), body_of(lower, 0.0)), (), (contact,))
    loop, force = collide(model, 1.0)
    assert force.max() == pytest.approx(peak, rel=0.01)
    assert np.flatnonzero(force)[-1] * loop.dt == pytest.approx(duration, rel=0.02)
    before = -0.25 * mass * SPEED
    assert loop.momenta()[:, 2].sum() == pytest.approx(before, rel=1e-12)
    energy = 0.125 * mass * SPEED**2
    gained = energies_of(loop).total - energy - loop.problem.contacts[0].record.work
    assert abs(gained) < 1e-11 * energy
    assert -1e-3 * energy < loop.problem.contacts[0].record.work < 0.0


def test_contact_leaves_no_gap_violated_and_no_pull() -> None:
    mesh = quarter(2, 0.8e-3)
    nodes, _ = near_pole(mesh, 5e-3)
    rigid = RigidBody("ball", 0.001, guided((0.0, 0.0, 1.0)), (0.0, 0.0, 80.0))
    contact = SphereContact("ball", 0, nodes, 0, (0.0, 0.0, -RADIUS), RADIUS)
    loop = make_loop(Model((body_of(mesh, 0.0),), (rigid,), (contact,)), alone())
    loop.set_step(0.9 * critical_time_step(loop), 1)
    most = 0
    for _ in range(60):
        loop.advance(5)
        moved = mesh.points + loop.gather(loop.u)
        centre = np.array([0.0, 0.0, -RADIUS + loop.problem.rigids[0].u[2]])
        gap = np.linalg.norm(moved[nodes] - centre, axis=1) - RADIUS
        force = loop.problem.multipliers(0)
        assert force.min() >= 0.0
        assert gap.min() > -1e-9
        # Where there is a force, the gap is closed (the normal is that of the predicted place).
        assert np.all(np.abs(gap[force > 0.0]) < 1e-9)
        most = max(most, int(np.count_nonzero(force)))
    assert most > 3


def test_a_light_ball_that_overlaps_many_nodes_is_pushed_off_and_pulled_by_none() -> None:
    mesh = quarter(2, 0.8e-3)
    nodes, _ = near_pole(mesh, 5e-3)
    depth = 4e-4
    # Far lighter than a node: what corrects the deepest overlap lifts the ball off the others.
    rigid = RigidBody("ball", 1e-9, guided((0.0, 0.0, 1.0)))
    contact = SphereContact("ball", 0, nodes, 0, (0.0, 0.0, depth - RADIUS), RADIUS)
    loop = make_loop(Model((body_of(mesh, 0.0),), (rigid,), (contact,)), alone())
    loop.set_step(0.9 * critical_time_step(loop), 1)
    overlap = np.linalg.norm(mesh.points[nodes] - contact.centre, axis=1) < RADIUS
    assert np.count_nonzero(overlap) > 5
    loop.advance(1)
    moved = mesh.points + loop.gather(loop.u)
    centre = np.array([0.0, 0.0, depth - RADIUS + loop.problem.rigids[0].u[2]])
    gap = np.linalg.norm(moved[nodes] - centre, axis=1) - RADIUS
    force = loop.problem.multipliers(0)
    assert force.min() >= 0.0
    assert 0 < np.count_nonzero(force) < np.count_nonzero(overlap)
    # Normals are those of the predicted place: second order in the correction remains.
    assert gap.min() > -0.05 * depth


def test_order_one_and_two_have_the_same_corners() -> None:
    one, two = quarter(1, 1.2e-3), quarter(2, 1.2e-3)
    assert np.array_equal(one.cells, two.corners)
    again = tetrahedra("sphere", one.points, one.corners, 2)
    assert np.array_equal(again.points, two.points)


def test_too_little_memory_is_refused() -> None:
    needed = SOLID[2].per_node * 1_000_000
    assert "3000000 dofs" in require_memory(1_000_000, SOLID[2], alone(), 2.0 * needed)
    with pytest.raises(SolverError, match=r"3000000 dofs and needs about .* GB more memory"):
        require_memory(1_000_000, SOLID[2], alone(), needed)
    # the finest mesh of the series is known before the first is solved
    with pytest.raises(SolverError, match=r"finest mesh of the series has about 24000000 dofs"):
        require_memory(1_000_000, SOLID[2], alone(), 2.0 * needed, refinement=2.0)


def test_memory_left_is_that_of_the_tightest_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def write(name: str, text: str) -> None:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)

    assert memory_free(1, tmp_path / "nothing") is None
    write("proc/meminfo", "MemTotal: 16000000 kB\nMemAvailable: 8000000 kB\n")
    assert memory_free(1, tmp_path) == 8e6 * 1024.0
    write("proc/self/cgroup", "0::/jobs/one\n")
    write("sys/fs/cgroup/jobs/one/memory.max", "max\n")
    write("sys/fs/cgroup/jobs/one/memory.current", "1000\n")
    write("sys/fs/cgroup/jobs/memory.max", "3000000000\n")
    write("sys/fs/cgroup/jobs/memory.current", "1000000000\n")
    assert memory_free(1, tmp_path) == 2e9
    write("proc/self/cgroup", "4:cpu,cpuacct:/\n3:memory:/old\n")
    write("sys/fs/cgroup/memory/old/memory.limit_in_bytes", "1500000000\n")
    write("sys/fs/cgroup/memory/old/memory.usage_in_bytes", "1600000000\n")
    assert memory_free(1, tmp_path) == 0.0
    write("sys/fs/cgroup/memory/old/memory.stat", "cache 7\ntotal_inactive_file 300000000\n")
    assert memory_free(1, tmp_path) == 2e8
    write("proc/self/cgroup", "")
    monkeypatch.setattr(resource, "getrlimit", lambda _: (3 * 10**9, 3 * 10**9))
    assert memory_free(1, tmp_path) == 3e9
    assert memory_free(2, tmp_path) == 6e9


def test_radii_found_that_differ_by_round_off_make_the_same_mesh() -> None:
    radii = np.geomspace(1e-5, 1e-3, 400)
    found = np.array([rounded(radius) for radius in radii])
    assert np.abs(np.log(found / radii)).max() <= 0.5 * math.log(RADIUS_STEP) * (1.0 + 1e-9)
    again = np.array([rounded(radius * (1.0 + 1e-11)) for radius in radii])
    # Hardly any radius is that close to the middle between two of the series.
    assert np.count_nonzero(found != again) <= 1
    assert len({rounded(3.1e-4 * (1.0 + e)) for e in (-1e-3, 0.0, 1e-3)}) == 1
