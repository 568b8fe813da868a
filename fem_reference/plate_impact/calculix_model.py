"""The deck of a plate impact for CalculiX."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..axisymmetric.mesh import BodyMesh, face_nodes
from ..axisymmetric.system import hertz_weights
from ..calculix.deck import AXIAL, Contact, Deck, Observer, Part, Term
from ..calculix.wedge import Quadratic, Wedge, quadratic, wedge, wedge_part
from ..common.arrays import Floats, Ints
from ..common.bodies import Sphere
from ..common.errors import SceneError
from ..common.hertz import effective_modulus
from ..common.settings import Options
from .meshing import ImpactMesh
from .motion import SIDES, observed_circle
from .scene import Scene

PENALTY = 500.0
"""Pressure over penetration, times element size over contact modulus: a contact yields by
2 / (pi `PENALTY`) elements more than Hertz's under its largest pressure."""
BODIES = ("OUTER", "PLATE", "INNER")
FACES = "FACES"
"""Of the plate, where its motion is observed."""
SLAVES, MASTERS = 1.2, 2.0
"""Radii of the contact surfaces of sphere and plate over that of the zone of contact elements."""


def require_supported(scene: Scene, options: Options) -> None:
    """Refuse what the deck does not describe.

    Raises:
        SceneError: naming the field, its value and what it must be.
    """
    unsupported = {
        "fields are requested; this solver writes none": bool(
            options.stress_times or options.frame_times
        ),
        "fluid is given; it must be absent": scene.fluid is not None,
        "series is given; it must be absent": scene.series is not None,
        f"friction is {max(scene.frictions.values()):g}; it must be 0": scene.rubs,
        f"plate.damping_ratio is {scene.plate.damping_ratio:g}; it must be 0": (
            scene.plate.damping_ratio > 0.0
        ),
        "reference.geometry is 'solid'; it must be 'axisymmetric'": scene.geometry == "solid",
        "a material yields; all must be elastic": scene.yields,
        f"{', '.join(scene.relaxing)}.material.relaxation is given; all must be elastic": bool(
            scene.relaxing
        ),
    }
    for name, body in (("outer", scene.outer), ("inner", scene.inner)):
        unsupported[
            f"{name}.kind is '{type(body).__name__.lower()}'; it must be 'sphere'"
        ] = not isinstance(body, Sphere)
    for reason, refused in unsupported.items():
        if refused:
            raise SceneError(f"{reason}: --solver calculix has dry elastic spheres on a plate only")


@dataclass(frozen=True)
class Model:
    """The deck of a scene on one mesh, and what it takes to read the result."""

    deck: Deck
    planes: tuple[Quadratic, Quadratic, Quadratic]
    masses: tuple[float, float, float]
    """Of the meshes of outer body, plate and inner body, kg."""

    @property
    def dofs(self) -> int:
        """Free displacements and fixed ones of the planes."""
        return 2 * sum(len(plane.points) for plane in self.planes)


def _true(mesh: BodyMesh, sphere: Sphere, pole: float, side: float) -> BodyMesh:
    """The mesh of a sphere that was enlarged about its pole to have its volume, at its own size."""
    from_pole = mesh.points - np.array([0.0, pole])
    size = 2.0 * sphere.radius / float((side * from_pole[:, 1]).max())
    return BodyMesh(mesh.name, size * from_pole + np.array([0.0, pole]), mesh.quads)


def model(scene: Scene, mesh: ImpactMesh) -> Model:
    """The deck on the elements of a mesh."""
    half = 0.5 * scene.plate.thickness
    zones = [float(surface.radii[-1]) for surface in (mesh.outer_contact, mesh.inner_contact)]
    poles = (half, -half - scene.gap)
    spheres = [body for body in (scene.outer, scene.inner) if isinstance(body, Sphere)]
    places = list(zip(spheres, poles, SIDES, strict=True))
    centres = [(sphere.radius, pole + side * sphere.radius) for sphere, pole, side in places]
    outer, inner = (
        quadratic(_true(body, *place), centre)
        for body, place, centre in zip((mesh.outer, mesh.inner), places, centres, strict=True)
    )
    planes = (outer, quadratic(mesh.plate), inner)
    speeds = (-scene.speed, 0.0, scene.inner_speed)
    none = np.zeros(0, dtype=np.int64)
    parts: list[Part] = []
    wedges: list[Wedge] = []
    node = element = 1
    for name, plane, material, speed in zip(BODIES, planes, scene.materials, speeds, strict=True):
        solid = wedge(plane, node, element)
        rim = none
        if name == "PLATE" and scene.plate.edge != "free":
            rim = np.flatnonzero(plane.points[:, 0] > scene.plate.radius * (1.0 - 1e-9))
        clamped = rim if scene.plate.edge == "clamped" else none
        parts.append(wedge_part(name, solid, material, clamped, rim, speed))
        wedges.append(solid)
        node, element = solid.nodes[-1][0] + 1, element + len(plane.quads)
    contacts = []
    plate = wedges[1]
    for name, solid, face, (sphere, _, side), centre, zone in zip(
        *((BODIES[0], BODIES[2]), (wedges[0], wedges[2]), (half, -half), places, centres, zones),
        strict=True,
    ):
        points = solid.plane.points
        from_centre = np.hypot(points[:, 0], points[:, 1] - centre[1])
        on_sphere = np.abs(from_centre - sphere.radius) < 1e-6 * sphere.radius
        near = (points[:, 0] < SLAVES * zone) & (side * (points[:, 1] - centre[1]) < 0.0)
        on_face = face_nodes(plate.plane.points, face)
        modulus = effective_modulus(sphere.material, scene.plate.material)
        contacts.append(
            Contact(
                name,
                solid.surface(np.flatnonzero(on_sphere & near)),
                plate.surface(on_face[plate.plane.points[on_face, 0] < MASTERS * zone]),
                PENALTY * modulus / mesh.settings.contact_element,
            )
        )
    volumes = [plane.nodal_volumes() for plane in planes]
    observers = [
        Observer(name, node + k, _axial(solid, volume / volume.sum()), speed)
        for k, (name, solid, volume, speed) in enumerate(
            zip(BODIES, wedges, volumes, speeds, strict=True)
        )
    ]
    faces, shares = _watched(scene, planes[1])
    observers.append(Observer(FACES, node + len(parts), _axial(plate, shares, faces)))
    masses = [m.density * float(v.sum()) for m, v in zip(scene.materials, volumes, strict=True)]
    return Model(Deck(parts, contacts, observers), planes, (masses[0], masses[1], masses[2]))


def _axial(solid: Wedge, weights: Floats, of: Ints | slice = slice(None)) -> list[Term]:
    """Axial displacements of nodes of the plane, weighted."""
    nodes = solid.first[of].tolist()
    return [(node, AXIAL, weight) for node, weight in zip(nodes, weights.tolist(), strict=True)]


def _watched(scene: Scene, plate: Quadratic) -> tuple[Ints, Floats]:
    """Nodes of the plate's faces within `observed_circle`, and their shares in the mean of both."""
    half, circle = 0.5 * scene.plate.thickness, observed_circle(scene)
    faces = [face_nodes(plate.points, z) for z in (half, -half)]
    shares = [0.5 * hertz_weights(plate.points[face, 0], circle) for face in faces]
    nodes, share = np.concatenate(faces), np.concatenate(shares)
    return nodes[share > 0.0], share[share > 0.0]
