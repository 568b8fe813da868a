"""Local refinement by bisection: conforming, as fine as asked, of the same volume and shape."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference.common.arrays import Floats, Ints
from fem_reference.solid.bisection import bisected
from fem_reference.solid.mesh import TetMesh, edge_lengths, qualities, surface


def cube() -> tuple[Floats, Ints]:
    """A unit cube of six tetrahedra."""
    points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    paths = [(1, 3), (1, 5), (2, 3), (2, 6), (4, 5), (4, 6)]
    corners = np.array([[0, a, b, 7] for a, b in paths])
    turned = np.linalg.det(points[corners[:, 1:]] - points[corners[:, :1]]) < 0.0
    corners[turned] = corners[turned][:, [1, 0, 2, 3]]
    return points, corners


def sizes(places: Floats) -> Floats:
    """Small at a corner, growing away from it."""
    return 0.05 + 0.4 * np.linalg.norm(places, axis=1)


def test_a_cube_is_cut_into_matching_elements() -> None:
    points, corners = bisected(*cube(), sizes, lambda places: places)
    mesh = TetMesh("cube", points, corners)
    assert mesh.volume() == pytest.approx(1.0, rel=1e-12)
    longest = edge_lengths(points, corners).max(axis=1)
    assert np.all(longest <= sizes(points[corners].mean(axis=1)))
    assert corners.shape[0] > 100
    assert qualities(points, corners).min() > 0.3
    # faces that only one element has are those of the cube
    facets = points[surface(mesh)]
    flat = (np.ptp(facets, axis=1) == 0.0) & np.isin(facets[:, 0], (0.0, 1.0))
    assert flat.any(axis=1).all()
    area = 0.5 * np.linalg.norm(
        np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0]), axis=1
    )
    assert area.sum() == pytest.approx(6.0, rel=1e-12)
    again = bisected(*cube(), sizes, lambda places: places)
    assert np.array_equal(again[0], points)
    assert np.array_equal(again[1], corners)


def test_new_nodes_of_the_surface_go_where_it_is() -> None:
    start, corners = cube()
    start = (start - 0.5) / np.linalg.norm([0.5, 0.5, 0.5])

    def on_sphere(places: Floats) -> Floats:
        return places / np.linalg.norm(places, axis=1, keepdims=True)

    points, corners = bisected(start, corners, lambda at: np.full(len(at), 0.3), on_sphere)
    mesh = TetMesh("ball", points, corners)
    outside = np.unique(surface(mesh))
    assert np.linalg.norm(points[outside], axis=1) == pytest.approx(1.0, rel=1e-12)
    assert mesh.volume() == pytest.approx(4.0 / 3.0 * np.pi, rel=0.03)


def test_what_is_fine_enough_stays() -> None:
    points, corners = cube()
    same = bisected(points, corners, lambda at: np.full(len(at), 2.0), lambda places: places)
    assert np.array_equal(same[0], points)
    assert np.array_equal(same[1], corners)
