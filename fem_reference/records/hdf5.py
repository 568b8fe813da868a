"""HDF5, and MATLAB's files of version 7.3, which are HDF5, by h5py."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .channel import MOST_ROWS, Channel, is_numeric
from .clock import in_si, says_when, timed
from .matrix import columns_of

UNITS = ("unit", "units", "Unit", "Units")
"""Attributes that state a unit."""
MATLAB = "MATLAB_class"
"""Attribute of every variable of MATLAB."""


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The vectors and matrices of an HDF5 file; those of groups are ``group/name``.

    In a file of MATLAB groups are structures, ``structure.name``, and matrices are transposed.
    Data that lie in other files are left out. Raises ValueError where there is too much.
    """
    with path.open("rb") as stream:
        record = _Record(is_matlab=stream.read(6) == b"MATLAB")
    with h5py.File(path, "r") as file:
        record.clocks_in((), file)
        # follows no links to other files
        file.visititems(record.visit)
        yield timed(record.found, record.numbers)


class _Record:
    """Collects channels and what says when their samples are."""

    def __init__(self, is_matlab: bool) -> None:
        self.is_matlab = is_matlab
        self.found: list[Channel] = []
        self.numbers: defaultdict[tuple[str, ...], dict[str, float]] = defaultdict(dict)
        # columns of a matrix follow one another: it is read once
        self.read = lru_cache(maxsize=1)(lambda dataset: dataset[()])

    def visit(self, name: str, node: Any) -> None:
        """Take a group or a data set, at its path."""
        path = tuple(name.split("/"))
        if path[0].startswith("#"):
            return  # MATLAB's cells and objects
        self.clocks_in(path, node)
        if not isinstance(node, h5py.Dataset) or not is_numeric(node.dtype):
            return
        is_text = _text(node.attrs.get(MATLAB)) == "char" or "MATLAB_empty" in node.attrs
        if is_text or node.external or node.is_virtual or not node.size:
            return
        unit = next((_text(node.attrs[key]) for key in UNITS if key in node.attrs), None)
        if node.size == 1:
            self.number(path, node, unit)
            return
        _require_chunks(node)
        read = partial(self.read, node)
        shape, separator = node.shape, "/"
        if self.is_matlab:
            shape, separator = shape[::-1], "."
        columns = columns_of(path, separator, shape, lambda: self.oriented(read()), unit)
        self.found += columns

    def oriented(self, array: Any) -> Any:
        """An array as the program that wrote it has it."""
        return array.T if self.is_matlab else array

    def number(self, path: tuple[str, ...], node: Any, unit: str | None) -> None:
        """Take a single number, if it says when samples are and its unit is known."""
        scale = in_si(unit)
        if says_when(path[-1]) and scale is not None:
            self.numbers[path[:-1]][path[-1]] = scale * float(np.ravel(node[()])[0])

    def clocks_in(self, path: tuple[str, ...], node: Any) -> None:
        """Take what attributes say of the clock of a group or a data set."""
        for key in filter(says_when, node.attrs):
            value = np.asarray(node.attrs[key])
            if value.size == 1 and is_numeric(value.dtype):
                self.numbers[path][key] = float(value.item())


def _require_chunks(dataset: Any) -> None:
    """Refuse a data set whose chunks, each of which is decompressed as a whole, are too large.

    Raises:
        ValueError: a chunk has more than `MOST_ROWS` numbers.
    """
    size = math.prod(dataset.chunks or (1,))
    if size > MOST_ROWS:
        raise ValueError(
            f"data set {dataset.name!r} has chunks of {size} numbers; at most {MOST_ROWS} are read"
        )


def _text(value: Any) -> str | None:
    """The text of an attribute, None if it is no text."""
    array = np.ravel(value)
    first = array[0] if array.size == 1 else None
    if isinstance(first, bytes):
        first = first.decode(errors="replace")
    return first if isinstance(first, str) else None
