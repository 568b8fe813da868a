"""The result of any impact as a folder: history, summary and provenance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..common.arrays import Floats
from ..common.output import write_history, write_json
from ..common.progress import Progress
from ..common.settings import (
    CHATTER_FRACTION,
    PEAK_WINDOW_FRACTION,
    RESOLUTIONS,
    Options,
    missed_instants,
)
from ..common.uncertainty import ORDER, Estimate
from ..common.versions import versions
from .history import Curves, Sampling, columns, curve_bands, history
from .run import ImpactRun
from .scene import ImpactScene
from .series import MeshResult, MeshSolver, S, estimates, relative_error, solve_series

SCHEMA_VERSION = 1
DIGITS = 10
"""Of the numbers of a history."""
OF_A_BODY = "first_frequency"
"""The quantity that is a body's own, whatever an impact on it comes to."""


@dataclass(frozen=True, kw_only=True)
class Details:
    """What only this kind of scene states of a solution, besides `ImpactRun`."""

    contacts: tuple[str, ...]
    """Names of `ImpactRun.contacts`."""
    duration: float
    """Contact duration estimated beforehand, s."""
    mesh: dict[str, Any] = field(default_factory=dict)
    """For the summary."""
    solver: dict[str, Any] = field(default_factory=dict)
    """For the summary: levels, processes, memory."""
    settings: dict[str, Any] = field(default_factory=dict)
    """For the provenance."""
    stress_times: list[float] = field(default_factory=list)
    """Instants of the fields written, s."""
    summary: dict[str, Any] = field(default_factory=dict)
    """Further entries."""
    provenance: dict[str, Any] = field(default_factory=dict)
    """Further entries."""
    uncertainty: dict[str, float] = field(default_factory=dict)
    """Bands besides those of quantities."""
    undetermined: tuple[str, ...] = ()
    """Quantities that mean nothing in this scene."""
    warnings: tuple[str, ...] = ()
    """What a user has to know before relying on the result, a sentence each."""


@dataclass(frozen=True, kw_only=True)
class ImpactSolver(MeshSolver[S]):
    """How a kind of scene is solved on one mesh, and what its result states."""

    scene: ImpactScene
    curves: Curves
    """Of the history."""
    digits: int = DIGITS
    """Of the history's numbers."""
    details: Callable[[Path, S, list[MeshResult], Floats], Details]
    """Writes mesh, fields and whatever else only this kind has into a folder. Gets the solution of
    the finest mesh, all meshes (finest first), and the bands (samples, curves) of the history."""
    sampling: Callable[[Floats], Sampling] = Sampling.on
    """Of the history of the finest mesh, from the instants of its raw samples (s)."""


def solve(
    solver: ImpactSolver[S],
    target: Path,
    resolution: str,
    comm: Any,
    options: Options,
    progress: Progress | None = None,
) -> None:
    """Solve a scene and write the result folder ``target``; see the package's README.

    Raises:
        RunError: see `ImpactSolver.compute` and `solve_series`.
    """

    def write(folder: Path, solution: S, meshes: list[MeshResult]) -> None:
        _write(folder, solver, solution, meshes, resolution, options)

    solve_series(solver, write, target, RESOLUTIONS[resolution], comm, options, progress)


def _write(
    folder: Path,
    solver: ImpactSolver[S],
    solution: S,
    meshes: list[MeshResult],
    resolution: str,
    options: Options,
) -> None:
    sampling = solver.sampling(meshes[0].times)
    places = [sampling, *(sampling.of_others() for _ in meshes[1:])]
    tables = [history(solver.curves, *each) for each in zip(meshes, places, strict=True)]
    widths = curve_bands(tables, [mesh.factor for mesh in meshes])
    names = columns(solver.curves)
    write_history(folder / "history.csv", names, tables[0], widths, solver.digits)
    details = solver.details(folder, solution, meshes, widths)
    result = _Result(solver, solution.run, _without_parts(meshes), details, resolution, options)
    sampled = {"samples": tables[0].shape[0], "sample_interval": sampling.interval}
    write_json(folder / "summary.json", {**result.summary(), **sampled, **details.summary})
    write_json(folder / "provenance.json", {**result.provenance(), **details.provenance})


def _without_parts(meshes: list[MeshResult]) -> list[MeshResult]:
    """Without the quantities "PART/NAME", which the kind of scene states itself."""
    return [
        replace(mesh, values={n: v for n, v in mesh.values.items() if "/" not in n})
        for mesh in meshes
    ]


@dataclass(frozen=True)
class _Result:
    """What the documents of a result are made of."""

    solver: ImpactSolver[Any]
    run: ImpactRun
    meshes: list[MeshResult]
    """Finest first."""
    details: Details
    resolution: str
    options: Options
    made_with: dict[str, Any] = field(default_factory=versions)
    """Of everything the result depends on."""

    def summary(self) -> dict[str, Any]:
        """The summary.

        A run that ended during a contact has not determined what the impact comes to: those
        quantities are null, and ``at_end`` says what they had come to.
        """
        scene, run, values = self.solver.scene, self.run, self.meshes[0].values
        found = self._determined()
        return {
            "schema_version": SCHEMA_VERSION,
            "scene": scene.name,
            "scene_hash": scene.scene_hash,
            "settings_hash": scene.settings_hash,
            "source": "reference",
            "model": None,
            "modes": None,
            "resolution": self.resolution,
            **{name: value if name in found else None for name, value in values.items()},
            "energy_residual": run.energy_residual,
            "momentum_residual": run.momentum_residual,
            "steps": run.steps,
            "solve_seconds": run.loop_seconds,
            "in_contact_at_end": run.in_contact_at_end,
            "end_time": float(run.times[-1]),
            "uncertainty": {
                **{name: estimate.band for name, estimate in found.items()},
                **self.details.uncertainty,
            },
            "convergence": self._convergence(found),
            "solver": {
                "time_step": run.time_step,
                "critical_time_step": run.critical_time_step,
                "courant": self._courant(),
                "versions": self.made_with,
                **self.details.solver,
            },
            "residuals": self._residuals(),
            "mesh": self.details.mesh,
            "stress_times": self.details.stress_times,
            **self._where_there_are_any(),
        }

    def provenance(self) -> dict[str, Any]:
        """The provenance."""
        scene, details = self.solver.scene, self.details
        named = zip(details.contacts, self.run.contacts, strict=True)
        return {
            "schema_version": SCHEMA_VERSION,
            "created": datetime.now(UTC).isoformat(timespec="seconds"),
            "scene": scene.raw,
            "scene_hash": scene.scene_hash,
            "settings_hash": scene.settings_hash,
            "settings": {
                "resolution": self.resolution,
                "resolution_factor": RESOLUTIONS[self.resolution],
                "courant": self._courant(),
                "peak_window": PEAK_WINDOW_FRACTION * details.duration,
                "chatter_limit": CHATTER_FRACTION * details.duration,
                **details.settings,
                "uncertainty_companion_ratio": 1.0 / self.solver.ratio,
                "target_error": self.options.target_error,
            },
            "versions": self.made_with,
            "residuals": self._residuals(),
            "contacts": {name: [list(span) for span in each.intervals] for name, each in named},
        }

    def _estimates(self) -> dict[str, Estimate]:
        """Of the quantities that mean something in this scene."""
        found = estimates(self.meshes)
        return {n: each for n, each in found.items() if n not in self.details.undetermined}

    def _determined(self) -> dict[str, Estimate]:
        """Of the quantities that the run has determined."""
        found, cut = self._estimates(), self.run.in_contact_at_end
        return {name: each for name, each in found.items() if not cut or name == OF_A_BODY}

    def _where_there_are_any(self) -> dict[str, Any]:
        """Losses, warnings, and what a run that was cut had come to."""
        run, values, found = self.run, self.meshes[0].values, {}
        if run.in_contact_at_end:
            found["at_end"] = {
                name: {"value": values[name], "band": estimate.band}
                for name, estimate in self._estimates().items()
            }
        if run.losses is not None:
            losses = asdict(run.losses).items()
            found["losses"] = {name: loss for name, loss in losses if loss not in (None, ())}
        missed = missed_instants(self.options.stress_times, float(run.times[-1]))
        warnings = [*missed, *self.details.warnings]
        return {**found, **({"warnings": warnings} if warnings else {})}

    def _convergence(self, found: dict[str, Estimate]) -> dict[str, Any]:
        """What the meshes say together, per quantity that is determined."""
        meshes, targeted = self.meshes, self.solver.targeted
        determined = {target.name for target in targeted} <= set(found)
        return {
            "rule": "least squares after Eca & Hoekstra 2014, order fixed",
            "order": ORDER,
            "meshes": [mesh.numbers for mesh in meshes],
            "quantities": {
                name: {
                    "values": [mesh.values[name] for mesh in meshes],
                    "extrapolated": estimate.extrapolated,
                    "scatter": estimate.deviation,
                    "band": estimate.band,
                }
                for name, estimate in found.items()
            },
            "relative_error": relative_error(meshes, targeted) if determined else None,
        }

    def _residuals(self) -> dict[str, float]:
        return {
            "energy": self.run.energy_residual,
            "momentum": self.run.momentum_residual,
            "contact_energy_loss": self.run.contact_loss,
            "support_impulse": self.run.support_impulse,
        }

    def _courant(self) -> float | None:
        """Time step over the critical one."""
        return self.run.critical_time_step and self.run.time_step / self.run.critical_time_step
