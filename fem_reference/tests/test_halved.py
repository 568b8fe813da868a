"""Meshes of bodies with elements of half the size."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference.body.halved import halved
from fem_reference.body.tets import qualities, volume
from fem_reference.solid.mesh import EDGES, FACES

CORNERS = np.array(
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, 1.0, 0.0], [0.2, 0.3, 1.0], [0.9, 0.8, 0.9]]
)
CELLS = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])


def curved_pair() -> tuple[np.ndarray, np.ndarray]:
    """Two curved tetrahedra that share a face."""
    points, number, cells = list(CORNERS), {}, []
    shift = np.random.default_rng(1)
    for cell in CELLS:
        # of positive volume
        if np.linalg.det(CORNERS[cell[1:]] - CORNERS[cell[0]]) < 0.0:
            cell = cell[[0, 2, 1, 3]]
        for a, b in EDGES:
            key = tuple(sorted((cell[a], cell[b])))
            if key not in number:
                number[key] = len(points)
                points.append(
                    0.5 * (CORNERS[cell[a]] + CORNERS[cell[b]]) + shift.normal(0, 0.02, 3)
                )
        cells.append([*cell, *(number[tuple(sorted((cell[a], cell[b])))] for a, b in EDGES)])
    return np.array(points), np.array(cells)


def test_a_curved_body_stays_what_it_is() -> None:
    points, cells = curved_pair()
    finer_points, finer = halved(points, cells)
    assert finer.shape == (16, 10)
    assert np.array_equal(np.unique(finer), np.arange(finer_points.shape[0]))
    assert qualities(finer_points, finer).min() > 0.1
    # each old element is filled by its own eight
    for k, cell in enumerate(cells):
        parts = volume(finer_points, finer[8 * k : 8 * k + 8])
        assert parts == pytest.approx(volume(points, cell[None]), rel=1e-12)
    # 35 nodes each, of which the 15 of the shared face are the same
    assert finer_points.shape == (55, 3)
    faces = np.concatenate([finer[:, list(face)] for face in FACES])
    _, owners = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
    # 24 on the surface; 4 between the old elements and 8 within each
    assert np.bincount(owners).tolist() == [0, 24, 20]


def test_nodes_in_the_middle_lie_on_the_old_curves() -> None:
    """The finer elements' own shape functions give the old ones' places."""
    points, cells = curved_pair()
    finer_points, finer = halved(points, cells)
    place = np.array([0.1, 0.2, 0.3, 0.4])
    shapes = np.array(
        [*(place * (2.0 * place - 1.0)), *(4.0 * place[a] * place[b] for a, b in EDGES)]
    )
    corners = np.eye(4)
    ten = np.array([*corners, *(0.5 * (corners[a] + corners[b]) for a, b in EDGES)])
    for cell in finer[:4]:
        # the first four are those at the old corners: their barycentric places are known
        own = [int(np.flatnonzero(cells[0] == node)[0]) for node in cell[:4]]
        old = place @ ten[own]
        expected = np.array(
            [*(old * (2.0 * old - 1.0)), *(4.0 * old[a] * old[b] for a, b in EDGES)]
        )
        assert shapes @ finer_points[cell] == pytest.approx(expected @ points[cells[0]], rel=1e-12)
