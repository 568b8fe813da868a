"""How far can a fast reduced model of an impact be trusted? The program, from Python.

Five lines judge the paper's Table 1::

    import impactcheck as ic

    for name in ("scaled-plate-r10", "scaled-plate-r6.35"):
        comparison = ic.compare(ic.Scene.read(name))
        print(name, comparison.verdict, comparison.model("C").efficiency)

Every number is in SI and signed along z, which points from the inner to the outer body. What the
program refuses is an :class:`Error` with its sentence and its exit status. Each call runs the
program once (some 10 ms) and leaves the interpreter free meanwhile.
"""

from __future__ import annotations

from impactcheck._program import Error, run
from impactcheck._results import Comparison, Result
from impactcheck._scene import Scene

__all__ = ["Comparison", "Error", "Result", "Scene", "compare", "reduced", "run", "sweep"]

import json
import tempfile
from concurrent.futures import ThreadPoolExecutor
from os import PathLike, cpu_count, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

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
        Summary and curves.

    Raises:
        Error: If the program refuses the scene or the model fails.
    """
    options = {"--model": model, "--modes": modes, "--tolerance": tolerance}
    given = [f"{key}={value}" for key, value in options.items() if value is not None]
    with tempfile.TemporaryDirectory() as folder:
        history = Path(folder) / "history.csv"
        file = scene.file(folder)
        summary = run("reduced", file, "--json", f"--history={history}", *given)
        return Result.of(json.loads(summary), history.read_text())


def sweep(
    scenes: Iterable[Scene],
    model: Model | None = None,
    modes: int | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
) -> list[Result]:
    """Run a reduced model of many scenes side by side, in their order.

    For more than some thousands of them ``impactcheck study sweep`` is the way.

    Args:
        scenes: The impacts.
        model: As in :func:`reduced`.
        modes: As in :func:`reduced`.
        tolerance: As in :func:`reduced`.
        threads: Programs at a time; as many as there are cores.

    Raises:
        Error: Of the first scene that fails.
    """
    with ThreadPoolExecutor(threads or cpu_count()) as pool:
        return list(pool.map(lambda scene: reduced(scene, model, modes, tolerance), scenes))


def compare(
    *scenes: Scene,
    models: Sequence[str] = ("A", "B", "C", "external"),
    resolution: str = "paper",
    compute: bool = False,
    allow_external: bool = False,
    out: str | PathLike[str] | None = None,
) -> Comparison:
    """Compare models with the stored reference of each scene, and judge them by its tolerances.

    Args:
        scenes: The impacts; without any, those shipped.
        models: A, B, C, auto, and external for the programs that the scenes name.
        resolution: Of the reference: coarse, paper, fine, an error such as 0.2%, or imported.
        compute: Whether references that are missing are computed (needs FEniCSx).
        allow_external: Whether the programs that scenes name may run.
        out: Folder of the report; without one the report is not kept.

    Raises:
        Error: If a scene is not valid, a reference is missing or a model fails.
    """
    flags = {"--compute": compute, "--allow-external": allow_external}
    with tempfile.TemporaryDirectory() as folder:
        report = Path(fspath(out)) if out is not None else Path(folder) / "report"
        document = run(
            "compare",
            *(scene.file(folder) for scene in scenes),
            f"--models={','.join(models)}",
            f"--resolution={resolution}",
            f"--out={report}",
            "--json",
            *(flag for flag, is_set in flags.items() if is_set),
        )
        return Comparison.of(json.loads(document), report)
