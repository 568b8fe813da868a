"""Universal files: functions over time of data sets 58, as text or binary (58b), by pyuff."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import pyuff

from .channel import Channel, require_size
from .clock import in_si

MOST_BYTES = 4_000_000_000
"""Of a file, which pyuff reads as a whole."""
REAL = (2, 4)
"""Types of ordinate, single and double; others are complex."""
TIME = 17
"""Type of data of an abscissa in time."""
DIRECTIONS = ("", "+X", "+Y", "+Z", "+RX", "+RY", "+RZ", "-RZ", "-RY", "-RX", "-Z", "-Y", "-X")
"""Of a response, by its number; negative ones count from the end."""


@contextmanager
def channels(path: Path) -> Iterator[list[Channel]]:
    """The functions over time of a universal file; others, over frequency say, are left out.

    Uneven ones bring a channel of their abscissa. Raises ValueError where the file has none, or
    is cut or too large.
    """
    _require_whole(path)
    file = pyuff.UFF(str(path))
    kinds = list(file.get_set_types())
    if 0 in kinds:
        raise ValueError(f"its data set {kinds.index(0) + 1} does not begin with a number")
    places = [place for place, kind in enumerate(kinds) if kind == 58]
    heads = {place: file.read_sets(place, header_only=True) for place in places}
    wanted = {place: head for place, head in heads.items() if _is_over_time(head)}
    if heads and not wanted:
        raise ValueError(f"none of its {len(heads)} functions is real and over time")
    read = lru_cache(maxsize=1)(file.read_sets)
    found: list[Channel] = []
    for (place, head), name in zip(wanted.items(), _names(list(wanted.values())), strict=True):
        require_size(name, head["num_pts"])
        found += _of_function(head, name, len(found), partial(read, place))
    yield found


def _require_whole(path: Path) -> None:
    """Refuse a file that pyuff would read in part, or that is too large for it.

    Raises:
        ValueError: it does not end with the end of a data set, or has more than `MOST_BYTES`.
    """
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise ValueError(f"it has {size} bytes; at most {MOST_BYTES} are read")
    with path.open("rb") as stream:
        stream.seek(max(size - 200, 0))
        if not stream.read().rstrip().endswith(b"    -1"):
            raise ValueError("it is cut: its last line is not the end of a data set (-1)")


def _is_over_time(head: dict[str, Any]) -> bool:
    """Whether a function is real and over time, or of a general kind over nothing stated."""
    over = head["abscissa_spec_data_type"]
    is_time = over == TIME or (over == 0 and head["func_type"] in (0, 1))
    return is_time and head["ord_data_type"] in REAL and head["num_pts"] > 0


def _names(heads: list[dict[str, Any]]) -> list[str]:
    """A name for every function: its first line, with node and direction where that recurs."""
    titles = [_stated(head["id1"]) or "function" for head in heads]
    counts = Counter(titles)
    for place, head in enumerate(heads):
        if counts[titles[place]] > 1:
            turn = head["rsp_dir"]
            direction = DIRECTIONS[turn] if -7 < turn < 7 else ""
            titles[place] += f" {head['rsp_node']}{direction}"
    counts = Counter(titles)
    return [
        f"{title} ({titles[:place].count(title) + 1})" if counts[title] > 1 else title
        for place, title in enumerate(titles)
    ]


def _stated(text: str | None) -> str | None:
    """A text of a header, None where it says that there is none."""
    text = (text or "").strip()
    return None if text.upper() in ("", "NONE") else text


def _of_function(head: dict[str, Any], name: str, place: int, read: Any) -> list[Channel]:
    """Channels of a function, which come at a place of the record."""
    unit, rows = _stated(head["ordinate_axis_units_lab"]), head["num_pts"]
    over = _stated(head["abscissa_axis_units_lab"])
    if head["abscissa_spacing"] == 0:
        return [
            Channel(name, rows, lambda: read()["data"], unit, time=place + 1),
            Channel(f"{name} time", rows, lambda: read()["x"], over or "s"),
        ]
    second = in_si(over)
    start, interval = (second and second * head[key] for key in ("abscissa_min", "abscissa_inc"))
    return [Channel(name, rows, lambda: read()["data"], unit, start, interval)]
