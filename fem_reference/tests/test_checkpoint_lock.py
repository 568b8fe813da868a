"""Two runs of one solution at once: the second waits for the first."""

from __future__ import annotations

import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ..explicit.checkpoint import exclusive

ALONE: Any = SimpleNamespace(rank=0, barrier=lambda: None)


def test_the_second_run_waits_until_the_first_has_gone(tmp_path: Path) -> None:
    """It says so, and enters only after the first has left, even if that one failed."""
    folder = tmp_path / "scene" / ".checkpoint-coarse"
    told, order = threading.Event(), []

    def second() -> None:
        with exclusive(folder, ALONE, told.set):
            order.append("second")

    thread = threading.Thread(target=second)
    try:
        with exclusive(folder, ALONE, lambda: order.append("first had to wait")):
            thread.start()
            assert told.wait(10.0)
            order.append("first")
            raise RuntimeError
    except RuntimeError:
        pass
    thread.join(10.0)
    assert order == ["first", "second"]
