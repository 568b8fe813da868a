"""Contact radii and duration before any mesh exists, and the elements that follow from them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..body.fine import Fineness
from ..common.bodies import Material
from ..common.errors import SceneError
from ..common.hertz import (
    effective_modulus,
    hertz_approach,
    hertz_contact_radius,
    hertz_stiffness,
    hertz_time_scale,
)
from ..solid.meshing import SizeField
from .scene import OUTER, Scene

FINE_ZONE = 1.3
"""Radius of the zone of smallest elements over the contact radius expected."""
CANDIDATE_ZONE = 1.8
"""Radius of the zone of nodes that may touch over the contact radius expected."""
LARGEST = 0.25
"""Largest element of a sphere over its radius."""
SLOPE, STEEPEST = 0.2, 0.6
"""Growth of the element size per distance from the contact, at factor 1, and at any: above, gmsh
takes an element that reaches to the contact for small enough."""
WALLS = 0.22
"""Largest element over the thickness of a wall, at factor 1."""
PER_WAVE = {1: 24.0, 2: 8.0}
"""Elements per shortest wavelength, by order."""
PER_CIRCLE = 45.0
"""Elements around a circle, at factor 1."""
WAVE_FREQUENCY = 3.0
"""Highest frequency resolved, times the Hertz duration: its pulse has less than 1 % beyond."""
FORCE_BEHIND = 0.4
"""Force of the inner contact over that of the outer one, before anything is known of it."""
MINOR_FORCE = 0.05
"""A contact whose force stays below this share of the other one's does not refine the mesh."""
ECHO = 0.65
"""Radius of a wall over the way of a pressure wave in the Hertz duration: 0.5 lets its echo come
back at the end."""
PER_WALL = 6.0
"""Elements along a wall's radius, at least, at factor 1."""


def contact_modulus(scene: Scene, name: str) -> float:
    """Hertz's E* of a contact, Pa; a rigid side deforms nothing."""
    sides = [scene.struck_material]
    if name not in scene.rigid:
        sides.append(scene.partners()[name].material)
    elastic = [side for side in sides if side is not None]
    if len(elastic) == 1:
        return elastic[0].plane_strain_modulus
    return effective_modulus(*elastic)


def contact_radius(scene: Scene, name: str, force: float, curvature: float = 0.0) -> float:
    """Hertz's contact radius under a force (N), m.

    Args:
        scene: the bodies.
        name: of the contact.
        force: N.
        curvature: mean one of what is struck, 1/m; of two spheres that of the inner one.
    """
    if scene.struck_is_inner and scene.inner is not None:
        curvature = 1.0 / scene.inner.tip_radius
    relative = 1.0 / scene.partners()[name].tip_radius + curvature
    if not relative > 0.0:
        raise SceneError(f"{name}.radius does not fit into the concave face that it strikes")
    return hertz_contact_radius(force, contact_modulus(scene, name), 1.0 / relative)


@dataclass(frozen=True)
class Estimate:
    """What the first mesh is made for."""

    radii: dict[str, float]
    """Of the contacts, by name, m."""
    duration: float
    """Shortest Hertz duration of a contact on a half-space, s."""


def estimate(scene: Scene) -> Estimate:
    """Hertz's impact of the outer body on a half-space, and of an inner one that moves."""
    radii, durations, forces = {}, [], []
    for name, body in scene.partners().items():
        mass, radius = body.mass, body.tip_radius
        if scene.struck_is_inner and scene.inner is not None:
            mass = 1.0 / (1.0 / mass + 1.0 / scene.inner.mass)
            radius = 1.0 / (1.0 / radius + 1.0 / scene.inner.tip_radius)
        speed = scene.closing_speed if name == OUTER else max(scene.inner_speed, 0.0)
        stiffness = hertz_stiffness(contact_modulus(scene, name), radius)
        if speed > 0.0:
            forces.append(stiffness * hertz_approach(mass, speed, stiffness) ** 1.5)
            durations.append(3.218 * hertz_time_scale(mass, stiffness, speed))
        else:
            forces.append(FORCE_BEHIND * forces[0])
        radii[name] = contact_radius(scene, name, forces[-1])
    return Estimate(radii, min(durations))


def shear_wave(material: Material, duration: float) -> float:
    """Shortest wavelength of shear that matters, m."""
    return math.sqrt(material.shear_modulus / material.density) * duration / WAVE_FREQUENCY


@dataclass(frozen=True)
class Sizes:
    """Elements for contact radii, with a factor on their number in every direction."""

    scene: Scene
    radii: dict[str, float]
    duration: float
    factor: float
    steepest: float = STEEPEST
    """Largest growth of the elements per distance."""

    @property
    def slope(self) -> float:
        """Growth of the elements per distance from the contact."""
        return min(SLOPE / self.factor, self.steepest)

    def least(self, name: str) -> float:
        """Size at a contact, m."""
        return self.radii[name] / self.scene.elements_per_contact_radius / self.factor

    def zone(self, name: str) -> float:
        """Radius of the zone of candidates at a contact, m."""
        return CANDIDATE_ZONE * self.radii[name]

    def per_wave(self, material: Material) -> float:
        """Largest element for the waves in a material at factor 1, m."""
        return shear_wave(material, self.duration) / PER_WAVE[self.scene.element_order]

    def field(
        self, name: str, largest: float, centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> SizeField:
        """Around one contact; ``largest`` (m) is that at factor 1."""
        least = self.least(name)
        return SizeField(
            (centre,),
            FINE_ZONE * self.radii[name],
            least,
            self.slope,
            max(least, largest / self.factor),
        )

    def sphere(self, name: str, radius: float, material: Material) -> SizeField:
        """Of a sphere that touches at the origin.

        Raises:
            SceneError: it is too small for its contact.
        """
        contact = name if name in self.radii else OUTER
        if 3.0 * self.zone(contact) > radius:
            raise SceneError(
                f"{name}.radius is {radius:g} m, but a contact radius of "
                f"{self.radii[contact]:.3g} m is expected; {3.0 * CANDIDATE_ZONE:g} times as much "
                "is the least"
            )
        return self.field(contact, min(LARGEST * radius, self.per_wave(material)))

    def body(self, material: Material) -> Fineness:
        """Of a body from a file."""
        contacts = {
            name: (self.least(name), FINE_ZONE * radius) for name, radius in self.radii.items()
        }
        return Fineness(
            contacts,
            self.slope,
            WALLS / self.factor,
            self.per_wave(material) / self.factor,
            PER_CIRCLE * self.factor,
        )
