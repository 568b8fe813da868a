"""TDMS, of LabVIEW and DIAdem, by npTDMS."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from nptdms import TdmsFile

from .channel import Channel, is_dated, is_numeric, unit_in
from .clock import in_si, timed

LEAD_IN = 28
"""Bytes before a segment: tag, contents, version, size of the rest, size of its headers."""
BIG_ENDIAN = 1 << 6
"""Flag among the contents."""


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The channels of numbers of a TDMS file, called ``group/channel``.

    Raises ValueError where the file is cut.
    """
    _require_whole(path)
    # opened here, npTDMS reads no index file beside it, which could be another's
    with path.open("rb") as stream, TdmsFile.open(stream) as file:
        _require_samples(file)
        found = [channel for group in file.groups() for channel in group.channels()]
        read = [channel for channel in found if len(channel) and is_numeric(channel.dtype)]
        yield timed([_channel(channel) for channel in read], {})


def _require_whole(path: Path) -> None:
    """Refuse a file whose last segment is cut: npTDMS reads what is left of it.

    Raises:
        ValueError: the segment's size and the file's.
    """
    size, position = path.stat().st_size, 0
    with path.open("rb") as stream:
        while position < size:
            stream.seek(position)
            lead_in = stream.read(LEAD_IN)
            if len(lead_in) < LEAD_IN or not lead_in.startswith(b"TDSm"):
                raise ValueError(f"no segment begins at its byte {position}")
            order = ">" if struct.unpack_from("<L", lead_in, 4)[0] & BIG_ENDIAN else "<"
            (rest,) = struct.unpack_from(f"{order}Q", lead_in, 12)
            if position + LEAD_IN + rest > size:
                raise ValueError(
                    f"it is cut: the segment at byte {position} has {LEAD_IN + rest} bytes, the "
                    f"file {size}"
                )
            position += LEAD_IN + rest


def _require_samples(file: Any) -> None:
    """Refuse a file whose last segment has less samples than its headers state.

    Raises:
        ValueError: both numbers.
    """
    for name, status in (file.file_status.channel_statuses or {}).items():
        stated, found = status.expected_length, status.read_length
        if stated != found:
            raise ValueError(f"channel {name} has {found} samples, its header states {stated}")


def _channel(channel: Any) -> Channel:
    """A channel of npTDMS, with the clock of its waveform if it has one."""
    start, interval = _waveform(channel.properties)
    dated = is_dated(channel.dtype)
    stated = channel.properties.get("unit_string") or unit_in(channel.name)
    return Channel(
        f"{channel.group_name}/{channel.name}",
        len(channel),
        channel.read_data,
        "s" if dated else stated,
        start,
        interval,
        group=(channel.group_name,),
        label=channel.name,
        dated=dated,
    )


def _waveform(properties: Any) -> tuple[float | None, float | None]:
    """Start and interval in s, None where the properties do not state an interval of time."""
    second, interval = in_si(properties.get("wf_xunit_string")), properties.get("wf_increment")
    if second is None or not interval:
        return None, None
    return second * float(properties.get("wf_start_offset", 0.0)), second * float(interval)
