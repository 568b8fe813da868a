"""The times of channels, from what stands beside them: a channel of times, a sampling interval."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from .channel import Channel

SCALES = {
    **{"s": 1.0, "sec": 1.0, "second": 1.0, "seconds": 1.0},
    **{"ms": 1e-3, "us": 1e-6, "\u00b5s": 1e-6, "\u03bcs": 1e-6, "ns": 1e-9},
    **{"hz": 1.0, "khz": 1e3, "mhz": 1e6, "ghz": 1e9},
}
"""Units of times in s, of rates in Hz; in lower case (nobody samples at millihertz)."""
TIMES = {
    *("t", "time", "times", "timestamp", "timestamps", "seconds"),
    *("zeit", "temps", "tiempo", "tempo", "xaxis", "xvalue"),
}
RATES = {
    *("fs", "samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "samplefreq"),
}
INTERVALS = {
    *("dt", "ts", "deltat", "xdelta", "xinc", "xincr", "xincrement", "tinterval", "timestep"),
    *("sampleinterval", "samplinginterval", "sampletime", "sampleperiod", "samplingperiod"),
}
STARTS = {"t0", "tstart", "xstart", "xorg", "xorigin"}
"""Names in lower case, without what is no letter or digit."""

Numbers = Mapping[tuple[str, ...], Mapping[str, float]]
"""Single numbers by their names, of every group; a channel of HDF5 can have some of its own."""


def plain(name: str) -> str:
    """A name in lower case, without its unit in brackets and what is no letter or digit."""
    heading = name.replace("[", "(").partition("(")[0]
    return "".join(character for character in heading.lower() if character.isalnum())


def in_si(unit: str | None) -> float | None:
    """Size in s, or in Hz, of a unit of times or rates; without one 1, None of another unit."""
    return SCALES.get(unit.strip().lower()) if unit else 1.0


def says_when(name: str) -> bool:
    """Whether a single number of this name belongs to a clock."""
    return plain(name) in RATES | INTERVALS | STARTS


def timed(channels: list[Channel], numbers: Numbers) -> list[Channel]:
    """Channels with the clocks that their groups, or those around them, have.

    A channel of times counts where it has as many samples; else a sampling rate or interval, if
    there is one only. Channels that have a clock keep it.
    """
    clocks = [(place, channel) for place, channel in enumerate(channels) if is_clock(channel)]
    made = []
    for channel in channels:
        if not (is_clock(channel) or channel.time is not None or channel.interval is not None):
            time = _time_of(channel, clocks)
            start, interval = (None, None) if time is not None else _even(channel, numbers)
            channel = replace(channel, time=time, start=start, interval=interval)
        made.append(channel)
    return made


def is_clock(channel: Channel) -> bool:
    """Whether a channel has times, by its name or by what it holds."""
    return channel.dated or plain(channel.label) in TIMES


def _time_of(channel: Channel, clocks: list[tuple[int, Channel]]) -> int | None:
    """Place of the one channel of times in the nearest group that has any of this length."""
    for depth in range(len(channel.group), -1, -1):
        group = channel.group[:depth]
        found = [k for k, clock in clocks if (clock.group, clock.rows) == (group, channel.rows)]
        if found:
            return found[0] if len(found) == 1 else None
    return None


def _even(channel: Channel, numbers: Numbers) -> tuple[float | None, float | None]:
    """Start and interval in s, of the nearest group that has a rate or an interval."""
    own = (*channel.group, channel.label)
    for depth in range(len(own), -1, -1):
        here = {plain(name): value for name, value in numbers.get(own[:depth], {}).items()}
        found = [value for name, value in here.items() if name in INTERVALS]
        found += [1.0 / value for name, value in here.items() if name in RATES and value]
        if found:
            starts = {value for name, value in here.items() if name in STARTS}
            start = starts.pop() if len(starts) == 1 else 0.0
            sound = math.isfinite(start) and all(0.0 < value < math.inf for value in found)
            one = max(found) - min(found) <= 1e-6 * max(found)
            return (start, found[0]) if sound and one else (None, None)
    return None, None
