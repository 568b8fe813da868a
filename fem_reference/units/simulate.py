"""One simulation of a unit: its curves and last values under the names of the scene."""

from __future__ import annotations

import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu

from ..common.errors import SceneError, SolverError

EXCHANGE = "model-exchange"
INTERFACES = {"co-simulation": "CoSimulation", EXCHANGE: "ModelExchange"}
"""As the scene names them, as FMPy does."""
TOLERANCE = 1e-8
"""Relative, of the solver that integrates a unit's equations."""
MOST_SAMPLES = 100_000
"""Of a history; a longer simulation has wider intervals."""
SHOWN = 20
"""Most names of variables that a message lists."""


@dataclass(frozen=True)
class Variable:
    """What a variable of the unit is to the scene: ``factor`` times it plus ``offset``, SI."""

    name: str
    factor: float
    offset: float

    def in_si(self, values: Any) -> np.ndarray:
        """Its values as the scene has them."""
        return self.factor * np.asarray(values, dtype=float) + self.offset


def answer(question: dict[str, Any]) -> dict[str, Any]:
    """The answer to a question of the program.

    ``question["unit"]`` has the ``file``, the ``variables`` by curves and quantities, by name their
    SI ``units`` with the exponents of base units, which names are ``curves``, the ``start``
    values, and the ``interface``.
    """
    unit, scene = question["unit"], question["scene"]
    file = Path(unit["file"])
    try:
        described = read_model_description(str(file))
    except Exception as error:
        raise SceneError(f"{file} is no Functional Mock-up Unit: {error}") from error
    variables = {
        name: _variable(described, own, name, unit["units"].get(name))
        for name, own in unit["variables"].items()
    }
    end = scene["run"].get("end_time") or _default_end(described)
    interval = max(question["sample_interval"], end / MOST_SAMPLES)
    start = _start(described, unit["start"], scene)
    interface = unit.get("interface") or _interface(described)
    found = _simulate(file, interface, start, (end, interval), variables)
    time = np.asarray(found["time"], dtype=float)
    # at an event there are two samples, before and after it
    last = np.append(np.diff(time) > 0.0, True)
    document: dict[str, Any] = {"schema_version": question["schema_version"]}
    history = {"time": time[last].tolist()}
    for name, variable in variables.items():
        values = variable.in_si(found[variable.name])
        if name in unit["curves"]:
            if not np.isfinite(values).all():
                at = time[~np.isfinite(values)][0]
                raise SolverError(f"{file.name}: {variable.name!r} is not finite at {at:g} s")
            history[name] = values[last].tolist()
        else:
            document[name] = float(values[-1]) if math.isfinite(values[-1]) else None
    if len(history) > 1:
        document["history"] = history
    return document


def _simulate(
    file: Path,
    interface: str,
    start: dict[str, float | bool],
    times: tuple[float, float],
    variables: dict[str, Variable],
) -> Any:
    end, interval = times
    folder = extract(str(file))
    said: list[str] = []
    try:
        return simulate_fmu(
            folder,
            start_time=0.0,
            stop_time=end,
            output_interval=interval,
            fmi_type=INTERFACES[interface],
            relative_tolerance=TOLERANCE if interface == EXCHANGE else None,
            start_values=start,
            output=sorted({variable.name for variable in variables.values()}),
            logger=lambda *message: said.append(_text(message[-1])),
        )
    except Exception as error:
        reasons = " ".join([f"{error}.", *said[-3:]])
        raise SolverError(f"{file.name}: the simulation of the unit failed: {reasons}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _interface(described: Any) -> str:
    return EXCHANGE if described.coSimulation is None else "co-simulation"


def _text(message: Any) -> str:
    return message.decode(errors="replace") if isinstance(message, bytes) else str(message)


def _default_end(described: Any) -> float:
    experiment = described.defaultExperiment
    if experiment is None or experiment.stopTime is None:
        raise SceneError("the unit has no default experiment: state run.end_time in the scene")
    return float(experiment.stopTime)


def _known(described: Any, name: str, what: str) -> Any:
    """The unit's variable of this name."""
    for variable in described.modelVariables:
        if variable.name == name:
            return variable
    names = [variable.name for variable in described.modelVariables]
    listed = ", ".join(names[:SHOWN]) + (", ..." if len(names) > SHOWN else "")
    raise SceneError(f"{what}: the unit has no variable {name!r}; it has {listed}")


def _variable(
    described: Any, own: str, name: str, unit: tuple[str, dict[str, int]] | None
) -> Variable:
    """The unit's variable ``own`` as the curve or quantity ``name`` in the SI ``unit``."""
    key = f"external.variables.{name}"
    variable = _known(described, own, key)
    if unit is None:
        raise SceneError(f"{key}: the scene has no curve and no quantity {name!r}")
    named = variable.unit or getattr(variable.declaredType, "unit", None)
    if named is None:
        return Variable(own, 1.0, 0.0)
    base = next((u.baseUnit for u in described.unitDefinitions if u.name == named), None)
    if base is None:
        raise SceneError(f"{key}: the unit does not define {named!r}, in which {own!r} is")
    symbol, needed = unit
    exponents = {k: getattr(base, k) for k in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")}
    if {k: e for k, e in exponents.items() if e} != needed:
        raise SceneError(f"{key}: {own!r} is in {named}, but {name} is in {symbol}")
    return Variable(own, float(base.factor or 1.0), float(base.offset or 0.0))


def _start(
    described: Any, stated: dict[str, Any], scene: dict[str, Any]
) -> dict[str, float | bool]:
    """Start values; a text is the path of a number of the scene."""
    values: dict[str, float | bool] = {}
    for name, value in stated.items():
        _known(described, name, f"external.start.{name}")
        values[name] = _number(scene, value, name) if isinstance(value, str) else value
    return values


def _number(scene: dict[str, Any], path: str, name: str) -> float:
    node: Any = scene
    for key in path.split("."):
        node = node.get(key) if isinstance(node, dict) else None
    if isinstance(node, bool) or not isinstance(node, int | float):
        raise SceneError(f"external.start.{name}: the scene has no number at {path!r}")
    return float(node)
