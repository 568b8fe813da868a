"""WAV, by SciPy."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from scipy.io import wavfile

from ..common.arrays import Floats
from .channel import Channel, require_size


@dataclass(frozen=True)
class _Head:
    """What a file's headers state."""

    channels: int
    rate: int
    """Hz."""
    rows: int


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The channels of a WAV file, evenly sampled; integers are parts of the full scale.

    Raises ValueError where the file is cut, too long or has no rate.
    """
    with path.open("rb") as stream:
        head = _head(stream)
    require_size("1", head.rows)
    read = lru_cache(maxsize=1)(partial(_matrix, path))
    yield [
        Channel(
            f"channel {k + 1}",
            head.rows,
            partial(_scaled, read, k),
            start=0.0,
            interval=1.0 / head.rate,
        )
        for k in range(head.channels if head.rows else 0)
    ]


def _head(stream: BinaryIO) -> _Head:
    """Number and rate of a file's samples.

    Raises:
        ValueError: a part is missing, or does not lie within the file.
    """
    size = os.fstat(stream.fileno()).st_size
    riff, _, wave = struct.unpack("<4sI4s", stream.read(12).ljust(12))
    if (riff, wave) != (b"RIFF", b"WAVE"):
        raise ValueError("its header is not that of RIFF and WAVE")
    form = None
    while len(begin := stream.read(8)) == 8:
        name, count = struct.unpack("<4sI", begin)
        end = stream.tell() + count
        if end > size:
            raise ValueError(
                f"it is cut: its part {name.decode('latin-1')!r} ends at byte {end}, the file "
                f"{size}"
            )
        if name == b"fmt " and count >= 16:
            form = struct.unpack("<HHIIHH", stream.read(16))
        elif name == b"data" and form:
            _, number, rate, _, step, _ = form
            if not (number and rate and step):
                raise ValueError(f"it states {number} channels at {rate} Hz of {step} bytes")
            return _Head(number, rate, count // step)
        # parts begin at even bytes
        stream.seek(end + count % 2)
    raise ValueError("it has no part 'data' after a part 'fmt '")


def _matrix(path: Path) -> Any:
    """All samples, as they are stored, one column per channel."""
    _, samples = wavfile.read(path)
    return samples.reshape(len(samples), -1)


def _scaled(read: Callable[[], Any], channel: int) -> Floats:
    """Samples of one channel; integers as parts of the full scale."""
    samples = read()[:, channel]
    kind = samples.dtype
    if kind.kind == "f":
        return samples.astype(np.float64)  # type: ignore[no-any-return]
    half = 2.0 ** (8 * kind.itemsize - 1)
    # 8 bits are without sign, with the zero in the middle
    return samples / half - (1.0 if kind.kind == "u" else 0.0)  # type: ignore[no-any-return]
