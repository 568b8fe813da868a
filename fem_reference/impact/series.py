"""A scene on a series of meshes, all kept until the result is written."""

from __future__ import annotations

import hashlib
import json
import shutil
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar, cast

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SceneError, SolverError
from ..common.output import exclusive, result_folder, write_json
from ..common.processes import threads_per_process
from ..common.progress import MeshOfSeries, Progress, Report
from ..common.settings import Options, Settings, require_instants, require_share
from ..common.uncertainty import Estimate, least_squares
from .run import ImpactRun

MESHES = 5
MOST_REFINED = {2: 8.0, 3: 4.0}
"""Refining towards a target ends beyond this factor on the number of elements, by dimension."""


class Solved(Protocol):
    """What a series needs of a solution."""

    @property
    def run(self) -> ImpactRun:
        """The run."""

    @property
    def dofs(self) -> int:
        """Degrees of freedom, fixed ones included."""


S = TypeVar("S", bound=Solved)


@dataclass(frozen=True)
class Target:
    """A quantity whose band counts for `Options.target_error`."""

    name: str
    small: float = 0.0
    """Of what the impact has of it: errors of a value below are relative to that share."""
    of: str | None = None
    """The quantity that says what the impact has; None: 1."""

    def scale(self, values: dict[str, float]) -> float:
        """What an error is relative to, in the quantity's unit."""
        impact = values[self.of] if self.of else 1.0
        return max(abs(values[self.name]), self.small * abs(impact))


Write = Callable[[Path, S, list["MeshResult"]], None]
"""Writes the result into a folder; meshes finest first."""


@dataclass(frozen=True, kw_only=True)
class MeshSolver(Generic[S]):
    """A scene, and how a kind of scene is solved on one mesh."""

    method: list[Any]
    """What kept results depend on, as JSON: revision of the method, scene."""
    end_time: float | None
    ratio: float
    """Elements of a mesh in every direction over those of the next finer one."""
    targeted: tuple[Target, ...]
    compute: Callable[[float, Settings, Report, S | None], S]
    """Solves with a factor on the number of elements in every direction; where the finest mesh
    leads, coarser ones get its solution."""
    quantities: Callable[[S], dict[str, float]]
    dimension: int = 3
    """A run costs the elements in a direction to this power, and once more for the steps."""
    leads: Callable[[S], list[Any]] | None = None
    """If the finest mesh is solved first: what the others' results depend on of its solution."""
    resumes: bool = True
    """Whether a run that was killed finds something to go on from."""


@dataclass(frozen=True)
class MeshResult:
    """What a run on one mesh leaves for the bands."""

    factor: float
    """On the number of elements requested."""
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


def relative_error(meshes: list[MeshResult], targeted: tuple[Target, ...]) -> float:
    """Largest relative band of the quantities ``targeted``; one of no size aside."""
    found = estimates(meshes)
    scales = {target.name: target.scale(meshes[0].values) for target in targeted}
    return max(found[name].band / scale for name, scale in scales.items() if scale > 0.0)


def solve_series(
    solver: MeshSolver[S],
    write: Write[S],
    target: Path,
    factor: float,
    comm: Any,
    options: Options,
    progress: Progress | None = None,
) -> None:
    """Solve on `MESHES` meshes and write the result folder ``target``.

    The finest has ``factor`` times the elements requested in every direction, or as many more as
    `Options.target_error` needs. A series that was killed goes on from its files. ``write`` is
    called in the first process only.

    Raises:
        SceneError: an option is out of bounds, or a band is requested of what the run leaves open.
        RunError: a mesh could not be solved, or the result not be written.
    """
    progress = progress if progress is not None else Progress()
    require_instants(options.stress_times, solver.end_time)
    require_share(options.target_error)
    name = f".checkpoint-{target.name}" if solver.resumes else f".partial-{target.name}-kept"
    folder = options.checkpoint or target.absolute().parent / name

    def waiting() -> None:
        progress.report("waiting", 0.0, "another run of this solution is under way")

    with (
        exclusive(folder, comm, waiting),
        result_folder(target) if comm.rank == 0 else nullcontext(target) as partial,
    ):
        solution, meshes = Series(solver, factor, comm, options, folder, progress).solve()
        if comm.rank == 0:
            progress.report("writing", 0.0, "writing the results", series=1.0)
            write(partial, solution, meshes)
            progress.report("writing", 1.0, "done", series=1.0)
            shutil.rmtree(folder, ignore_errors=True)
        comm.barrier()


class Series(Generic[S]):
    """Meshes numbered from the one requested (0); finer ones have negative numbers.

    Args:
        solver: see there.
        factor: of mesh 0 on the number of elements in every direction.
        comm: of the processes.
        options: what the user asks for.
        folder: for states and kept results.
        progress: where to report.
    """

    def __init__(
        self,
        solver: MeshSolver[S],
        factor: float,
        comm: Any,
        options: Options,
        folder: Path,
        progress: Progress,
    ) -> None:
        self.solver, self.factor, self.comm = solver, factor, comm
        self.options, self.folder, self.progress = options, folder, progress
        self.lead: S | None = None

    def solve(self) -> tuple[S, list[MeshResult]]:
        """The finest mesh's solution, and all meshes of its series, finest first."""
        finest = 0
        while True:
            solution, meshes = self._meshes(finest)
            aim = self.options.target_error
            if aim is None:
                return solution, meshes
            if solution.run.in_contact_at_end:
                raise SceneError(
                    "the run ends at run.end_time during a contact, which leaves open what the "
                    f"band of {aim:g} is requested; set a later end, or none"
                )
            reached = relative_error(meshes, self.solver.targeted)
            if reached <= aim:
                return solution, meshes
            self._keep(finest, meshes[0])
            # Second order at best: never further than that would need, and at least one step.
            steps = int(np.log(reached / aim) / -np.log(self.solver.ratio) / 2.0)
            finest -= max(1, min(3, steps))
            if self._factor(finest) > MOST_REFINED[self.solver.dimension] * self.factor:
                raise SolverError(
                    f"the largest relative band is {reached:.3g} at {meshes[0].factor:.3g} times "
                    f"the elements requested; {aim:g} is requested"
                )

    def _meshes(self, finest: int) -> tuple[S, list[MeshResult]]:
        coarser = range(finest + 1, finest + MESHES)
        self.lead = None
        if self.solver.leads is None:
            stored = [self._stored(number, finest) for number in reversed(coarser)][::-1]
            solution = self._compute(finest, finest)
        else:
            solution = self.lead = self._compute(finest, finest)
            stored = []
        found = self._result(finest, solution)
        return solution, [found, *(stored or [self._stored(number, finest) for number in coarser])]

    def _factor(self, number: int) -> float:
        return float(self.factor * self.solver.ratio**number)

    def _label(self, number: int) -> str:
        return f"mesh{number:+d}"

    def _compute(self, number: int, finest: int) -> S:
        """Solve mesh ``number`` of the series of ``finest``; only that keeps fields."""
        costs = [self.solver.ratio ** (k * (self.solver.dimension + 1)) for k in range(MESHES)]
        place = number - finest
        if self.solver.leads is None:
            costs, place = costs[::-1], MESHES - 1 - place
        progress = MeshOfSeries(self.progress, place + 1, costs)

        def report(phase: str, done: float, message: str) -> None:
            if self.comm.rank == 0:
                progress.report(phase, done, message)

        options = self.options
        settings = Settings(
            options.courant,
            self.folder,
            options.checkpoint_interval,
            self._label(number),
            refinement=self._factor(finest) / self._factor(number),
            threads=threads_per_process(options.threads, self.comm),
        )
        if number == finest:
            instants = (*options.stress_times, *options.frame_times)
            settings = replace(settings, frames=options.frames, frame_times=instants)
        return self.solver.compute(self._factor(number), settings, report, self.lead)

    def _result(self, number: int, solution: S) -> MeshResult:
        run, factor = solution.run, self._factor(number)
        numbers = {
            "factor": factor,
            "dofs": solution.dofs,
            "steps": run.steps,
            "seconds": run.loop_seconds,
            "energy_residual": run.energy_residual,
        }
        values = self.solver.quantities(solution)
        return MeshResult(factor, values, run.times, run.rows, numbers)

    def _stored(self, number: int, finest: int) -> MeshResult:
        """A coarser mesh's, from its files if an earlier start has come that far."""
        found = self._load(number) if self.comm.rank == 0 else None
        found = cast("MeshResult | None", self.comm.bcast(found))
        if found is None:
            found = self._result(number, self._compute(number, finest))
            self._keep(number, found)
        return found

    def _identity(self, number: int) -> dict[str, Any]:
        method = self.solver.method
        if self.solver.leads is not None and self.lead is not None:
            method = [*method, self.solver.leads(self.lead)]
        # Through JSON, as the identity read is.
        method = json.loads(json.dumps(method))
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
        curves = path.with_name(f"{path.stem}-curves.npz")
        np.savez(curves, times=mesh.times, rows=mesh.rows)
        # The description is written last: without it the curves are not used.
        temporary = path.with_name(f".partial-{path.name}")
        document = {
            "identity": self._identity(number),
            "quantities": mesh.values,
            "numbers": mesh.numbers,
        }
        write_json(temporary, document | {"checksum": _checksum(document, curves)})
        temporary.replace(path)

    def _load(self, number: int) -> MeshResult | None:
        path = self.folder / f"{self._label(number)}.json"
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            curves = path.with_name(f"{path.stem}-curves.npz")
            intact = document.pop("checksum") == _checksum(document, curves)
            if not intact or document["identity"] != self._identity(number):
                return None
            with np.load(curves, allow_pickle=False) as file:
                times, rows = file["times"], file["rows"]
            values, numbers = document["quantities"], document["numbers"]
            return MeshResult(self._factor(number), values, times, rows, numbers)
        except (OSError, ValueError, KeyError, zipfile.BadZipFile):
            return None


def _checksum(document: dict[str, Any], curves: Path) -> str:
    """Of a kept mesh's description and the file of its curves."""
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode())
    digest.update(curves.read_bytes())
    return digest.hexdigest()
