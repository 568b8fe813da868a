"""A scene that takes too long."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
import solve


def test_a_program_that_takes_too_long_is_asked_to_end(tmp_path: Path) -> None:
    """So that it can end what it has started: a killed one leaves its reference running."""
    ended, script = tmp_path / "ended", tmp_path / "program"
    script.write_text(f"trap 'touch {ended}; exit 1' TERM\nsleep 30 &\nwait\n", encoding="utf-8")
    with pytest.raises(subprocess.TimeoutExpired):
        solve._run(["sh", script], 0.5)
    assert ended.exists()
