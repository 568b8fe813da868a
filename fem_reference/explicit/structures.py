"""Mirrors of the C structures of `kernel.c` and its parts; `kernel.load` checks their sizes."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path
from typing import Any

MAX_INTERVALS = 256
INT64 = ctypes.POINTER(ctypes.c_int64)
DOUBLE = ctypes.POINTER(ctypes.c_double)


class Record(ctypes.Structure):
    """Mirror of ``Record`` in C."""


class Tip(ctypes.Structure):
    """Mirror of ``Tip`` in C."""


class Pairs(ctypes.Structure):
    """Mirror of ``Pairs`` in C."""


class Film(ctypes.Structure):
    """Mirror of ``Film`` in C."""


class Plastic(ctypes.Structure):
    """Mirror of ``Plastic`` in C."""


class Rigid(ctypes.Structure):
    """Mirror of ``Rigid`` in C."""


class Contact(ctypes.Structure):
    """Mirror of ``Contact`` in C."""


class Voltage(ctypes.Structure):
    """Mirror of ``Voltage`` in C."""


class Problem(ctypes.Structure):
    """Mirror of ``Problem`` in C."""


class RowPart(ctypes.Structure):
    """Mirror of ``Part`` in C, of two components."""


class ElementPart(ctypes.Structure):
    """Mirror of ``Part`` in C, of three components."""


class Relaxing(ctypes.Structure):
    """Mirror of ``Relaxing`` in C."""


class State(ctypes.Structure):
    """Mirror of ``State`` in C."""


class Carried(ctypes.Structure):
    """Mirror of ``Carried`` in C."""


class Watched(ctypes.Structure):
    """Mirror of ``Watched`` in C."""


PARTS: dict[int, type[ctypes.Structure]] = {2: RowPart, 3: ElementPart}
"""By components of displacement per node."""

_MIRRORS = (
    *(Record, Tip, Pairs, Film, Plastic, Rigid, Contact, Voltage, Problem),
    *(RowPart, ElementPart, Relaxing, State, Carried, Watched),
)
"""In the order in which C declares them."""
_TYPES: dict[str, Any] = {
    "double": ctypes.c_double,
    "int32_t": ctypes.c_int32,
    "int64_t": ctypes.c_int64,
    **{mirror.__name__: mirror for mirror in _MIRRORS},
}
_NAMES = {"lambda": "multipliers", "yield": "yield_strength", "global": "map"}
"""Names that Python does not have for itself."""
_DECLARATION = re.compile(r"typedef struct \{([^{}]*)\} (\w+);")
_FIELD = re.compile(r"(?:const )?(\w+) (\*?)(\w+)(?:\[(\w+)\])?;")


def _field(kind: str, pointer: str, name: str, length: str) -> tuple[str, Any]:
    if kind == "Part":
        # of two components or of three, see PARTS
        return name, ctypes.c_void_p
    made = _TYPES[kind]
    if pointer:
        made = ctypes.POINTER(made)
    elif length:
        made *= MAX_INTERVALS if length == "MAX_INTERVALS" else int(length)
    return _NAMES.get(name, name), made


def _mirror() -> None:
    """Gives every mirror the fields that C declares."""
    folder = Path(__file__).parent
    source = "".join((folder / name).read_text("utf-8") for name in ("structures.c", "kernel.c"))
    declared = _DECLARATION.findall(re.sub(r"/\*.*?\*/", "", source, flags=re.DOTALL))
    for mirror, (fields, name) in zip(_MIRRORS, declared, strict=False):
        if not mirror.__name__.endswith(name):
            raise ImportError(f"{mirror.__name__} is no mirror of {name}")
        mirror._fields_ = tuple(_field(*field) for field in _FIELD.findall(fields))


_mirror()
