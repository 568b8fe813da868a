"""Impacts on a body by CalculiX: the same scene and mesh generator, otherwise another program.

Consistent mass, curved edges, implicit steps and penalty contact stand against lumped mass,
straight edges, explicit steps and multipliers. Element size, time step and the penalty's
compliance shrink together along a series of meshes, so that its bands are of all three.
"""

from __future__ import annotations

import math
import tempfile
import time
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from ..calculix import program
from ..calculix.contacts import DAMPING
from ..calculix.deck import MILLI, Steps
from ..calculix.printed import Printed, frequencies, shapes
from ..common.errors import SolverError
from ..common.memory import Elements, memory_needed, require_memory
from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.excited import EXCITED
from ..solid.system import make_loop
from .calculix_model import AT, PENALTY, Model, modal_deck, model
from .calculix_observed import Observed, first_over, run_of
from .ending import Bodies, Softness, softness
from .estimate import Sizes
from .model import STRUCK, ImpactModel
from .run import LONGEST_RUN, Run
from .scene import Scene
from .solve import Meshed, on_fitting_mesh

NAME = "CalculiX"
REVISION = 3
"""Counts changes of the method that make kept results useless."""
COARSER = 0.5
"""Elements in every direction for one that is requested: every step factorises a matrix."""
AT_CONTACTS = 1.7
"""More elements at the contacts than elsewhere: well below one in a contact radius the contact is
too stiff."""
STEEPEST = 0.7
"""Growth of the elements: with steeper growth the mesher passes over a contact."""
STEPS = 60.0
"""Time steps in the shortest Hertz contact duration at `paper` resolution."""
MOST_HALVED = 3
"""Times that the steps are halved where one diverges: the first touch may need shorter ones."""
CHANGES = 0.02
"""See `Steps.changes`; the step after makes up for what is left."""
MODES = (16, 64)
"""Lowest eigenfrequencies among which the first one is that the contacts excite: so many, or if
there is none so many more."""
PER_NODE = 1.2e3
"""Memory of a run per node^(4/3), bytes: the factorised matrix of a solid."""


class _Course:
    """Watches a run: reads, reports, and says when no further contact is possible."""

    def __init__(
        self, scene: Scene, made: Model, duration: float, settings: Settings, report: Report
    ) -> None:
        self.scene, self.made, self.duration, self.report = scene, made, duration, report
        self.threads = settings.threads
        self.over = -1
        """First row after which no further contact is possible."""
        self._printed: Printed | None = None
        self._done = 0

    def __call__(self, path: Path) -> bool:
        """See `program.run`."""
        return self._look(path) is not None and self.over >= 0

    def _look(self, path: Path, to_the_end: bool = False) -> Observed | None:
        """What there is, if anything came since."""
        self._printed = self._printed or Printed(path)
        count = self._printed.advance(to_the_end)
        if count <= self._done and not to_the_end:
            return None
        if count < 1:
            raise SolverError("CalculiX ended without printing any increment")
        seen = Observed.of(self._printed, self.scene, self.made, count)
        now = float(seen.times[-1])
        expected = self.scene.end_time or max(2.5 * self.duration, 1.2 * now)
        self.report("stepping", now / expected, f"{1e6 * now:.4g} us")
        if self.scene.end_time is None and self.over < 0:
            self.over = first_over(seen, self.made, self._softness, self._done + 1)
        self._done = count
        return seen

    def finish(self, path: Path) -> Observed:
        """All curves up to the end, which does not depend on when this process has looked.

        Raises:
            SolverError: nothing was printed.
        """
        seen = self._look(path, to_the_end=True)
        assert seen is not None
        return seen if self.over < 0 else seen.until(self.over + 1)

    @cached_property
    def _softness(self) -> list[list[Softness]]:
        """By the explicit solver's elements; it decides only when the run ends."""
        from mpi4py import MPI

        made = self.made.made
        return softness(Bodies(make_loop(made.model, MPI.COMM_SELF, self.threads), made))


@dataclass(frozen=True, kw_only=True)
class Result:
    """What CalculiX has found on one mesh."""

    run: Run
    model: Model
    frequency: float
    """Lowest of what is struck that the contacts excite, Hz."""
    version: str
    memory_stated: float
    """Bytes."""


@dataclass(frozen=True, kw_only=True)
class Solution(Result, Meshed):
    """A run on a mesh that fits its contacts."""

    @property
    def dofs(self) -> int:
        """Displacements, fixed ones included."""
        return 3 * self.model.nodes

    def program(self) -> str | None:
        """That made it."""
        return NAME

    def first_frequency(self) -> float:
        """Lowest frequency of what is struck that the contacts excite, Hz."""
        return self.frequency

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``."""
        return {
            "program": NAME,
            "version": self.version,
            "damping": DAMPING,
            "penalty": PENALTY,
            "memory_stated": self.memory_stated,
        }

    def mesh_report(self) -> dict[str, Any]:
        """For the summary's ``mesh``."""
        return {**super().mesh_report(), "element": "C3D10"}

    def settings(self) -> dict[str, Any]:
        """For the provenance."""
        return {
            **super().settings(),
            "program": f"{NAME} {self.version}",
            "elements": COARSER,
            "elements_at_contacts": COARSER * AT_CONTACTS,
            "steps_per_contact": STEPS,
            "damping": DAMPING,
            "penalty": PENALTY,
        }

    def write_fields(self, folder: Path) -> list[float]:
        """None."""
        return []


def method(scene: Scene) -> list[Any]:
    """What kept results depend on, meshes and step apart."""
    return [NAME, REVISION, scene.raw]


def first_frequency(made: Model, folder: Path) -> float:
    """Lowest eigenfrequency of what is struck that the contacts excite, Hz; found in ``folder``.

    Raises:
        SolverError: there is none among the lowest, or CalculiX failed.
    """
    rigid = 6 if made.is_free else 0
    names = [f"O{AT}{side.name.upper()}" for side in made.made.sides]
    for modes in MODES:
        deck, own = modal_deck(made).modes(modes + rigid), folder / f"modes-{modes}"
        printed = program.run(deck, own, lambda _: False)
        # of modal mass 1 g
        moved = abs(shapes(printed, names)).max(axis=1) * math.sqrt(MILLI * made.masses[STRUCK])
        excited = MILLI * frequencies(printed)[rigid:][moved[rigid:] > EXCITED]
        if excited.size > 0:
            return float(excited[0])
    raise SolverError(f"the contacts excite none of the {MODES[-1]} lowest modes of the body")


def _impact(
    scene: Scene, made: Model, duration: float, factor: float, settings: Settings, report: Report
) -> tuple[Run, float]:
    """Run and the first frequency of what is struck, on one mesh."""
    started = time.monotonic()
    settings.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=settings.folder, prefix="calculix-") as name:
        folder = Path(name)
        frequency = first_frequency(made, folder)
        for halved in range(MOST_HALVED + 1):
            course = _Course(scene, made, duration, settings, report)
            steps = _steps(scene, duration, STEPS * factor * 2**halved)
            try:
                printed = program.run(
                    made.deck.impact(steps), folder / f"impact-{halved}", course, settings.threads
                )
                break
            except program.DivergedError:
                if halved == MOST_HALVED:
                    raise
        seen = course.finish(printed)
    if scene.end_time is None and course.over < 0:
        raise SolverError(
            f"no end of the contacts was found within {steps.end:.3g} s; set run.end_time"
        )
    return run_of(scene, seen, made, duration, time.monotonic() - started), frequency


def _steps(scene: Scene, duration: float, per_contact: float) -> Steps:
    longest = LONGEST_RUN * duration if scene.end_time is None else scene.end_time
    count = max(1, round(longest * per_contact / duration))
    return Steps(longest / count, longest, DAMPING, CHANGES)


def compute(
    scene: Scene, file: Path | None, factor: float, settings: Settings, comm: Any, report: Report
) -> Solution:
    """Solve a scene with ``factor`` times the elements and steps; see `solve.compute`.

    Raises:
        SceneError: the scene is outside the method.
        SolverError: CalculiX is missing or failed, or the mesh stayed too coarse.
    """
    version = program.version()

    def solved(made: ImpactModel, sizes: Sizes, attempt: int) -> Result:
        deck = model(scene, made)
        elements = Elements(3, PER_NODE * (settings.refinement * deck.nodes) ** (1.0 / 3.0))
        report(
            "assembly",
            0.0,
            require_memory(deck.nodes, elements, comm, refinement=settings.refinement),
        )
        run, frequency = _impact(scene, deck, sizes.duration, factor, settings, report)
        return Result(
            run=run,
            model=deck,
            frequency=frequency,
            version=version,
            memory_stated=memory_needed(deck.nodes, elements, 1),
        )

    elements = AT_CONTACTS * scene.elements_per_contact_radius
    finer = replace(scene, elements_per_contact_radius=elements)
    found, meshed = on_fitting_mesh(
        finer, file, COARSER * factor, settings, comm, report, method(scene), solved, STEEPEST
    )
    return Solution(**vars(found), **vars(meshed))
