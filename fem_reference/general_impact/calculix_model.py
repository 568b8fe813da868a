"""The deck of an impact on a body for CalculiX."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..calculix.deck import Contact, Deck, Observer, Part
from ..calculix.tets import Tetrahedra, nodal_volumes
from ..common.arrays import Floats, Ints
from ..common.errors import SceneError
from ..common.settings import Options
from ..solid.mesh import TetMesh, surface
from .estimate import contact_modulus
from .model import FACING, OPPOSITE, STRUCK, ImpactModel, Side
from .scene import OUTER, Scene

PENALTY = 500.0
"""Pressure over penetration, times element size over contact modulus: a contact deforms by
2 / (pi `PENALTY`) elements more than Hertz's under its largest pressure."""
BODY = "BODY"
"""Name of the part that is struck; the spheres have those of their sides."""
MOTION = "MOTION"
"""Name of the observers of its rigid motions, with their numbers."""
AT = "AT"
"""Name of the observers of its surface, with the names of the sides."""


def require_supported(scene: Scene, options: Options, processes: int) -> None:
    """Refuse what the deck does not describe.

    Raises:
        SceneError: naming the field, its value and what it must be.
    """
    for refused, reason in _refusals(scene, options, processes):
        if refused:
            raise SceneError(
                f"{reason}: --solver calculix has elastic spheres on a body from a file only"
            )


def _refusals(scene: Scene, options: Options, processes: int) -> Iterator[tuple[bool, str]]:
    for name in ("plate", "wall"):
        yield getattr(scene, name) is not None, f"{name} is given; it must be absent"
    yield scene.body is None, "body is missing"
    for name, partner in scene.partners().items():
        kind = type(partner).__name__.lower()
        yield kind != "sphere", f"{name}.kind is '{kind}'; it must be 'sphere'"
    yield bool(scene.rigid), f"reference.rigid is '{scene.rigid_bodies}'; it must be 'none'"
    order = scene.element_order
    yield order != 2, f"reference.element_order is {order}; it must be 2"
    yield (
        bool(options.stress_times or options.frames or options.frame_times),
        "fields are requested; this solver writes none",
    )
    yield processes > 1, f"--np is {processes}; it must be 1"


def rigid_motions(points: Floats, masses: Floats, count: int) -> Floats:
    """(count, n, 3) translations, then rotations, orthonormal in the norm of the masses (n,)."""
    place = points - masses @ points / masses.sum()
    axes = np.eye(3)
    motions = [np.broadcast_to(axis, place.shape) for axis in axes]
    motions += [np.cross(axis, place) for axis in axes]
    found: list[Floats] = []
    for motion in motions[:count]:
        own = motion - sum(
            (other * (masses @ (other * motion).sum(axis=1)) for other in found), np.zeros(3)
        )
        found.append(own / np.sqrt(masses @ (own**2).sum(axis=1)))
    return np.stack(found)


@dataclass(frozen=True)
class Model:
    """The deck of a scene on one mesh, and what it takes to read the result."""

    deck: Deck
    made: ImpactModel
    masses: tuple[float, ...]
    """Of what is struck and of the spheres, kg."""
    motions: int
    """Observed rigid motions of what is struck, translations first: 3 if it is held, else 6."""
    moved: Floats
    """(sides, motions) what each motion moves at a contact along its normal; 0 if it is held."""

    @property
    def nodes(self) -> int:
        """Of all meshes."""
        return sum(len(part.nodes) for part in self.deck.parts)

    @property
    def is_free(self) -> bool:
        """Whether what is struck is not held."""
        return self.motions == 6


def _exact_body(made: ImpactModel) -> TetMesh:
    """What is struck, its nodes around the contacts on the exact surface."""
    mesh = made.model.elastic[STRUCK].mesh
    points = mesh.points.copy()
    for side in made.sides:
        points[side.patch.nodes] = side.places
    return replace(mesh, points=points)


def _exact_sphere(mesh: TetMesh, side: Side) -> TetMesh:
    """A sphere with all nodes of its surface on the exact one, edges curved."""
    points, outside = mesh.points.copy(), np.unique(surface(mesh))
    arm = points[outside] - np.array(side.ball.centre)
    arm *= side.ball.radius / np.linalg.norm(arm, axis=1, keepdims=True)
    points[outside] = np.array(side.ball.centre) + arm
    return replace(mesh, points=points)


def _near(mesh: TetMesh, side: Side, towards: float, reach: float) -> Ints:
    """Facets within a distance of a contact that face along (1) or against (-1) its normal."""
    facets = surface(mesh)
    a, b, c = (mesh.points[facets[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    facing = towards * (normals @ side.strike.normal) > FACING * np.linalg.norm(normals, axis=1)
    away = np.linalg.norm(mesh.points[facets[:, :3]] - side.strike.point, axis=2).min(axis=1)
    return np.asarray(facets[facing & (away <= reach)])


def model(scene: Scene, made: ImpactModel) -> Model:
    """The deck on the meshes of the explicit solver, with curved edges.

    Raises:
        SolverError: a curved element is inverted.
    """
    bodies, sides = made.model.elastic, made.sides
    spheres = [_exact_sphere(bodies[side.body or 0].mesh, side) for side in sides]
    names = [BODY, *(side.name.upper() for side in sides)]
    exact = [None, *(scene.partners()[side.name].mass for side in sides)]
    parts: list[Part] = []
    tets: list[Tetrahedra] = []
    lumps: list[Floats] = []
    node = element = 0
    for name, mesh, body, mass in zip(
        names, [_exact_body(made), *spheres], bodies, exact, strict=True
    ):
        numbered, volumes = Tetrahedra(mesh, node + 1, element + 1), nodal_volumes(mesh)
        density = body.material.density if mass is None else mass / float(volumes.sum())
        material = replace(body.material, density=density)
        held = numbered.held(body.fixed)
        nodes, elements = numbered.nodes, numbered.elements
        parts.append(Part(name, nodes, elements, material, held, velocity=body.velocity))
        tets.append(numbered)
        lumps.append(density * volumes)
        node, element = parts[-1].last
    contacts = [
        Contact(
            name,
            sphere.faces(_near(sphere.mesh, side, -1.0, side.patch.reach)),
            tets[STRUCK].faces(_near(tets[STRUCK].mesh, side, 1.0, OPPOSITE * side.patch.reach)),
            PENALTY * contact_modulus(scene, side.name) / side.size,
        )
        for name, sphere, side in zip(names[1:], tets[1:], sides, strict=True)
    ]
    motions = rigid_motions(
        tets[STRUCK].mesh.points, lumps[STRUCK], 3 if bodies[STRUCK].fixed.size else 6
    )
    observed = [
        (name, sphere, (lump / lump.sum())[:, None] * side.along, scene_speed(scene, side))
        for name, sphere, lump, side in zip(names[1:], tets[1:], lumps[1:], sides, strict=True)
    ]
    observed += [
        (f"{MOTION}{k}", tets[STRUCK], lumps[STRUCK][:, None] * motion, 0.0)
        for k, motion in enumerate(motions)
    ]
    observers = [
        Observer(name, node + k, body.terms(weights), speed)
        for k, (name, body, weights, speed) in enumerate(observed, 1)
    ]
    moved = np.zeros((len(sides), len(motions)))
    if len(motions) == 6:
        loads = [_load(side, tets[STRUCK].mesh) for side in sides]
        moved = np.array([[(load * motion).sum() for motion in motions] for load in loads])
    masses = tuple(float(lump.sum()) for lump in lumps)
    return Model(Deck(parts, contacts, observers), made, masses, len(motions), moved)


def scene_speed(scene: Scene, side: Side) -> float:
    """Of the body of a side along its direction at the start, m/s."""
    return -scene.speed if side.name == OUTER else scene.inner_speed


def _load(side: Side, mesh: TetMesh) -> Floats:
    """(n, 3) unit load of a contact on what is struck, see `Patch.load`."""
    weights = side.patch.weights()
    load = np.zeros_like(mesh.points)
    load[side.patch.nodes] = weights[:, None] * side.patch.normals
    return load


def modal_deck(made: Model) -> Deck:
    """What is struck alone, observed where it is struck."""
    part = made.deck.parts[STRUCK]
    mesh = made.made.model.elastic[STRUCK].mesh
    numbered = Tetrahedra(mesh, part.nodes[0][0], 1)
    last, _ = part.last
    observers = [
        Observer(f"{AT}{side.name.upper()}", last + k, numbered.terms(_load(side, mesh)))
        for k, side in enumerate(made.made.sides, 1)
    ]
    return Deck([part], observers=observers)
