"""Faults of bodies: a sentence each, status 3, nothing half-written."""

from pathlib import Path

import pytest
from bodies import BLOCK, made, run, scene


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a block as a mesh of linear tetrahedra, and its surface alone."""
    folder = tmp_path_factory.mktemp("block")
    made(folder, BLOCK)
    return folder


FAULTS = {
    "no such file": ('file = "none.msh"', None, "none.msh"),
    "an ending that nobody knows": ('file = "part.toml"', None, ".toml"),
    "a surface without volume": ('file = "surface.msh"\nunit = "mm"', None, "surface"),
    "millimetres as metres": ('file = "block.msh"', None, "unit"),
    "a missing group": ('file = "block.msh"\nunit = "mm"\nfixed = ["bas"]', None, "'base'"),
    "a point inside": (
        'file = "block.msh"\nunit = "mm"',
        'at = ["5 mm", "5 mm", "2.5 mm"]',
        "outer.at",
    ),
    "a point far away": (
        'file = "block.msh"\nunit = "mm"',
        'at = ["50 mm", "5 mm", "5 mm"]',
        "outer.at",
    ),
    "a place without a body's": ('file = "block.msh"\nunit = "mm"', "", "outer.at"),
    "a unit that there is not": ('file = "block.msh"\nunit = "inch"', None, "body.unit"),
    "no file at all": ('unit = "mm"', None, "body.file"),
    "two coordinates": ('file = "block.msh"\nunit = "mm"', 'at = ["5 mm", "5 mm"]', "outer.at"),
    "an empty file": ('file = "empty.step"', None, "empty.step"),
    "no STEP inside": ('file = "text.step"', None, "text.step"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_a_sentence_with_status_3_and_leaves_nothing(block: Path, fault: str) -> None:
    """Field or file is named; no mesh is left half-written."""
    body, outer, named = FAULTS[fault]
    (block / "empty.step").write_text("")
    (block / "text.step").write_text("this is no part\n")
    top = 'at = ["5 mm", "5 mm", "5 mm"]'
    name = scene(block, body, outer=top if outer is None else outer, radius="2 mm")
    said = run(block, "mesh", name, "--out", "fault.vtu", status=3)[1]
    assert named in said, said
    assert "Traceback" not in said, said
    assert not list(block.glob("fault.*"))
