"""Records of a synthetic instrument, whose truth is known: what `records.py` has read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.signal import butter, lfilter, sosfilt, sosfiltfilt

Floats = NDArray[np.float64]
BODIES = ("outer", "inner")
VELOCITIES = ("outer_velocity", "inner_velocity")
DISPLACEMENTS = ("outer_displacement", "inner_displacement")
FINE = 40.0
"""Samples per period of the bandwidth before the instrument samples."""
MARGIN = 12.0
"""Periods of the bandwidth that the filter gets to settle."""
FALL = 20e-3
"""Time that the outer body has moved before the impact, s: an AC-coupled sensor knows it."""
PATH = 2.5e-6
"""Noise of a displacement over that of a velocity, s."""
FULL_SCALE = 1.25
"""Range of the instrument over the largest value."""


@dataclass(frozen=True)
class History:
    """An impact: its first contact is at 0 s, the bodies fly freely before and after."""

    name: str
    time: Floats
    """s."""
    velocities: dict[str, Floats]
    """m/s, by body."""

    @property
    def end(self) -> float:
        """Last instant, s."""
        return float(self.time[-1])

    def final(self, body: str) -> float:
        """Velocity after the impact, m/s."""
        return float(self.velocities[body][-1])

    @property
    def speed(self) -> float:
        """Of the outer body before the impact, m/s."""
        return -float(self.velocities["outer"][0])


def history_of(name: str, file: Path) -> History:
    """The history in a file of this program."""
    table = np.genfromtxt(file, delimiter=",", names=True)
    return History(name, table["time"], {body: table[f"{body}_velocity"] for body in BODIES})


@dataclass(frozen=True)
class Event:
    """A change of a body's velocity besides the impact."""

    body: str
    time: float
    """s after the first contact."""
    change: float
    """m/s."""


@dataclass(frozen=True)
class Instrument:
    """How a record is made."""

    signals: tuple[str, ...] = VELOCITIES
    bandwidth: float = 100e3
    """Hz, -3 dB, without phase."""
    sampling: float = 2e6
    """Hz."""
    bits: int = 12
    noise: float = 2e-3
    """Standard deviation of a velocity, m/s."""
    order: int = 0
    """Of the filter (Butterworth) that limits the noise; 0: it is white."""
    corner: float = 100e3
    """-3 dB frequency of that filter, Hz."""
    before: float = 200e-6
    """Record before the first contact, s."""
    after: float = 300e-6
    """Record after the end of the history, s."""
    zero: float = 0.0
    """Time of the first contact on the record's clock, s."""
    offset: float = 0.0
    """Standard deviation of the offsets, m/s."""
    drift: float = 0.0
    """Standard deviation of the drifts, m/s^2."""


@dataclass
class Record:
    """Samples, and the truth of them."""

    name: str
    seed: int
    instrument: Instrument
    time: Floats
    """s, on the record's clock."""
    values: dict[str, Floats]
    """SI, by signal; not a number where they are missing."""
    efficiency: float
    inner_final: float
    """m/s."""
    offsets: dict[str, float] = field(default_factory=dict)
    """By velocity, m/s, at the first contact."""
    drifts: dict[str, float] = field(default_factory=dict)
    """m/s^2."""
    steps: dict[str, float] = field(default_factory=dict)
    """Between two numbers of a signal, over the standard deviation of its noise."""
    scene: str = "scaled-plate-r10"
    """Whose reference it is compared with."""
    speed: str = "scene"
    """Where the program is to take the outer body's speed from."""

    @property
    def shift(self) -> float:
        """Time of the first contact on the record's clock, s."""
        return self.instrument.zero


Velocity = Callable[[Floats], Floats]


@lru_cache(maxsize=64)
def _low_pass(bandwidth: float) -> Floats:
    """Sections of a filter that has -3 dB at `bandwidth` Hz when it runs forwards and backwards."""
    corner = bandwidth / (2.0**0.5 - 1.0) ** 0.25
    return np.asarray(butter(2, corner, fs=FINE * bandwidth, output="sos"), dtype=np.float64)


def _true_velocity(history: History, body: str, events: list[Event]) -> Velocity:
    """Velocity in m/s over the time in s from the first contact, at any time."""
    course = PchipInterpolator(history.time, history.velocities[body])

    def at(time: Floats) -> Floats:
        inside = np.clip(time, history.time[0], history.time[-1])
        jumps = [event.change * (time >= event.time) for event in events if event.body == body]
        return np.asarray(course(inside) + sum(jumps, np.zeros_like(time)), dtype=np.float64)

    return at


def _coupled(values: Floats, step: float, start: float, constant: float) -> Floats:
    """Values behind a high-pass of first order with this time constant, both in s."""
    keep = float(np.exp(-step / constant))
    first = values[0] * np.exp(-(FALL + start) / constant)
    changes = np.diff(values, prepend=values[0])
    passed = lfilter([0.5 * (1.0 + keep)], [1.0, -keep], changes, zi=[keep * first])[0]
    return np.asarray(passed, dtype=np.float64)


def shown(
    history: History,
    instrument: Instrument,
    events: list[Event],
    time: Floats,
    constant: float | None = None,
) -> dict[str, Floats]:
    """The signals without noise at `time`, s from the first contact.

    `constant` is the time constant of an AC-coupled sensor, s.
    """
    margin = MARGIN / instrument.bandwidth
    step = 1.0 / (FINE * instrument.bandwidth)
    fine = np.arange(time[0] - margin, time[-1] + margin, step)
    found = {}
    for body in BODIES:
        exact = _true_velocity(history, body, events)(fine)
        passed = sosfiltfilt(_low_pass(instrument.bandwidth), exact, padtype="constant")
        path = cumulative_trapezoid(passed, dx=step, initial=0.0) + exact[0] * fine[0]
        if constant is not None:
            passed = _coupled(passed, step, float(fine[0]), constant)
        found[f"{body}_velocity"] = np.asarray(CubicSpline(fine, passed)(time))
        found[f"{body}_displacement"] = np.asarray(CubicSpline(fine, path)(time))
    return {signal: found[signal] for signal in instrument.signals}


def noise(random: np.random.Generator, instrument: Instrument, count: int) -> Floats:
    """Noise with a standard deviation of 1 and the spectrum of the instrument."""
    if instrument.order == 0:
        return random.standard_normal(count)
    sections = butter(instrument.order, instrument.corner, fs=instrument.sampling, output="sos")
    settle = int(10 * instrument.sampling / instrument.corner)
    pulse = np.zeros(4 * settle)
    pulse[0] = 1.0
    power = float(np.sum(sosfilt(sections, pulse) ** 2))
    made = sosfilt(sections, random.standard_normal(count + settle))[settle:]
    return np.asarray(made / power**0.5, dtype=np.float64)


def least_step(values: Floats, bits: int) -> float:
    """Between two numbers of an instrument of so many bits, whose range fits the values."""
    return 2.0 * FULL_SCALE * float(np.max(np.abs(values))) / 2.0**bits


Change = Callable[[str, Floats, Floats], Floats]
"""What a flaw does to a signal: name, time in s from the first contact, values."""


def record(
    name: str,
    seed: int,
    history: History,
    instrument: Instrument,
    *,
    events: list[Event] | None = None,
    constant: float | None = None,
    before_noise: Change | None = None,
    after_noise: Change | None = None,
    scale: tuple[float, float] = (1.0, 1.0),
    quiet: float = 1.0,
    late: float = 0.0,
) -> Record:
    """A record of a history.

    Args:
        name: of the record.
        seed: of noise, offsets and drifts.
        history: what happens.
        instrument: what sees it.
        events: what else happens.
        constant: time constant of an AC-coupled sensor, s.
        before_noise: a flaw in front of the last stage of the instrument.
        after_noise: a flaw behind it, before the values become numbers.
        scale: of both bodies' velocities, and of the inner one's once more.
        quiet: part of the noise that arises in front of `before_noise`; the rest behind it.
        late: by which the inner signals are late, s.
    """
    random = np.random.default_rng(seed)
    steps = np.arange(
        int(np.ceil(-instrument.before * instrument.sampling)),
        int(np.floor((history.end + instrument.after) * instrument.sampling)),
    )
    # samples know nothing of the impact
    time: Floats = np.asarray((steps + random.uniform()) / instrument.sampling)
    values, offsets, drifts, steps_of = {}, {}, {}, {}
    truth = shown(history, instrument, events or [], time, constant)
    moved = shown(history, instrument, events or [], time - late, constant) if late else truth
    for signal in instrument.signals:
        inner = signal.startswith("inner")
        motion = (moved if inner else truth)[signal] * scale[0] * (scale[1] if inner else 1.0)
        offset = instrument.offset * random.standard_normal()
        drift = instrument.drift * random.standard_normal()
        deviation = size = instrument.noise * (PATH if signal in DISPLACEMENTS else 1.0)
        if signal in DISPLACEMENTS:
            offset, drift = offset * 1e-4, drift * 1e-4
        else:
            offsets[signal], drifts[signal] = offset, drift
        motion = motion + offset + drift * time
        if before_noise:
            front = quiet * size * noise(random, instrument, len(time))
            motion = before_noise(signal, time, motion + front)
            size *= (1.0 - quiet**2) ** 0.5
        motion = motion + size * noise(random, instrument, len(time))
        if after_noise:
            motion = after_noise(signal, time, motion)
        least = least_step(motion, instrument.bits)
        values[signal] = np.asarray(np.round(motion / least) * least)
        steps_of[signal] = least / deviation
    final = history.final("inner") * scale[1]
    return Record(
        name,
        seed,
        instrument,
        time + instrument.zero,
        values,
        (final / history.speed) ** 2,
        final * scale[0],
        offsets,
        drifts,
        steps_of,
    )


def clean(seed: int, histories: dict[str, History]) -> Record:
    """A record with noise, offset and drift alone; all else is drawn."""
    random = np.random.default_rng([seed, 1])
    scene = str(random.choice(["scaled-plate-r10"] * 3 + ["scaled-plate-r6.35"]))
    bandwidth = float(random.choice([100e3, 100e3, 100e3, 1e6]))
    sampling = float(random.choice([2e6, 5e6, 20e6] if bandwidth < 1e6 else [5e6, 10e6, 20e6]))
    order, corner = [(0, 1.0), (1, 1.0), (2, 1.0), (6, 0.2)][random.integers(4)]
    both = VELOCITIES + DISPLACEMENTS
    choices = [VELOCITIES] * 5 + [DISPLACEMENTS, both, VELOCITIES[1:], VELOCITIES[1:]]
    signals = choices[random.integers(len(choices))]
    longest = 300e-6 if sampling > 5e6 else 1e-3
    instrument = Instrument(
        signals=signals,
        bandwidth=bandwidth,
        sampling=sampling,
        bits=int(random.choice([8, 10, 12, 14])),
        noise=float(random.choice([0.5e-3, 2e-3, 8e-3])),
        order=order,
        corner=corner * bandwidth,
        before=min(float(random.choice([40e-6, 100e-6, 300e-6, 1e-3])), longest),
        after=min(float(random.choice([50e-6, 100e-6, 300e-6, 1e-3])), longest),
        zero=float(random.uniform(-5e-3, 5e-3)),
        offset=0.05,
        drift=float(random.choice([0.0, 0.0, 20.0])),
    )
    speed, scale = "scene", (1.0, float(random.uniform(0.97, 1.0)))
    if seed % 10 == 9 and signals == VELOCITIES:
        # trusted to have no offset
        instrument = replace(instrument, offset=0.0, drift=0.0)
        speed, scale = "measured", (float(random.uniform(0.95, 1.05)), scale[1])
    made = record(f"clean-{seed:03}", seed, histories[scene], instrument, scale=scale)
    made.scene, made.speed = scene, speed
    return made
