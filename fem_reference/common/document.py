"""What the summary and the provenance of all solid solutions have in common."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, Protocol

import numpy as np

from ..explicit.contact import CHATTER_FRACTION, PEAK_WINDOW_FRACTION
from ..plate_impact.axisymmetric_result import SCHEMA_VERSION, convergence_part
from ..solid.loop import Loop
from .series import MeshResult, Run, estimates
from .settings import RESOLUTIONS


class Described(Protocol):
    """What a document says about a scene."""

    @property
    def name(self) -> str:
        """Of the scene."""

    @property
    def scene_hash(self) -> str:
        """Of the physics."""

    @property
    def settings_hash(self) -> str:
        """Of the reference's settings."""

    @property
    def raw(self) -> dict[str, Any]:
        """The scene as it was read."""


class Remembering(Protocol):
    """Loop and memory (bytes) of a solution."""

    @property
    def loop(self) -> Loop:
        """At the end."""

    @property
    def memory_used(self) -> float:
        """At most so far."""

    @property
    def memory_stated(self) -> float:
        """Before the run."""


class Verified(Run, Protocol):
    """What a document says about a run."""

    @property
    def momentum_residual(self) -> float:
        """Largest miss of the momentum balances, relative."""

    @property
    def contact_loss(self) -> float:
        """Energy lost to closing contacts, relative."""

    @property
    def support_impulse(self) -> float:
        """Along z, N s."""

    @property
    def in_contact_at_end(self) -> bool:
        """Whether the run ended during a contact."""

    @property
    def time_step(self) -> float:
        """S."""

    @property
    def critical_time_step(self) -> float:
        """S."""

    @property
    def sweeps_per_step(self) -> float:
        """Of the contact solver."""

    @property
    def unconverged(self) -> int:
        """Steps whose contact solver did not converge."""


def _residuals(run: Verified) -> dict[str, float]:
    return {
        "energy": run.energy_residual,
        "momentum": run.momentum_residual,
        "contact_energy_loss": run.contact_loss,
        "support_impulse": run.support_impulse,
    }


def machine(versions: dict[str, str | None], comm: Any, solution: Remembering) -> dict[str, Any]:
    """What a run needed of the machine: versions, processes, memory in bytes; its levels."""
    return {
        "nodes_per_level": list(solution.loop.levels),
        "versions": versions,
        "processes": comm.size,
        "peak_memory": solution.memory_used,
        "memory_stated": solution.memory_stated,
    }


def summary(
    scene: Described,
    resolution: str,
    run: Verified,
    meshes: list[MeshResult],
    solver: dict[str, Any],
    **special: Any,
) -> dict[str, Any]:
    """The summary of a solid solution.

    Args:
        scene: what was solved.
        resolution: a key of `RESOLUTIONS`.
        run: of the finest mesh.
        meshes: finest first.
        solver: versions, processes, memory.
        special: what only this kind of scene has.
    """
    found = estimates(meshes)
    values = {name: np.array([mesh.values[name] for mesh in meshes]) for name in found}
    return {
        "schema_version": SCHEMA_VERSION,
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "source": "reference",
        "model": None,
        "modes": None,
        "resolution": resolution,
        **meshes[0].values,
        "energy_residual": run.energy_residual,
        "momentum_residual": run.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": {name: estimate.band for name, estimate in found.items()},
        "convergence": convergence_part([mesh.numbers for mesh in meshes], values, found),
        "solver": {
            "time_step": run.time_step,
            "critical_time_step": run.critical_time_step,
            "courant": run.time_step / run.critical_time_step,
            "contact_sweeps_per_step": run.sweeps_per_step,
            "contact_unconverged_steps": run.unconverged,
            **solver,
        },
        "residuals": _residuals(run),
        **special,
    }


def provenance(
    scene: Described,
    resolution: str,
    run: Verified,
    duration: float,
    versions: dict[str, Any],
    settings: dict[str, Any],
    **special: Any,
) -> dict[str, Any]:
    """The provenance of a solid solution.

    Args:
        scene: what was solved.
        resolution: a key of `RESOLUTIONS`.
        run: of the finest mesh.
        duration: contact duration estimated beforehand, s.
        versions: of everything the result depends on.
        settings: those that only this kind of scene has.
        special: whatever else only this kind of scene has.
    """
    return {
        "schema_version": SCHEMA_VERSION,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "scene": scene.raw,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "settings": {
            "resolution": resolution,
            "resolution_factor": RESOLUTIONS[resolution],
            "courant": run.time_step / run.critical_time_step,
            "peak_window": PEAK_WINDOW_FRACTION * duration,
            "chatter_limit": CHATTER_FRACTION * duration,
            **settings,
        },
        "versions": versions,
        "residuals": _residuals(run),
        **special,
    }
