"""Typed access to a decoded ``scene.json``: every error names the field."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from .errors import SceneError


class Reader:
    """Typed access to one JSON object; every error names the field's full path."""

    def __init__(self, node: Any, path: str) -> None:
        if not isinstance(node, dict):
            raise SceneError(f"{path or 'the scene'} must be an object, not {_show(node)}")
        self.node = node
        self.path = path

    def _name(self, key: str) -> str:
        return f"{self.path}.{key}" if self.path else key

    def allow(self, *keys: str) -> None:
        """Refuse keys other than ``keys``."""
        for key in self.node:
            if key not in keys:
                raise SceneError(
                    f"{self._name(key)} is not a known field; known are {', '.join(keys)}"
                )

    def get(self, key: str) -> Any:
        """The value of a key that has to be there."""
        if key not in self.node:
            raise SceneError(f"{self._name(key)} is missing")
        return self.node[key]

    def child(self, key: str) -> Reader:
        """The object under a key."""
        return Reader(self.get(key), self._name(key))

    def children(self, key: str) -> list[Reader]:
        """The objects in the list under a key."""
        values = self.get(key)
        if not isinstance(values, list):
            raise SceneError(f"{self._name(key)} must be a list, not {_show(values)}")
        return [Reader(value, f"{self._name(key)}[{k}]") for k, value in enumerate(values)]

    def text(self, key: str) -> str:
        """The text under a key."""
        value = self.get(key)
        if not isinstance(value, str):
            raise SceneError(f"{self._name(key)} must be a text, not {_show(value)}")
        return value

    def flag(self, key: str) -> bool:
        """The truth value under a key."""
        value = self.get(key)
        if not isinstance(value, bool):
            raise SceneError(f"{self._name(key)} must be true or false, not {_show(value)}")
        return value

    def choice(self, key: str, allowed: tuple[str, ...]) -> str:
        """A text that is one of ``allowed``."""
        value = self.text(key)
        if value not in allowed:
            raise SceneError(
                f"{self._name(key)} is {value!r}, which this solver does not support; "
                f"supported: {', '.join(allowed)}"
            )
        return value

    def number_or(self, key: str, default: float, unit: str, **bounds: Any) -> float:
        """As `number`, or ``default`` where the key is absent."""
        return self.number(key, unit, **bounds) if key in self.node else default

    def number(
        self,
        key: str,
        unit: str,
        *,
        above: float = 0.0,
        below: float = math.inf,
        inclusive: bool = False,
    ) -> float:
        """A finite number above (or at, if ``inclusive``) one bound and below another."""
        value = self.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SceneError(f"{self._name(key)} must be a number in {unit}, not {_show(value)}")
        number = float(value)
        low_ok = number >= above if inclusive else number > above
        if not math.isfinite(number) or not low_ok or not number < below:
            relation = "at least" if inclusive else "above"
            limit = f" and below {below:g} {unit}" if math.isfinite(below) else ""
            raise SceneError(
                f"{self._name(key)} is {number:g} {unit}; "
                f"it must be finite, {relation} {above:g} {unit}{limit}"
            )
        return number


def _show(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:37] + "..."


def read_document(path: Path) -> Any:
    """The decoded ``scene.json``, or the scene in a ``provenance.json``; not yet checked.

    Raises:
        SceneError: the file cannot be read or is not JSON.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"scene file {path} cannot be read: {error}") from error
    try:
        document = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise SceneError(f"scene file {path} is not valid JSON: {error}") from error
    inner = document.get("scene") if isinstance(document, dict) else None
    return inner if isinstance(inner, dict) else document
