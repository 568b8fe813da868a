"""Results: summaries, curves as arrays, verdicts."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

from impactcheck import _core

if TYPE_CHECKING:
    import numpy as np
    import xarray
    from numpy.typing import NDArray

SHOWN = ("efficiency", "outer_force_peak", "inner_force_peak", "sphere_angle", "sphere_force_peak")


@dataclass(frozen=True, repr=False)
class Result:
    """A run of a model or a reference: summary, whose entries are attributes too, and curves.

    Attributes:
        summary: As `impactcheck reduced --json` prints it (of a sweep without `prediction`), SI:
            velocities in m/s, forces in N, times in s, `first_frequency` in Hz, the efficiency as
            a share of 1.
        curves: Arrays by the curve's name, shape (samples): `time` in s, displacements in m,
            velocities in m/s, forces in N.
    """

    summary: dict[str, Any]
    curves: dict[str, NDArray[np.float64]] = field(default_factory=dict)

    @classmethod
    def of(cls, summary: str, curves: list[tuple[str, _core.Samples]]) -> Result:
        """What the program gives; the curves are not copied."""
        # the program itself, which imports this module too, starts without
        import numpy as np

        return cls(json.loads(summary), {name: np.asarray(samples) for name, samples in curves})

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

    @property
    def _who(self) -> str:
        model = self.summary["model"]
        return f"model {model}" if model else "reference"

    def __repr__(self) -> str:
        return f"<impactcheck.Result {self.summary['scene']}, {self._who}>"

    def _repr_html_(self) -> str:
        rows = [(name, self.summary[name]) for name in SHOWN if name in self.summary]
        parts = [table_html((self._who, "SI"), rows), warnings_html(self._who, self.summary)]
        if self.curves:
            curves = list(self.curves.items())
            title = f"{self.summary['scene']}: {self._who}"
            parts.append(_core.figure(title, self.curves["time"], curves))
        return "".join(parts)


@dataclass(frozen=True, repr=False)
class Comparison:
    """Models compared with references, judged by the scenes' tolerances.

    Attributes:
        document: As `impactcheck compare --json` prints it.
        figures: A drawing of the curves per scene, SVG.
    """

    document: dict[str, Any]
    figures: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, document: str, figures: list[str]) -> Comparison:
        """What the program gives."""
        read = json.loads(document)
        names = [scene["scene"] for scene in read["scenes"]]
        return cls(read, dict(zip(names, figures, strict=True)))

    def __repr__(self) -> str:
        return f"<impactcheck.Comparison {', '.join(self.figures)}: {self.verdict}>"

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

    def measured(self, scene: str | None = None) -> dict[str, Any] | None:
        """Measured records compared with the models; None without. Default: the first scene.

        `efficiency` has mean, standard deviation and values of the impacts, `partners` a row for
        the reference and every model: `efficiency_difference` from the mean, `curves` (metrics).
        """
        for entry in self.document["scenes"]:
            if scene in (None, entry["scene"]):
                measured: dict[str, Any] | None = entry.get("measured")
                return measured
        raise KeyError(f"no scene {scene!r}")

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
            parts += [warnings_html(side, summary) for side, summary, _ in sides]
            parts.append(self.figures[scene["scene"]])
        return "".join(parts)


@dataclass(frozen=True, repr=False)
class Optimum:
    """The best design found.

    Attributes:
        document: As `impactcheck optimise --json` prints it: `variables` with their neighbourhood,
            `history`, everything that was tried, `summary` of the best, `verification`.
        scene: The best design.
        figure: The objective along every variable, and on the way there, SVG.
    """

    document: dict[str, Any]
    scene: _core.Scene
    figure: str

    @classmethod
    def of(cls, document: str, figure: str, scene: str) -> Optimum:
        """What the program gives."""
        return cls(json.loads(document), _core.Scene(scene), figure)

    def __repr__(self) -> str:
        return f"<impactcheck.Optimum {self.document['scene']}: {self.values}>"

    @property
    def values(self) -> dict[str, float]:
        """The best value of every variable by its field, SI."""
        return {v["field"]: float(v["optimum"]) for v in self.document["variables"]}

    @property
    def objective(self) -> float:
        """What was maximised, at the best design, in its SI unit: the quantile if one was."""
        robust = self.document.get("robust")
        return float(robust["quantile"] if robust else self.document["objective_value"])

    @property
    def result(self) -> Result:
        """The result of the model there, without curves."""
        return Result(self.document["summary"])

    def _repr_html_(self) -> str:
        rows = [(v["field"], v["optimum"], v["unit"]) for v in self.document["variables"]]
        name = self.document["objective"]
        rows.append((name, self.objective, self.document["objective_unit"]))
        return table_html(("best", "value", "unit"), rows) + self.figure


def warnings_html(who: str, summary: dict[str, Any]) -> str:
    """What has to be known before the result is relied on."""
    return "".join(f"<p>{escape(f'{who}: {warning}')}</p>" for warning in summary["warnings"])


def table_html(heading: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    """A table; numbers have four digits."""

    def cell(value: object) -> str:
        return f"{value:.4g}" if isinstance(value, float) else escape(str(value))

    head = "".join(f"<th>{escape(name)}</th>" for name in heading)
    body = "".join("<tr>" + "".join(f"<td>{cell(v)}</td>" for v in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
