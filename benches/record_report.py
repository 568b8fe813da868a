"""The table of the bench of records, and its targets."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

from record_flaws import SIZES, Case
from record_readings import SHIFT, Reading, is_alarm, is_found

COVERAGE = (0.92, 0.98)
"""Part of the stated 95 % intervals that hold the truth."""
FOUND = 0.95
"""Least part of the flaws that are found, removed or harmless."""
ALARMS = 0.02
"""Clean records with a finding have to be fewer than this part."""
SEEDS = 6
"""Records of each flaw and size."""


def share(values: Iterable[bool]) -> float:
    """Part that is true; not a number of none."""
    known = list(values)
    return sum(known) / len(known) if known else float("nan")


def percent(value: float) -> str:
    """A part in per cent."""
    return "-" if value != value else f"{100 * value:.1f} %"


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
