"""A scene on a sequence of meshes: values, observed orders, bands of quantities and curves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..axisymmetric.modal import first_frequency
from ..axisymmetric.system import System
from ..common.arrays import Floats
from ..common.errors import SolverError
from ..common.progress import MeshOfSeries, Progress
from ..common.uncertainty import Estimate, curve_band, least_squares
from .axisymmetric import Solution, compute
from .axisymmetric_run import Run
from .history import HISTORY_COLUMNS, Sampled, history, resampled
from .scene import Scene

RATIO = 0.84
"""Elements of a mesh over those of the next finer one: four steps halve them."""
MESHES = 5
COST_ORDER = 3
"""A run costs the elements in a direction to this power: two for their number, one for steps."""
CURVE_REACH = 0.02
"""Half width of the window of the curves' band over the Hertz contact duration."""

QUANTITIES = (
    "efficiency",
    "outer_velocity_final",
    "inner_velocity_final",
    "outer_force_peak",
    "inner_force_peak",
    "outer_contact_end",
    "inner_contact_end",
    "first_frequency",
)
TARGETED = ("efficiency", "outer_force_peak", "inner_force_peak")
"""Quantities whose relative band `refine` brings down."""
MOST_REFINED = 8.0
"""`refine` gives up beyond this factor on the number of elements."""


def quantities(scene: Scene, run: Run, system: System) -> dict[str, float]:
    """The summary's physical quantities, SI; a contact that never closed ends at 0."""
    balance = run.balance
    return {
        "efficiency": scene.inner.mass
        * balance.inner_velocity**2
        / (scene.outer.mass * scene.speed**2),
        "outer_velocity_final": balance.outer_velocity,
        "inner_velocity_final": balance.inner_velocity,
        "outer_force_peak": run.contacts[0].force_peak,
        "inner_force_peak": run.contacts[1].force_peak,
        "outer_contact_end": run.contacts[0].end or 0.0,
        "inner_contact_end": run.contacts[1].end or 0.0,
        "first_frequency": first_frequency(system),
    }


@dataclass(frozen=True)
class Sequence:
    """Solutions of a scene, finest first, and what they say together."""

    solutions: tuple[Solution, ...]
    values: dict[str, Floats]
    """Per quantity the values on all meshes, finest first."""
    estimates: dict[str, Estimate]

    @property
    def finest(self) -> Solution:
        """The solution that counts."""
        return self.solutions[0]

    def relative_error(self) -> float:
        """Largest relative band of the quantities in `TARGETED`; a quantity of value 0 aside."""
        return max(
            self.estimates[name].band / abs(float(self.values[name][0]))
            for name in TARGETED
            if self.values[name][0] != 0.0
        )

    def curve_bands(self) -> Floats:
        """(samples, 8) half widths of the 95 % bands of the history's curves."""
        runs = [solution.run for solution in self.solutions]
        factors = [solution.factor for solution in self.solutions]
        return curve_bands(runs, factors, self.finest.estimate.duration)


def curve_bands(runs: Iterable[Sampled], factors: list[float], duration: float) -> Floats:
    """(samples, 8) half widths of the 95 % bands of the finest run's history.

    Args:
        runs: finest first.
        factors: of each mesh, on the number of elements.
        duration: Hertz contact duration, s.
    """
    finest, *coarser = runs
    table, interval = history(finest)
    tables = np.stack([table, *(resampled(run, table[:, 0]) for run in coarser)])
    reach = max(1, round(CURVE_REACH * duration / interval))
    columns = range(1, len(HISTORY_COLUMNS))
    sizes = 1.0 / np.array(factors)
    return np.stack([curve_band(tables[:, :, k], sizes, reach) for k in columns], axis=1)


def solve_sequence(
    scene: Scene,
    factor: float,
    *,
    courant: float = 0.9,
    snapshot_times: tuple[float, ...] = (),
    progress: Progress | None = None,
    known: dict[float, Solution] | None = None,
) -> Sequence:
    """Solve a scene with ``factor`` times its elements, and on `MESHES` - 1 coarser meshes.

    Args:
        scene: what to solve.
        factor: on the number of elements, of the finest mesh.
        courant: time step over the critical one; the same on all meshes, so that the error of the
            time step is part of the band.
        snapshot_times: of the finest run, s.
        progress: where to report.
        known: solutions by factor that need not be made again; new ones are added.
    """
    known = {} if known is None else known
    factors = [factor * RATIO**number for number in range(MESHES)]
    costs = [share**COST_ORDER for share in factors]

    def reporting(number: int) -> Progress | None:
        return MeshOfSeries(progress, number + 1, costs) if progress is not None else None

    finest = known.get(factor)
    if finest is None or snapshot_times:
        finest = compute(
            scene, factor, courant=courant, snapshot_times=snapshot_times, progress=reporting(0)
        )
    solutions = [finest]
    for number in range(1, MESHES):
        coarser = factors[number]
        near = next((s for f, s in known.items() if abs(f / coarser - 1.0) < 1e-9), None)
        if near is None or near.radii != finest.radii:
            near = compute(scene, coarser, courant=courant, progress=reporting(number), like=finest)
        solutions.append(near)
    known.update({solution.factor: solution for solution in solutions})
    sizes = np.array([1.0 / solution.factor for solution in solutions])
    found = [quantities(scene, solution.run, solution.system) for solution in solutions]
    values = {name: np.array([each[name] for each in found]) for name in QUANTITIES}
    estimates = {name: least_squares(values[name], sizes) for name in QUANTITIES}
    return Sequence(tuple(solutions), values, estimates)


def refine(
    scene: Scene,
    factor: float,
    target: float,
    *,
    courant: float = 0.9,
    snapshot_times: tuple[float, ...] = (),
    progress: Progress | None = None,
) -> Sequence:
    """Refine until the relative band of efficiency and force peaks is at most ``target``.

    Meshes are those of `solve_sequence`, so that each step shares most of them with the last.

    Raises:
        SolverError: the band is still too wide at `MOST_REFINED` times the elements.
    """
    known: dict[float, Solution] = {}
    while True:
        sequence = solve_sequence(scene, factor, courant=courant, progress=progress, known=known)
        reached = sequence.relative_error()
        if reached <= target:
            break
        # Second order at best: never further than that would need, and at least one step.
        steps = max(1, min(3, int(np.log(reached / target) / -np.log(RATIO) / 2.0)))
        factor /= RATIO**steps
        if factor > MOST_REFINED:
            raise SolverError(
                f"the band of efficiency and force peaks is {reached:.3g} of them at "
                f"{factor * RATIO**steps:.3g} times the elements asked for; {target:g} is asked for"
            )
    if snapshot_times:
        sequence = solve_sequence(
            scene,
            factor,
            courant=courant,
            snapshot_times=snapshot_times,
            progress=progress,
            known=known,
        )
    return sequence
