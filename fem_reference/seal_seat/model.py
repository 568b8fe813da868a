"""The seal-seat scene as a three-dimensional model: half of it, actuator rigid, sphere either."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from ..explicit.contact import Contact, RigidBody, SphereContact, SurfaceContact, guided
from ..solid.mesh import TetMesh, surface
from ..solid.model import ElasticBody, Model, nodal_areas, symmetry_plane
from ..solid.patch import Patch
from ..solid.sphere_pairs import sphere_pairs
from .scene import Ring, SeatScene

FRACTION = 0.5
"""Share of the bodies that is modelled."""
RING_REACH = 0.4
"""Distance from the ring within which nodes of the cone may touch, over the sphere's radius.

While the sphere is launched it slides up the cone's flanks by some hundredths of its radius."""
TIP_REACH = 0.25
"""The same under a tip, over the tip's radius."""
SEAT, ELASTIC_SPHERE = 0, 1
"""Numbers of the elastic bodies."""
LEFT, RIGHT = 0, 1
"""Numbers of the contacts of the cone's flanks with the sphere; the tips' follow."""


@dataclass(frozen=True)
class SeatModel:
    """The model and where its parts are."""

    model: Model
    patches: tuple[Patch, ...]
    """One per contact."""
    places: tuple[Floats, ...] = ()
    """(n, 3) exact places of each flank's candidates, m."""
    sphere_facets: Ints | None = None
    """Facets of an elastic sphere that can touch; None: the sphere is rigid."""

    @property
    def mesh(self) -> TetMesh:
        """Of the seat."""
        return self.model.elastic[0].mesh

    @property
    def actuator(self) -> int:
        """Number of the rigid body."""
        return len(self.model.rigid) - 1

    @property
    def tips(self) -> range:
        """Numbers of the tips' contacts."""
        return range(RIGHT + 1, len(self.model.contacts))


def clamped_rim(mesh: TetMesh, facets: Ints, radius: float) -> Ints:
    """Fixed components of the nodes on the membrane's rim."""
    corners = mesh.points[facets[:, :3]]
    on_rim = np.abs(np.hypot(corners[:, :, 0], corners[:, :, 1]) - radius) < 1e-6 * radius
    nodes = np.unique(facets[np.all(on_rim, axis=1)])
    if nodes.size == 0:
        raise SolverError("the mesh of the seat has no face on the rim of its membrane")
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def cone_nodes(mesh: TetMesh, facets: Ints, ring: Ring, reach: float) -> tuple[Ints, Floats]:
    """Facets of the cone around the ring, and the areas (n,) they give to the mesh's nodes."""
    corners = mesh.points[facets[:, :3]]
    s, rho = ring.coordinates(corners.reshape(-1, 3))
    away = np.abs(rho - ring.cone(s)).reshape(-1, 3)
    near = ring.distance(corners.reshape(-1, 3)).reshape(-1, 3)
    cone = np.all(away < 1e-6 * ring.radius, axis=1) & np.any(near <= reach, axis=1)
    if not np.any(cone):
        raise SolverError("the mesh of the seat has no faces on the cone around its contact ring")
    return facets[cone], nodal_areas(mesh, facets[cone])


def contact_facets(scene: SeatScene, mesh: TetMesh) -> Ints:
    """Facets of the sphere's surface that the cone can meet."""
    ring = scene.ring()
    facets = surface(mesh)
    outside = ~np.all(mesh.points[facets[:, :3]][:, :, 1] == 0.0, axis=1)
    s, _ = ring.coordinates(mesh.points[facets[:, :3]].mean(axis=1))
    # The lower part, well beyond the ring to both sides.
    return np.asarray(facets[outside & (s < 0.3 * ring.offset)])


def _ring_patches(scene: SeatScene, mesh: TetMesh, facets: Ints) -> tuple[Patch, Patch, Floats]:
    """Both flanks, and the exact places of all nodes that are on the cone (else the mesh's)."""
    ring = scene.ring()
    reach = RING_REACH * scene.sphere_radius
    cone, areas = cone_nodes(mesh, facets, ring, reach)
    nodes = np.unique(cone)
    places = mesh.points.copy()
    places[nodes] = ring.on_cone(mesh.points[nodes])
    distance = ring.distance(places[nodes])
    order = np.argsort(distance, kind="stable")
    nodes, distance = nodes[order], distance[order]
    nodes, distance = nodes[distance <= reach], distance[distance <= reach]
    s, rho = ring.coordinates(places[nodes])
    axis = np.array(ring.axis)
    outward = places[nodes] - np.array(ring.sphere_centre) - s[:, None] * axis
    outward /= rho[:, None]
    sin, cos = np.sin(ring.half_angle), np.cos(ring.half_angle)
    normals = sin * axis - cos * outward
    # +x of the axis, in the plane of symmetry: the right flank.
    right = outward @ np.array([axis[2], 0.0, -axis[0]]) >= 0.0

    def patch(chosen: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> Patch:
        return Patch(nodes[chosen], areas[nodes[chosen]], normals[chosen], reach, distance[chosen])

    return patch(~right), patch(right), places


def _tip_patch(scene: SeatScene, mesh: TetMesh, areas: Floats, x: float) -> Patch:
    reach = TIP_REACH * scene.actuator.tip_radius
    distance = np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1])
    nodes = np.flatnonzero((areas > 0.0) & (distance <= reach))
    if nodes.size == 0:
        raise SolverError(f"the mesh of the seat has no node under the tip at x = {x:.6g} m")
    nodes = nodes[np.argsort(distance[nodes], kind="stable")]
    normals = np.tile([0.0, 0.0, -1.0], (nodes.size, 1))
    return Patch(nodes, areas[nodes], normals, reach, distance[nodes])


def seat_model(scene: SeatScene, mesh: TetMesh, sphere_mesh: TetMesh | None = None) -> SeatModel:
    """Bodies, supports and contacts on a mesh of the half seat, and of the sphere if it is elastic.

    Raises:
        SolverError: the mesh is not one of this scene.
    """
    facets = surface(mesh)
    fixed = np.union1d(
        symmetry_plane(mesh, 1), clamped_rim(mesh, facets, scene.seat.membrane_radius)
    )
    left, right, places = _ring_patches(scene, mesh, facets)
    under = facets[np.all(mesh.points[facets][:, :, 2] == 0.0, axis=1)]
    areas = nodal_areas(mesh, under)
    tips = [_tip_patch(scene, mesh, areas, x) for x in scene.actuator.tip_positions]
    actuator = RigidBody(
        "actuator",
        FRACTION * scene.actuator.mass,
        guided((0.0, 0.0, 1.0)),
        (0.0, 0.0, scene.actuator.speed),
    )
    flanks = (("left flank", left), ("right flank", right))
    elastic = [ElasticBody(mesh, scene.seat.material, fixed)]
    rigid = [actuator]
    contacts: list[Contact] = []
    sphere_facets = None
    if sphere_mesh is None:
        in_plane = guided((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        mass = FRACTION * scene.sphere_mass
        turning = guided((0.0, 1.0, 0.0)) / (0.4 * mass * scene.sphere_radius**2)
        rigid.insert(0, RigidBody("sphere", mass, in_plane, turning=turning))
        centre, radius, friction = scene.ring().sphere_centre, scene.sphere_radius, scene.friction
        for name, patch in flanks:
            exact = places[patch.nodes]
            contacts.append(
                SphereContact(name, SEAT, patch.nodes, 0, centre, radius, exact, friction)
            )
    else:
        # The mass is the scene's, whatever the material's density.
        density = FRACTION * scene.sphere_mass / sphere_mesh.volume()
        material = replace(scene.sphere_material, density=density)
        elastic.append(ElasticBody(sphere_mesh, material, symmetry_plane(sphere_mesh, 1)))
        sphere_facets = contact_facets(scene, sphere_mesh)
        still = np.zeros_like(sphere_mesh.points)
        for name, patch in flanks:
            pairs = sphere_pairs(scene.ball, sphere_mesh, sphere_facets, places[patch.nodes], still)
            contacts.append(
                SurfaceContact(
                    name,
                    SEAT,
                    patch.nodes,
                    ELASTIC_SPHERE,
                    pairs.facets,
                    pairs.weights,
                    pairs.normals,
                    pairs.gaps,
                    np.unique(sphere_facets),
                    scene.friction,
                )
            )
    radius = scene.actuator.tip_radius
    contacts += [
        SphereContact(
            f"tip {number}",
            SEAT,
            patch.nodes,
            len(rigid) - 1,
            (x, 0.0, -radius),
            radius,
            friction=scene.friction,
        )
        for number, (x, patch) in enumerate(
            zip(scene.actuator.tip_positions, tips, strict=True), start=1
        )
    ]
    model = Model(tuple(elastic), tuple(rigid), tuple(contacts))
    exact_places = (places[left.nodes], places[right.nodes])
    return SeatModel(model, (left, right, *tips), exact_places, sphere_facets)
