"""Plate impacts that the finite elements do not cover."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from ..common.bodies import Bender, Compact, Sphere, Stack
from ..common.errors import SceneError

if TYPE_CHECKING:
    from .scene import Scene

MOMENT_LEFT = 1e-3
"""Largest share of a bender's moment at the strike."""
AXISYMMETRIC = "take reference.geometry 'axisymmetric'"


def require_solvable(scene: Scene) -> None:
    """Refuse what these finite elements do not solve.

    Raises:
        SceneError: naming the field, its value and what it must be.
    """
    for refused, sentence in chain(_geometry(scene), _bodies(scene), _materials(scene)):
        if refused:
            raise SceneError(sentence)


def _geometry(scene: Scene) -> Iterator[tuple[bool, str]]:
    """Of the geometry: whether a scene is refused, and why."""
    solid, plate = scene.geometry == "solid", scene.dry_plate
    for name, value, unit in (("offset", scene.offset, "m"), ("angle", scene.angle, "rad")):
        yield (
            value != 0.0 and not solid,
            f"outer.{name} is {value:g} {unit}, which has no axis of symmetry: take "
            "reference.geometry 'solid'",
        )
    yield (
        solid and scene.fluid is not None,
        f"fluid is given; solid geometry is for dry impacts, it must be null: {AXISYMMETRIC}",
    )
    yield (
        solid and plate.damping_ratio > 0.0,
        f"plate.damping_ratio is {plate.damping_ratio:g}; solid geometry has no damping, it must "
        f"be 0: {AXISYMMETRIC}",
    )
    yield solid and scene.series is not None, f"series is given: {AXISYMMETRIC}"


def _bodies(scene: Scene) -> Iterator[tuple[bool, str]]:
    """Of bodies, damping and friction: whether a scene is refused, and why."""
    outer, fluid, solid = scene.outer, scene.fluid, scene.geometry == "solid"
    mounted = isinstance(outer, Bender | Stack)
    yield mounted and solid, f"outer.kind is {type(outer).__name__.lower()!r}: {AXISYMMETRIC}"
    yield (
        mounted and scene.end_time is None,
        "run.end_time is missing; a bender or a stack comes back to the plate for ever, so that it "
        "has to be given",
    )
    if isinstance(outer, Bender):
        left = outer.strike.moment_left
        yield (
            left > MOMENT_LEFT,
            f"outer.discharge_time is {outer.discharge_time:g} s: {100.0 * left:.2g} % of the "
            f"drive's moment is left at the strike; it must be at most {100.0 * MOMENT_LEFT:g} %",
        )
    # From 1 on modes creep instead of oscillating, and the end of the run has no proof.
    for name, ratio in (
        ("plate.damping_ratio", scene.dry_plate.damping_ratio),
        ("fluid.plate_damping_ratio", fluid.plate_damping_ratio if fluid else 0.0),
    ):
        yield ratio >= 1.0, f"{name} is {ratio:g}; it must be below 1"
    yield (
        scene.rubs and not all(isinstance(b, Sphere) for b in (outer, scene.inner)),
        f"friction is {max(scene.frictions.values()):g}; this solver has it between spheres and "
        "plate, elsewhere it must be 0",
    )
    for name, spin in (("outer", scene.outer_spin), ("inner", scene.inner_spin)):
        yield (
            spin != 0.0,
            f"{name}.spin is {spin:g} rad/s; this solver begins without spin: it must be 0",
        )
    for name, body in (("outer", outer), ("inner", scene.inner)):
        yield (
            solid and isinstance(body, Compact) and name not in scene.rigid,
            f"{name}.kind is 'compact', whose tip deforms; solid geometry has rigid tips only: "
            f"{AXISYMMETRIC}, or name it in reference.rigid",
        )


def _materials(scene: Scene) -> Iterator[tuple[bool, str]]:
    """Of plasticity and relaxation: whether a scene is refused, and why."""
    relaxing = scene.relaxing
    soft = " and ".join(f"{name}.material" for name in relaxing)
    for name, material in zip(("outer", "plate", "inner"), scene.materials, strict=True):
        yields = material.yielding is not None
        yield (
            yields and scene.geometry == "solid",
            f"{name}.material yields (hardening {material.hardening} Pa); solid geometry is "
            f"elastic: {AXISYMMETRIC}",
        )
        yield (
            yields and bool(relaxing),
            f"{name}.material yields and {soft} relaxes; this solver has one of both in a scene",
        )
    for name, body in (("outer", scene.outer), ("inner", scene.inner)):
        yield (
            not isinstance(body, Sphere) and name not in scene.rigid and name in relaxing,
            f"{name}.material.relaxation is given; the tip of a compact body or a bender deforms "
            "as an elastic half-space: take a sphere",
        )
