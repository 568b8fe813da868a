"""Impacts one after the other, each with the dents of those before; what is finished is kept.

Fig. 13 of the paper: a low start, a rise, and a steady state once nothing yields any more.
"""

from __future__ import annotations

import hashlib
import json
import zipfile
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..axisymmetric.system import AxisymmetricSystem
from ..common.arrays import Floats
from ..common.settings import Settings
from ..explicit.checkpoint import write_arrays
from ..explicit.energies import Energies
from ..explicit.records import ContactRecord
from ..impact.run import Losses
from .axisymmetric_motion import AxisymmetricMotion
from .dents import Memory
from .motion import Yielded
from .run import Run
from .scene import Series

SHAKEN_DOWN = 3e-4
"""Plastic work over the impact's energy below which nothing yields any more."""

ARRAYS = ("times", "rows", "dents")
"""Of a run."""

Impact = Callable[[int, Memory | None], tuple[Run, AxisymmetricMotion]]
"""Makes the impact of a number, from 0 on, with what the bodies know of those before."""


class StoredRuns:
    """The finished impacts of a mesh, in a file that survives a killed run.

    Args:
        settings: of the mesh.
        attempt: number of the mesh among those tried; each has a file of its own.
        method: what the impacts depend on besides the mesh, as JSON.
        system: on the mesh.
    """

    def __init__(
        self, settings: Settings, attempt: int, method: list[Any], system: AxisymmetricSystem
    ) -> None:
        digest = hashlib.sha256(json.dumps([*method, settings.courant], sort_keys=True).encode())
        digest.update(np.round(system.points, 15).tobytes())
        self._identity = digest.hexdigest()
        self._path: Path = settings.folder / f"{settings.label}-impacts-{attempt}.npz"

    def save(self, runs: list[Run], memory: Memory) -> None:
        """All runs so far and what the next impact has to know.

        Raises:
            SolverError: the file cannot be written.
        """
        described = [{**asdict(run), **dict.fromkeys(ARRAYS)} for run in runs]
        arrays = {
            f"{name}-{k}": getattr(run, name) for name in ARRAYS for k, run in enumerate(runs)
        }
        text = json.dumps({"identity": self._identity, "runs": described})
        write_arrays(self._path, text=np.array(text), **asdict(memory), **arrays)

    def load(self) -> tuple[list[Run], Memory | None]:
        """What was saved of the same impacts on the same mesh."""
        try:
            with np.load(self._path, allow_pickle=False) as file:
                saved = {name: file[name] for name in file.files}
            described = json.loads(str(saved["text"]))
            if described["identity"] != self._identity:
                return [], None
            runs = [
                _run(values, {name: saved[f"{name}-{k}"] for name in ARRAYS})
                for k, values in enumerate(described["runs"])
            ]
            return runs, Memory(saved["strain"], saved["accumulated"])
        except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile):
            return [], None


def _tuples(value: Any) -> Any:
    """JSON's lists as the tuples they were."""
    if isinstance(value, dict):
        return {name: _tuples(each) for name, each in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _run(described: dict[str, Any], arrays: dict[str, Floats]) -> Run:
    values = _tuples(described)
    nested = {"energies": Energies, "losses": Losses, "yielded": Yielded}
    made = {name: kind(**values[name]) for name, kind in nested.items() if values[name] is not None}
    contacts = tuple(ContactRecord(**contact) for contact in values["contacts"])
    return Run(**{**values, **made, "contacts": contacts, **arrays})


@dataclass(frozen=True)
class Struck:
    """A series of impacts on one mesh."""

    runs: list[Run]
    motion: AxisymmetricMotion
    """After the last one."""


def has_shaken_down(run: Run) -> bool:
    """Whether an impact leaves the next one nothing new; one that is cut leaves nothing at all."""
    work = sum(run.yielded.work) if run.yielded else 0.0
    return run.in_contact_at_end or work < SHAKEN_DOWN * run.initial_energy


def strike(
    series: Series | None,
    impact: Impact,
    stored: StoredRuns,
    accepted: Callable[[Run, AxisymmetricMotion], bool],
    count: int | None,
) -> Struck:
    """All impacts of a scene, up to the first that is not accepted.

    Args:
        series: None: a single one.
        impact: makes one.
        stored: those an earlier start has finished, and where finished ones go.
        accepted: whether the mesh is good enough for an impact.
        count: of the impacts; None: until nothing yields any more.
    """
    runs, memory = stored.load()
    most = count or (series.impacts if series else 1)
    while True:
        run, motion = impact(len(runs), memory)
        runs.append(replace(run, dents=motion.dents.profiles()) if motion.dents else run)
        done = len(runs) >= most or (count is None and has_shaken_down(run))
        if done or motion.dents is None or series is None or not accepted(run, motion):
            return Struck(runs, motion)
        memory = motion.dents.memory(series.sphere_spot == "fresh")
        stored.save(runs, memory)
