"""A model stepped through time, and what that needed of the machine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from ..common.memory import SOLID, memory_needed, peak_memory, require_memory
from ..common.progress import Report
from ..common.settings import Settings
from ..explicit.checkpoint import checkpoint_of
from ..explicit.frames import Recorder
from ..explicit.loop import Loop
from ..explicit.supervision import Account, stable_run
from .model import Model
from .system import make_loop


class Accounted(Protocol):
    """What decides whether a run with sub-cycling is taken."""

    def account(self, levels: int) -> Account:
        """Of the run with so many levels."""


R = TypeVar("R", bound=Accounted)


@dataclass(frozen=True, kw_only=True)
class Stepped(Generic[R]):
    """A run of a model."""

    run: R
    loop: Loop
    recorder: Recorder
    memory_stated: float
    """Before the run, bytes."""
    memory_used: float
    """At most so far, bytes."""

    @property
    def dofs(self) -> int:
        """Degrees of freedom, fixed ones included."""
        return 3 * int(self.loop.system.mass.size)

    def machine(self) -> dict[str, Any]:
        """For the summary's ``solver``: levels, contact solver, processes, memory (bytes)."""
        state = self.loop.problem.state
        return {
            "nodes_per_level": list(self.loop.levels),
            "contact_sweeps_per_step": state.sweeps / max(1, state.step),
            "contact_unconverged_steps": state.unconverged,
            "processes": self.loop.comm.size,
            "threads": self.loop.threads,
            "peak_memory": self.memory_used,
            "memory_stated": self.memory_stated,
        }


def stepped(
    model: Model,
    method: list[Any],
    settings: Settings,
    comm: Any,
    report: Report,
    integrate: Callable[..., R],
    suffix: str = "",
) -> Stepped[R]:
    """Step a model, again without sub-cycling where that is unstable.

    Args:
        model: bodies and contacts.
        method: what a kept state depends on, model and step apart.
        settings: of the mesh.
        comm: of the processes.
        report: where to report.
        integrate: steps a loop; gets it, and options of `supervise` and ``most_levels`` by name.
        suffix: for the names of kept files.

    Raises:
        SolverError: there is too little memory, or see ``integrate``.
    """
    nodes, form = int(model.first[-1]), SOLID[model.elastic[0].mesh.order]
    report("assembly", 0.0, require_memory(nodes, form, comm, refinement=settings.refinement))

    def attempt(most_levels: int) -> tuple[Loop, R, Recorder]:
        loop = make_loop(model, comm, settings.threads)
        recorder = Recorder(settings, f"{suffix}-{most_levels}")
        run = integrate(
            loop,
            courant=settings.courant,
            most_levels=most_levels,
            fields=recorder,
            checkpoint=checkpoint_of(settings, [*method, most_levels], model.meshes, suffix),
            on_progress=lambda done, message: report("stepping", done, message),
        )
        return loop, run, recorder

    loop, run, recorder = stable_run(attempt, lambda made: made[1].account(len(made[0].levels)))
    return Stepped(
        run=run,
        loop=loop,
        recorder=recorder,
        memory_stated=memory_needed(nodes, form, comm.size),
        memory_used=peak_memory(comm),
    )
