"""Axisymmetric meshes of a scene, and the discrete system on them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse

from ..axisymmetric.elasticity import (
    BodyMatrices,
    assemble,
    beam_body,
    rigid_node,
    with_rigid_part,
)
from ..axisymmetric.film import facing_nodes, squeeze_film
from ..axisymmetric.mesh import BodyMesh, check_elements, face_nodes
from ..axisymmetric.meshing import flat_face, mesh_plate, mesh_sphere, mesh_tip
from ..axisymmetric.plastic import boxes, plasticity, together, with_box
from ..axisymmetric.sizes import MeshSettings
from ..axisymmetric.stack import ACROSS, StackBody
from ..axisymmetric.system import (
    AxisymmetricSystem,
    axis_constraints,
    hertz_weights,
    plate_constraints,
    renumbering,
)
from ..axisymmetric.tip import tip_flexibility
from ..common.arrays import Floats, Ints
from ..common.bodies import Bender, Body, Compact, Plate, Sphere, Stack, sphere_profile
from ..common.errors import SceneError, SolverError
from ..explicit.contact import MatchedContact
from ..explicit.film import Film
from ..explicit.plastic import Plasticity
from .motion import observed_circle
from .scene import Scene

CONTACT_ZONE = 1.3
"""Radius with matching nodes over the largest contact radius expected."""
LEAST_TIP = 4.0 * CONTACT_ZONE
"""Least radius of a body's tip over the radius of its own contact."""
MOST_ELEMENTS = 400
"""Across the contact zone."""
MOST_ALONG = 3.0
"""Most elements of a sphere along the way from the contact, over those that contact alone asks for:
elements are then about as long as wide."""
NOT_REFINED = (1.0, 1.0, 1.0)
"""Elements far from the contacts as contact radius and thickness ask for them."""
TIP_SHARE = 0.5
"""Largest share of a compact body's mass that its meshed tip may have."""
YIELDING_REACH = 3.0
"""Radius and depth of the boxes that may yield over the radius with matching nodes."""


def mesh_settings(
    scene: Scene,
    outer_radius: float,
    inner_radius: float,
    factor: float,
    refinement: tuple[float, float, float] = NOT_REFINED,
) -> MeshSettings:
    """Settings for the contact radii (m) expected, with ``factor`` from `RESOLUTIONS`.

    ``refinement`` is a factor on the number of elements far from the contacts, of outer body, plate
    and inner body.

    Raises:
        SceneError: the contact is too large for plate or spheres, or the mesh too large.
    """
    plate = scene.plate
    radii = (outer_radius, inner_radius)
    for name, radius, contact in (
        (f"outer.{scene.outer.RADIUS_KEY}", scene.outer.tip_radius, outer_radius),
        (f"inner.{scene.inner.RADIUS_KEY}", scene.inner.tip_radius, inner_radius),
        ("plate.radius", plate.radius, max(radii)),
    ):
        if LEAST_TIP * contact > radius:
            raise SceneError(
                f"{name} is {radius:g} m, but a contact radius of {contact:.3g} m "
                f"is expected; {LEAST_TIP:g} times as much is the least"
            )
    of_spheres = refinement[0], refinement[2]
    # Elements wide enough for the waves take more elements around the contact, too.
    around = max(1.0, *(requested / MOST_ALONG for requested in of_spheres))
    per_radius = scene.elements_per_contact_radius * factor * around
    # Along the plate four elements per thickness carry the waves: the incompatible modes bend. The
    # stress at a clamped rim's corners is singular and would make the plate too stiff by the
    # length of the elements there: fine elements at the rim hold the first frequency to 0.01 %.
    along = min(plate.thickness / 4.0, plate.radius / 48.0) / factor / refinement[1]
    through = min(plate.thickness / 8.0, plate.radius / 48.0) / factor / refinement[1]
    rim = (
        None if plate.edge == "free" else min(plate.thickness / 32.0, plate.radius / 96.0) / factor
    )
    size = min(min(radii) / per_radius, along / 2.0, through)
    zone = CONTACT_ZONE * max(radii)
    # An even count at factor 1: then the zone is the same at 2/3 and 3/2 of it, up to rounding.
    count = max(4, round(2.0 * math.ceil(zone / (2.0 * size * factor) - 1e-9) * factor))
    if count > MOST_ELEMENTS:
        raise SceneError(
            f"the scene needs {count} elements across the contact zone, more than "
            f"{MOST_ELEMENTS}: its two contacts or contact and plate differ too much in size"
        )
    # What yields lies up to twice the contact radius deep.
    through_ratio = 1.35 if scene.plate.material.yielding is None else 1.12
    growth, through_growth = (ratio ** (1.0 / factor) for ratio in (1.2, through_ratio))
    settings = MeshSettings(
        *(size, count, along, through, growth, through_growth),
        edge=(min(radii), max(radii)),
        rim_element=rim,
        factor=factor,
        sphere_refinement=(of_spheres[0] / around, of_spheres[1] / around),
    )
    tips = (scene.outer.tip_radius, scene.inner.tip_radius)
    return replace(settings, sphere_elements=_own_zones(settings, tips, radii))


def _own_zones(
    settings: MeshSettings, tips: tuple[float, float], contacts: tuple[float, float]
) -> tuple[int | None, int | None]:
    """Elements of the zone of each body; of one that is too small for the larger contact's its own.

    Args:
        settings: of the zone of both.
        tips: radii of the bodies' tips, m.
        contacts: their contact radii, m.
    """
    found: list[int | None] = []
    for tip, contact in zip(tips, contacts, strict=True):
        whole = LEAST_TIP * max(contacts) <= tip
        own = int(np.searchsorted(settings.zone_radii(), CONTACT_ZONE * contact))
        found.append(None if whole else max(4, own))
    return found[0], found[1]


@dataclass(frozen=True)
class ContactSurface:
    """Matching surface nodes of a body and the plate, by increasing radius."""

    radii: Floats
    body_nodes: Ints
    """Of a compact body or a bender its tip, for every node of the plate."""
    plate_nodes: Ints


@dataclass(frozen=True)
class ImpactMesh:
    """The three bodies and the two contact surfaces."""

    outer: BodyMesh
    plate: BodyMesh
    inner: BodyMesh
    outer_contact: ContactSurface
    inner_contact: ContactSurface
    settings: MeshSettings
    min_quality: float
    """Least scaled Jacobian of all elements."""
    stack: StackBody | None = None
    """The outer body, if it is one."""

    @property
    def bodies(self) -> tuple[BodyMesh, BodyMesh, BodyMesh]:
        """Outer body, plate, inner body."""
        return self.outer, self.plate, self.inner

    @property
    def poles(self) -> tuple[dict[int, float], ...]:
        """Of each body the z of its contacts by their number, m."""
        upper, lower = (
            float(self.plate.points[surface.plate_nodes[0], 1])
            for surface in (self.outer_contact, self.inner_contact)
        )
        inner = float(self.inner.points[self.inner_contact.body_nodes[0], 1])
        return {0: upper}, {0: upper, 1: lower}, {1: inner}


def mesh_impact(scene: Scene, settings: MeshSettings) -> ImpactMesh:
    """Mesh bodies and plate, each where it stands at t = 0; what is no sphere has its tip's node.

    Raises:
        SolverError: gmsh failed or an element is degenerate.
    """
    across = max(2, round(ACROSS * settings.factor))
    stack = StackBody(scene.outer, across) if isinstance(scene.outer, Stack) else None
    plate = mesh_plate(scene.plate, settings)
    half = scene.plate.thickness / 2.0

    def above(body: Body, name: str, number: int) -> tuple[BodyMesh, Ints]:
        if isinstance(body, Sphere):
            return mesh_sphere(body, settings, name, number)
        if _has_meshed_tip(body):
            return mesh_tip(Sphere(body.tip_radius, body.material), settings, name, number)
        # All nodes of a beam or a stack at its tip, which is the last.
        count = body.beam.mass.size if isinstance(body, Bender) else 1
        count = stack.count if stack is not None and body is scene.outer else count
        tip = BodyMesh(name, np.zeros((count, 2)), np.zeros((0, 4), dtype=np.int64))
        return tip, np.full(settings.of_sphere(number)[1].size, count - 1)

    upper, upper_nodes = above(scene.outer, "outer", 0)
    lower, lower_nodes = above(scene.inner, "inner", 1)
    outer = BodyMesh("outer", upper.points + np.array([0.0, half]), upper.quads)
    # Mirrored, hence the elements' sense of rotation reversed.
    inner = BodyMesh(
        "inner",
        lower.points * np.array([1.0, -1.0]) - np.array([0.0, half + scene.gap]),
        lower.quads[:, ::-1].copy(),
    )
    quality = min(check_elements(body) for body in (outer, plate, inner) if body.quads.size)

    def surface(number: int, nodes: Ints, z: float) -> ContactSurface:
        radii = settings.of_sphere(number)[1]
        opposite = face_nodes(plate.points, z)[: radii.size]
        if not np.allclose(plate.points[opposite, 0], radii, rtol=0.0, atol=1e-9 * radii[-1]):
            raise SolverError("the plate's surface nodes do not match the spheres' contact nodes")
        return ContactSurface(radii, nodes, opposite)

    return ImpactMesh(
        outer,
        plate,
        inner,
        surface(0, upper_nodes, half),
        surface(1, lower_nodes, -half),
        settings,
        quality,
        stack,
    )


def _film(scene: Scene, mesh: ImpactMesh, numbers: list[Ints]) -> Film | None:
    """The squeeze film of a scene; ``numbers`` are the system's, of each body's nodes."""
    fluid, inner = scene.fluid, scene.inner
    if fluid is None or not fluid.squeeze_film:
        return None
    pole = -0.5 * scene.plate.thickness - scene.gap
    surface = np.zeros(1, dtype=np.int64)
    if isinstance(inner, Sphere):
        surface = facing_nodes(mesh.inner, pole, inner.radius)
    face = face_nodes(mesh.plate.points, -0.5 * scene.plate.thickness)
    return squeeze_film(
        fluid,
        (numbers[1][face], mesh.plate.points[face, 0]),
        (numbers[2][surface], mesh.inner.points[surface, 0]),
        inner.tip_radius,
        scene.gap,
    )


def _watched(scene: Scene, plate: BodyMesh) -> tuple[Ints, Floats]:
    """Nodes of the plate's faces within `observed_circle`, and their shares in the mean of both."""
    half, circle = scene.plate.thickness / 2.0, observed_circle(scene)
    nodes, shares = [], []
    for z in (half, -half):
        face = face_nodes(plate.points, z)
        share = hertz_weights(plate.points[face, 0], circle)
        nodes.append(face[share > 0.0])
        shares.append(0.5 * share[share > 0.0])
    return np.concatenate(nodes), np.concatenate(shares)


def _has_meshed_tip(body: Body | Plate) -> bool:
    return isinstance(body, Compact) and body.material.yielding is not None


@dataclass(frozen=True)
class _Discretised:
    matrices: BodyMatrices
    points: Floats
    """(n, 2) of its nodes, m."""
    fixed: Ints
    """Components (2 * node + component)."""
    place: Ints
    """Node of each point of the mesh."""


def _discretised(
    body: BodyMesh, made: Body | Plate, pole: float, stack: StackBody | None
) -> _Discretised:
    """A body whose contact, or one of them, lies at z = ``pole`` (m)."""
    itself = np.arange(body.points.shape[0])
    if isinstance(made, Stack) and stack is not None:
        return _Discretised(stack.matrices, body.points, stack.fixed, itself)
    if isinstance(made, Bender):
        return _Discretised(beam_body(made.beam), body.points, np.arange(2), itself)
    if isinstance(made, Compact):
        return _compact(body, made, pole)
    fixed = plate_constraints(made, body) if isinstance(made, Plate) else axis_constraints(body)
    return _Discretised(assemble(body, made.material), body.points, fixed, itself)


def _compact(body: BodyMesh, made: Compact, pole: float) -> _Discretised:
    """Rigid, but for the half of a sphere below its mass if its tip yields.

    The tip's density has no part in the scene: it is the material's, or less in a light body.
    """
    if not _has_meshed_tip(made):
        return _Discretised(
            rigid_node(made.mass), body.points, axis_constraints(body), np.zeros(1, dtype=np.int64)
        )
    density = min(made.material.density, TIP_SHARE * made.mass / body.volume())
    rigid = flat_face(body, pole)
    matrices = assemble(body, replace(made.material, density=density))
    matrices, place = with_rigid_part(matrices, rigid, made.mass)
    points = np.vstack([body.points[~rigid], [0.0, body.points[rigid, 1].mean()]])
    axis = 2 * np.flatnonzero(points[:, 0] == 0.0)
    return _Discretised(matrices, points, axis, place)


def _place(outer: Body) -> float:
    """Distance of the outer body's tip from the plate with all of it undeformed, m."""
    if isinstance(outer, Bender):
        return -outer.offset
    return outer.gap if isinstance(outer, Stack) else 0.0


def build_system(
    scene: Scene, mesh: ImpactMesh, yielding_reach: float = YIELDING_REACH
) -> AxisymmetricSystem:
    """Assemble with dolfinx, constrain and renumber.

    Args:
        scene: what to solve.
        mesh: of its bodies.
        yielding_reach: radius and depth of the boxes that may yield over `contact_zone`.

    Raises:
        SolverError: a lumped mass is not positive.
    """
    stiffness, mass, inverse, numbers, points, supports = [], [], [], [], [], []
    element_nodes, element_stiffness, element_steps = [], [], []
    yielding: list[Plasticity] = []
    first = np.zeros(4, dtype=np.int64)
    of_scene = (scene.outer, scene.plate, scene.inner)
    for index, (body, made) in enumerate(zip(mesh.bodies, of_scene, strict=True)):
        part = _discretised(body, made, next(iter(mesh.poles[index].values())), mesh.stack)
        matrices, fixed = part.matrices, part.fixed
        if not matrices.mass.min() > 0.0:
            node = int(np.argmin(matrices.mass))
            r, z = part.points[node]
            raise SolverError(
                f"node {node} of body '{body.name}' at r = {r:.6g} m, z = {z:.6g} m has the mass "
                f"{matrices.mass[node]:.3g} kg; it must be positive"
            )
        box = None
        if made.material.yielding is not None:
            size = yielding_reach * mesh.settings.contact_zone
            box = boxes(part.points, matrices.elements.nodes, mesh.poles[index], size)
            matrices = with_box(matrices, part.points, made.material, box)
        number = renumbering(matrices)
        order = np.argsort(number)
        rows = (2 * order[:, None] + np.arange(2)).ravel()
        stiffness.append(matrices.stiffness[rows][:, rows])
        mass.append(matrices.mass[order])
        body_inverse = np.repeat(1.0 / matrices.mass, 2)
        body_inverse[fixed] = 0.0
        inverse.append(body_inverse[rows])
        points.append(part.points[order])
        number = number + first[index]
        numbers.append(number[part.place])
        supports.append(number[fixed[fixed % 2 == 1] // 2])
        elements = matrices.elements
        if box is not None:
            yields = plasticity(elements.nodes, part.points, made.material, box)
            yielding.append(replace(yields, nodes=number[yields.nodes]))
        element_nodes.append(number[elements.nodes])
        element_stiffness.append(elements.stiffness)
        element_steps.append(elements.critical_time_steps())
        first[index + 1] = first[index] + order.size
    stack, contacts = mesh.stack, []
    for name, surface, index, gap, normal in (
        ("outer", mesh.outer_contact, 0, _place(scene.outer), 1.0),
        ("inner", mesh.inner_contact, 2, scene.gap, -1.0),
    ):
        made = scene.outer if index == 0 else scene.inner
        deforms = not (isinstance(made, Sphere) or _has_meshed_tip(made))
        contacts.append(
            MatchedContact(
                name,
                normal,
                numbers[index][surface.body_nodes],
                numbers[1][surface.plate_nodes],
                surface.radii,
                gap + sphere_profile(made.tip_radius, surface.radii),
                tip_flexibility(made.material, surface.radii) if deforms else None,
                scene.frictions[name],
            )
        )
    faces, shares = _watched(scene, mesh.plate)
    velocity = np.zeros((int(first[-1]), 2))
    velocity[: first[1], 1] = -scene.speed
    velocity[first[2] :, 1] = scene.inner_speed
    displacement = tip = None
    if isinstance(scene.outer, Bender):
        displacement, strike, beam = np.zeros_like(velocity), scene.outer.strike, numbers[0]
        displacement[beam], velocity[beam], tip = strike.displacement, strike.velocity, beam[-1]
    if stack is not None:
        displacement, first_contact, rod = np.zeros_like(velocity), stack.first_contact, numbers[0]
        displacement[rod], velocity[rod], tip = (
            first_contact.displacement,
            first_contact.velocity,
            rod[-1],
        )
    return AxisymmetricSystem(
        stiffness=scipy.sparse.block_diag(stiffness, format="csr"),
        points=np.concatenate(points),
        mass=np.concatenate(mass),
        inverse_mass=np.concatenate(inverse),
        velocity=velocity,
        first=first,
        numbers=(numbers[0], numbers[1], numbers[2]),
        supports=np.sort(np.concatenate(supports)),
        watched=(numbers[1][faces], shares),
        matched=(contacts[0], contacts[1]),
        element_nodes=np.concatenate(element_nodes),
        element_stiffness=np.concatenate(element_stiffness),
        element_steps=np.concatenate(element_steps),
        displacement=displacement,
        relaxations=tuple(material.relaxation for material in scene.materials),
        tip=tip,
        film=_film(scene, mesh, numbers),
        plasticity=together(yielding),
        stack=stack,
    )
