"""Whether records of instruments are read and judged rightly: records whose truth is known.

Histories of stored references are seen by a synthetic instrument: filtered, sampled, with noise,
offset and drift, as numbers of some bits. The files are written in the forms of instruments and
programs, with flaws of three sizes, and clean. The program compares each with its scene. Writes the
table, and fails if a target is missed:

    python3 benches/records.py PROGRAM --out reports/records.md

Needs numpy, scipy and the libraries of the formats (`pip install "impactcheck[records]"`).
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from typing import Any

from record_flaws import FLAWS, SIZES, Case
from record_forms import forms
from record_signals import History, Instrument, Record, clean, history_of, record

ROOT = Path(__file__).resolve().parent.parent
SOLUTIONS = ROOT / "fem_reference" / "solutions"
SCENES = ("scaled-plate-r10", "scaled-plate-r6.35")
PLATES = {"plate-2.1mm": "2.1 mm", "plate-3mm": "3 mm"}
"""Other scenes, by the thickness of their plate."""
COVERAGE = (0.92, 0.98)
"""Part of the stated 95 % intervals that hold the truth."""
FOUND = 0.95
"""Least part of the flaws that are found, removed or harmless."""
ALARMS = 0.02
"""Clean records with a finding have to be fewer than this part."""
SHIFT = 0.05
"""Error of the time of the first contact that matters, over the period of the bandwidth."""
BATCH = 25
"""Most records of one run of the program."""
PATIENCE = 3600.0
"""Seconds for that."""
REMOVED = {"padding", "second_strike", "end_stop", "hum"}
"""Findings after which the results are right, as the program says."""
SEEDS = 6
"""Records of each flaw and size."""


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


def share(values: Iterable[bool]) -> float:
    """Part that is true; not a number of none."""
    known = list(values)
    return sum(known) / len(known) if known else float("nan")


def percent(value: float) -> str:
    """A part in per cent."""
    return "-" if value != value else f"{100 * value:.1f} %"


def is_alarm(found: Reading) -> bool:
    """Whether a clean record has a finding that is not true; those with a drift may say so."""
    true = {"drift"} if found.record.instrument.drift > 0.0 else set()
    return bool(found.refusal) or bool(found.kinds - true)


@dataclass(frozen=True)
class Found:
    """All readings."""

    forms: dict[str, Reading]
    clean: list[Reading]
    flawed: list[tuple[Case, Reading]]

    @property
    def removed(self) -> list[tuple[Case, Reading]]:
        """Records whose flaws the program claims to have removed."""
        return [(case, one) for case, one in self.flawed if one.is_removed]

    def targets(self) -> Iterator[tuple[str, str, str, bool]]:
        """What, value, target, whether it is met."""
        if self.forms:
            right = share(one.is_right for one in self.forms.values())
            yield "forms read, results right", percent(right), "100 %", right == 1.0
        low, high = COVERAGE
        removed = [one for _, one in self.removed]
        for what, readings in (("clean", self.clean), ("flaws removed", removed)):
            if readings:
                held = share(one.within for one in readings)
                text = f"{percent(held)} of {len(readings)}"
                target = f"{100 * low:.0f} to {100 * high:.0f} %"
                yield f"95 % intervals that hold, {what}", text, target, low <= held <= high
        if self.flawed:
            known = share(is_found(case, one) for case, one in self.flawed)
            text = f"{percent(known)} of {len(self.flawed)}"
            yield "flaws found, removed or harmless", text, f"{100 * FOUND:.0f} %", known >= FOUND
        if self.clean:
            alarms = share(is_alarm(one) for one in self.clean)
            text = f"{percent(alarms)} of {len(self.clean)}"
            yield "false alarms", text, f"below {100 * ALARMS:.0f} %", alarms < ALARMS


def lines_of(rows: Iterable[Iterable[object]], *head: str) -> list[str]:
    """A table of Markdown."""
    lines = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    return [*lines, *(f"| {' | '.join(map(str, row))} |" for row in rows), ""]


def form_rows(found: dict[str, Reading]) -> Iterator[list[str]]:
    """One row a form."""
    for name, one in found.items():
        if one.refusal:
            yield [name, f"no: {one.refusal}", "-", "-", "-"]
            continue
        velocity = one.inner_final - one.record.inner_final
        numbers = [f"{100 * one.off:+.4f} (±{100 * one.band:.3f})", f"{1e3 * velocity:+.4f}"]
        yield [name, "yes", *numbers, f"{1e9 * one.shift_off:+.0f}"]


def groups_of(found: Reading) -> Iterator[str]:
    """What a clean record is one of."""
    how = found.record.instrument
    yield found.record.scene
    yield f"bandwidth {how.bandwidth / 1e3:.0f} kHz"
    yield {0: "white noise", 1: "noise of a single pole", 2: "noise of two poles"}.get(
        how.order, "noise of six poles at a fifth of the bandwidth"
    )
    names = "velocities" if how.signals[0].endswith("velocity") else "displacements"
    yield {1: "inner velocity alone", 4: "velocities and displacements"}.get(
        len(how.signals), names
    )
    yield f"{how.bits} bits"
    coarse = max(found.record.steps.values()) > 2.0
    yield f"step of the numbers {'above' if coarse else 'up to'} 2 standard deviations of noise"
    yield f"noise {1e3 * how.noise:g} mm/s"
    yield f"free flight before of {1e6 * how.before:.0f} µs"
    yield f"speed of the {'signal' if found.record.speed == 'measured' else 'scene'}"


def clean_rows(found: list[Reading]) -> Iterator[list[str]]:
    """Coverage and alarms of the groups of clean records."""
    members: dict[str, list[Reading]] = {"all": found}
    for one in found:
        for group in groups_of(one):
            members.setdefault(group, []).append(one)
    for group in ["all", *sorted(set(members) - {"all"})]:
        those = members[group]
        held, alarms = share(o.within for o in those), sum(is_alarm(o) for o in those)
        worst = max(abs(one.shift_off) * one.record.instrument.bandwidth for one in those)
        yield [group, str(len(those)), percent(held), str(alarms), f"{100 * worst:.1f} %"]


def flaw_rows(flawed: list[tuple[Case, Reading]]) -> Iterator[list[str]]:
    """One row a flaw and size."""
    for (flaw, size), group in groupby(flawed, lambda item: (item[0].flaw, item[0].size)):
        members = list(group)
        known = sum(is_found(case, one) for case, one in members)
        named: Counter[str] = Counter()
        for _, one in members:
            named.update(["refused"] if one.refusal else one.kinds or {"nothing"})
        kinds = ", ".join(f"{kind} {count}" for kind, count in sorted(named.items()))
        right = sum(one.is_right for _, one in members)
        offs = [abs(one.off) for _, one in members if not one.refusal]
        off = f"{100 * max(offs):.2f}" if offs else "-"
        yield [flaw, SIZES[size], f"{known} of {len(members)}", kinds, str(right), off]


def misses(found: Found) -> Iterator[str]:
    """The records that count against a target, with their names."""
    for name, one in found.forms.items():
        if not one.is_right:
            yield f"{name}: {one.in_words}"
    for one in found.clean:
        if not one.within or is_alarm(one):
            yield f"{one.record.name} ({', '.join(groups_of(one))}): {one.in_words}"
    removed = {case.name for case, one in found.removed if not one.within}
    for case, one in found.flawed:
        if case.name in removed or not is_found(case, one):
            yield f"{case.name}: {one.in_words}"


def report(found: Found) -> str:
    """Markdown."""
    words = {True: "yes", False: "**no**"}
    lines = [
        "# Records with a known truth",
        "",
        "Made by `benches/records.py`: histories of the stored references, seen by a synthetic",
        "instrument (bandwidth 100 kHz, 2 MHz, 12 bits, noise 2 mm/s where nothing else stands).",
        "A result is right if the stated 95 % interval holds the true efficiency, and the time of",
        f"the first contact is off by at most {100 * SHIFT:.0f} % of the bandwidth's period.",
        "`--only NAME --keep FOLDER` makes a record again and keeps its file.",
        "",
    ]
    targets = ([what, value, target, words[met]] for what, value, target, met in found.targets())
    lines += lines_of(targets, "what", "value", "target", "met")
    if found.forms:
        lines += ["## Forms", "", "One record in all forms.", ""]
        of_form = ("form", "read", "efficiency off by, points", "inner final velocity, mm/s")
        lines += lines_of(form_rows(found.forms), *of_form, "first contact, ns")
    if found.clean:
        lines += ["## Clean records", "", "Noise, offset and drift alone; all else is drawn.", ""]
        of_group = ("group", "records", "interval holds", "false alarms")
        lines += lines_of(
            clean_rows(found.clean), *of_group, "first contact off, of a period, at most"
        )
    if found.flawed:
        lines += ["## Flaws", "", f"{SEEDS} records of each size.", ""]
        of_flaw = ("flaw", "size", "found, removed or harmless", "findings", "results right")
        lines += lines_of(flaw_rows(found.flawed), *of_flaw, "efficiency off by at most, points")
    missed = [f"- {line}" for line in misses(found)]
    lines += ["## Against the targets", "", *(missed or ["none"])]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Makes, reads, writes the table, and fails if a target is missed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", type=lambda path: Path(path).resolve())
    parser.add_argument("--out", type=Path, required=True, help="Markdown")
    parser.add_argument("--draws", type=int, default=120, help="clean records")
    parser.add_argument("--only", default="*", help="names: forms, clean-*, gap-1-*, ...")
    parser.add_argument("--keep", type=Path, help="folder for the files")
    arguments = parser.parse_args()
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        program = Program(arguments.program, folder)
        histories = {
            name: history_of(name, SOLUTIONS / name / "paper" / "history.csv") for name in SCENES
        }
        histories |= {name: program.history(name, size) for name, size in PLATES.items()}
        sizes = range(len(SIZES))
        cases = [
            Case(flaw, size, seed, histories)
            for flaw in FLAWS
            for size in sizes
            for seed in range(SEEDS)
        ]
        cases = [case for case in cases if fnmatch.fnmatch(case.name, arguments.only)]
        seeds = range(arguments.draws)
        seeds_wanted = [k for k in seeds if fnmatch.fnmatch(f"clean-{k:03}", arguments.only)]
        with_forms = fnmatch.fnmatch("forms", arguments.only)
        found = Found(
            read_forms(program, histories) if with_forms else {},
            read_clean(program, [clean(seed, histories) for seed in seeds_wanted]),
            read_flawed(program, cases),
        )
    arguments.out.write_text(report(found), encoding="utf-8")
    missed = [
        f"{what}: {value}, target {target}"
        for what, value, target, met in found.targets()
        if not met
    ]
    print(f"{time.monotonic() - start:.0f} s", *missed, sep="\n")
    sys.exit(bool(missed))


if __name__ == "__main__":
    main()
