"""Scenes that are invalid or unsupported are refused, and the field is named."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fem_reference.common.errors import SceneError
from fem_reference.plate_impact.scene import parse_scene, read_scene

from .conftest import document


def test_valid_scene_is_read() -> None:
    scene = parse_scene(document(run__end_time=1e-4, plate__edge="free"))
    assert scene.plate.edge == "free"
    assert scene.end_time == 1e-4
    assert scene.outer.mass == pytest.approx(7780.0 * 4 / 3 * math.pi * 1e-6, rel=1e-15)


def test_yield_strength_is_admissible_and_changes_nothing() -> None:
    strong = document()
    strong["plate"]["material"] = {**strong["plate"]["material"], "yield_strength": 1.2e9}
    assert parse_scene(strong).plate.material.yielding is None


def test_relaxing_and_yielding_together_are_refused() -> None:
    scene = document()
    scene["plate"]["material"]["relaxation"] = [{"ratio": 0.1, "time": 1e-5}]
    scene["outer"]["material"] |= {"yield_strength": 6e8, "hardening": 0.0}
    with pytest.raises(SceneError, match=r"outer\.material yields and plate\.material relaxes"):
        parse_scene(scene)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"kind": "seal-seat"}, "kind"),
        ({"kind": None}, "kind is null, which this solver does not support"),
        ({"outer__kind": "compact"}, "outer.mass is missing"),
        ({"inner__kind": "compact"}, "inner.mass is missing"),
        ({"outer__kind": "bender"}, "outer.length is missing"),
        ({"inner__kind": "bender"}, 'inner.kind is "bender", which this solver does not support'),
        ({"inner__speed": math.inf}, "inner.speed is Infinity; it must be a finite number"),
        ({"fluid": {"viscosity": 1e-3}}, "fluid.density is missing"),
        ({"fluid": 3}, "fluid must be an object, not 3"),
        ({"plate__edge": "glued"}, "plate.edge"),
        ({"reference__geometry": "shell"}, "reference.geometry"),
        ({"plate__thickness": math.nan}, "plate.thickness is NaN; it must be a finite number"),
        ({"plate__thickness": 10**400}, "plate.thickness is 1000"),
        ({"inner__radius": "10 mm"}, 'inner.radius is "10 mm"; it must be a finite number'),
        ({"inner__radius": True}, "inner.radius is true"),
        ({"plate__colour": "red"}, "plate.colour is not a known field; known are radius"),
        ({"outer__material__colour": "red"}, "outer.material.colour is not a known field"),
        ({"run__start": 0.0}, "run.start is not a known field; known are end_time"),
        ({"colour": "red"}, "colour is not a known field"),
        ({"outer": None}, "outer must be an object, not null"),
        ({"run": 1.0}, "run must be an object, not 1.0"),
        ({"name": 1}, "name is 1; it must be a text"),
    ],
)
def test_unsupported_or_invalid_field_is_named(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(SceneError, match=re.escape(field)):
        parse_scene(document(**changes))


def test_what_is_null_may_be_absent() -> None:
    scene = document()
    for absent in ("run", "fluid"):
        del scene[absent]
    assert parse_scene(scene) == replace(parse_scene(document()), raw=scene)


def test_missing_field_is_named() -> None:
    broken = document()
    del broken["outer"]["material"]["density"]
    with pytest.raises(SceneError, match=r"outer\.material\.density is missing"):
        parse_scene(broken)


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe\x00", b"[" * 100000, b"[1]"])
def test_file_that_is_no_scene(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(content)
    with pytest.raises(SceneError):
        read_scene(path)


def test_absent_file(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="cannot be read"):
        read_scene(tmp_path / "none.json")


def test_document_is_stored_for_the_provenance(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document()))
    assert read_scene(path).raw == document()
