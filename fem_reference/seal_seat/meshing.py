"""Tetrahedral mesh of the seal seat by gmsh's CAD kernel: the half y >= 0, one solid.

Membrane and island are fused; then, for each seat, one solid of revolution (bore and cone) and,
if there is one, the notch are cut out. The contact ring is an edge of the cone, so that nodes lie
on it, and there is a node where each tip touches first. The element size grows linearly with the
distance from the ring and from the tips.

Elements have straight edges, also the quadratic ones: their stiffness and mass are then integrated
exactly, and any program that reads the mesh gets the same discrete body. Midside nodes next to the
ring lie on chords, inside the cone by up to h^2 / (8 rho); the contact takes their gap where the
exact surface is (`Ring.on_cone`), so that nothing penetrates at the start.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from ..common.mesher import start_gmsh
from ..solid.collapse import collapse_short_edges
from ..solid.mesh import (
    MINIMUM_QUALITY,
    TetMesh,
    check_elements,
    edge_lengths,
    qualities,
    tetrahedra,
)
from ..solid.meshing import TRIES, generate
from .scene import Ring, SeatScene

SLOPE = 0.6
"""Growth of the element size per distance, at factor 1."""
TIP_ELEMENT = 1.6
"""Element size under the tips over that at the ring."""
SPHERE_ELEMENT = 1.5
"""Element size of an elastic sphere at the ring over that of the seat."""
THROUGH_MEMBRANE = 1.0
"""Least number of elements through the membrane; quadratic ones bend well with one."""
THROUGH_ISLAND = 2.5
"""Least number of elements over the island's height."""
CAD_UNITS = (1.0, 1e-3)
"""Units of length of the CAD model, m, tried in this order.

OpenCASCADE intersects surfaces to 1e-7 units. In metres that leaves the crest of the cones up to
5e-6 rad off in a cone's parameter plane. gmsh then joins curves to 3e-3, in v as in the angle: as
much as the whole cone is long in metres. Version 4.8 gets over it, 4.13 does not ("Impossible to
mesh periodic surface").
"""


def _ring_distance(ring: Ring) -> str:
    """The distance from the ring for gmsh's MathEval."""
    (cx, _, cz), (nx, _, nz) = ring.sphere_centre, ring.axis
    x, z = f"(x-({cx!r}))", f"(z-({cz!r}))"
    s = f"({x}*({nx!r})+{z}*({nz!r}))"
    rho = f"Sqrt(Max(0,{x}*{x}+y*y+{z}*{z}-{s}*{s}))"
    across, along = f"({rho}-{ring.radius!r})", f"({s}-({ring.offset!r}))"
    return f"Sqrt({across}*{across}+{along}*{along})"


@dataclass(frozen=True)
class ShortEdge:
    """A place at which an edge of the geometry is too short for the elements there."""

    centre: tuple[float, float, float]
    """m"""
    length: float
    """m"""

    def over(self, unit: float) -> ShortEdge:
        """The same in multiples of ``unit`` (m)."""
        x, y, z = self.centre
        return ShortEdge((x / unit, y / unit, z / unit), self.length / unit)

    def expression(self, slope: float) -> str:
        """Size that grows with the distance, for gmsh's MathEval."""
        x, y, z = (f"({axis}-({at!r}))" for axis, at in zip("xyz", self.centre, strict=True))
        return f"{self.length!r}+{slope!r}*Sqrt({x}*{x}+{y}*{y}+{z}*{z})"


@dataclass(frozen=True)
class SeatSize:
    """Element size min(largest, ring + slope * d_ring, tip + slope * max(0, d_tip - zone)), m.

    At short edges elements are smaller, too.
    """

    ring: Ring
    at_ring: float
    tips: tuple[float, ...]
    """x of each, m."""
    at_tips: float
    tip_zone: float
    """Radius of the zone of smallest elements under a tip, m."""
    slope: float
    largest: float
    membrane: float
    """Largest size in the membrane, m."""
    membrane_top: float
    """z, m."""
    short_edges: tuple[ShortEdge, ...]

    def expression(self) -> str:
        """For gmsh's MathEval."""
        size = f"{self.at_ring!r}+{self.slope!r}*{_ring_distance(self.ring)}"
        for tip in self.tips:
            away = f"Sqrt((x-({tip!r}))*(x-({tip!r}))+y*y+z*z)"
            near = f"{self.at_tips!r}+{self.slope!r}*Max(0,{away}-{self.tip_zone!r})"
            size = f"Min({size},{near})"
        for edge in self.short_edges:
            size = f"Min({size},{edge.expression(self.slope)})"
        # From the membrane's size to that of the island over a membrane's thickness or so.
        bulk = f"({self.membrane!r}+{self.slope!r}*Max(0,z-{self.membrane_top!r}))"
        return f"Min(Min({self.largest!r},{bulk}),{size})"


def seat_size(scene: SeatScene, factor: float, short_edges: Iterable[ShortEdge]) -> SeatSize:
    """Element sizes for ``factor`` times the elements requested, in every direction."""
    seat, ring = scene.seat, scene.ring()
    at_ring = ring.radius / scene.elements_per_ring_radius / factor
    # Linear tetrahedra are too stiff in bending: more of them through the thickness.
    through = {1: 2.0, 2: 1.0}[scene.element_order]
    membrane = seat.membrane_thickness / (THROUGH_MEMBRANE * through)
    return SeatSize(
        ring=ring,
        at_ring=at_ring,
        tips=scene.actuator.tip_positions,
        at_tips=TIP_ELEMENT * at_ring,
        tip_zone=0.1 * scene.actuator.tip_radius,
        slope=SLOPE / factor,
        largest=seat.island_height / (THROUGH_ISLAND * through) / factor,
        membrane=membrane / factor,
        membrane_top=seat.membrane_thickness,
        short_edges=tuple(short_edges),
    )


def _revolved(scene: SeatScene, ring: Ring) -> int:
    """Bore and cone of one seat, to beyond the island's top, as a solid; its tag."""
    seat, occ = scene.seat, gmsh.model.occ
    tan = math.tan(ring.half_angle)
    rim = ring.offset - (ring.radius - seat.bore_radius) / tan
    # The cone's inner flank rises least: it decides where the cone has left the island.
    rise = math.cos(ring.half_angle + seat.tilt) / math.cos(ring.half_angle)
    ring_low = ring.sphere_centre[2] + ring.offset * math.cos(seat.tilt)
    ring_low -= ring.radius * math.sin(seat.tilt)
    top = ring.offset + 1.05 * (seat.island_height - ring_low) / rise
    profile = [
        (0.0, -seat.bore_depth),
        (seat.bore_radius, -seat.bore_depth),
        (seat.bore_radius, rim),
        (ring.radius, ring.offset),
        (ring.radius + (top - ring.offset) * tan, top),
        (0.0, top),
    ]
    (cx, _, cz), (nx, _, nz) = ring.sphere_centre, ring.axis
    corners = [
        occ.addPoint(cx + s * nx + rho * nz, 0.0, cz + s * nz - rho * nx) for rho, s in profile
    ]
    lines = [occ.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    made = occ.revolve([(2, face)], cx, 0.0, cz, nx, 0.0, nz, 2.0 * math.pi)
    return int(next(tag for dimension, tag in made if dimension == 3))


def _cut_out(scene: SeatScene, together: bool) -> int:
    """Add the half seat to gmsh's OCC model; the number of its pieces."""
    seat, occ = scene.seat, gmsh.model.occ
    length, width, height = seat.island_length, seat.island_width, seat.island_height
    membrane = occ.addCylinder(
        0.0, 0.0, 0.0, 0.0, 0.0, seat.membrane_thickness, seat.membrane_radius, -1, math.pi
    )
    island = occ.addBox(-0.5 * length, 0.0, 0.0, length, 0.5 * width, height)
    cut, _ = occ.fuse([(3, membrane)], [(3, island)])
    tools = [(3, _revolved(scene, scene.ring(side))) for side in (-1.0, 1.0)]
    if seat.notch is not None:
        notch = seat.notch
        slot = occ.addBox(-0.5 * notch.width, -width, notch.floor, notch.width, 2.0 * width, height)
        tools.append((3, slot))
    for group in [tools] if together else [[tool] for tool in tools]:
        cut, _ = occ.cut(cut, group)
    # A node where each tip touches first: otherwise the force peaks scatter with the nodes' places.
    tips = [(0, occ.addPoint(x, 0.0, 0.0)) for x in scene.actuator.tip_positions]
    whole, _ = occ.fragment(cut, tips)
    return sum(dimension == 3 for dimension, _ in whole)


def build(scene: SeatScene) -> None:
    """Add the half seat to gmsh's OCC model.

    OpenCASCADE sometimes leaves parts of tools that overlap each other; taken out one after the
    other they are gone.
    """
    pieces = _cut_out(scene, together=True)
    if pieces != 1:
        gmsh.model.occ.remove(gmsh.model.occ.getEntities(), recursive=True)
        pieces = _cut_out(scene, together=False)
    if pieces != 1:
        raise SolverError(f"the seal seat falls into {pieces} pieces: its features cut it through")


def cad_volume(scene: SeatScene) -> float:
    """Volume of the exact half body, m^3."""
    start_gmsh()
    try:
        gmsh.model.add("seat")
        build(scene)
        gmsh.model.occ.synchronize()
        return float(sum(gmsh.model.occ.getMass(3, tag) for _, tag in gmsh.model.getEntities(3)))
    finally:
        gmsh.finalize()


@dataclass(frozen=True)
class RingSize:
    """Element size min(largest, least + slope * d), d the distance from the ring, m."""

    ring: Ring
    least: float
    slope: float
    largest: float

    def expression(self) -> str:
        """For gmsh's MathEval."""
        return f"Min({self.largest!r},{self.least!r}+{self.slope!r}*{_ring_distance(self.ring)})"


def sphere_mesh(scene: SeatScene, factor: float = 1.0) -> TetMesh:
    """Half of the sphere in its seat, finest along the ring; its volume is exact.

    Raises:
        SolverError: gmsh failed, or an element is inverted or degenerate.
    """
    ring, radius = scene.ring(), scene.sphere_radius
    x, y, z = ring.sphere_centre

    def add() -> None:
        half = 0.5 * math.pi
        tag = gmsh.model.occ.addSphere(x, y, z, radius, -1, -half, half, math.pi)
        # gmsh's half sphere begins at the plane y = 0 on the side of +x and turns towards +y.
        if gmsh.model.occ.getCenterOfMass(3, tag)[1] < 0.0:
            raise SolverError("gmsh made the half sphere on the wrong side")

    least = SPHERE_ELEMENT * ring.radius / scene.elements_per_ring_radius / factor
    size = RingSize(ring, least, SLOPE / factor, 0.5 * radius / factor)
    points, corners = generate("sphere", add, size)
    points[np.abs(points[:, 1]) < 1e-9 * radius, 1] = 0.0
    volume = TetMesh("sphere", points, corners).volume()
    centre = np.array([x, y, z])
    points = centre + (points - centre) * math.cbrt(2.0 / 3.0 * math.pi * radius**3 / volume)
    mesh = tetrahedra("sphere", points, corners, scene.element_order)
    check_elements(mesh)
    return mesh


def _corner_mesh_in(
    scene: SeatScene, factor: float, short_edges: Sequence[ShortEdge], unit: float
) -> tuple[Floats, Ints]:
    """Points (n, 3), m, and elements (m, 4) of the half seat, its CAD model built in ``unit``.

    Raises:
        SolverError: gmsh failed.
    """
    cad = scene.lengths_over(unit)
    size = seat_size(cad, factor, (edge.over(unit) for edge in short_edges))
    points, corners = generate("seat", lambda: build(cad), size)
    return points * unit, corners


def corner_mesh(
    scene: SeatScene, factor: float, short_edges: Sequence[ShortEdge] = ()
) -> tuple[Floats, Ints]:
    """The same in the first unit with which gmsh succeeds."""
    *others, last = CAD_UNITS
    for unit in others:
        with contextlib.suppress(SolverError):
            return _corner_mesh_in(scene, factor, short_edges, unit)
    return _corner_mesh_in(scene, factor, short_edges, last)


def _short_edges(points: Floats, corners: Ints) -> list[ShortEdge]:
    """The shortest edge of each degenerate element, at its centre."""
    degenerate = corners[~(qualities(points, corners) > MINIMUM_QUALITY)]
    centres, lengths = points[degenerate].mean(axis=1), edge_lengths(points, degenerate)
    return [
        ShortEdge((float(x), float(y), float(z)), float(length))
        for (x, y, z), length in zip(centres, lengths.min(axis=1), strict=True)
    ]


def seat_mesh(scene: SeatScene, factor: float = 1.0) -> TetMesh:
    """The half seat with ``factor`` times the elements requested, in every direction.

    Where elements are degenerate, smaller ones are tried around them.

    Raises:
        SolverError: gmsh failed, an element is inverted or degenerate, or the ring is no edge.
    """
    short_edges: list[ShortEdge] = []
    for _ in range(TRIES):
        points, corners = collapse_short_edges(*corner_mesh(scene, factor, short_edges))
        found = _short_edges(points, corners)
        if not found:
            break
        short_edges += found
    length = scene.seat.membrane_radius
    # What lies on the plane of symmetry and on the underside up to rounding, lies there exactly.
    for axis in (1, 2):
        points[np.abs(points[:, axis]) < 1e-9 * length, axis] = 0.0
    mesh = tetrahedra("seat", points, corners, scene.element_order)
    check_elements(mesh)
    on_ring = np.count_nonzero(scene.ring().distance(points) < 1e-9 * length)
    if on_ring < 5:
        raise SolverError(f"only {on_ring} corners of the mesh lie on the contact ring")
    return mesh
