"""A scene on a series of meshes: coarser ones first, all kept until the result is written."""

from __future__ import annotations

import argparse
import hashlib
import json
import shutil
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar, cast

import numpy as np

from ..explicit.checkpoint import Checkpoint, exclusive
from ..solid.fields import Frames
from ..solid.loop import Loop
from ..solid.model import Model
from .arrays import Floats
from .errors import SolverError
from .output import result_folder, write_json
from .progress import MeshOfSeries, Progress
from .settings import require_instants, require_share
from .uncertainty import Estimate, least_squares

MESHES = 5
COST_ORDER = 4
"""A run costs the elements in a direction to this power: three for their number, one for steps."""
MOST_REFINED = 4.0
"""Refining towards a target ends beyond this factor on the number of elements."""

Report = Callable[[str, float, str], None]
"""Gets phase, share done, message."""


@dataclass(frozen=True)
class Options:
    """What a user asks of a solution, mesh apart."""

    courant: float = 0.9
    """Time step over the critical one."""
    stress_times: tuple[float, ...] = ()
    """Instants at which fields are written, s."""
    frames: int = 0
    """Fields are written at least so many times, evenly over the run; 0: not."""
    checkpoint: Path | None = None
    """Folder; by default ``.checkpoint-<name>`` beside the result."""
    checkpoint_interval: float = 60.0
    """Wall-clock time between checkpoints, s."""
    target_error: float | None = None
    """Refine until the relative bands are that small."""

    @staticmethod
    def of(arguments: argparse.Namespace) -> Options:
        """From the command line."""
        return Options(
            arguments.courant,
            arguments.stress_at,
            arguments.fields,
            arguments.checkpoint,
            arguments.checkpoint_interval,
            arguments.target_error,
        )


class Recorder:
    """Makes the recorder of a run's fields once its sampling interval is known.

    Args:
        folder: for the fields until they are written.
        count: see `Frames`; 0 with no ``times``: nothing is kept.
        times: instants, s.
    """

    def __init__(self, folder: Path, count: int, times: tuple[float, ...]) -> None:
        self.folder, self.count, self.times = folder, count, times
        self.made: Frames | None = None

    def __call__(self, interval: float) -> Frames:
        """Recorder for a run sampled at ``interval`` s."""
        self.made = Frames(self.folder, self.count, self.times, interval)
        return self.made

    def frames(self) -> list[tuple[float, Floats]]:
        """Instant (s) and displacement (N, 3) of all fields kept."""
        return self.made.frames() if self.made else []


@dataclass(frozen=True)
class Settings:
    """How one mesh of a series is solved."""

    courant: float
    folder: Path
    """For states and kept results."""
    checkpoint_interval: float
    label: str
    """Of this mesh, for the names of its files."""
    frames: int = 0
    frame_times: tuple[float, ...] = ()

    def checkpoint(self, method: list[Any], model: Model, suffix: str = "") -> Checkpoint:
        """Of a run on ``model``'s meshes; ``method`` is what else its state depends on."""
        digest = hashlib.sha256()
        digest.update(json.dumps([*method, self.courant], sort_keys=True).encode())
        for body in model.elastic:
            digest.update(np.round(body.mesh.points, 15).tobytes())
            digest.update(body.mesh.cells.tobytes())
        path = self.folder / f"{self.label}{suffix}.npz"
        return Checkpoint(path, digest.hexdigest(), self.checkpoint_interval)

    def recorder(self, suffix: str = "") -> Recorder:
        """Of the run's fields."""
        folder = self.folder / f"{self.label}{suffix}-frames"
        return Recorder(folder, self.frames, self.frame_times)


class Run(Protocol):
    """What a series needs of a run."""

    @property
    def times(self) -> Floats:
        """(m,) raw sampling instants, s."""

    @property
    def rows(self) -> Floats:
        """(m, columns) raw samples."""

    @property
    def steps(self) -> int:
        """Time steps."""

    @property
    def loop_seconds(self) -> float:
        """Wall time of the loop, s."""

    @property
    def energy_residual(self) -> float:
        """Of the energy ledger, relative."""


class Solved(Protocol):
    """What a series needs of a solution."""

    @property
    def run(self) -> Run:
        """The run."""

    @property
    def loop(self) -> Loop:
        """State at the end."""


S = TypeVar("S", bound=Solved)


@dataclass(frozen=True)
class Problem(Generic[S]):
    """A scene, and how a kind of scene is solved on one mesh."""

    method: list[Any]
    """What kept results depend on, as JSON: revision of the method, scene."""
    end_time: float | None
    ratio: float
    """Elements of a mesh in every direction over those of the next finer one."""
    targeted: tuple[str, ...]
    """Quantities whose relative band counts for `Options.target_error`."""
    compute: Callable[[float, Settings, Report], S]
    """Solves with a factor on the number of elements in every direction."""
    quantities: Callable[[S], dict[str, float]]
    write: Callable[[Path, S, list[MeshResult]], None]
    """Writes the result; meshes finest first. Called in the first process only."""


@dataclass(frozen=True)
class MeshResult:
    """What a run on one mesh leaves for the bands."""

    factor: float
    """On the number of elements asked for."""
    values: dict[str, float]
    times: Floats
    rows: Floats
    numbers: dict[str, Any]
    """For the summary: factor, dofs, steps, seconds, energy residual."""


def estimates(meshes: list[MeshResult]) -> dict[str, Estimate]:
    """Per quantity what the meshes (finest first) say together."""
    sizes = np.array([1.0 / mesh.factor for mesh in meshes])
    return {
        name: least_squares(np.array([mesh.values[name] for mesh in meshes]), sizes)
        for name in meshes[0].values
    }


def relative_error(meshes: list[MeshResult], targeted: tuple[str, ...]) -> float:
    """Largest relative band of the quantities ``targeted``; one of value 0 aside."""
    found = estimates(meshes)
    values = meshes[0].values
    return max(found[name].band / abs(values[name]) for name in targeted if values[name] != 0.0)


def solve_series(
    problem: Problem[S],
    target: Path,
    factor: float,
    comm: Any,
    options: Options,
    progress: Progress | None = None,
) -> None:
    """Solve on `MESHES` meshes and write the result folder ``target``.

    The finest has ``factor`` times the elements asked for in every direction, or as many more as
    `Options.target_error` needs. A series that was killed goes on from its files.

    Raises:
        SceneError: an option is out of bounds.
        RunError: a mesh could not be solved, or the result not be written.
    """
    progress = progress if progress is not None else Progress()
    require_instants(options.stress_times, problem.end_time)
    require_share(options.target_error)
    folder = options.checkpoint or target.absolute().parent / f".checkpoint-{target.name}"

    def waiting() -> None:
        progress.report("waiting", 0.0, "another run of this solution is under way")

    with (
        exclusive(folder, comm, waiting),
        result_folder(target) if comm.rank == 0 else nullcontext(target) as partial,
    ):
        series = _Series(problem, factor, comm, options, folder, progress)
        solution, meshes = series.solve()
        if comm.rank == 0:
            progress.report("writing", 0.0, "writing the results", series=1.0)
            problem.write(partial, solution, meshes)
            progress.report("writing", 1.0, "done", series=1.0)
            shutil.rmtree(folder, ignore_errors=True)
        comm.barrier()


class _Series(Generic[S]):
    """Meshes numbered from the one asked for (0); finer ones have negative numbers."""

    def __init__(
        self,
        problem: Problem[S],
        factor: float,
        comm: Any,
        options: Options,
        folder: Path,
        progress: Progress,
    ) -> None:
        self.problem, self.factor, self.comm = problem, factor, comm
        self.options, self.folder, self.progress = options, folder, progress

    def solve(self) -> tuple[S, list[MeshResult]]:
        """The finest mesh's solution, and all meshes of its series, finest first."""
        finest = 0
        while True:
            coarser = [self._kept(finest + step, step) for step in range(MESHES - 1, 0, -1)]
            solution = self._compute(finest, 0, with_fields=True)
            meshes = [self._result(finest, solution), *reversed(coarser)]
            aim = self.options.target_error
            if aim is None:
                return solution, meshes
            reached = relative_error(meshes, self.problem.targeted)
            if reached <= aim:
                return solution, meshes
            if self._factor(finest - 1) > MOST_REFINED * self.factor:
                raise SolverError(
                    f"the largest relative band is {reached:.3g} at {meshes[0].factor:.3g} times "
                    f"the elements asked for; {aim:g} is asked for"
                )
            self._keep(finest, meshes[0])
            finest -= 1

    def _factor(self, number: int) -> float:
        return float(self.factor * self.problem.ratio**number)

    def _label(self, number: int) -> str:
        return f"mesh{number:+d}"

    def _compute(self, number: int, step: int, *, with_fields: bool) -> S:
        """Solve mesh ``number``, ``step`` meshes coarser than the finest, which comes last."""
        costs = [self.problem.ratio ** (COST_ORDER * k) for k in range(MESHES - 1, -1, -1)]
        progress = MeshOfSeries(self.progress, MESHES - step, costs)

        def report(phase: str, done: float, message: str) -> None:
            if self.comm.rank == 0:
                progress.report(phase, done, message)

        options = self.options
        settings = Settings(
            options.courant, self.folder, options.checkpoint_interval, self._label(number)
        )
        if with_fields:
            settings = replace(settings, frames=options.frames, frame_times=options.stress_times)
        return self.problem.compute(self._factor(number), settings, report)

    def _result(self, number: int, solution: S) -> MeshResult:
        run, factor = solution.run, self._factor(number)
        numbers = {
            "factor": factor,
            "dofs": 3 * int(solution.loop.all_masses.size),
            "steps": run.steps,
            "seconds": run.loop_seconds,
            "energy_residual": run.energy_residual,
        }
        values = self.problem.quantities(solution)
        return MeshResult(factor, values, run.times, run.rows, numbers)

    def _kept(self, number: int, step: int) -> MeshResult:
        """A coarser mesh's, from its files if an earlier start has come that far."""
        found = self._load(number) if self.comm.rank == 0 else None
        found = cast("MeshResult | None", self.comm.bcast(found))
        if found is None:
            found = self._result(number, self._compute(number, step, with_fields=False))
            self._keep(number, found)
        return found

    def _identity(self, number: int) -> dict[str, Any]:
        # Through JSON, as the identity read is.
        method = json.loads(json.dumps(self.problem.method))
        return {
            "method": method,
            "courant": self.options.courant,
            "factor": self._factor(number),
        }

    def _keep(self, number: int, mesh: MeshResult) -> None:
        if self.comm.rank != 0:
            return
        path = self.folder / f"{self._label(number)}.json"
        self.folder.mkdir(parents=True, exist_ok=True)
        np.savez(path.with_name(f"{path.stem}-curves.npz"), times=mesh.times, rows=mesh.rows)
        # The description is written last: without it the curves are not used.
        temporary = path.with_name(f".partial-{path.name}")
        document = {
            "identity": self._identity(number),
            "quantities": mesh.values,
            "numbers": mesh.numbers,
        }
        write_json(temporary, document)
        temporary.replace(path)

    def _load(self, number: int) -> MeshResult | None:
        path = self.folder / f"{self._label(number)}.json"
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            if document["identity"] != self._identity(number):
                return None
            with np.load(path.with_name(f"{path.stem}-curves.npz"), allow_pickle=False) as file:
                times, rows = file["times"], file["rows"]
            values, numbers = document["quantities"], document["numbers"]
            return MeshResult(self._factor(number), values, times, rows, numbers)
        except (OSError, ValueError, KeyError):
            return None
