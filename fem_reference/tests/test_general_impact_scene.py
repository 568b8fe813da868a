"""Scenes of kind impact: what they have, and what is refused."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import pytest

from fem_reference.common.errors import SceneError
from fem_reference.general_impact.command import require_content
from fem_reference.general_impact.scene import parse_scene
from fem_reference.tests.general_scenes import SPHERE, STEEL, document

WALL = {"material": STEEL}
BODY = {
    "content": "0",
    "unit": 0.001,
    "material": STEEL,
    "fixed": ["base", [0.0, 0.0, 0.0]],
    "element_size": None,
    "damping_ratio": 0.0,
    "at": ["strike", [0.0, 0.0, 0.002]],
}
PLATE = {"radius": 0.03, "thickness": 0.002, "edge": "free", "material": STEEL}
STILL = SPHERE | {"gap": 0.0, "speed": 0.0}


def has(**changes: Any) -> set[str]:
    """Which of the quantities in question a scene has."""
    scene = parse_scene(document(**changes))
    names = ("efficiency", "inner_force_peak", "inner_restitution", "first_frequency")
    return {name for name in names if scene.has(name)}


def test_a_scene_has_the_quantities_that_its_bodies_have() -> None:
    assert has(wall=WALL) == set()
    assert has(inner=STILL) == {"efficiency"}
    assert has(plate=PLATE) == {"first_frequency"}
    assert has(body=BODY) == {"first_frequency"}
    both = {"efficiency", "inner_force_peak", "first_frequency"}
    assert has(body=BODY, inner=STILL) == both
    assert has(body=BODY, inner=STILL | {"speed": 0.1}) == both | {"inner_restitution"}


def test_rust_documents_decode() -> None:
    scene = parse_scene(document(body=BODY, inner=STILL))
    assert scene.held
    made = scene.body_scene(Path("part.step"))
    assert made.body.unit == 0.001
    assert made.outer.at == "strike"
    assert made.inner is not None
    assert made.inner.at == [0.0, 0.0, 0.002]
    assert made.inner.tip_radius == 0.004


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({}, "inner is missing"),
    ({"wall": WALL, "plate": PLATE}, "has wall and plate"),
    ({"wall": WALL, "inner": STILL}, "inner is given with wall"),
    ({"wall": WALL, "outer__angle": 0.1}, "outer.angle is 0.1"),
    ({"wall": WALL, "outer__kind": "bender"}, 'outer.kind is "bender"'),
    ({"wall": WALL, "friction": 0.2}, "friction is 0.2"),
    ({"wall": WALL, "outer__spin": 20.0}, "outer.spin is 20"),
    ({"wall": WALL, "series": {"impacts": 2}}, "series is given"),
    ({"plate": PLATE | {"damping_ratio": 0.01}}, "plate.damping_ratio is 0.01"),
    ({"body": BODY | {"damping_ratio": 0.02}}, "body.damping_ratio is 0.02"),
    ({"body": BODY | {"materials": {"left": STEEL}}}, "the reference takes one material"),
    ({"inner": STILL | {"speed": -0.5}}, "approach each other at 0 m/s"),
    (
        {"wall": {"material": STEEL | {"yield_strength": 1e9, "hardening": 0.0}}},
        "yields (hardening 0.0 Pa)",
    ),
    (
        {"wall": {"material": STEEL | {"relaxation": [{"ratio": 0.1, "time": 1e-5}]}}},
        "(struck) relaxes",
    ),
    (
        {
            "wall": WALL,
            "outer": {
                "kind": "compact",
                "mass": 1.0,
                "tip_radius": 0.01,
                "material": STEEL,
                "speed": 1.0,
            },
        },
        "outer.kind is 'compact'",
    ),
    ({"wall": {"material": None}, "reference__rigid": "outer"}, "but the wall is rigid"),
    ({"wall": WALL, "wall__tilt": 1.0}, "wall.tilt is not a known field"),
]


@pytest.mark.parametrize(("changes", "sentence"), REFUSED, ids=[text for _, text in REFUSED])
def test_what_is_not_covered_is_refused_by_name(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(SceneError) as refused:
        parse_scene(document(**changes))
    assert sentence in str(refused.value)


def test_another_file_than_the_scenes_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "part.step"
    file.write_text("part", encoding="utf-8")
    own = "0"
    with pytest.raises(SceneError, match="another file, or it has changed"):
        require_content(file, own)
    with pytest.raises(SceneError, match="--body FILE must name"):
        require_content(None, own)
    with pytest.raises(SceneError, match="cannot be read"):
        require_content(tmp_path / "none.step", own)
    require_content(file, hashlib.sha256(file.read_bytes()).hexdigest())
