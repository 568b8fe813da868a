"""A body of revolution as a wedge of quadratic solid elements.

CalculiX turns its own axisymmetric elements into such wedges, but leaves initial velocities behind.
So the wedge is made here: every node off the axis has a twin on the other side and, at corners, one
half-way between them. The twins follow by linear equations, so that radial and axial displacement
of the first side are all that is free.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..axisymmetric.mesh import BodyMesh
from ..common.arrays import Floats, Ints
from ..common.bodies import Material
from ..common.errors import SolverError
from .deck import Elements, Part

ANGLE = math.radians(2.0)
"""Between both sides: the one CalculiX takes."""
SHARE = ANGLE / (2.0 * math.pi)
"""Of the whole body that is modelled."""
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))


@dataclass(frozen=True)
class Quadratic:
    """Eight-node quadrilaterals in the (r, z) half-plane: corners first, then midside nodes."""

    points: Floats
    """(n, 2) m; the first ones are the nodes of the mesh it was made of."""
    quads: Ints
    """(m, 8)"""
    corners: int
    """Number of corner nodes."""

    @property
    def axis(self) -> Ints:
        """Nodes on the axis."""
        return np.flatnonzero(self.points[:, 0] == 0.0)

    def nodal_volumes(self) -> Floats:
        """(n,) share of each node in the volume integral of its shape function, m^3."""
        gauss = np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)])
        weight = np.array([5.0, 8.0, 5.0]) / 9.0
        x = self.points[self.quads]
        volumes = np.zeros(len(self.points))
        for xi, a in zip(gauss, weight, strict=True):
            for eta, b in zip(gauss, weight, strict=True):
                shape, slope = _shape(xi, eta)
                jacobian = np.einsum("dk,ekc->edc", slope, x)
                area = np.linalg.det(jacobian)
                swept = 2.0 * math.pi * a * b * area * (x[:, :, 0] @ shape)
                np.add.at(volumes, self.quads, swept[:, None] * shape)
        return volumes


def _shape(xi: float, eta: float) -> tuple[Floats, Floats]:
    """Serendipity functions (8,) and their derivatives (2, 8) at a point of the square."""
    xs, ys = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    p, q = 1.0 + xs * xi, 1.0 + ys * eta
    r = xs * xi + ys * eta - 1.0
    shape, slope = np.empty(8), np.empty((2, 8))
    shape[:4] = 0.25 * p * q * r
    slope[0, :4] = 0.25 * xs * q * (r + p)
    slope[1, :4] = 0.25 * ys * p * (r + q)
    for k, side in ((4, -1.0), (6, 1.0)):
        shape[k] = 0.5 * (1.0 - xi**2) * (1.0 + side * eta)
        slope[:, k] = -xi * (1.0 + side * eta), 0.5 * side * (1.0 - xi**2)
    for k, side in ((5, 1.0), (7, -1.0)):
        shape[k] = 0.5 * (1.0 + side * xi) * (1.0 - eta**2)
        slope[:, k] = 0.5 * side * (1.0 - eta**2), -eta * (1.0 + side * xi)
    return shape, slope


def quadratic(mesh: BodyMesh, sphere: tuple[float, float] | None = None) -> Quadratic:
    """Midside nodes for a mesh; on the surface of a sphere they lie on it.

    Args:
        mesh: of quadrilaterals.
        sphere: radius and z of the centre, m, if it is one.
    """
    edges = np.stack([mesh.quads[:, pair] for pair in EDGES], axis=1)
    named, place, uses = np.unique(
        np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True, return_counts=True
    )
    middle = mesh.points[named].mean(axis=1)
    if sphere is not None:
        radius, height = sphere
        outside = (uses == 1) & (middle[:, 0] > 0.0)
        arm = middle[outside] - np.array([0.0, height])
        middle[outside] += arm * (radius / np.linalg.norm(arm, axis=1)[:, None] - 1.0)
    count = len(mesh.points)
    quads = np.hstack([mesh.quads, count + place.reshape(-1, 4)])
    return Quadratic(np.vstack([mesh.points, middle]), quads, count)


@dataclass(frozen=True)
class Wedge:
    """The solid elements of a body, numbered from the first number given on."""

    plane: Quadratic
    first: Ints
    """(n,) number of each node on the first side."""
    nodes: list[tuple[int, Floats]]
    """Number and place (3,) of every node, m."""
    twins: list[tuple[int, int, float]]
    """Node, the one on the first side that it follows, and the angle between them."""
    elements: Elements
    faces: dict[tuple[int, int], tuple[int, str]]
    """Element and its face on each edge (element, edge) of the plane."""

    def surface(self, on: Ints) -> list[tuple[int, str]]:
        """Faces whose corners in the plane are all among the nodes ``on``."""
        inside = np.zeros(len(self.plane.points), dtype=bool)
        inside[on] = True
        quads = self.plane.quads
        chosen = ((k, e) for k in range(len(quads)) for e in range(4))
        return [self.faces[k, e] for k, e in chosen if inside[quads[k, list(EDGES[e])]].all()]


def wedge(plane: Quadratic, node: int, element: int) -> Wedge:
    """The wedge of a mesh; its nodes and elements are numbered from ``node`` and ``element`` on.

    Raises:
        SolverError: an element has one corner on the axis only.
    """
    count = len(plane.points)
    off = np.flatnonzero(plane.points[:, 0] > 0.0)
    corners = off[off < plane.corners]
    first = node + np.arange(count)
    second, half = first.copy(), first.copy()
    second[off] = node + count + np.arange(off.size)
    half[corners] = node + count + off.size + np.arange(corners.size)

    def placed(numbers: Ints, which: Ints, angle: float) -> list[tuple[int, Floats]]:
        r, z = plane.points[which].T
        x = np.column_stack([r * math.cos(angle), r * math.sin(angle), z])
        return list(zip(numbers[which].tolist(), x, strict=True))

    nodes = placed(first, np.arange(count), 0.0)
    nodes += placed(second, off, ANGLE) + placed(half, corners, 0.5 * ANGLE)
    twins = [(int(second[k]), int(first[k]), ANGLE) for k in off]
    twins += [(int(half[k]), int(first[k]), 0.5 * ANGLE) for k in corners]
    elements: Elements = {"C3D20R": [], "C3D15": []}
    faces: dict[tuple[int, int], tuple[int, str]] = {}
    on_axis = plane.points[:, 0] == 0.0
    for k, quad in enumerate(plane.quads):
        number = element + k
        on_axis_edges = [edge for edge in range(4) if on_axis[quad[list(EDGES[edge])]].all()]
        if not on_axis[quad[:4]].any():
            a, b = quad[:4], quad[4:]
            ids = [second[a], first[a], second[b], first[b], half[a]]
            elements["C3D20R"].append((number, np.concatenate(ids).tolist()))
            faces |= {(k, edge): (number, f"S{3 + edge}") for edge in range(4)}
            continue
        if len(on_axis_edges) != 1:
            r, z = plane.points[quad[:4]].mean(axis=0)
            raise SolverError(
                f"the element at r = {r:.4g} m, z = {z:.4g} m has but one corner on the axis"
            )
        # From the axis' lower node on: bottom a b, outer side b c, top c d.
        turn = [(on_axis_edges[0] + 1 + j) % 4 for j in range(4)]
        a, b, c, d = quad[turn]
        ab, bc, cd, da = quad[4:][turn]
        ids = [first[a], first[b], second[b], first[d], first[c], second[c], first[ab], half[b]]
        ids += [second[ab], first[cd], half[c], second[cd], first[da], first[bc], second[bc]]
        elements["C3D15"].append((number, [int(i) for i in ids]))
        faces |= {(k, turn[j]): (number, f"S{face}") for j, face in ((0, 1), (1, 4), (2, 2))}
    return Wedge(plane, first, nodes, twins, elements, faces)


def wedge_part(
    name: str, wedge: Wedge, material: Material, clamped: Ints, supported: Ints, speed: float = 0.0
) -> Part:
    """A body of revolution.

    Args:
        name: of the body.
        wedge: its elements.
        material: of all of it.
        clamped: nodes of the plane that cannot move along r.
        supported: nodes of the plane that cannot move along z.
        speed: along z at the start, m/s.
    """
    first, equations = wedge.first, []
    for twin, leader, angle in wedge.twins:
        cosine, sine = math.cos(angle), math.sin(angle)
        equations.append([(twin, 1, 1.0), (leader, 1, -cosine)])
        equations.append([(twin, 2, 1.0), (leader, 1, -sine)])
        equations.append([(twin, 3, 1.0), (leader, 3, -1.0)])
    held = [(node, 2) for node in first.tolist()]
    held += [(int(first[node]), 1) for node in {*wedge.plane.axis, *clamped}]
    held += [(int(first[node]), 3) for node in supported]
    return Part(name, wedge.nodes, wedge.elements, material, held, equations, (0.0, 0.0, speed))
