"""How the bodies of a model move in a run."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats
from ..explicit.loop import Loop
from ..solid.sphere_pairs import sphere_pairs
from .model import STRUCK, ImpactModel, Side

MOVED = 0.005
"""Way of a sphere along the surface after which its pairs are made anew, over the size of the
elements there."""

COLUMNS = 3
"""Of the raw samples, for each side: displacement (m), velocity (m/s), impulse of its contact so
far (N s, on the whole bodies)."""


class Motion:
    """Mean motions of all bodies, and what the contacts do to them.

    Args:
        loop: bodies and contacts.
        made: where they are.
        inner: direction in which a struck sphere counts as the inner body; None: it is not one.
    """

    def __init__(self, loop: Loop, made: ImpactModel, inner: Floats | None) -> None:
        self.loop, self.made, self.inner = loop, made, inner
        masses = loop.body_masses()
        self._weights = np.stack(
            [np.where(loop.body == k, loop.mass / masses[k], 0.0) for k in range(masses.size)]
        )
        self._looked: dict[str, Floats] = {}

    def mean(self, vector: str, body: int) -> Floats:
        """(3,) mean displacement "u" (m) or velocity "v" (m/s) of an elastic body."""
        values = getattr(self.loop, vector).reshape(-1, 3)
        return np.asarray(self.loop.total(self._weights[body] @ values))

    def of_side(self, vector: str, side: Side) -> Floats:
        """(3,) the same of the body of a side."""
        if side.body is not None:
            return self.mean(vector, side.body)
        number = self.made.model.contacts[side.contact].rigid  # type: ignore[union-attr]
        return np.array(getattr(self.loop.problem.rigids[number], vector))

    def compressive(self, quantity: str, side: Side) -> float:
        """Impulse or force of a contact, on the whole bodies."""
        vector = np.array(getattr(self.loop.problem.contacts[side.contact], quantity))
        # what is struck is pushed against its normal; of a sphere on a rigid wall it is the sphere
        sign = -1.0 if self.made.has_struck else 1.0
        return sign * float(vector @ side.strike.normal) / self.made.share

    def speeds(self) -> Floats:
        """(sides,) velocities of the bodies along their directions, m/s."""
        return np.array(self._along("v"))

    def _along(self, vector: str) -> list[float]:
        found = [float(side.along @ self.of_side(vector, side)) for side in self.made.sides]
        if self.inner is not None:
            found.append(float(self.inner @ self.mean(vector, STRUCK)))
        return found

    def sample(self, samples: int, stride: int) -> Floats:
        """Advance by samples * stride steps; a row of `COLUMNS` of the first step of each stride.

        All pairs are made anew at first: a run that goes on from a saved state has no others.
        """
        self._looked.clear()
        return np.array([self._sample(stride) for _ in range(samples)])

    def _sample(self, stride: int) -> list[float]:
        self._follow()
        loop, sides = self.loop, self.made.sides
        places, before = self._along("u"), self._along("v")
        loop.advance(1)
        after = self._along("v")
        row = []
        for k, (place, first, second) in enumerate(zip(places, before, after, strict=True)):
            impulse = 0.0
            if k < len(sides):
                # the multiplier of a step acts half a step before and after its instant
                half = 0.5 * loop.dt * self.compressive("force", sides[k])
                impulse = self.compressive("impulse", sides[k]) - half
            row += [place, 0.5 * (first + second), impulse]
        loop.advance(stride - 1)
        return row

    def _follow(self) -> None:
        """Pair spheres that have moved along the surface with what lies opposite now."""
        displacement = None
        for side in self.made.sides:
            if side.facets is None or side.body is None:
                continue
            mean = self.mean("u", side.body) - self.mean("u", STRUCK)
            lateral = mean - (mean @ side.strike.normal) * side.strike.normal
            looked = self._looked.get(side.name)
            if looked is not None and np.linalg.norm(lateral - looked) < MOVED * side.size:
                continue
            self._looked[side.name] = lateral
            if displacement is None:
                displacement = self.loop.gather(self.loop.u)
            self._pair(side, side.body, displacement)

    def _pair(self, side: Side, body: int, displacement: Floats) -> None:
        model = self.made.model
        first, end = (int(n) for n in model.first[body : body + 2])
        facets = side.facets
        assert facets is not None
        pairs = sphere_pairs(
            *(side.ball, model.elastic[body].mesh, facets, side.places, displacement[first:end]),
            self.mean("u", body),
            displacement[side.patch.nodes],
        )
        self.loop.problem.pair(
            *(side.contact, first, pairs.facets, pairs.weights, pairs.normals, pairs.gaps)
        )
