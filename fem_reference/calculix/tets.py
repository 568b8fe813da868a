"""A body of quadratic tetrahedra, numbered as CalculiX's C3D10."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from ..solid.mesh import EDGES, FACES, TetMesh
from .deck import Elements, Term

GAUSS_POINTS = 4
"""In each direction: exact for the volumes of curved elements."""


def _rule() -> tuple[Floats, Floats]:
    """Barycentric coordinates (n, 4) and weights (n,), the reference volume 1/6 included."""
    x, w = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    a, b, c = (each.ravel() for each in np.meshgrid(x, x, x, indexing="ij"))
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel() * (1.0 - b) * (1.0 - c) ** 2
    third = c
    second = b * (1.0 - third)
    first = a * (1.0 - second - third)
    return np.column_stack([1.0 - first - second - third, first, second, third]), weights


def _shapes(at: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (n, 10) and their derivatives (n, 10, 3) at points (n, 4)."""
    slopes = np.vstack([-np.ones(3), np.eye(3)])
    shape = [at[:, k] * (2.0 * at[:, k] - 1.0) for k in range(4)]
    slope = [(4.0 * at[:, k, None] - 1.0) * slopes[k] for k in range(4)]
    for p, q in EDGES:
        shape.append(4.0 * at[:, p] * at[:, q])
        slope.append(4.0 * (at[:, p, None] * slopes[q] + at[:, q, None] * slopes[p]))
    return np.stack(shape, axis=1), np.stack(slope, axis=1)


def nodal_volumes(mesh: TetMesh) -> Floats:
    """(n,) integrals of the nodes' shape functions over a mesh with curved edges, m^3.

    Raises:
        SolverError: an element is inverted.
    """
    at, weights = _rule()
    shape, slope = _shapes(at)
    found, least = np.zeros(mesh.points.shape[0]), np.inf
    for functions, derivatives, weight in zip(shape, slope, weights, strict=True):
        jacobians = np.einsum("kd,mkc->mdc", derivatives, mesh.points[mesh.cells])
        volumes = weight * np.linalg.det(jacobians)
        least = min(least, float(volumes.min()))
        np.add.at(found, mesh.cells, volumes[:, None] * functions)
    if not least > 0.0:
        raise SolverError(f"the mesh of body '{mesh.name}' has a curved element that is inverted")
    return found


@dataclass(frozen=True)
class Tetrahedra:
    """A mesh whose nodes and elements CalculiX numbers from ``node`` and ``element`` on."""

    mesh: TetMesh
    node: int
    element: int

    @property
    def nodes(self) -> list[tuple[int, Floats]]:
        """See `deck.Part`."""
        return list(enumerate(self.mesh.points, self.node))

    @property
    def elements(self) -> Elements:
        """See `deck.Part`."""
        return {"C3D10": list(enumerate((self.node + self.mesh.cells).tolist(), self.element))}

    def held(self, components: Ints) -> list[tuple[int, int]]:
        """Nodes and directions of components 3 * node + direction from 0."""
        return [(self.node + int(c) // 3, 1 + int(c) % 3) for c in components]

    def terms(self, weights: Floats) -> list[Term]:
        """A sum over displacements with weights (n, 3)."""
        return [
            (self.node + int(n), 1 + int(d), float(weights[n, d])) for n, d in np.argwhere(weights)
        ]

    def faces(self, facets: Ints) -> list[tuple[int, str]]:
        """Element and face of each of the facets (k, 3 or 6) on the surface."""
        wanted = {frozenset(corners) for corners in facets[:, :3].tolist()}
        found = []
        for number, face in enumerate(FACES, 1):
            corners: Iterable[list[int]] = self.mesh.cells[:, list(face)].tolist()
            found += [
                (self.element + k, f"S{number}")
                for k, each in enumerate(corners)
                if frozenset(each) in wanted
            ]
        return sorted(found)
