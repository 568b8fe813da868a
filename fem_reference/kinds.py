"""The kinds of scenes: one line each, a folder with the commands it answers."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from importlib import import_module
from typing import Any, cast

from .common.reader import Reader

KINDS = {"plate-impact": "plate_impact", "seal-seat": "seal_seat"}
"""Folder of each kind; its module `command` has the dictionary ``COMMANDS``."""

Command = Callable[[Any, argparse.Namespace], None]
"""Gets a decoded ``scene.json`` and the command line."""


def commands_of(document: Any) -> dict[str, Command]:
    """Commands, by name, for the kind of a decoded ``scene.json``.

    Raises:
        SceneError: the kind is missing or unknown.
    """
    kind = Reader(document, "").choice("kind", tuple(KINDS))
    module = import_module(f".{KINDS[kind]}.command", __package__)
    return cast("dict[str, Command]", module.COMMANDS)
