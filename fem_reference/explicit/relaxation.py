"""Bodies that relax: their springs for `relaxation.c`, and the energy they store and lose."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Relaxation
from . import kernel, structures


class Springs:
    """Of every node of a loop: the extension of each term's spring.

    Args:
        terms: of the relaxation of each body.
        body: (n,) number of each node's body.
        components: of displacement per node.

    Attributes:
        extension: (n, terms, C) m; terms that a body lacks stay 0.
        ratio, time: (bodies, terms) share of the modulus, and time constant, s.
        lasting: (bodies,) share of the modulus that does not relax.
    """

    def __init__(self, terms: Sequence[Sequence[Relaxation]], body: Ints, components: int) -> None:
        most = max(len(of_body) for of_body in terms)
        self.body = body
        self.extension = np.zeros((body.size, most, components))
        self.ratio, self.time = np.zeros((len(terms), most)), np.ones((len(terms), most))
        for number, of_body in enumerate(terms):
            self.ratio[number, : len(of_body)] = [term.ratio for term in of_body]
            self.time[number, : len(of_body)] = [term.time for term in of_body]
        self.counts = [len(of_body) for of_body in terms]
        self.lasting = 1.0 - self.ratio.sum(axis=1)

    def effective(self, u: Floats) -> Floats:
        """(C n,) displacement that K acts on."""
        places = u.reshape(self.body.size, -1)
        springs = np.einsum("nk,nkd->nd", self.ratio[self.body], self.extension)
        return np.asarray(self.lasting[self.body, None] * places + springs).ravel()

    def of_body(self, body: int) -> Floats:
        """(C n, terms) extensions of one body's nodes, m."""
        own = self.extension[self.body == body, : self.counts[body]].transpose(0, 2, 1)
        return np.asarray(own.reshape(own.shape[0] * own.shape[1], -1))

    def groups(
        self, level: Ints, dt: float, arrays: kernel.Arrays
    ) -> ctypes.Array[structures.Relaxing]:
        """The kernel's, for a time step (s) and the level (n,) of each node."""
        pairs = sorted(set(zip(self.body.tolist(), level.tolist(), strict=True)))
        made = (structures.Relaxing * len(pairs))()
        for group, (body, of_level) in zip(made, pairs, strict=True):
            nodes = np.flatnonzero((self.body == body) & (level == of_level))
            terms = slice(self.counts[body])
            exponent = dt * 2.0**of_level / self.time[body, terms]
            components = self.extension.shape[2]
            group.level, group.count = of_level, nodes.size
            group.entries = components * self.counts[body]
            group.node = arrays.pointer(nodes, np.int32)
            group.lasting = self.lasting[body]
            for name, values in {
                "ratio": self.ratio[body, terms],
                "decay": np.exp(-exponent),
                "growth": -self.time[body, terms] * np.expm1(-exponent),
            }.items():
                setattr(group, name, arrays.pointer(np.repeat(values, components), np.float64))
        return made


class Ledger:
    """What springs and dashpots store and lose, from the displacements at which all levels meet.

    A body's free energy is 1/2 (1 - sum g) u K u + sum 1/2 g d K d, d the extension of each term's
    spring, and it loses sum (g/tau) d K d per time. The extensions here are the ledger's own: all
    nodes move evenly from one look to the next. The kernel's follow the velocity of each node's
    own step; where tau is as short, even motion would strain them between two levels.
    """

    def __init__(self, springs: Springs) -> None:
        self._springs = springs
        self._u, self._force = np.zeros((2, *springs.extension[:, 0].shape))
        self._extension = np.zeros_like(springs.extension)
        self._forces = np.zeros_like(springs.extension)
        self._lost = np.zeros(springs.body.size)

    def look(self, time: float, u: Floats, force: Floats) -> None:
        """``time`` s after the last look the displacement (C n,) is u (m) and K u ``force`` (N)."""
        places, forces = u.reshape(self._u.shape), force.reshape(self._u.shape)
        speed, rate = (places - self._u) / time, (forces - self._force) / time
        self._u, self._force = places.copy(), forces
        springs = self._springs
        share, tau = springs.ratio / springs.time, springs.time
        decay = np.exp(-time / tau)
        # Integrals of e^2, e (1 - e) and (1 - e)^2, e = exp(-t/tau).
        once, twice = -tau * np.expm1(-time / tau), -0.5 * tau * np.expm1(-2.0 * time / tau)
        stays, meets, comes = twice, once - twice, time - 2.0 * once + twice
        body = springs.body
        stays, meets, comes = share * stays, 2.0 * share * tau * meets, share * tau**2 * comes
        self._lost += (
            stays[body] * np.einsum("nkd,nkd->nk", self._extension, self._forces)
            + meets[body] * np.einsum("nd,nkd->nk", speed, self._forces)
            + comes[body] * np.einsum("nd,nd->n", speed, rate)[:, None]
        ).sum(axis=1)
        for x, v in ((self._extension, speed), (self._forces, rate)):
            x *= decay[body, :, None]
            x += once[body, :, None] * v[:, None, :]

    def energies(self, time: float, moved: Floats) -> tuple[Floats, Floats]:
        """(n,) stored in the springs and lost so far, J, ``time``/2 s from now.

        Over the whole time u moves by ``moved`` (C n,). Over a step of a central difference
        sum 1/2 (g/a) d_n K d_{n+1}, a = (tau/h) (1 - exp(-h/tau)), is exact.
        """
        springs, stored, lost = self._springs, np.zeros_like(self._lost), self._lost.copy()
        path = moved.reshape(self._u.shape)
        decay, evened = (
            np.exp(-time / springs.time),
            -springs.time / time * np.expm1(-time / springs.time),
        )
        for k in range(decay.shape[1]):
            ratio, tau, keep, even = (
                x[springs.body, k] for x in (springs.ratio, springs.time, decay, evened)
            )
            d, q = self._extension[:, k], self._forces[:, k]
            following = keep[:, None] * d + even[:, None] * path
            stored += 0.5 * ratio / even * (following * q).sum(axis=1)
            lost += 0.5 * time * ratio / tau * (d * q).sum(axis=1)
        return stored, lost

    @property
    def state(self) -> dict[str, Floats]:
        """For a checkpoint, at a look."""
        return {"spring": self._extension, "spring_force": self._forces, "lost": self._lost}

    def restore(self, saved: dict[str, Floats], u: Floats, force: Floats) -> None:
        """The reverse; u (C n,) and K u are those of the look."""
        self._u, self._force = (x.reshape(self._u.shape).copy() for x in (u, force))
        for name, array in self.state.items():
            array[:] = saved[name]
