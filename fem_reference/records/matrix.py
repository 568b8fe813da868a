"""Vectors and matrices of a record as channels."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from .channel import MOST_VALUES, Channel, require_size, unit_in


def columns_of(
    path: tuple[str, ...],
    separator: str,
    shape: tuple[int, ...],
    read: Callable[[], Any],
    unit: str | None = None,
) -> list[Channel]:
    """Channels of an array: samples run along its longer side, along rows of a square.

    A vector is one channel, of the array's name; a matrix has ``name(1)``, ``name(2)``, ...

    Args:
        path: groups and name of the array.
        separator: between them in the names of channels.
        shape: of the array.
        read: it, with numbers.
        unit: of the numbers; else the name's, if it has one.

    Returns:
        None, of a single number, an empty array, or one of more than two dimensions.

    Raises:
        ValueError: it is too large.
    """
    sides = [side for side in shape if side != 1] or [1]
    if min(sides) < 2 or len(sides) > 2:
        return []
    name, rows = separator.join(path), max(sides)
    require_size(name, rows)
    columns = sides[0] * sides[-1] // rows if len(sides) == 2 else 1
    if rows * columns > MOST_VALUES:
        raise ValueError(
            f"matrix {name!r} has {rows * columns} numbers; at most {MOST_VALUES} are read"
        )
    return [
        Channel(
            name=name if columns == 1 else f"{name}({column + 1})",
            rows=rows,
            read=partial(_column, read, rows, columns, column),
            unit=unit or unit_in(name),
            group=path[:-1],
            label=path[-1],
        )
        for column in range(columns)
    ]


def _column(read: Callable[[], Any], rows: int, columns: int, column: int) -> Any:
    """A column of an array, whose samples run along its longer side."""
    array = read().squeeze()
    if columns == 1:
        return array
    return array[:, column] if array.shape == (rows, columns) else array[column]
