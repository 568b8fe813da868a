"""How far can a fast reduced model of an impact be trusted? The program, in Python's process.

Five lines judge the paper's Table 1::

    import impactcheck as ic

    for name in ("scaled-plate-r10", "scaled-plate-r6.35"):
        comparison = ic.compare(ic.Scene.read(name))
        print(name, comparison.verdict, comparison.model("C").efficiency)

Every number is in SI and signed along z, which points from the inner to the outer body. What the
program refuses is an :class:`Error` with its sentence and its exit status. Other threads go on
while anything is computed. The finite elements are `impactcheck.fem_reference`.
"""

from __future__ import annotations

from impactcheck import _core
from impactcheck._core import Scene
from impactcheck._error import Error
from impactcheck._results import Comparison, Optimum, Result

__all__ = [
    "Comparison",
    "Error",
    "Model",
    "Optimum",
    "Result",
    "Scene",
    "compare",
    "optimise",
    "reduced",
    "reference",
    "sweep",
]

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from os import PathLike

Model = Literal["A", "B", "C", "auto"]


def reduced(
    scene: Scene,
    model: Model | None = None,
    modes: int | None = None,
    tolerance: float | None = None,
) -> Result:
    """Run a reduced model.

    Args:
        scene: The impact.
        model: A, B, C or auto; the scene's, else C.
        modes: Number of modes; the scene's, else the model's.
        tolerance: Relative error: of the time integration, of auto that of the results.

    Returns:
        Summary and curves. `prediction` has for each quantity the interval (`low` to `high`) that
        holds with 95 % what a reference would find on infinitely fine meshes; or it is None, and
        `prediction_reason` states why. For models A and B, model C runs too.

    Raises:
        Error: If the model fails, or is none of the scene's.
    """
    return Result.of(*_core.predicted(scene, model, modes, tolerance))


def sweep(
    scenes: Iterable[Scene],
    model: Model | None = None,
    modes: int | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
) -> list[Result]:
    """Run a reduced model of many scenes side by side, in their order.

    Each result is what :func:`reduced` gives, without `prediction`; plates that were solved once
    serve all of the same shape. More than some ten thousands fill the memory with curves:
    `impactcheck study sweep` keeps the quantities alone, in files, and goes on where it was ended.

    Args:
        scenes: The impacts.
        model: As in :func:`reduced`.
        modes: As in :func:`reduced`.
        tolerance: As in :func:`reduced`.
        threads: Number of threads; by default the number of cores.

    Raises:
        Error: Of the first scene that fails.
    """
    runs = _core.reduced(list(scenes), model, modes, tolerance, threads)
    return [Result.of(*run) for run in runs]


def reference(scene: Scene, resolution: str = "paper", compute: bool = False) -> Result:
    """Find the stored finite-element reference of exactly this scene.

    Args:
        scene: The impact.
        resolution: coarse, paper, fine, an error such as 0.2%, or imported.
        compute: Whether one that is missing is computed and stored (needs FEniCSx; seconds to
            minutes).

    Returns:
        Summary, with 95 % bands in `uncertainty`, and curves.

    Raises:
        Error: If there is none, or it can't be computed.
    """
    return Result.of(*_core.reference(scene, resolution, compute))


def compare(
    *scenes: Scene,
    models: Sequence[str] = ("A", "B", "C", "external"),
    resolution: str = "paper",
    compute: bool = False,
    allow_external: bool = False,
    out: str | PathLike[str] | None = None,
    measured: Sequence[str | PathLike[str]] = (),
    bandwidth: str | float | None = None,
    speed: Literal["scene", "measured"] | None = None,
    record_map: str | PathLike[str] | None = None,
) -> Comparison:
    """Compare models with the reference of each scene, and judge them by its tolerances.

    A program of the user's that fails stops nothing: its verdict is fail, and its summary says why
    in `failure`.

    Args:
        scenes: The impacts; without any, those shipped.
        models: A, B, C, auto, and external for the programs that the scenes name.
        resolution: Of the reference, as in :func:`reference`.
        compute: As in :func:`reference`.
        allow_external: Whether the programs that scenes name may run.
        out: Folder of the report; none is written without.
        measured: Records of instruments, repeated impacts of the one scene; what they show is
            :meth:`Comparison.measured`. The channels of one impact may be in several files:
            "outer.csv+inner.csv".
        bandwidth: Of the instrument, with unit or in Hz; by default "100 kHz". The models' curves
            are filtered to it.
        speed: Source of the outer body's speed before the impact: the scene (default), or the
            record, if its signal has no offset ("measured").
        record_map: File that says which column of a record is what; by default that is inferred.

    Raises:
        Error: If a reference is missing, a model fails or a record can't be aligned.
    """
    how = (None if bandwidth is None else str(bandwidth), speed, record_map)
    document, figures = _core.compare(
        scenes, models, resolution, compute, allow_external, out, measured, how
    )
    return Comparison.of(document, figures)


def optimise(
    scene: Scene,
    over: Mapping[str, tuple[str | float, str | float]],
    objective: str | None = None,
    within: str | float | None = None,
    mesh: str | PathLike[str] | None = None,
    model: Literal["A", "B", "C"] | None = None,
    modes: int | None = None,
    seed: int = 1,
    samples: int | None = None,
    robust: float | None = None,
    verify: bool = False,
    resolution: str = "paper",
    out: str | PathLike[str] | None = None,
    progress: Callable[[int, float | None], object] | None = None,
) -> Optimum:
    """Search the numbers of a scene with which a result is largest, as `impactcheck optimise`.

    Args:
        scene: The impact.
        over: Bounds by field, with units or in SI: `{"plate.thickness": ("1 mm", "3 mm")}`; fields
            that take the same value are joined by commas.
        objective: A quantity of the summary. Default: the efficiency; of a seal seat
            `intended_speed`, the sphere's speed in the intended direction in m/s.
        within: How far from that direction the sphere may fly, with unit or in rad.
        mesh: Mesh (.vtu) of a seal seat, scaled to its dimensions; by default a coarse one.
        model: A, B or C; the scene's, else B, of a seal seat C.
        modes: As in :func:`reduced`.
        seed: Of the samples of a search over several variables.
        samples: Their number.
        robust: Maximise this quantile of the objective (0.05 = 5 %) under the scene's uncertainty.
        verify: Whether the optimum is compared with the reference, which is computed if there is
            none (needs FEniCSx).
        resolution: Of that reference.
        out: Folder of the optimum's files; none are written without.
        progress: Called about ten times a second with the number of designs tried and the best
            objective (None before the first result).

    Raises:
        Error: If a field or its bounds make no sense, or nothing within them has a result.
    """
    options = [
        f"--seed={seed}",
        f"--resolution={resolution}",
        *(f"--over={field}={low}..{high}" for field, (low, high) in over.items()),
    ]
    named = {
        "objective": objective,
        "within": within,
        "mesh": mesh,
        "model": model,
        "modes": modes,
        "samples": samples,
        "robust": robust,
        "out": out,
    }
    options += [f"--{name}={value}" for name, value in named.items() if value is not None]
    options += ["--verify"] if verify else []
    document, figure, best = _core.optimise(scene, options, progress)
    return Optimum.of(document, figure, best)
