"""When a run may end: no further contact of any body is possible."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..common.arrays import Floats
from ..explicit.energies import Energies
from ..explicit.excited import excited_frequency
from ..explicit.free_motions import FreeMotions, flexibility
from ..explicit.loop import Loop
from ..explicit.spectrum import free_components
from ..impact.ending import Approach, Ending
from ..solid.two_level import TwoLevel
from .model import STRUCK, ImpactModel
from .motion import Motion


class Bodies:
    """The rigid motions of all elastic bodies, and what a contact's pressure displaces of them."""

    def __init__(self, loop: Loop, made: ImpactModel) -> None:
        self.loop, self.made = loop, made
        self.floating = [FreeMotions(loop, k) for k in range(len(made.model.elastic))]
        self._two_levels: dict[int, TwoLevel] = {}

    def precondition(self, number: int) -> TwoLevel | None:
        """For static solutions of a body; None: its mesh is linear, and the diagonal serves."""
        loop, model = self.loop, self.made.model
        body, first = model.elastic[number], int(model.first[number])
        if body.mesh.order == 1:
            return None
        if number not in self._two_levels:
            free = free_components(loop, number)
            self._two_levels[number] = TwoLevel(loop, body.mesh, body.material, first, free)
        return self._two_levels[number]

    def rigid(self, load: Floats, vector: Floats, body: int) -> float:
        """What the rigid motion in a displacement or velocity (3 n,) comes to under a load."""
        floating = self.floating[body]
        return float(floating.along(load) @ floating.coordinates(vector))

    def vibration(self, energies: Energies, body: int) -> float:
        """Energy of a body, rigid motions apart, J."""
        moving = self.floating[body].coordinates(self.loop.v)
        return energies.elastic[body] - 0.5 * float(moving @ moving)

    def first_frequency(self) -> float:
        """Lowest frequency of what is struck that the contacts excite, Hz.

        Raises:
            SolverError: none was found.
        """
        return excited_frequency(
            self.loop,
            STRUCK,
            [side.patch.load(self.loop, STRUCK) for side in self.made.sides],
            self.floating[STRUCK],
            self.precondition(STRUCK),
        )

    def flexibility(self, body: int, load: Floats) -> float:
        """Static flexibility of a body under a unit load, m/N."""
        return flexibility(self.loop, body, load, self.floating[body], self.precondition(body))


@dataclass(frozen=True)
class Softness:
    """What a contact's pressure displaces of one of its bodies."""

    body: int
    """Number among the elastic ones."""
    load: Floats
    """(3 n,) unit load in the loop's order."""
    flexibility: float
    """m/N"""


def softness(bodies: Bodies) -> list[list[Softness]]:
    """Of each side what is struck, then its own body if that is elastic."""
    loop, found = bodies.loop, []
    for side in bodies.made.sides:
        patches = [(STRUCK, side.patch)]
        if side.own is not None and side.body is not None:
            patches.append((side.body, side.own))
        loads = [(body, patch.load(loop, body)) for body, patch in patches]
        found.append([Softness(body, load, bodies.flexibility(body, load)) for body, load in loads])
    return found


def impact_ending(motion: Motion) -> Ending:
    """When all bodies can be proven never to touch again."""
    loop, made = motion.loop, motion.made
    bodies = Bodies(loop, made)
    found = softness(bodies)

    def approaches(energies: Energies) -> Iterator[Approach]:
        for side, of_side in zip(made.sides, found, strict=True):
            clearance, opening = (
                float(side.strike.normal @ motion.of_side(vector, side))
                - (
                    bodies.rigid(of_side[0].load, getattr(loop, vector), STRUCK)
                    if made.has_struck
                    else 0.0
                )
                for vector in ("u", "v")
            )
            vibrating = tuple(
                (bodies.vibration(energies, each.body), each.flexibility) for each in of_side
            )
            yield Approach(side.gap + clearance, opening, vibrating)

    return Ending(loop, approaches)
