"""Decodes a ``scene.json`` into dataclasses, by the types of their fields.

Bounds and what goes together are the program's to check, before it calls this package. What is
missing, unknown or of the wrong type ends in one sentence that names the field.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from .errors import SceneError

T = TypeVar("T")
SCALARS = {
    float: "a finite number in SI units",
    int: "a whole number",
    str: "a text",
    bool: "true or false",
}


@dataclass(frozen=True)
class At:
    """Where a field is that is not under its own name: ``Annotated[float, At("outer.speed")]``.

    Keys joined by dots; none: its own fields are in this object. A default also replaces a field
    whose object is absent or null.
    """

    path: str = ""


def decode(kind: type[T], document: Any) -> T:
    """Decoded JSON as a ``kind``, a dataclass.

    A field is a number, a text, a truth value, one of the values of a `Literal`, a tuple (from a
    list), a dataclass (from an object), an object as it stands (``dict[str, Any]``), any value as
    it stands (``object``), or one of these or ``None`` (null or absent). Among several dataclasses
    the key ``kind`` chooses, by the name of the class in lower case.

    Raises:
        SceneError: a field is missing, unknown or of another type.
    """
    decoder = _Decoder()
    made: T = decoder.object(kind, document, "")
    decoder.refuse_unknown(document, "")
    return made


def one_of(value: Any, path: str, allowed: tuple[Any, ...]) -> Any:
    """``value``, one of those ``allowed``."""
    if isinstance(value, bool) or value not in allowed:
        raise SceneError(
            f"{path} is {_show(value)}, which this solver does not support; "
            f"supported: {', '.join(map(str, allowed))}"
        )
    return allowed[allowed.index(value)]


def member(node: Any, path: str, key: str) -> Any:
    """The value of a key that has to be there, of the object at ``path``."""
    if not isinstance(node, dict):
        raise SceneError(f"{path or 'the scene'} must be an object, not {_show(node)}")
    if key not in node:
        raise SceneError(f"{_join(path, key)} is missing")
    return node[key]


class _Decoder:
    """Notes, by the path of an object, the keys that it may have, and what it leaves unchecked."""

    def __init__(self) -> None:
        self.known: defaultdict[str, list[str]] = defaultdict(list)
        self.unchecked: set[str] = set()

    def object(self, kind: type[Any], node: Any, path: str) -> Any:
        """A dataclass from the object at ``path``."""
        values = {}
        for each, (hint, where) in _places(kind).items():
            required = each.default is MISSING and NoneType not in get_args(hint)
            found = self.find(node, path, where, required)
            if found is not None:
                values[each.name] = self.value(hint, *found)
            elif each.default is MISSING:
                values[each.name] = None
        return kind(**values)

    def find(
        self, node: Any, path: str, where: list[str], required: bool
    ) -> tuple[Any, str] | None:
        """A field's value and path; None: it is not there and need not be."""
        for depth, key in enumerate(where):
            self.known[path].append(key)
            absent = depth > 0 if node is None else isinstance(node, dict) and key not in node
            if absent and not required:
                return None
            node, path = member(node, path, key), _join(path, key)
        return node, path

    def value(self, hint: Any, node: Any, path: str) -> Any:
        """What a type makes of the value at ``path``."""
        if isinstance(hint, UnionType):
            if node is None and NoneType in get_args(hint):
                return None
            hint = self.chosen(
                [each for each in get_args(hint) if each is not NoneType], node, path
            )
        if is_dataclass(hint):
            return self.object(hint, node, path)  # type: ignore[arg-type]
        if get_origin(hint) is Literal:
            return one_of(node, path, get_args(hint))
        if get_origin(hint) is tuple:
            if not isinstance(node, list):
                raise SceneError(f"{path} must be a list, not {_show(node)}")
            element = get_args(hint)[0]
            return tuple(self.value(element, each, f"{path}[{k}]") for k, each in enumerate(node))
        if hint is object:
            self.unchecked.add(path)
            return node
        return node if get_origin(hint) is dict else _scalar(hint, node, path)

    def chosen(self, kinds: list[Any], node: Any, path: str) -> Any:
        """The type that the object's ``kind`` names, if there are several."""
        if len(kinds) == 1:
            return kinds[0]
        self.known[path].append("kind")
        named = {each.__name__.lower(): each for each in kinds}
        return named[one_of(member(node, path, "kind"), _join(path, "kind"), tuple(named))]

    def refuse_unknown(self, node: Any, path: str) -> None:
        """Refuse keys that no dataclass has a field for."""
        if isinstance(node, list):
            for k, each in enumerate(node):
                self.refuse_unknown(each, f"{path}[{k}]")
        elif isinstance(node, dict) and path not in self.unchecked:
            known = dict.fromkeys(self.known[path])
            for key, each in node.items():
                if key not in known:
                    raise SceneError(
                        f"{_join(path, key)} is not a known field; known are {', '.join(known)}"
                    )
                self.refuse_unknown(each, _join(path, key))


def _places(kind: type[Any]) -> dict[Field[Any], tuple[Any, list[str]]]:
    """Types of a dataclass's fields, and the keys under which they are."""
    found, hints = {}, get_type_hints(kind, include_extras=True)
    for each in fields(kind):
        hint, where = hints[each.name], [each.name]
        if get_origin(hint) is Annotated:
            hint, at = get_args(hint)
            where = [key for key in at.path.split(".") if key]
        found[each] = (hint, where)
    return found


def _scalar(hint: Any, node: Any, path: str) -> Any:
    types = (int, float) if hint is float else hint
    right = isinstance(node, types) and isinstance(node, bool) == (hint is bool)
    if not right or (hint is float and not abs(node) <= sys.float_info.max):
        raise SceneError(f"{path} is {_show(node)}; it must be {SCALARS[hint]}")
    return hint(node)


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _show(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:37] + "..."


def read_document(path: Path) -> Any:
    """The decoded ``scene.json``, or the scene in a ``provenance.json``; not yet a dataclass.

    Raises:
        SceneError: the file cannot be read or is not JSON.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"scene file {path} cannot be read: {error}") from error
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise SceneError(f"scene file {path} is not valid JSON: {error}") from error
    inner = document.get("scene") if isinstance(document, dict) else None
    return inner if isinstance(inner, dict) else document
