"""Largest and smallest eigenvalue and static flexibility, from products with K only."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np
from scipy.linalg import eigh_tridiagonal

from ..common.arrays import Floats, Ints
from ..common.errors import SolverError
from .loop import Loop

LANCZOS_STEPS = 400
LANCZOS_TOLERANCE = 1e-5
CG_STEPS = 20000
CG_TOLERANCE = 1e-7
PLAIN_STEPS, STEPS = 60, 120
"""Most steps of inverse iteration from the last motion alone, and in all."""
LOWER = 10.0
"""Relative change of the square over the tolerance by which another motion is a lower one."""
PARALLEL = 1e-8
"""Distance of unit vectors below which they are the same but for rounding."""

Precondition = Callable[[Floats], Floats]
"""A symmetric approximation of K^-1."""


def critical_time_step(loop: Loop) -> float:
    """2 / omega_max of the lumped system, s, from a safe upper estimate of omega_max.

    Lanczos on M^-1/2 K M^-1/2; adding the residual of the largest Ritz value makes it an upper
    bound of the eigenvalue it belongs to.
    """
    root = np.sqrt(loop.inverse)
    # The same start vector whatever the number of processes.
    start = np.random.default_rng(1).standard_normal((loop.system.mass.size, 3))
    vector = loop.own(start) * (root > 0.0)
    vector /= math.sqrt(loop.dot(vector, vector))
    before = np.zeros_like(vector)
    diagonal: list[float] = []
    off_diagonal: list[float] = []
    beta = 0.0
    for step in range(LANCZOS_STEPS):
        image = root * loop.product(root * vector) - beta * before
        alpha = loop.dot(image, vector)
        image -= alpha * vector
        beta = math.sqrt(loop.dot(image, image))
        diagonal.append(alpha)
        if beta == 0.0 or step % 10 == 9 or step == LANCZOS_STEPS - 1:
            values, vectors = eigh_tridiagonal(
                diagonal, off_diagonal, select="i", select_range=(len(diagonal) - 1,) * 2
            )
            residual = beta * abs(float(vectors[-1, 0]))
            if residual <= LANCZOS_TOLERANCE * float(values[0]):
                return 2.0 / math.sqrt(float(values[0]) + residual)
        off_diagonal.append(beta)
        before, vector = vector, image / beta
    raise SolverError("the largest eigenvalue of the system was not found; the mesh may be poor")


def conjugate_gradients(
    loop: Loop,
    load: Floats,
    free: Floats,
    project: Callable[[Floats], Floats] = lambda x: x,
    start: Floats | None = None,
    tolerance: float = CG_TOLERANCE,
    precondition: Precondition | None = None,
) -> Floats:
    """K^-1 load on the components where ``free`` is 1.

    ``project`` takes the motions out of a residual that cost no energy; ``precondition``
    is by default the inverse of the diagonal.

    Raises:
        SolverError: no convergence.
    """
    weight = free / loop.diagonal
    improved = precondition or (lambda residual: weight * residual)
    x = np.zeros_like(load) if start is None else start * free
    residual = project(load * free - free * loop.product(x))
    limit = tolerance * math.sqrt(loop.dot(load * free, improved(load * free)))
    direction = np.zeros_like(load)
    rho = 1.0
    for _ in range(CG_STEPS):
        scaled = improved(residual)
        following = loop.dot(residual, scaled)
        if math.sqrt(following) <= limit:
            return x
        direction = scaled + (following / rho) * direction
        rho = following
        image = free * loop.product(direction)
        step = rho / loop.dot(direction, image)
        x += step * direction
        residual = residual - step * image
    raise SolverError(f"the static solution did not converge in {CG_STEPS} steps")


def free_components(loop: Loop, body: int) -> Floats:
    """1 for the components of a body that can move, else 0."""
    inside = np.repeat(loop.body == body, 3)
    return np.asarray(inside & (loop.inverse > 0.0), dtype=np.float64)


def body_translation(loop: Loop, body: int, axis: int) -> Floats:
    """The rigid motion of a body along an axis, 1 in every node that can move so."""
    motion = np.zeros((loop.system.owned.size, 3))
    motion[:, axis] = loop.body == body
    return np.asarray(motion.ravel() * (loop.inverse > 0.0))


def body_rotation(loop: Loop, body: int) -> Floats:
    """The small rotation of a body about the y axis through its centre of mass, 1 rad."""
    inside = np.where(loop.body == body, loop.mass, 0.0)
    place = loop.system.points[loop.system.owned]
    centre = loop.total(inside @ place) / float(loop.body_masses()[body])
    motion = np.zeros_like(place)
    motion[:, 0], motion[:, 2] = place[:, 2] - centre[2], centre[0] - place[:, 0]
    return np.asarray((motion * (loop.body == body)[:, None]).ravel())


class RigidMotions:
    """The motions of a body that a force along an axis causes and no support hinders.

    Translation along the axis; along x, and the rotation about y, of a body that has no plane of
    symmetry but y = 0.

    Attributes:
        motions: each with its modal mass.
    """

    def __init__(self, loop: Loop, body: int, axis: int) -> None:
        self._loop, self._mass = loop, np.repeat(loop.mass, 3)
        self.motions: list[tuple[Floats, float]] = []
        mass = float(loop.body_masses()[body])
        translations = [(mass, body_translation(loop, body, k)) for k in sorted({axis, 0})]
        for whole, free in (*translations, self._rotation(body)):
            weight = loop.dot(free, self._mass * free)
            if weight >= (1.0 - 1e-9) * whole:
                self.motions.append((free, weight))

    def _rotation(self, body: int) -> tuple[float, Floats]:
        rotation = body_rotation(self._loop, body)
        whole = self._loop.dot(rotation, self._mass * rotation)
        return whole, rotation * (self._loop.inverse > 0.0)

    def out_of_motion(self, x: Floats) -> Floats:
        """A motion without them."""
        for rigid, weight in self.motions:
            x = x - rigid * (self._loop.dot(rigid, self._mass * x) / weight)
        return x

    def out_of_force(self, force: Floats) -> Floats:
        """A force without what accelerates them."""
        for rigid, weight in self.motions:
            force = force - self._mass * rigid * (self._loop.dot(rigid, force) / weight)
        return force


class Floating(Protocol):
    """Rigid motions of a body."""

    @property
    def motions(self) -> list[tuple[Floats, float]]:
        """Each with its modal mass."""

    def out_of_motion(self, x: Floats) -> Floats:
        """A motion without them."""

    def out_of_force(self, force: Floats) -> Floats:
        """A force without what accelerates them."""


def first_frequency(
    loop: Loop,
    body: int,
    axis: int = 2,
    tolerance: float = 1e-6,
    start: Floats | None = None,
    floating: Floating | None = None,
) -> float:
    """Lowest eigenfrequency of a body, Hz, by inverse iteration from the motion along ``axis``.

    Where the two lowest are close to each other, plain iteration is slow or stops at the second
    one; then each step begins with the best combination of the last three motions.

    A body that is free along ``axis`` keeps that motion out of the iteration. ``start`` (3 n,) is
    another motion to begin with, where the lowest mode may not contain that along ``axis``;
    ``floating`` the rigid motions, where there may be others than a force along it causes.
    """
    free = free_components(loop, body)
    mass = np.repeat(loop.mass, 3)
    floating = floating or RigidMotions(loop, body, axis)
    x = rigid = body_translation(loop, body, axis)
    orthogonal, balanced = floating.out_of_motion, floating.out_of_force
    if floating.motions:
        place = loop.system.points[loop.system.owned]
        x = orthogonal(rigid * np.repeat((place[:, :2] ** 2).sum(axis=1), 3))
    if start is not None:
        x = orthogonal(start * free)
    value, is_plain = 0.0, True
    earlier: list[Floats] = []
    for step in range(1, STEPS + 1):
        following = x if is_plain else _lowest_within(loop, [x, *earlier], mass, free)
        earlier = [x, *earlier[:1]]
        x = following / math.sqrt(loop.dot(following, mass * following))
        load = mass * x * free
        x = orthogonal(
            conjugate_gradients(
                loop,
                load,
                free,
                balanced,
                start=x / value if value else None,
                tolerance=1e-4,
            )
        )
        squared = _rayleigh_quotient(loop, x, mass, free)
        if abs(squared - value) <= tolerance * squared:
            if not is_plain:
                return math.sqrt(squared) / (2.0 * math.pi)
            lowest = _lowest_within(loop, [x, *earlier], mass, free)
            least = _rayleigh_quotient(loop, lowest, mass, free)
            if least >= (1.0 - LOWER * tolerance) * squared:
                return math.sqrt(squared) / (2.0 * math.pi)
            is_plain = False
        value, is_plain = squared, is_plain and step < PLAIN_STEPS
    raise SolverError("the first eigenfrequency was not found")


def _rayleigh_quotient(loop: Loop, x: Floats, mass: Floats, free: Floats) -> float:
    """Square of the angular frequency of a motion, 1/s^2."""
    return float(loop.dot(x, loop.product(x) * free) / loop.dot(x, mass * x * free))


def _lowest_within(loop: Loop, motions: list[Floats], mass: Floats, free: Floats) -> Floats:
    """The motion of least frequency that motions combine to (Rayleigh and Ritz)."""

    def length(motion: Floats) -> float:
        return math.sqrt(loop.dot(motion, mass * motion))

    basis: list[Floats] = []
    for motion in motions:
        rest = motion / length(motion)
        for known in (*basis, *basis):  # twice: they are nearly parallel
            rest = rest - loop.dot(known, mass * rest) * known
        if length(rest) > PARALLEL:
            basis.append(rest / length(rest))
    images = [loop.product(motion) * free for motion in basis]
    matrix = np.array([[loop.dot(a, image) for image in images] for a in basis])
    weights = np.linalg.eigh(0.5 * (matrix + matrix.T))[1][:, 0]
    return np.asarray(sum(weight * motion for weight, motion in zip(weights, basis, strict=True)))


def patch_flexibility(loop: Loop, body: int, nodes: Ints, weights: Floats) -> float:
    """Flexibility of a body along z over a patch, p^T K^-1 p, m/N (of the part modelled).

    Static if the body is supported along z, otherwise that of the free body under the force
    and its own inertia, rigid motion apart (inertia relief).

    Args:
        loop: the assembled system.
        body: number of the elastic body.
        nodes: (n,) the patch, numbers in the body.
        weights: (n,) shares of a unit force, their sum is 1.
    """
    patch = np.zeros((loop.system.mass.size, 3))
    patch[nodes + loop.system.first[body], 2] = weights
    load = loop.own(patch)
    free = free_components(loop, body)
    floating = RigidMotions(loop, body, 2)
    relieved = floating.out_of_force(load)
    x = conjugate_gradients(loop, relieved, free, floating.out_of_force, tolerance=1e-4)
    return loop.dot(relieved, x)
