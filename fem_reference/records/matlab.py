"""MATLAB's files of version 5 to 7.2, by SciPy."""

from __future__ import annotations

import struct
import zlib
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from scipy.io import loadmat, whosmat

from .channel import MOST_VALUES, Channel, is_numeric
from .clock import timed
from .matrix import columns_of

HEADER = 128
"""Bytes before the variables; the last two state the order of bytes."""
ORDERS = {b"IM": "<", b"MI": ">"}
COMPRESSED = 15
"""Type of data of a compressed variable."""
MOST_BYTES = 8 * MOST_VALUES
"""Of all variables, decompressed."""
PIECE = 1 << 20
"""Bytes that are decompressed at once."""


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The vectors and matrices of a MATLAB file; those of structures are ``structure.name``.

    Raises ValueError where the file is cut or has too much.
    """
    _require_sound(path)
    wanted = []
    for name, shape, kind in whosmat(path, appendmat=False):
        if kind in ("single", "double", "logical", "struct") or "int" in kind:
            # refuses what is too large, before it is read
            columns_of((name,), ".", shape, dict)
            wanted.append(name)
    tree = loadmat(path, appendmat=False, variable_names=wanted, simplify_cells=True)
    found: list[Channel] = []
    numbers: defaultdict[tuple[str, ...], dict[str, float]] = defaultdict(dict)
    for path_of, array in _arrays((), {name: tree[name] for name in wanted}):
        if array.size == 1:
            numbers[path_of[:-1]][path_of[-1]] = float(array.item())
        else:
            found += columns_of(path_of, ".", array.shape, partial(np.asarray, array))
    yield timed(found, numbers)


def _require_sound(path: Path) -> None:
    """Refuse a file that is cut, or whose variables are too large once decompressed.

    Raises:
        ValueError: the sizes.
    """
    size, position, left = path.stat().st_size, HEADER, MOST_BYTES
    with path.open("rb") as stream:
        stream.seek(HEADER - 2)
        order = ORDERS.get(stream.read(2))
        if order is None:
            raise ValueError(f"its {HEADER} bytes of header are not whole")
        while position < size:
            stream.seek(position)
            tag = stream.read(8).ljust(8, b"\xff")
            kind, count = struct.unpack(f"{order}II", tag)
            position += 8 + count
            if position > size:
                raise ValueError(f"it is cut: a variable ends at byte {position}, the file {size}")
            left -= _decompressed(stream, count, left) if kind == COMPRESSED else count
            if left < 0:
                raise ValueError(
                    f"its variables have more than {MOST_BYTES} bytes; at most these are read"
                )


def _decompressed(stream: BinaryIO, count: int, most: int) -> int:
    """Bytes that the next ``count`` ones decompress to, or a number above ``most``."""
    engine, found = zlib.decompressobj(), 0
    while count and found <= most:
        piece = stream.read(min(count, PIECE))
        count -= len(piece)
        while piece and found <= most:
            found += len(engine.decompress(piece, PIECE))
            piece = engine.unconsumed_tail
    return found


def _arrays(path: tuple[str, ...], value: Any) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Arrays of real numbers, single ones too, in structures and arrays of structures."""
    if isinstance(value, dict):
        for name, each in value.items():
            yield from _arrays((*path, name), each)
    elif isinstance(value, list) or (isinstance(value, np.ndarray) and value.dtype == object):
        for k, each in enumerate(value):
            yield from _arrays((*path[:-1], f"{path[-1]}({k + 1})"), each)
    elif isinstance(value, int | float | np.number | np.ndarray):
        array = np.asarray(value)
        if is_numeric(array.dtype) and array.size:
            yield path, array
