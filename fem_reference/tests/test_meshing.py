"""Meshes: volumes in closed form, matching contact nodes, refinement, degenerate elements."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fem_reference.elasticity import assemble
from fem_reference.errors import SceneError, SolverError
from fem_reference.estimate import estimate_contact
from fem_reference.grading import graded
from fem_reference.mesh import BodyMesh, check_elements, edge_lengths, element_volumes
from fem_reference.meshing import ImpactMesh, mesh_impact, mesh_settings
from fem_reference.scene import Scene, parse_scene

from .conftest import document


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
        sphere = body.points[surface.sphere_nodes]
        plate = mesh.plate.points[surface.plate_nodes]
        assert np.allclose(sphere[:, 0], plate[:, 0], rtol=0.0, atol=1e-15)
        assert np.allclose(plate[:, 1], sign * 0.001, rtol=0.0, atol=1e-15)
        height = sign * (sphere[:, 1] - plate[:, 1])
        exact = 0.01 - np.sqrt(0.01**2 - sphere[:, 0] ** 2)
        assert np.allclose(height, exact, rtol=0.02, atol=1e-12)
        assert np.unique(surface.sphere_nodes).size == surface.radii.size


def test_inner_sphere_stands_off_by_its_gap() -> None:
    mesh = build(parse_scene(document(inner__gap=2e-5)))
    assert mesh.inner.points[:, 1].max() == pytest.approx(-0.001 - 2e-5, abs=1e-15)


def test_contact_zone_has_the_elements_asked_for(scene: Scene, mesh: ImpactMesh) -> None:
    smallest = min(estimate_contact(scene).inner_radius, estimate_contact(scene).outer_radius)
    size = mesh.settings.contact_element
    assert smallest / size == pytest.approx(4.0, rel=1e-12)
    assert np.allclose(np.diff(mesh.outer_contact.radii), size)
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
