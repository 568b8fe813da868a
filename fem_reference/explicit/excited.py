"""Lowest frequency of a body that contacts excite, by load-dependent Ritz vectors.

E. L. Wilson, M.-W. Yuan, J. M. Dickens, Earthquake Eng. Struct. Dyn. 10 (1982) 813: the static
solution under the contact forces, then again and again that under the inertia forces of the last.
"""

from __future__ import annotations

import math

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SolverError
from .free_motions import FreeMotions, static_shape
from .loop import Loop
from .spectrum import Precondition, free_components

EXCITED = 0.1
"""Motion of a contact along its normal, over the root mean square of a mode's displacement, from
which on the contact counts as exciting the mode. An unsymmetrical mesh of a cube moves the middle
of a face by up to 0.025 in modes that it does not excite, and by 1.4 in the first one it does."""
UNLIKE = 0.618
"""Share of the second force in the first vector: with equal shares it would not hold the modes that
move two opposite contacts together."""
VECTORS = 16
MOST_VECTORS = 32
"""The same where the mode has more than `LOOSE`."""
LOOSE = 0.1
"""Share of the last vector in a mode above which its frequency is not known: the error of its
square is about that of the share."""
CONVERGED = 1e-4
"""Share of the last vector in a mode at which the search ends. Where the body has several modes of
one frequency, as a cube has, that is never reached: an unsymmetrical mesh parts them further and
further. Then the mode counts that had the least share of the last vector."""


def excited_frequency(
    loop: Loop,
    body: int,
    loads: list[Floats],
    floating: FreeMotions,
    precondition: Precondition | None = None,
) -> float:
    """Lowest frequency of a body that its contacts excite, Hz.

    Args:
        loop: the assembled system.
        body: number of the elastic body.
        loads: (3 n,) each, a unit force of each contact.
        floating: free motions of the body.
        precondition: see `conjugate_gradients`.

    Raises:
        SolverError: none was found.
    """
    free, mass = free_components(loop, body), np.repeat(loop.mass, 3)
    whole = math.sqrt(float(loop.body_masses()[body]))
    vector = np.zeros_like(loads[0])
    for k, load in enumerate(loads):
        vector += UNLIKE**k * static_shape(loop, body, load, floating, precondition)
    basis: list[Floats] = []
    rows: list[Floats] = []
    squared, doubt = 0.0, 1.0
    while doubt > CONVERGED and len(basis) < (VECTORS if doubt <= LOOSE else MOST_VECTORS):
        if basis:
            vector = static_shape(loop, body, mass * basis[-1], floating, precondition)
        for known in (*basis, *basis):  # twice is enough (Parlett, 6.9)
            vector = vector - loop.dot(known, mass * vector) * known
        vector = vector / math.sqrt(loop.dot(vector, mass * vector))
        basis.append(vector)
        image = loop.product(vector) * free
        rows.append(np.array([loop.dot(known, image) for known in basis]))
        squares, modes = _of_lower_triangle(rows)
        moved = np.array([[loop.dot(load, known) for known in basis] for load in loads]) @ modes
        for k in np.flatnonzero(np.abs(moved).max(axis=0) * whole > EXCITED)[:1]:
            share = abs(float(modes[-1, k]))
            if share < doubt:
                squared, doubt = float(squares[k]), share
    if squared == 0.0 or doubt > LOOSE:
        raise SolverError("the first eigenfrequency that the contacts excite was not found")
    return math.sqrt(squared) / (2.0 * math.pi)


def _of_lower_triangle(rows: list[Floats]) -> tuple[Floats, Floats]:
    """Eigenvalues, ascending, and eigenvectors of a symmetric matrix."""
    matrix = np.zeros((len(rows), len(rows)))
    for k, row in enumerate(rows):
        matrix[k, : k + 1] = row
    return np.linalg.eigh(matrix, UPLO="L")
