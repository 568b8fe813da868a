"""Single tetrahedra: stiffness, critical time step, and what the compiled loop needs of them."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from ..explicit.elements import Tetrahedra
from .elasticity import LUMPED_SHARES
from .mesh import EDGES, TetMesh, volumes

CHUNK = 2000
"""Elements whose stiffness is held at once."""
_A, _B = 0.5854101966249685, 0.1381966011250105
QUADRATURE = np.full((4, 4), _B) + (_A - _B) * np.eye(4)
"""Barycentric coordinates of four points of equal weight, exact to second degree (Keast 1986)."""


def _gradients(points: Floats, cells: Ints) -> tuple[Floats, Floats]:
    """(4, m, n, 3) gradients of the shape functions at the quadrature's points, (m,) volumes."""
    corners = points[cells[:, :4]]
    inverse = np.linalg.inv(corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    flat = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    volume = volumes(points, cells[:, :4])
    if cells.shape[1] == 4:
        return np.broadcast_to(flat, (4, *flat.shape)), volume
    at = []
    for place in QUADRATURE:
        corner = (4.0 * place - 1.0)[None, :, None] * flat
        midside = [4.0 * (place[a] * flat[:, b] + place[b] * flat[:, a]) for a, b in EDGES]
        at.append(np.concatenate([corner, np.stack(midside, axis=1)], axis=1))
    return np.stack(at), volume


def element_stiffness(points: Floats, cells: Ints, material: Material) -> Floats:
    """(m, 3 n, 3 n) stiffness of elements with straight edges, row 3 * node + component, N/m."""
    gradients, volume = _gradients(points, cells)
    count, size = cells.shape
    lame, shear = material.lame_lambda, material.shear_modulus
    stiffness = np.zeros((count, size, 3, size, 3))
    for g in gradients:
        outer = np.einsum("eai,ebj->eaibj", g, g)
        stiffness += lame * outer + shear * outer.transpose(0, 1, 4, 3, 2)
        inner = shear * np.einsum("eak,ebk->eab", g, g)
        for direction in range(3):
            stiffness[:, :, direction, :, direction] += inner
    scaled = stiffness * (0.25 * volume)[:, None, None, None, None]
    return np.asarray(scaled.reshape(count, 3 * size, 3 * size))


def element_time_steps(mesh: TetMesh, material: Material) -> Floats:
    """(m,) critical time step of each element alone with its lumped mass, 2 / omega_max, s.

    That of a body is at least the smallest of its elements'.
    """
    nodes = mesh.cells.shape[1]
    corner, midside = LUMPED_SHARES[mesh.order]
    shares = np.repeat([corner] * 4 + [midside] * (nodes - 4), 3)
    steps = np.empty(mesh.cells.shape[0])
    for start in range(0, steps.size, CHUNK):
        cells = mesh.cells[start : start + CHUNK]
        mass = material.density * volumes(mesh.points, cells[:, :4])[:, None] * shares
        stiffness = element_stiffness(mesh.points, cells, material)
        stiffness /= np.sqrt(mass[:, :, None] * mass[:, None, :])
        steps[start : start + CHUNK] = 2.0 / np.sqrt(np.linalg.eigvalsh(stiffness)[:, -1])
    return steps


def tetrahedra(
    points: Floats,
    elements: Ints,
    number: Ints,
    moduli: tuple[Floats, Floats],
    which: Ints,
) -> Tetrahedra:
    """Elements for the compiled loop.

    Args:
        points: (N, 3) m.
        elements: (e, 4 or 10) nodes.
        number: (N,) of each node in the process, from 0 on.
        moduli: (e,) Lame's constants, Pa.
        which: (e,) number of each element in the system.
    """
    corners = points[elements[:, :4]]
    gradients = np.linalg.inv(corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    share = volumes(points, elements[:, :4]) / (1.0 if elements.shape[1] == 4 else 20.0)
    nodes = number[elements]
    diagonal = np.zeros((int(nodes.max()) + 1, 3))
    for start in range(0, which.size, CHUNK):
        some = slice(start, start + CHUNK)
        parts = _diagonal(points, elements[some], *(modulus[some] for modulus in moduli))
        np.add.at(diagonal, nodes[some], parts)
    lame, shear = (share * modulus for modulus in moduli)
    return Tetrahedra(nodes, gradients, lame, shear, which, diagonal.ravel())


def _diagonal(points: Floats, cells: Ints, lame: Floats, shear: Floats) -> Floats:
    """(m, n, 3) diagonal of each element's stiffness, N/m."""
    gradients, volume = _gradients(points, cells)
    squares = 0.25 * (gradients**2).sum(axis=0)
    own = (lame + shear)[:, None, None] * squares
    return np.asarray(
        volume[:, None, None] * (own + shear[:, None, None] * squares.sum(axis=2, keepdims=True))
    )
