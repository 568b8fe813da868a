"""Flaws of a record in three sizes, from just relevant to gross: what `records.py` has found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from record_signals import VELOCITIES, Event, Floats, History, Instrument, Record, record

SIZES = ("just relevant", "clear", "gross")
BASE = Instrument(offset=0.02, drift=1.0)
"""Its efficiency has a band of about 0.2 percentage points: 0.15 % of the velocity."""


@dataclass(frozen=True)
class Case:
    """A flaw at a size."""

    flaw: str
    size: int
    seed: int
    histories: dict[str, History]
    """By name: of the scene, and of others."""

    @property
    def name(self) -> str:
        """Of its record."""
        return f"{self.flaw}-{self.size + 1}-{self.seed}"

    @property
    def random(self) -> np.random.Generator:
        """For what is drawn besides the noise."""
        return np.random.default_rng([self.seed, self.size, sum(self.flaw.encode())])

    @property
    def instrument(self) -> Instrument:
        """White noise, or noise that a filter limits, in turn."""
        zero = float(self.random.uniform(-5e-3, 5e-3))
        return replace(BASE, zero=zero, order=(0, 1, 2)[self.seed % 3])

    @property
    def noise_seed(self) -> int:
        """Of the record: all have noise of their own."""
        return 1000 * sum(self.flaw.encode()) + 10 * self.seed + self.size

    @property
    def history(self) -> History:
        """Of the scene."""
        return self.histories["scaled-plate-r10"]


Made = list[Record]
"""The record; of a flaw that takes several, those before it first."""


def offset_and_drift(case: Case) -> Made:
    """Offset and constant drift far above those of a good sensor."""
    offset, drift = [(0.02, 5.0), (0.1, 50.0), (0.4, 500.0)][case.size]
    instrument = replace(case.instrument, offset=offset, drift=drift)
    return [record(case.name, case.noise_seed, case.history, instrument)]


def hum(case: Case) -> Made:
    """Mains at 50, 60 or 150 Hz in both signals; the records are long, medium and short."""
    amplitude = [2e-3, 10e-3, 100e-3][case.size]
    frequency, length = [(50.0, 12e-3), (60.0, 5e-3), (150.0, 1e-3)][case.seed % 3]
    instrument = replace(case.instrument, before=length, after=length, sampling=1e6)
    # mains keep their frequency within some tenths of a per cent
    turn = 2 * np.pi * frequency * float(case.random.uniform(0.998, 1.002))
    phase = float(case.random.uniform(0, 2 * np.pi))

    def with_hum(_: str, time: Floats, values: Floats) -> Floats:
        return np.asarray(values + amplitude * np.sin(turn * time + phase))

    made = record(case.name, case.noise_seed, case.history, instrument, after_noise=with_hum)
    return [made]


def limited(case: Case, *, noisy: bool) -> Made:
    """A limit below the inner body's final velocity, in turn below the outer one's first.

    Args:
        case: flaw, size and seed.
        noisy: whether noise of a later stage hides that all values are the same.
    """
    limit = [0.997, 0.95, 0.7][case.size]
    signal = VELOCITIES[0 if case.seed % 3 == 2 else 1]
    highest = limit * (
        case.history.speed if signal == VELOCITIES[0] else -case.history.final("inner")
    )

    def cut(name: str, _: Floats, values: Floats) -> Floats:
        return np.clip(values, -highest, highest) if name == signal else values

    instrument = replace(case.instrument, offset=0.0, drift=0.0)
    arguments = (case.name, case.noise_seed, case.history, instrument)
    if noisy:
        return [record(*arguments, before_noise=cut, quiet=0.98)]
    return [record(*arguments, after_noise=cut)]


def clipping(case: Case) -> Made:
    """The range of the converter is exceeded."""
    return limited(case, noisy=False)


def saturation(case: Case) -> Made:
    """An amplifier reaches its limit; a fifth of the noise arises behind it."""
    return limited(case, noisy=True)


def gap(case: Case) -> Made:
    """Samples are missing: not a number in contact or free flight, no rows in the contact."""
    length = [6e-6, 30e-6, 100e-6][case.size]
    start = [20e-6, 250e-6, 20e-6][case.seed % 3]
    made = record(case.name, case.noise_seed, case.history, case.instrument)
    time = made.time - made.shift
    missing = (time >= start) & (time < start + length)
    if case.seed % 3 == 2:
        made.time = made.time[~missing]
        made.values = {signal: values[~missing] for signal, values in made.values.items()}
    else:
        for values in made.values.values():
            values[missing] = np.nan
    return [made]


def padding(case: Case) -> Made:
    """Zeros at the end of all signals, at the beginning in turn."""
    count = [2, 20, 300][case.size]
    made = record(case.name, case.noise_seed, case.history, case.instrument)
    for values in made.values.values():
        values[slice(0, count) if case.seed % 3 == 2 else slice(-count, None)] = 0.0
    return [made]


def struck(case: Case, change: float) -> Made:
    """The inner body's velocity changes by a part of the final one while it flies freely."""
    time = float(case.random.uniform(200e-6, 350e-6))
    event = Event("inner", time, change * case.history.final("inner"))
    return [record(case.name, case.noise_seed, case.history, case.instrument, events=[event])]


def second_strike(case: Case) -> Made:
    """The plate hits the inner body again."""
    return struck(case, [0.007, 0.05, 0.5][case.size])


def end_stop(case: Case) -> Made:
    """The inner body rubs at a stop, or returns from it."""
    return struck(case, -[0.007, 0.2, 1.6][case.size])


def ac_coupling(case: Case) -> Made:
    """Sensors that do not pass constant values."""
    constant = [50e-3, 5e-3, 0.5e-3][case.size]
    made = record(case.name, case.noise_seed, case.history, case.instrument, constant=constant)
    return [made]


def delay(case: Case) -> Made:
    """The inner signal is late; the time of the first contact is the outer one's."""
    late = [2e-6, 10e-6, 60e-6][case.size]
    return [record(case.name, case.noise_seed, case.history, case.instrument, late=late)]


def wrong_sign(case: Case) -> Made:
    """Of the inner signal, the outer one, both."""
    made = record(case.name, case.noise_seed, case.history, case.instrument)
    for signal in [VELOCITIES[1:], VELOCITIES[:1], VELOCITIES][case.size]:
        made.values[signal] = -made.values[signal]
    return [made]


def other_scene(case: Case) -> Made:
    """A plate of 2.1 mm for 2 mm, one of 3 mm; smaller and slower spheres."""
    history = case.histories[["plate-2.1mm", "plate-3mm", "scaled-plate-r6.35"][case.size]]
    return [record(case.name, case.noise_seed, history, case.instrument)]


def twice(case: Case) -> Made:
    """The same file; a copy with another clock and fewer digits; every second sample of it."""
    made = record(case.name, case.noise_seed, case.history, case.instrument)
    first = replace(made, name=f"{case.name}-first")
    every = 2 if case.size == 2 else 1
    if case.size > 0:
        made.instrument = replace(made.instrument, zero=made.shift + 1e-3)
        made.time = np.round(made.time[::every] + 1e-3, 9)
        made.values = {name: np.round(values[::every], 5) for name, values in made.values.items()}
    return [first, made]


FLAWS: dict[str, tuple[Callable[[Case], Made], set[str]]] = {
    "offset-drift": (offset_and_drift, {"drift", "other_scene"}),
    "hum": (hum, {"hum", "drift"}),
    "clipping": (clipping, {"clipped"}),
    "saturation": (saturation, {"clipped"}),
    "gap": (gap, {"gap"}),
    "padding": (padding, {"padding"}),
    "second-strike": (second_strike, {"second_strike"}),
    "end-stop": (end_stop, {"end_stop"}),
    "ac-coupling": (ac_coupling, {"ac_coupled", "drift"}),
    "delay": (delay, {"delay"}),
    "wrong-sign": (wrong_sign, {"other_scene"}),
    "other-scene": (other_scene, {"other_scene"}),
    "twice": (twice, {"duplicate"}),
}
"""How each is made, and the kinds of findings that name it."""
