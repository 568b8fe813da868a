"""What CalculiX prints while it runs, read as it comes (its ``.dat`` file)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..common.arrays import Floats
from ..common.errors import SolverError

HEADINGS = (
    re.compile(r" (?P<what>displacements|velocities) \(.*\) for set (?P<of>\S+) and time +(\S+)"),
    re.compile(r" total (?P<what>internal|kinetic) energy for set (?P<of>\S+) and time +(\S+)"),
    re.compile(r" statistics for slave set (?P<of>\S+), master set \S+ and time +(\S+)"),
)


@dataclass
class Printed:
    """Values by time; every name has one row per increment.

    ``(displacements|velocities, SET)`` has the axial value of each node of the set, by node number;
    ``(internal|kinetic, SET)`` its energy; ``(force, SLAVE)`` the force (3,) on the slave.
    """

    path: Path
    times: list[float] = field(default_factory=list)
    rows: dict[tuple[str, str], list[list[float]]] = field(default_factory=dict)
    _read: int = 0

    def advance(self, to_the_end: bool = False) -> int:
        """Read what has come since; the number of increments that are complete.

        Raises:
            SolverError: a line is none that CalculiX writes, or a value is not a number.
        """
        if not self.path.exists():
            return 0
        with self.path.open(encoding="ascii", errors="replace") as stream:
            stream.seek(self._read)
            text = stream.read()
        blocks = [*re.finditer(r"^ (?:displ|veloc|total [ik]|statis).*$", text, re.MULTILINE)]
        starts = [block.start() for block in blocks]
        if to_the_end:
            starts.append(len(text))
        # Otherwise the last block may not be complete yet.
        for block, end in zip(blocks, starts[1:], strict=False):
            self._take(block.group(), text[block.end() : end])
        self._read += starts[-1] if starts else 0
        # An increment is whole when the next one has begun.
        whole = max(0, len(self.times) - 1)
        return min(map(len, self.rows.values()), default=0) if to_the_end else whole

    def _take(self, heading: str, body: str) -> None:
        found = next((match for form in HEADINGS if (match := form.match(heading))), None)
        if found is None:
            raise SolverError(f"CalculiX printed {heading.strip()!r}, which is not understood")
        what = found.groupdict().get("what", "force")
        time = float(found.groups()[-1])
        lines = [line.split() for line in body.splitlines() if line.strip()]
        try:
            if what == "force":
                values = [float(lines[1][k]) for k in range(3)]
            elif what in ("internal", "kinetic"):
                values = [float(lines[0][0])]
            else:
                values = [float(line[3]) for line in lines]
        except (IndexError, ValueError) as error:
            raise SolverError(f"CalculiX printed no values under {heading.strip()!r}") from error
        if not np.isfinite(values).all():
            raise SolverError(f"CalculiX diverged: {heading.strip()!r} is not a number")
        if not self.times or time > self.times[-1]:
            self.times.append(time)
        self.rows.setdefault((what, found["of"]), []).append(values)

    def curve(self, what: str, of: str, count: int | None = None) -> Floats:
        """(increments,) the first value over time, of the first ``count`` increments."""
        return self.table(what, of, count)[:, 0]

    def table(self, what: str, of: str, count: int | None = None) -> Floats:
        """(increments, values) of the first ``count`` increments."""
        return np.array(self.rows[what, of][:count])


def frequencies(path: Path) -> Floats:
    """Eigenfrequencies of a frequency step, Hz if time is in s.

    Raises:
        SolverError: there are none.
    """
    text = path.read_text(encoding="ascii", errors="replace") if path.exists() else ""
    _, _, table = text.partition("E I G E N V A L U E   O U T P U T")
    table = table.partition("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in table.splitlines()]
    found = [float(row[3]) for row in rows if len(row) == 5 and row[0].isdecimal()]
    if not found:
        raise SolverError("CalculiX printed no eigenfrequencies")
    return np.array(found)


def shapes(path: Path, sets: list[str]) -> Floats:
    """(modes, sets) axial displacements of single nodes in the modes of a frequency step.

    Raises:
        SolverError: one is missing.
    """
    text = path.read_text(encoding="ascii", errors="replace") if path.exists() else ""
    columns = []
    for name in sets:
        heading = rf"^ displacements \(.*\) for set {name} and time .*\n\s*\n(.*)$"
        rows = [row.split() for row in re.findall(heading, text, re.MULTILINE)]
        columns.append([float(row[3]) for row in rows if len(row) == 4])
    if not columns[0] or len({len(column) for column in columns}) != 1:
        raise SolverError("CalculiX printed no shapes of its modes")
    return np.array(columns).T
