"""Meshes: volumes in closed form, matching contact nodes, refinement, degenerate elements."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fem_reference.axisymmetric.elasticity import assemble
from fem_reference.axisymmetric.grading import graded
from fem_reference.axisymmetric.mesh import BodyMesh, check_elements, edge_lengths, element_volumes
from fem_reference.common.errors import SceneError, SolverError
from fem_reference.plate_impact.axisymmetric import LEAST_ELEMENTS_PER_WAVELENGTH, refined
from fem_reference.plate_impact.estimate import estimate_contact
from fem_reference.plate_impact.meshing import (
    CONTACT_ZONE,
    NOT_REFINED,
    ImpactMesh,
    build_system,
    mesh_impact,
    mesh_settings,
)
from fem_reference.plate_impact.scene import Scene, parse_scene
from fem_reference.plate_impact.studies.random_scenes import draw
from fem_reference.plate_impact.suitability import per_wavelength

from .conftest import document, integrate


def build(scene: Scene, factor: float = 1.0) -> ImpactMesh:
    estimate = estimate_contact(scene)
    return mesh_impact(
        scene, mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, factor)
    )


@pytest.fixture(scope="module")
def mesh(scene: Scene) -> ImpactMesh:
    return build(scene)


def test_element_volume_of_a_ring_closed_form() -> None:
    points = np.array([[1.0, 0.0], [3.0, 0.0], [3.0, 5.0], [1.0, 5.0]])
    volume = element_volumes(points, np.array([[0, 1, 2, 3]]))
    assert volume == pytest.approx(math.pi * (9 - 1) * 5, rel=1e-14)


def test_sphere_and_plate_have_their_exact_mass(scene: Scene, mesh: ImpactMesh) -> None:
    for body, exact in (
        (mesh.outer, scene.outer.mass),
        (mesh.inner, scene.inner.mass),
        (mesh.plate, 7780.0 * math.pi * 0.033**2 * 0.002),
    ):
        matrices = assemble(body, scene.plate.material)
        assert matrices.mass.sum() == pytest.approx(exact, rel=1e-12)
        assert matrices.mass.min() > 0.0


def test_contact_nodes_match_pairwise(mesh: ImpactMesh) -> None:
    for surface, body, sign in (
        (mesh.outer_contact, mesh.outer, 1.0),
        (mesh.inner_contact, mesh.inner, -1.0),
    ):
        sphere = body.points[surface.body_nodes]
        plate = mesh.plate.points[surface.plate_nodes]
        assert np.allclose(sphere[:, 0], plate[:, 0], rtol=0.0, atol=1e-15)
        assert np.allclose(plate[:, 1], sign * 0.001, rtol=0.0, atol=1e-15)
        height = sign * (sphere[:, 1] - plate[:, 1])
        exact = 0.01 - np.sqrt(0.01**2 - sphere[:, 0] ** 2)
        assert np.allclose(height, exact, rtol=0.02, atol=1e-12)
        assert np.unique(surface.body_nodes).size == surface.radii.size


def test_inner_sphere_stands_off_by_its_gap() -> None:
    mesh = build(parse_scene(document(inner__gap=2e-5)))
    assert mesh.inner.points[:, 1].max() == pytest.approx(-0.001 - 2e-5, abs=1e-15)


def test_contact_zone_has_the_requested_elements(scene: Scene, mesh: ImpactMesh) -> None:
    smallest = min(estimate_contact(scene).inner_radius, estimate_contact(scene).outer_radius)
    size = mesh.settings.contact_element
    assert smallest / size == pytest.approx(4.0, rel=1e-12)
    radii = mesh.outer_contact.radii
    assert radii[-1] == pytest.approx(mesh.settings.contact_zone, rel=1e-12)
    # Finest where the edge of contact stands at the peaks, nowhere twice as coarse as asked.
    gaps, middles = np.diff(radii), 0.5 * (radii[1:] + radii[:-1])
    low, high = mesh.settings.edge or (0.0, 0.0)
    assert gaps[(middles > low) & (middles < high)].max() < 0.8 * size
    assert gaps.max() < 2.0 * size
    # At least eight elements through the thickness, also at the rim.
    rim = mesh.plate.points[:, 0] > 0.033 * (1 - 1e-9)
    assert rim.sum() - 1 >= 8


def test_refinement_divides_every_direction(scene: Scene) -> None:
    coarse, fine = build(scene, 2.0), build(scene, 4.0)
    for name in ("outer", "plate", "inner"):
        before, after = getattr(coarse, name), getattr(fine, name)
        assert after.quads.shape[0] / before.quads.shape[0] == pytest.approx(4.0, rel=0.15)
        ratio = (
            edge_lengths(before.points, before.quads).max()
            / edge_lengths(after.points, after.quads).max()
        )
        assert ratio == pytest.approx(2.0, rel=0.2)


def test_graded_division_adds_up() -> None:
    for length in (1.0, 0.05, 0.013):
        segments = graded(length, 0.01, 0.1, 1.2)
        assert sum(segment.length for segment in segments) == pytest.approx(length, rel=1e-12)
        first = segments[0]
        total = sum(first.ratio**k for k in range(first.count))
        assert first.length / total == pytest.approx(0.01, rel=0.35)


def test_patch_test_of_constant_stress_on_distorted_elements(scene: Scene) -> None:
    """U = (a r, b z) strains every element alike: no residual force inside, whatever its shape."""
    grid = np.linspace(0.0, 1.0, 6)
    points = np.array([(r, z) for r in grid for z in grid])
    inside = (points > 0.0).all(axis=1) & (points < 1.0).all(axis=1)
    points[inside] += 0.05 * np.random.default_rng(4).standard_normal((inside.sum(), 2))
    quads = np.array(
        [
            (6 * i + j, 6 * i + j + 6, 6 * i + j + 7, 6 * i + j + 1)
            for i in range(5)
            for j in range(5)
        ]
    )
    body = BodyMesh("plate", points * 1e-3, quads)
    check_elements(body)
    matrices = assemble(body, scene.plate.material)
    force = (matrices.stiffness @ (body.points * np.array([2.0, -0.7])).ravel()).reshape(-1, 2)
    largest = np.abs(force).max()
    assert np.abs(force[inside]).max() < 1e-12 * largest
    # And a rigid motion along the axis costs nothing.
    rigid = matrices.stiffness @ np.tile([0.0, 1e-3], points.shape[0])
    assert np.abs(rigid).max() < 1e-12 * largest


def test_long_elements_bend_without_parasitic_shear(scene: Scene) -> None:
    """Clamped plate, elements half as long as it is thick: 4655 Hz, quadratic continuum elements.

    Bilinear elements of this length without incompatible modes are 4 % too stiff.
    """
    from fem_reference.axisymmetric.modal import first_frequency

    from .conftest import make_system

    system, _ = make_system(scene, 0.5)
    assert first_frequency(system) == pytest.approx(4655.0, rel=5e-4)


def test_solid_elements_bend_as_the_plate_does() -> None:
    """The same plate of tetrahedra, small at its clamped rim; one through it is 0.4 % too stiff."""
    from fem_reference.common.fenicsx import alone
    from fem_reference.explicit.spectrum import first_frequency
    from fem_reference.plate_impact.estimate import shortest_wavelengths
    from fem_reference.plate_impact.motion import PLATE
    from fem_reference.plate_impact.solid_model import plate_model
    from fem_reference.solid.system import make_loop

    def frequency(elements: float) -> float:
        reference = {"geometry": "solid", "elements_per_contact_radius": 2, "rigid": "both"}
        scene = parse_scene(document(reference={**reference, "elements_per_thickness": elements}))
        estimate = estimate_contact(scene)
        waves = shortest_wavelengths(scene, estimate.duration)
        made = plate_model(scene, estimate, waves, 1.0)
        return first_frequency(make_loop(made.model, alone()), made.elastic[PLATE])

    assert frequency(2.0) == pytest.approx(4655.0, rel=1e-3)
    assert frequency(1.0) > 4655.0 * 1.003


def test_degenerate_element_is_refused_with_number_and_place() -> None:
    points = np.array([[0.0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [3.0, 0], [1.5, 0.2]])
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [2, 6, 7, 5]])
    good = BodyMesh("plate", points, quads[:2])
    assert check_elements(good) == pytest.approx(1.0)
    with pytest.raises(SolverError, match=r"element 2 of body 'plate' at r = .* is degenerate"):
        check_elements(BodyMesh("plate", points, quads))


def test_clockwise_element_is_refused(mesh: ImpactMesh) -> None:
    quads = mesh.plate.quads.copy()
    quads[7] = quads[7, ::-1]
    with pytest.raises(SolverError, match="element 7 "):
        check_elements(BodyMesh("plate", mesh.plate.points, quads))


def test_too_small_a_plate_is_refused() -> None:
    with pytest.raises(SceneError, match=r"plate\.radius"):
        build(parse_scene(document(plate__radius=0.001)))


@pytest.mark.parametrize("seed", [6, 25, 49])
def test_elements_follow_the_waves_in_every_body(seed: int) -> None:
    """Random scenes with 1.9, 5.7 and 2.6 elements per wavelength by contact and thickness."""
    scene = draw(seed)
    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius)
    requested = mesh_impact(scene, mesh_settings(scene, *radii, 2.0 / 3.0))
    least, _ = min(per_wavelength(scene, requested, estimate.duration))
    assert least < 0.5 * LEAST_ELEMENTS_PER_WAVELENGTH
    mesh, refinement = refined(scene, radii, 2.0 / 3.0, estimate.duration)
    found = per_wavelength(scene, mesh, estimate.duration)
    assert min(count for count, _ in found) >= LEAST_ELEMENTS_PER_WAVELENGTH
    assert min(count for count, _ in found) < 1.3 * LEAST_ELEMENTS_PER_WAVELENGTH
    # bodies that have enough get no more than elements around the contact bring along
    few = [number > 1.0 for number in refinement]
    assert few == [
        count < LEAST_ELEMENTS_PER_WAVELENGTH
        for count, _ in per_wavelength(scene, requested, estimate.duration)
    ]
    assert mesh.min_quality > 0.4


def test_a_mesh_that_suits_the_waves_is_the_requested_one(scene: Scene, mesh: ImpactMesh) -> None:
    estimate = estimate_contact(scene)
    radii = (estimate.outer_radius, estimate.inner_radius)
    same, refinement = refined(scene, radii, 1.0, estimate.duration)
    assert refinement == NOT_REFINED
    for one, other in zip(same.bodies, mesh.bodies, strict=True):
        assert np.array_equal(one.points, other.points) and np.array_equal(one.quads, other.quads)


def test_each_contact_has_its_own_radius() -> None:
    """The inner sphere is ten times as small as the outer one, and fits its own contact."""
    light = parse_scene(document(inner__radius=0.0006, plate__radius=0.025, outer__radius=0.006))
    estimate = estimate_contact(light)
    assert 5.2 * estimate.outer_radius > light.inner.tip_radius > 5.2 * estimate.inner_radius
    mesh = build(light)
    zone = mesh.inner_contact.radii[-1]
    assert CONTACT_ZONE * estimate.inner_radius <= zone < 0.25 * light.inner.tip_radius
    assert mesh.inner_contact.radii.size < mesh.outer_contact.radii.size
    nodes = mesh.inner.points[mesh.inner_contact.body_nodes]
    assert np.allclose(nodes[:, 0], mesh.inner_contact.radii, rtol=0.0, atol=1e-15)
    fast = parse_scene(document(outer__speed=400.0))
    own = estimate_contact(fast).outer_radius
    with pytest.raises(SceneError, match=f"outer.radius is 0.01 m, but .* of {own:.3g} m"):
        build(fast)


def test_a_zone_of_its_own_gives_what_the_zone_of_both_gives() -> None:
    light = parse_scene(
        document(inner__radius=0.004, plate__radius=0.015, run__end_time=3e-5, outer__radius=0.006)
    )
    estimate = estimate_contact(light)
    settings = mesh_settings(light, estimate.outer_radius, estimate.inner_radius, 1.0)
    own = int(np.searchsorted(settings.zone_radii(), CONTACT_ZONE * estimate.inner_radius))
    assert settings.sphere_elements == (None, None) and own < 0.8 * settings.contact_elements
    runs = [
        integrate(build_system(light, mesh_impact(light, made)), light, estimate.duration)
        for made in (settings, replace(settings, sphere_elements=(None, own)))
    ]
    peaks = [run.contacts[1].force_peak for run in runs]
    assert peaks[1] == pytest.approx(peaks[0], rel=5e-3)
    assert runs[1].inner_velocity == pytest.approx(runs[0].inner_velocity, rel=2e-3)
    assert runs[1].outer_velocity == pytest.approx(runs[0].outer_velocity, rel=1e-3)
    assert runs[1].momentum_residual < 1e-9


@pytest.mark.parametrize("length", [0.3, 1.0, 1.0004, 1.2, 1.3, 1.99, 7.0])
def test_a_division_of_one_element_or_two(length: float) -> None:
    """Hardly longer than its first element: one, and no sliver beside it."""
    (segment,) = graded(length, 1.0, 100.0, 1.2)
    sizes = segment.ratio ** np.arange(segment.count)
    sizes *= length / sizes.sum()
    assert sizes.min() > 0.2 * min(length, 1.0) and sizes.max() < 2.5
