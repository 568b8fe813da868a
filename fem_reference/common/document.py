"""What the summary and the provenance of all solutions have in common."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, Protocol

from .series import MeshResult, SampledRun, Target, estimates, relative_error
from .settings import CHATTER_FRACTION, PEAK_WINDOW_FRACTION, RESOLUTIONS
from .uncertainty import ORDER, Estimate

SCHEMA_VERSION = 1
OF_A_BODY = "first_frequency"
"""The quantity that is a body's own, whatever an impact on it comes to."""


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


class Verified(SampledRun, Protocol):
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
    def time_step(self) -> float:
        """S."""

    @property
    def critical_time_step(self) -> float | None:
        """S; None of steps that any length keeps stable."""


def _convergence(
    meshes: list[MeshResult], found: dict[str, Estimate], targeted: tuple[Target, ...]
) -> dict[str, Any]:
    """What the meshes (finest first) say together, per quantity that is determined."""
    determined = {target.name for target in targeted} <= set(found)
    return {
        "rule": "least squares after Eca & Hoekstra 2014, order fixed",
        "order": ORDER,
        "meshes": [mesh.numbers for mesh in meshes],
        "quantities": {
            name: {
                "values": [mesh.values[name] for mesh in meshes],
                "extrapolated": estimate.extrapolated,
                "scatter": estimate.scatter,
                "band": estimate.band,
            }
            for name, estimate in found.items()
        },
        "relative_error": relative_error(meshes, targeted) if determined else None,
    }


def _residuals(run: Verified) -> dict[str, float]:
    return {
        "energy": run.energy_residual,
        "momentum": run.momentum_residual,
        "contact_energy_loss": run.contact_loss,
        "support_impulse": run.support_impulse,
    }


def _courant(run: Verified) -> float | None:
    """Time step over the critical one."""
    return run.critical_time_step and run.time_step / run.critical_time_step


def summary(
    scene: Described,
    resolution: str,
    run: Verified,
    meshes: list[MeshResult],
    targeted: tuple[Target, ...],
    solver: dict[str, Any],
    undetermined: tuple[str, ...] = (),
    warnings: tuple[str, ...] = (),
    **special: Any,
) -> dict[str, Any]:
    """The summary of a solution.

    A run that ended during a contact has not determined what the impact comes to: those quantities
    are null, and ``at_end`` says what they had come to.

    Args:
        scene: what was solved.
        resolution: a key of `RESOLUTIONS`.
        run: of the finest mesh.
        meshes: finest first.
        targeted: quantities whose relative band counts.
        solver: versions; levels, processes, memory.
        undetermined: quantities that mean nothing in this scene.
        warnings: what a user has to know before relying on the result, a sentence each.
        special: what only this kind of scene has.
    """
    values, found = meshes[0].values, estimates(meshes)
    found = {name: estimate for name, estimate in found.items() if name not in undetermined}
    special = {**special, **({"warnings": list(warnings)} if warnings else {})}
    if run.in_contact_at_end:
        special["at_end"] = {
            name: {"value": value, "band": found[name].band}
            for name, value in values.items()
            if name in found
        }
        found = {OF_A_BODY: found[OF_A_BODY]}
    return {
        "schema_version": SCHEMA_VERSION,
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "settings_hash": scene.settings_hash,
        "source": "reference",
        "model": None,
        "modes": None,
        "resolution": resolution,
        **{name: value if name in found else None for name, value in values.items()},
        "energy_residual": run.energy_residual,
        "momentum_residual": run.momentum_residual,
        "steps": run.steps,
        "solve_seconds": run.loop_seconds,
        "in_contact_at_end": run.in_contact_at_end,
        "end_time": float(run.times[-1]),
        "uncertainty": {name: estimate.band for name, estimate in found.items()},
        "convergence": _convergence(meshes, found, targeted),
        "solver": {
            "time_step": run.time_step,
            "critical_time_step": run.critical_time_step,
            "courant": _courant(run),
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
    """The provenance of a solution.

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
            "courant": _courant(run),
            "peak_window": PEAK_WINDOW_FRACTION * duration,
            "chatter_limit": CHATTER_FRACTION * duration,
            **settings,
        },
        "versions": versions,
        "residuals": _residuals(run),
        **special,
    }
