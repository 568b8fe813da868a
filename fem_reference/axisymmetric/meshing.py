"""Meshes of plate and spheres: block-structured quadrilaterals by gmsh's transfinite algorithm.

The plate is a tensor product of graded divisions. A sphere's half-disc is cut into blocks
that are nearly conformal: w = zeta / (1 + zeta / (2 i R)) maps the quarter plane onto the
half-disc, the origin onto the contact pole and infinity onto the opposite pole, and takes
circles about the origin to circles that meet axis and surface at right angles. Around the
pole lies a square core with the contact's element size, around it shells that grow with the
distance, beyond the equator three blocks that meet in one point.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from contextlib import contextmanager

import gmsh
import numpy as np

from ..common.arrays import Floats, Ints, Mask
from ..common.bodies import Plate, Sphere, sphere_profile
from ..common.errors import SolverError
from ..common.mesher import start_gmsh
from .grading import Segment, graded
from .mesh import BodyMesh
from .sizes import MeshSettings


@contextmanager
def _gmsh_model() -> Iterator[None]:
    start_gmsh()
    try:
        gmsh.model.add("body")
        yield
    except SolverError:
        raise
    except Exception as error:
        raise SolverError(f"gmsh could not mesh the scene: {error}") from error
    finally:
        gmsh.finalize()


def _line(start: int, end: int, segment: Segment) -> int:
    tag = int(gmsh.model.geo.addLine(start, end))
    gmsh.model.geo.mesh.setTransfiniteCurve(tag, segment.count + 1, "Progression", segment.ratio)
    return tag


def _arc(start: int, centre: int, end: int, segment: Segment) -> int:
    tag = int(gmsh.model.geo.addCircleArc(start, centre, end))
    gmsh.model.geo.mesh.setTransfiniteCurve(tag, segment.count + 1, "Progression", segment.ratio)
    return tag


def _block(*curves: int) -> None:
    """A transfinite block of quadrilaterals; a negative curve is run through backwards."""
    geo = gmsh.model.geo
    surface = geo.addPlaneSurface([geo.addCurveLoop(list(curves))])
    geo.mesh.setTransfiniteSurface(surface)
    geo.mesh.setRecombine(2, surface)


def _generate(name: str) -> BodyMesh:
    """Mesh the current model and read it back, counter-clockwise, numbered from zero."""
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(2)
    types, _, connectivity = gmsh.model.mesh.getElements(2)
    if [int(kind) for kind in types] != [3]:
        raise SolverError(f"gmsh left elements that are not quadrilaterals in body '{name}'")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    used = np.unique(connectivity[0]).astype(np.int64)
    order[used] = np.arange(used.size)
    points = np.empty((used.size, 2))
    known = order[tags.astype(np.int64)] >= 0
    points[order[tags[known].astype(np.int64)]] = coordinates.reshape(-1, 3)[known, :2]
    quads = order[connectivity[0].astype(np.int64)].reshape(-1, 4)
    corners = points[quads]
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    clockwise = diagonals[0][:, 0] * diagonals[1][:, 1] < diagonals[0][:, 1] * diagonals[1][:, 0]
    quads[clockwise] = quads[clockwise, ::-1]
    points[np.abs(points[:, 0]) < 1e-12 * points[:, 0].max(), 0] = 0.0
    return BodyMesh(name, points, quads)


def _moved_radius(settings: MeshSettings, radii: Floats, r: Floats) -> Floats:
    """Takes even radii in the contact zone to those of the matching nodes (``radii``), m."""
    even = settings.contact_element * np.arange(settings.contact_elements + 1)
    return np.asarray(np.interp(r, even, radii))


def _rim(settings: MeshSettings) -> list[Segment]:
    """Elements that shrink towards the rim, from the plate's largest on; none if not requested."""
    first, last, ratio = settings.rim_element, settings.plate_element, settings.growth**2
    if first is None or last < 1.5 * first:
        return []
    count = max(2, round(math.log(last / first) / math.log(ratio)))
    exact = (last / first) ** (1.0 / count)
    length = first * (exact**count - 1.0) / (exact - 1.0)
    return [Segment(length, count, exact).reversed]


def mesh_plate(plate: Plate, settings: MeshSettings) -> BodyMesh:
    """Mesh of the plate, z = 0 at its midplane, fine at the axis and at both faces."""
    size, zone = settings.contact_element, settings.contact_zone
    rim = _rim(settings)
    rest = plate.radius - zone - sum(segment.length for segment in rim)
    radial = [
        Segment(zone, settings.contact_elements),
        *graded(rest, size * settings.growth, settings.plate_element, settings.growth),
        *rim,
    ]
    half = graded(plate.thickness / 2.0, size, settings.through_element, settings.through_growth)
    through = [*half, *(segment.reversed for segment in reversed(half))]
    r = np.concatenate([[0.0], np.cumsum([segment.length for segment in radial])])
    z = np.concatenate([[0.0], np.cumsum([segment.length for segment in through])])
    with _gmsh_model():
        point = [[gmsh.model.geo.addPoint(x, y - plate.thickness / 2.0, 0.0) for y in z] for x in r]
        across = [
            [_line(point[i][j], point[i + 1][j], radial[i]) for j in range(z.size)]
            for i in range(r.size - 1)
        ]
        up = [
            [_line(point[i][j], point[i][j + 1], through[j]) for j in range(z.size - 1)]
            for i in range(r.size)
        ]
        for i in range(r.size - 1):
            for j in range(z.size - 1):
                _block(across[i][j], up[i + 1][j], -across[i][j + 1], -up[i][j])
        mesh = _generate("plate")
    points = mesh.points.copy()
    inside = points[:, 0] < zone * (1.0 - 1e-9)
    points[inside, 0] = _moved_radius(settings, settings.zone_radii(), points[inside, 0])
    return BodyMesh(mesh.name, points, mesh.quads)


def modal_plate_mesh(plate: Plate) -> BodyMesh:
    """Even mesh of the plate alone, fit for eigenmodes with quadratic elements."""
    # The stress at a clamped rim's corners is singular and slows the convergence: with four
    # elements over the thickness the first frequency is up to 0.2 % high, with twelve 0.03 %.
    size = min(plate.thickness / 12.0, plate.radius / 24.0)
    return mesh_plate(plate, MeshSettings(size, 1, size, size, 1.2, 1.2))


def _half_disc(sphere: Sphere, settings: MeshSettings, name: str, along: float) -> BodyMesh:
    """Mesh of a sphere that touches z = 0 from above, without corrections.

    ``along`` is a factor on the number of elements along the way from the contact.
    """
    radius, zone = sphere.radius, settings.contact_zone
    n = settings.contact_elements

    def physical(zeta: complex) -> complex:
        return zeta / (1.0 + zeta / (2j * radius))

    edge = complex(zone, radius - math.sqrt(radius**2 - zone**2))
    c = (edge / (1.0 - edge / (2j * radius))).real
    shell = 2.5 * c
    diagonal = cmath.exp(0.25j * math.pi)
    with _gmsh_model():

        def add(w: complex) -> int:
            return int(gmsh.model.geo.addPoint(w.real, w.imag, 0.0))

        centre = add(1j * radius)
        pole, top = add(0j), add(2j * radius)
        # Core, first shell, equator: each from the surface over the diagonal to the axis.
        core = [add(edge), add(physical(1.12 * c * (1 + 1j))), add(physical(1j * c))]
        ring = [add(physical(shell * d)) for d in (1.0, diagonal, 1j)]
        middle = (math.sqrt(2.0) - 1.0) * radius
        equator = [add(complex(radius, radius)), add(complex(middle, radius)), centre]
        far = [add(radius * (1j + diagonal)), add(radius * (0.43 + 1.43j)), add(1.53j * radius)]
        even = Segment(0.0, n)
        # Core.
        floor, wall = _arc(pole, centre, core[0], even), _line(pole, core[2], even)
        right, lid = _line(core[0], core[1], even), _line(core[1], core[2], even)
        _block(floor, right, lid, -wall)
        # From the core's square to a circle.
        m = max(2, round(0.55 * n))
        widening = 2.0 ** (1.0 / m)
        spokes = [
            _arc(core[0], centre, ring[0], Segment(0.0, m, widening)),
            _line(core[1], ring[1], Segment(0.0, m)),
            _line(core[2], ring[2], Segment(0.0, m, widening)),
        ]
        kappa = (shell / (2.0 * radius)) ** 2
        ring_centre = add(complex(0.0, -2.0 * radius * kappa / (1.0 - kappa)))
        ring_arcs = [_arc(ring[i], ring_centre, ring[i + 1], even) for i in (0, 1)]
        _block(spokes[0], ring_arcs[0], -spokes[1], -right)
        _block(spokes[1], ring_arcs[1], -spokes[2], -lid)
        # Shells up to the equator, elements about twice as long as wide where none are requested.
        ratio = (1.0 + 2.0 * math.pi / (4.0 * n)) ** (1.0 / along)
        shells = Segment(
            0.0, max(2, round(math.log(2.0 * radius / shell) / math.log(ratio))), ratio
        )
        meridian = add(complex(-radius, radius))
        rays = [
            _arc(ring[0], centre, equator[0], shells),
            _arc(ring[1], meridian, equator[1], shells),
            _line(ring[2], equator[2], shells),
        ]
        halves = [_line(equator[0], equator[1], even), _line(equator[1], equator[2], even)]
        _block(rays[0], halves[0], -rays[1], -ring_arcs[0])
        _block(rays[1], halves[1], -rays[2], -ring_arcs[1])
        # The far half: three blocks about one point.
        half = Segment(0.0, max(2, round(along * n / 2)))
        out = [
            _arc(equator[0], centre, far[0], half),
            _line(equator[1], far[1], half),
            _line(equator[2], far[2], half),
        ]
        inward = _line(far[0], far[1], even), _line(far[1], far[2], even)
        cap = _arc(far[0], centre, top, even), _line(far[2], top, even)
        _block(out[0], inward[0], -out[1], -halves[0])
        _block(out[1], inward[1], -out[2], -halves[1])
        _block(cap[0], -cap[1], -inward[1], -inward[0])
        return _generate(name)


def _with_exact_volume(mesh: BodyMesh, sphere: Sphere, surface: Ints, radii: Floats) -> BodyMesh:
    """Give the polygon the sphere's volume and its contact nodes the plate's radii.

    The chords of an inscribed polygon cut off volume, hence mass: 0.1 % on these meshes, the
    largest error of all on coarse ones. The mesh is therefore enlarged about the contact pole
    until its volume is that of the sphere: the mass is then exact with the density unchanged,
    and the shape is off by less than before. Contact nodes are put at ``radii`` (m) on the
    enlarged sphere.
    """
    points = mesh.points
    scale = 1.0
    for _ in range(20):
        points = mesh.points * scale
        radius = sphere.radius * scale
        points[surface, 0] = radii
        points[surface, 1] = radius - np.sqrt(radius**2 - radii**2)
        ratio = sphere.volume / BodyMesh(mesh.name, points, mesh.quads).volume()
        if abs(ratio - 1.0) < 1e-14:
            break
        scale *= ratio ** (1.0 / 3.0)
    return BodyMesh(mesh.name, points, mesh.quads)


def mesh_sphere(
    sphere: Sphere, settings: MeshSettings, name: str, number: int
) -> tuple[BodyMesh, Ints]:
    """Outer (``number`` 0) or inner (1) sphere above z = 0, and its contact nodes outwards."""
    along = settings.sphere_refinement[number]
    settings, radii = settings.of_sphere(number)
    raw = _half_disc(sphere, settings, name, along)
    original = raw
    on_surface = (
        np.abs(np.hypot(raw.points[:, 0], raw.points[:, 1] - sphere.radius) - sphere.radius)
        < 1e-9 * sphere.radius
    )
    near = on_surface & (raw.points[:, 1] < sphere.radius)
    candidates = np.flatnonzero(near)
    surface = candidates[np.argsort(raw.points[candidates, 0])][: radii.size]
    # Below the surface the core's nodes move along with those on it, and less so further inside.
    points = original.points.copy()
    zone = settings.contact_zone
    inside = (points[:, 0] < zone) & (points[:, 1] < 3.0 * zone)
    r, z = points[inside].T
    fade = np.clip((3.0 * zone - z) / (2.0 * zone), 0.0, 1.0)
    moved = r + fade * (_moved_radius(settings, radii, r) - r)
    points[inside, 0] = moved
    points[inside, 1] += fade * (
        sphere_profile(sphere.radius, moved) - sphere_profile(sphere.radius, r)
    )
    raw = BodyMesh(name, points, original.quads)
    return _with_exact_volume(raw, sphere, surface, radii), surface


def mesh_tip(
    sphere: Sphere, settings: MeshSettings, name: str, number: int
) -> tuple[BodyMesh, Ints]:
    """The half of a sphere at z = 0, as `mesh_sphere`."""
    whole, surface = mesh_sphere(sphere, settings, name, number)
    near = whole.points[whole.quads].mean(axis=1)[:, 1] < sphere.radius
    nodes, quads = np.unique(whole.quads[near], return_inverse=True)
    half = BodyMesh(name, whole.points[nodes], quads.reshape(-1, 4))
    return half, np.searchsorted(nodes, surface)


def flat_face(mesh: BodyMesh, pole: float) -> Mask:
    """(n,) nodes of a tip that are farthest from its ``pole`` (m) along the axis."""
    height = np.abs(mesh.points[:, 1] - pole)
    return np.asarray(height > (1.0 - 1e-9) * height.max())
