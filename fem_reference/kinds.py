"""The kinds of scenes: one line each, a folder with the commands it answers."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any, cast

from .common.arguments import Study
from .common.decode import member, one_of

KINDS = {
    "plate-impact": "plate_impact",
    "seal-seat": "seal_seat",
    "impact": "general_impact",
}
"""Folder of each kind. Its module `command` has a dictionary ``COMMANDS`` by name, and may have
one of ``STUDIES``; it imports late what these need."""

Command = Callable[[Any, argparse.Namespace], None]
"""Gets a decoded ``scene.json`` and the command line."""


def _module(kind: str) -> ModuleType:
    return import_module(f".{KINDS[kind]}.command", __package__)


def commands_of(document: Any) -> dict[str, Command]:
    """Commands, by name, for the kind of a decoded ``scene.json``.

    Raises:
        SceneError: the kind is missing or unknown.
    """
    kind = one_of(member(document, "", "kind"), "kind", tuple(KINDS))
    return cast("dict[str, Command]", _module(kind).COMMANDS)


def studies() -> dict[str, Study]:
    """Studies of all kinds, by name."""
    found: dict[str, Study] = {}
    for kind in KINDS:
        found |= getattr(_module(kind), "STUDIES", {})
    return found
