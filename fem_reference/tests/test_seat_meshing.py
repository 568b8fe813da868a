"""The mesh of a seal seat: the CAD model it fills, its elements, its surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from fem_reference.common.arrays import Floats, Ints
from fem_reference.common.errors import SolverError
from fem_reference.seal_seat import meshing
from fem_reference.seal_seat.meshing import cad_volume, seat_mesh
from fem_reference.seal_seat.scene import SeatScene, parse_seat_scene
from fem_reference.solid.collapse import collapse_short_edges
from fem_reference.solid.mesh import TetMesh, edge_lengths, qualities
from fem_reference.solid.meshing import generate
from fem_reference.tests.seal_seat_scenes import DEGREE, seat_document


def scene(improved: bool = False, **changes: Any) -> SeatScene:
    return parse_seat_scene(seat_document(improved, **changes))


@pytest.fixture(scope="module")
def mesh() -> TetMesh:
    """A quadratic one of the improved design."""
    return seat_mesh(scene(True), 0.45)


@pytest.mark.parametrize("improved", [pytest.param(False, marks=pytest.mark.evidence), True])
def test_the_mesh_fills_the_cad_model(improved: bool) -> None:
    design = scene(improved, reference__element_order=1)
    exact = cad_volume(design)
    misses = []
    for factor in (0.6, 1.2):
        mesh = seat_mesh(design, factor)
        misses.append(abs(mesh.volume() / exact - 1.0))
        assert qualities(mesh.points, mesh.corners).min() > 0.1
    # Facets on curved faces: second order in their size.
    assert 2.8 * misses[1] < misses[0] < 0.004


def test_what_gmsh_cannot_mesh_in_metres_it_meshes_in_millimetres(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    largest = []

    def only_millimetres(name: str, add: Any, size: Any) -> Any:
        largest.append(size.largest)
        if size.largest < 0.1:
            raise SolverError("Impossible to mesh periodic surface 24")
        return generate(name, add, size)

    design = scene(reference__element_order=1)
    monkeypatch.setattr(meshing, "generate", only_millimetres)
    mesh = seat_mesh(design, 0.6)
    assert largest[1] == pytest.approx(1e3 * largest[0])
    assert mesh.volume() == pytest.approx(cad_volume(design), rel=4e-3)
    assert qualities(mesh.points, mesh.corners).min() > 0.1
    monkeypatch.setattr(meshing, "CAD_UNITS", (1.0,))
    with pytest.raises(SolverError, match="periodic surface 24"):
        seat_mesh(design, 0.6)


def with_short_edge(points: Floats, corners: Ints) -> tuple[Floats, Ints]:
    """The mesh with a node more, at a thousandth of the first element's first edge."""
    start, end, new = corners[0, 0], corners[0, 1], len(points)
    around = (corners == start).any(axis=1) & (corners == end).any(axis=1)
    near, far = (np.where(corners[around] == old, new, corners[around]) for old in (end, start))
    place = points[start] + 1e-3 * (points[end] - points[start])
    return np.vstack([points, place]), np.vstack([corners[~around], near, far])


def test_an_edge_that_is_far_too_short_is_no_edge_of_the_mesh() -> None:
    # At this tilt the crest between the cones meets the side of the island 3 um from its top edge:
    # gmsh 4.8 keeps that edge, 4.15 does not. The other edge is short in both.
    design = scene(seat__tilt=20.0 * DEGREE)
    made = meshing.corner_mesh(design, 2.0 / 3.0)
    points, corners = with_short_edge(*made)
    assert qualities(points, corners).min() < 0.05
    mended_points, mended = collapse_short_edges(points, corners)
    assert qualities(mended_points, mended).min() > 0.05
    assert len(made[1]) - 10 < len(mended) <= len(made[1])
    volume = TetMesh("seat", mended_points, mended).volume()
    assert volume == pytest.approx(TetMesh("seat", points, corners).volume(), rel=1e-6)


def test_a_seat_with_a_degenerate_element_has_smaller_ones_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    meshes: list[tuple[Floats, Ints]] = []
    places: list[Floats] = []
    made = meshing.corner_mesh

    def flat_at_first(*arguments: Any) -> tuple[Floats, Ints]:
        points, corners = made(*arguments)
        meshes.append((points, corners))
        if len(meshes) == 1:
            top = points[:, 2].argmax()
            element = corners[(corners == top).any(axis=1)][0]
            others = element[element != top]
            place = np.array([0.75, 0.125, 0.124, 0.001]) @ points[[top, *others]]
            corners = np.vstack([corners, [top, *others[:2], len(points)]])
            points = np.vstack([points, place])
            places.append(place)
        return points, corners

    def size_at(place: Floats, points: Floats, corners: Ints) -> float:
        near = np.linalg.norm(points[corners].mean(axis=1) - place, axis=1).argsort()[:20]
        return float(edge_lengths(points, corners[near]).mean())

    monkeypatch.setattr(meshing, "corner_mesh", flat_at_first)
    made_again = seat_mesh(scene(reference__element_order=1), 0.6)
    assert qualities(made_again.points, made_again.corners).min() > 0.05
    before, after = (size_at(places[0], *mesh) for mesh in meshes)
    assert after < 0.8 * before


def test_tools_that_overlap_leave_no_pieces() -> None:
    # OpenCASCADE leaves four pieces of the cones where the notch crosses them.
    design = scene(True, seat__tilt=17.5 * DEGREE, reference__element_order=1)
    between = [cad_volume(scene(True, seat__tilt=tilt * DEGREE)) for tilt in (17.0, 18.0)]
    assert cad_volume(design) == pytest.approx(0.5 * sum(between), rel=1e-3)


def test_sound_meshes_and_long_edges_are_left_as_they_are(mesh: TetMesh) -> None:
    corners = mesh.corners
    points = mesh.points[: corners.max() + 1]
    same_points, same = collapse_short_edges(points, corners)
    assert np.array_equal(points, same_points) and np.array_equal(corners, same)
    # A flat element on long edges stays, for the check of the mesh to find it.
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.5, 1e-3], [0, 0, 1], [1, 1, 1]])
    flat_corners = np.array([[0, 1, 2, 3], [0, 1, 3, 4], [1, 2, 3, 5]])
    assert np.array_equal(collapse_short_edges(flat, flat_corners)[1], flat_corners)
