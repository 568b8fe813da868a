"""Scenes: files, or dictionaries with the keys of a scene file."""

from __future__ import annotations

import json
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping


class Scene:
    """One impact; the program checks it whenever it is used.

    Args:
        content: The keys of a scene file. Quantities are texts with units ("33 mm") or numbers in
            SI; `impactcheck schema` tells all keys.
    """

    def __init__(self, content: Mapping[str, Any]) -> None:
        lines = (f"{json.dumps(key)} = {toml(value)}" for key, value in content.items())
        self._text: str | None = "\n".join(lines)
        self._place = str(content.get("name", "scene"))

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Scene:
        """The scene in a file, or the shipped one of that name."""
        scene = cls.__new__(cls)
        scene._text, scene._place = None, fspath(path)
        return scene

    def file(self, folder: str | PathLike[str]) -> str:
        """What the program calls the scene: its name or file, for a dictionary one in a folder."""
        if self._text is None:
            return self._place
        file = Path(folder) / f"{Path(self._place).name}.toml"
        file.write_text(self._text, encoding="utf-8")
        return str(file)

    def __repr__(self) -> str:
        return f"<impactcheck.Scene {self._place}>"


def toml(value: object) -> str:
    """A value as TOML, tables inline."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, bool | str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)
