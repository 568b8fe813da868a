"""Units of the program in a simulation of FMPy."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from fmpy import fmi2, fmi3, read_model_description
from fmpy.fmi1 import FMICallException

from .program import ROOT

PROGRAM = ROOT / "target/release/impactcheck"
DISCARD, ERROR = 2, 3
"""Statuses of the standard."""


def program(*arguments: object) -> str:
    """What the program prints."""
    command = [str(PROGRAM), *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def plate_units(folder: Path) -> dict[str, Path]:
    """Units of the plate of Table 1, by version of the standard."""
    made = {}
    for version in ("2", "3"):
        made[version] = folder / f"plate-{version}.fmu"
        program("fmu", "scaled-plate-r10", "--fmi", version, "-o", made[version])
    return made


@dataclass
class Instance:
    """A unit in a simulation, its variables by name."""

    file: Path
    folder: Path
    log: list[tuple[int, str]] = field(default_factory=list)
    early: bool = False

    def __post_init__(self) -> None:
        self.described = read_model_description(str(self.file))
        self.references = {v.name: v.valueReference for v in self.described.modelVariables}
        self.types = {v.name: v.type for v in self.described.modelVariables}
        self.is_3 = self.described.fmiVersion.startswith("3")
        kind = fmi3.FMU3Slave if self.is_3 else fmi2.FMU2Slave
        self.fmu = kind(
            guid=self.described.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.described.coSimulation.modelIdentifier,
            instanceName="tested",
        )
        if self.is_3:
            self.fmu.instantiate(
                loggingOn=True, earlyReturnAllowed=self.early, logMessage=self.heard
            )
        else:
            self.fmu.instantiate(loggingOn=True)
        self.ready()

    def heard(self, _: object, status: int, _category: bytes, message: bytes) -> None:
        """A line of the log."""
        self.log.append((status, message.decode()))

    def ready(self) -> None:
        """To the first communication point."""
        if self.is_3:
            self.fmu.enterInitializationMode(startTime=0.0)
        else:
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def _call(self, verb: str, name: str) -> Callable[..., Any]:
        kind = self.types[name]
        if not self.is_3:
            kind = {"Float64": "Real", "Int32": "Integer"}.get(kind, kind)
        call: Callable[..., Any] = getattr(self.fmu, verb + kind)
        return call

    def set(self, name: str, value: float | bool) -> None:
        """Set a variable."""
        self._call("set", name)([self.references[name]], [value])

    def get(self, *names: str) -> list[float]:
        """Values of variables."""
        return [self._call("get", name)([self.references[name]])[0] for name in names]

    def step(self, start: float, length: float) -> Any:
        """One communication step."""
        return self.fmu.doStep(start, length)

    def close(self) -> None:
        """End the instance."""
        self.fmu.freeInstance()


def refused(status: int, call: Callable[[], object]) -> None:
    """The call ends with this status."""
    with pytest.raises(FMICallException) as raised:
        call()
    assert raised.value.status == status
