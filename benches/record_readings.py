"""What the program reads of records whose truth is known, and whether it is right."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from typing import Any

from record_flaws import FLAWS, Case
from record_forms import forms
from record_signals import History, Instrument, Record, history_of, record

ROOT = Path(__file__).resolve().parent.parent
SCENES = ("scaled-plate-r10", "scaled-plate-r6.35")
SHIFT = 0.05
"""Error of the time of the first contact that matters, over the period of the bandwidth."""
BATCH = 25
"""Most records of one run of the program."""
PATIENCE = 3600.0
"""Seconds for that."""
REMOVED = {"padding", "second_strike", "end_stop", "hum"}
"""Findings after which the results are right, as the program says."""


@dataclass
class Reading:
    """What the program makes of a record."""

    record: Record
    refusal: str = ""
    efficiency: float = float("nan")
    band: float = float("nan")
    """Half width of the 95 % interval."""
    inner_final: float = float("nan")
    """m/s."""
    shift: float = float("nan")
    """s."""
    findings: list[tuple[str, str]] = field(default_factory=list)
    """Kinds and effects."""

    @property
    def off(self) -> float:
        """Error of the efficiency."""
        return self.efficiency - self.record.efficiency

    @property
    def shift_off(self) -> float:
        """Error of the time of the first contact, s."""
        return self.shift - self.record.shift

    @property
    def within(self) -> bool:
        """Whether the stated interval holds the true efficiency."""
        return not self.refusal and abs(self.off) <= self.band

    @property
    def is_right(self) -> bool:
        """Whether the time of the first contact is right, too."""
        return self.within and abs(self.shift_off) <= SHIFT / self.record.instrument.bandwidth

    @property
    def kinds(self) -> set[str]:
        """Of the findings."""
        return {kind for kind, _ in self.findings}

    @property
    def is_removed(self) -> bool:
        """Whether the program has found flaws and claims to have removed all of them.

        It claims so of a drift, provided that it is constant.
        """
        constant = self.record.name.startswith("offset-drift")

        def claimed(kind: str, effect: str) -> bool:
            return kind in REMOVED or (constant and kind == "drift" and "curved" not in effect)

        return bool(self.findings) and all(claimed(*finding) for finding in self.findings)

    @property
    def in_words(self) -> str:
        """Findings or refusal, and how far the results are off."""
        if self.refusal:
            return f"refused: {self.refusal}"
        found = ", ".join(sorted(self.kinds)) or "nothing found"
        return (
            f"{found}; efficiency off by {100 * self.off:+.3f} points (stated "
            f"±{100 * self.band:.3f}), first contact by {1e6 * self.shift_off:+.2f} µs"
        )


@dataclass(frozen=True)
class Program:
    """The program, and where its files are."""

    path: Path
    folder: Path

    def run(self, arguments: list[str]) -> subprocess.CompletedProcess[str]:
        """Run it in the folder of the records."""
        home = {"IMPACTCHECK_HOME": str(ROOT), "IMPACTCHECK_PYTHON": sys.executable}
        return subprocess.run(
            [str(self.path), *arguments],
            cwd=self.folder,
            env=home | dict(os.environ),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )

    def history(self, name: str, thickness: str) -> History:
        """Of model C in the first scene with a plate of another thickness."""
        text = (ROOT / "scenes" / f"{SCENES[0]}.toml").read_text(encoding="utf-8")
        scene, out = self.folder / f"{name}.toml", self.folder / f"{name}.csv"
        text = text.replace(SCENES[0], name).replace('"2 mm"', f'"{thickness}"')
        scene.write_text(text, encoding="utf-8")
        done = self.run(["reduced", scene.name, "--model", "C", "--history", out.name])
        if done.returncode != 0:
            sys.exit(done.stderr)
        return history_of(name, out)

    def read(self, files: list[tuple[Record, Path]], map_text: str = "") -> Iterator[Reading]:
        """Readings of records of one scene, bandwidth and source of the speed."""
        left = list(files)
        while left:
            first = left[0][0]
            command = ["compare", first.scene, "--models", "A", "--json", "--out", "report"]
            command += ["--bandwidth", f"{first.instrument.bandwidth:.0f} Hz"]
            command += ["--speed", first.speed]
            command += ["--measured", ",".join(path.name for _, path in left)]
            if map_text:
                (self.folder / "map.toml").write_text(map_text, encoding="utf-8")
                command += ["--map", "map.toml"]
            done = self.run(command)
            if done.returncode == 0 or done.stdout.startswith("{"):
                measured = json.loads(done.stdout)["scenes"][0]["measured"]["records"]
                for (record, _), found in zip(left, measured, strict=True):
                    yield reading(record, found)
                return
            said = sentence(done.stderr)
            refused = [item for item in left if item[1].name in said] or left[:1]
            yield Reading(refused[0][0], refusal=said.removeprefix(f"{refused[0][1].name}: "))
            left.remove(refused[0])


def sentence(said: str) -> str:
    """What an error says, without the frame and the lines of help around it."""
    lines = said[said.rfind("\N{MULTIPLICATION SIGN}") + 1 :].partition("  help: ")[0].splitlines()
    return " ".join(line.strip(" │") for line in lines).strip().replace("|", "/")


def reading(record: Record, found: dict[str, Any]) -> Reading:
    """From the program's JSON."""

    def number(name: str) -> float:
        value = found.get(name)
        return float("nan") if value is None else float(value)

    return Reading(
        record,
        "",
        number("efficiency"),
        number("efficiency_uncertainty"),
        number("inner_velocity_final"),
        number("shift"),
        [(finding["kind"], finding["effect"]) for finding in found["findings"]],
    )


def csv_of(folder: Path, record: Record) -> Path:
    """Write a record as a plain table; what is not a number is an empty cell."""
    file = folder / f"{record.name}.csv"
    names = list(record.values)
    lines = [",".join(["time", *names])]
    for row in zip(record.time, *record.values.values(), strict=True):
        lines.append(",".join("" if value != value else f"{value:.9g}" for value in row))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def batches(records: Iterable[Record]) -> Iterator[list[Record]]:
    """Records that one run of the program can take."""

    def how(record: Record) -> tuple[str, float, str]:
        return record.scene, record.instrument.bandwidth, record.speed

    for _, group in groupby(sorted(records, key=how), how):
        members = list(group)
        for start in range(0, len(members), BATCH):
            yield members[start : start + BATCH]


def read_forms(program: Program, histories: dict[str, History]) -> dict[str, Reading]:
    """One record in all forms."""
    instrument = Instrument(
        bits=14, noise=0.5e-3, before=100e-6, after=100e-6, zero=1.25e-3, offset=0.02, drift=1.0
    )
    made = record("form", 1, histories[SCENES[0]], instrument)
    found = {}
    for k, (name, form) in enumerate(forms(made).items()):
        file = program.folder / f"form{k}.{form.suffix}"
        form.write(file, made)
        found[name] = next(iter(program.read([(made, file)], form.map)))
        print(name, found[name].in_words, flush=True)
    return found


def read_clean(program: Program, records: list[Record]) -> list[Reading]:
    """Clean records."""
    found = []
    for batch in batches(records):
        for one in program.read([(made, csv_of(program.folder, made)) for made in batch]):
            print(one.record.name, one.in_words, flush=True)
            found.append(one)
    return sorted(found, key=lambda one: one.record.name)


def read_flawed(program: Program, cases: list[Case]) -> list[tuple[Case, Reading]]:
    """Records with flaws, those of one flaw together."""
    found = []
    for flaw, group in groupby(cases, lambda case: case.flaw):
        of_name = {case.name: case for case in group}
        made = [one for case in of_name.values() for one in FLAWS[flaw][0](case)]
        readings = program.read([(one, csv_of(program.folder, one)) for one in made])
        by_name = {one.record.name: one for one in readings}
        for name, case in of_name.items():
            print(name, by_name[name].in_words, flush=True)
            found.append((case, by_name[name]))
    return found


def is_found(case: Case, found: Reading) -> bool:
    """Whether the user knows of the flaw, or need not know."""
    named = bool(found.refusal) or bool(found.kinds & FLAWS[case.flaw][1])
    return named or (case.flaw != "twice" and found.is_right)


def is_alarm(found: Reading) -> bool:
    """Whether a clean record has a finding that is not true; those with a drift may say so."""
    true = {"drift"} if found.record.instrument.drift > 0.0 else set()
    return bool(found.refusal) or bool(found.kinds - true)
