"""The energy that a run has at an instant, and what of it is lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ..common.arrays import Floats
from . import structures
from .loop import Loop
from .plastic import PlasticState


@dataclass(frozen=True)
class Energies:
    """Discrete energy of the part that is modelled, J.

    1/2 w M w + 1/2 u_n K' u_{n+1}, w = (u_{n+1} - u_n)/D, with the step D at whose ends all levels
    meet and u_{n+1} - 2 u_n + u_{n-1} = -D^2 M^-1 K' u_n (e.g. Hairer, Lubich & Wanner, Geometric
    Numerical Integration). With one level K' = K, and the loop without contact conserves it. With
    several, K' is close to K and nearly symmetric for what is slower than D: 1e-6 is missed in a
    run, 1 % with white noise. K' u is found by one step from rest, which leads to
    (u_{n+1} + u_{n-1})/2.
    """

    elastic: tuple[float, ...]
    rigid_motion: tuple[float, ...]
    """Share of each elastic body's mean translation."""
    rigid: tuple[float, ...]
    lost: tuple[float, ...]
    """By each elastic body to relaxation so far."""

    @property
    def total(self) -> float:
        """Of all bodies, J."""
        return sum(self.elastic) + sum(self.rigid)


def _of_spin(rigid: structures.Rigid) -> float:
    """Energy of a ball's rotation, J."""
    about = zip(rigid.spin, rigid.turning[::4], strict=True)
    return float(sum(0.5 * spin**2 / turning for spin, turning in about if turning > 0.0))


def energies_of(loop: Loop) -> Energies:
    """Discrete energies of what ``loop`` moves, at an instant at which all levels meet."""
    lost = stored = np.zeros(loop.system.first.size - 1)
    plastic = loop.problem.plastic
    if loop.meeting == 1 and loop.ledger is None:
        velocity, force = loop.v, loop.product(loop.u)
        if plastic is not None:
            force -= plastic.force
        strain = 0.5 * (loop.u - loop.dt * loop.v) * force
    else:
        velocity, strain = _long_step(loop)
    if loop.springs is not None and loop.ledger is not None:
        loop.look()
        strain *= np.repeat(loop.springs.lasting[loop.body], loop.components)
        time = loop.meeting * loop.dt
        both = loop.ledger.energies(time, time * velocity)
        stored, lost = loop.body_sums(np.stack(both, axis=1)).T
    mass = np.repeat(loop.mass, loop.components)
    density = 0.5 * mass * velocity**2 + strain
    if plastic is not None:
        density += _of_plastic_strain(loop, plastic)
    elastic = loop.body_sums(density.reshape(-1, loop.components).sum(axis=1)) + stored
    free = loop.momenta()[:, loop.system.free_axes]
    mean = (free**2).sum(axis=1) / (2.0 * loop.body_masses())
    rigids = loop.problem.rigids[: loop.problem.state.rigids]
    rigid = [0.5 * r.mass * sum(x * x for x in r.v) + _of_spin(r) for r in rigids]
    parts = (tuple(energy.tolist()) for energy in (elastic, mean, np.array(rigid), lost))
    return Energies(*parts)


def _of_plastic_strain(loop: Loop, plastic: PlasticState) -> Floats:
    """(C n,) what 1/2 (u - u_p) K (u - u_p) has besides 1/2 u (K u - f_p), J."""
    density = -0.5 * loop.u * plastic.force
    np.add.at(density, 2 * plastic.plasticity.nodes[:, 0], plastic.stored())
    return np.asarray(density)


def _long_step(loop: Loop) -> tuple[Floats, Floats]:
    """W and 1/2 u_{n+1} K' u_n of `Energies`, by component, without contact."""
    long_step = loop.meeting * loop.dt
    with _as_it_was(loop):
        now = loop.u.copy()
        loop.drift(loop.meeting)
        following = loop.u.copy()
    return (following - now) / long_step, 0.5 * following * _mean_force(loop)


def _mean_force(loop: Loop) -> Floats:
    """K' u_n - f_p of `Energies`."""
    if loop.meeting == 1:
        return loop.product(loop.u)
    with _as_it_was(loop):
        # From rest: half the impulses, which the step itself gives in full.
        now, loop.v[:] = loop.u.copy(), 0.5 * loop.inverse * loop.impulse(loop.u)
        if loop.problem.plastic is not None:
            loop.v -= 0.5 * loop.dt * loop.inverse * loop.problem.plastic.force
        loop.drift_elastic(loop.meeting)
        mass, long_step = np.repeat(loop.mass, loop.components), loop.meeting * loop.dt
        return np.asarray(2.0 * mass * (now - loop.u) / long_step**2)


@contextmanager
def _as_it_was(loop: Loop) -> Iterator[None]:
    """Afterwards the state is what it is now."""
    u, v = loop.u.copy(), loop.v.copy()
    extension = None if loop.springs is None else loop.springs.extension.copy()
    yield
    loop.u[:], loop.v[:] = u, v
    if loop.springs is not None and extension is not None:
        loop.springs.extension[:] = extension
        loop.strain()
