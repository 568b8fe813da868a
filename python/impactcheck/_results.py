"""Results: summaries, curves as arrays, verdicts."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    import xarray
    from numpy.typing import NDArray

SHOWN = ("efficiency", "outer_force_peak", "inner_force_peak", "sphere_angle", "sphere_force_peak")


@dataclass(frozen=True)
class Result:
    """A run of a model: its summary, the quantities of which are attributes too, and its curves.

    Attributes:
        summary: As `impactcheck reduced --json` prints it, SI.
        curves: Arrays by the curve's name, SI, shape (samples); `time` in s among them.
    """

    summary: dict[str, Any]
    curves: dict[str, NDArray[np.float64]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, summary: dict[str, Any], history: str) -> Result:
        """A result with the curves of a CSV text."""
        heading, *rows = history.splitlines()
        table = np.loadtxt(rows, delimiter=",", ndmin=2).T
        return cls(summary, dict(zip(heading.split(","), np.ascontiguousarray(table), strict=True)))

    def __getattr__(self, name: str) -> Any:
        """A quantity of the summary; None if the run has not determined it."""
        if name.startswith("_") or name not in self.summary:
            raise AttributeError(
                f"there is no quantity {name!r} (there: {', '.join(self.summary)})"
            )
        return self.summary[name]

    def to_xarray(self) -> xarray.Dataset:
        """The curves over time in s, with the summary's numbers and texts as attributes."""
        import xarray

        curves = {name: ("time", curve) for name, curve in self.curves.items() if name != "time"}
        plain = {k: v for k, v in self.summary.items() if isinstance(v, (int, float, str))}
        return xarray.Dataset(curves, coords={"time": self.curves["time"]}, attrs=plain)

    def _repr_html_(self) -> str:
        rows = [(name, self.summary[name]) for name in SHOWN if name in self.summary]
        return table_html((f"model {self.summary.get('model')}", "SI"), rows)


@dataclass(frozen=True)
class Comparison:
    """Models beside references, judged by the scenes' tolerances.

    Attributes:
        document: As `impactcheck compare --json` prints it.
        figures: A drawing of the curves per scene, SVG.
    """

    document: dict[str, Any]
    figures: dict[str, str] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, document: dict[str, Any], report: Path) -> Comparison:
        """A comparison with the drawings of its report."""
        names = [scene["scene"] for scene in document["scenes"]]
        drawings = {name: report / f"{name}.svg" for name in names}
        return cls(document, {n: f.read_text("utf-8") for n, f in drawings.items() if f.is_file()})

    @property
    def verdict(self) -> str:
        """The worst verdict: pass, fail, undecided or not_gated."""
        return str(self.document["verdict"])

    def model(self, name: str, scene: str | None = None) -> Result:
        """The result of a model, without curves; of the first scene unless one is named."""
        return Result(self._entry(name, scene)["summary"])

    def discrepancies(self, name: str, scene: str | None = None) -> list[dict[str, Any]]:
        """The rows of a model: quantity, reduced, reference, relative, tolerance, verdict, ..."""
        return list(self._entry(name, scene)["discrepancies"])

    def _entry(self, name: str, scene: str | None) -> dict[str, Any]:
        for entry in self.document["scenes"]:
            if scene in (None, entry["scene"]):
                for model in entry["models"]:
                    if model["model"] == name:
                        return dict(model)
        raise KeyError(f"no model {name!r} in {scene or 'any scene'}")

    def _repr_html_(self) -> str:
        parts = []
        for scene in self.document["scenes"]:
            sides = [("reference", scene["reference"], "")]
            sides += [(m["model"], m["summary"], m["verdict"]) for m in scene["models"]]
            shown = [name for name in SHOWN if name in scene["reference"]]
            rows = [(side, *(s[name] for name in shown), v) for side, s, v in sides]
            parts.append(table_html((scene["scene"], *shown, "verdict"), rows))
            parts.append(self.figures.get(scene["scene"], ""))
        return "".join(parts)


def table_html(heading: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    """A table; numbers have four digits."""

    def cell(value: object) -> str:
        return f"{value:.4g}" if isinstance(value, float) else escape(str(value))

    head = "".join(f"<th>{escape(name)}</th>" for name in heading)
    body = "".join("<tr>" + "".join(f"<td>{cell(v)}</td>" for v in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
