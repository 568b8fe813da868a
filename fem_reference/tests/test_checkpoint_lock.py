"""Two runs of one solution at once: the second waits for the first."""

from __future__ import annotations

import shutil
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ..common.output import exclusive

ALONE: Any = SimpleNamespace(rank=0, barrier=lambda: None)


def test_the_second_run_waits_until_the_first_has_gone(tmp_path: Path) -> None:
    """It says so, and enters only after the first has left, even if that one failed."""
    folder = tmp_path / "scene" / ".checkpoint-coarse"
    waiting, order = threading.Event(), []

    def second() -> None:
        with exclusive(folder, ALONE, waiting.set):
            order.append("second")

    thread = threading.Thread(target=second)
    try:
        with exclusive(folder, ALONE, lambda: order.append("first had to wait")):
            thread.start()
            assert waiting.wait(10.0)
            order.append("first")
            raise RuntimeError
    except RuntimeError:
        pass
    thread.join(10.0)
    assert order == ["first", "second"]
    assert not folder.exists()


def test_runs_of_two_solutions_do_not_wait_for_each_other(tmp_path: Path) -> None:
    waiting: list[str] = []
    with (
        exclusive(tmp_path / ".checkpoint-a", ALONE, lambda: waiting.append("a")),
        exclusive(tmp_path / ".checkpoint-b", ALONE, lambda: waiting.append("b")),
    ):
        assert waiting == []


def test_a_folder_that_is_removed_and_made_again_is_locked_again(tmp_path: Path) -> None:
    folder = tmp_path / ".checkpoint-a"
    with exclusive(folder, ALONE, lambda: None):
        (folder / "state").touch()
        shutil.rmtree(folder)
        inside = threading.Event()

        def second() -> None:
            with exclusive(folder, ALONE, lambda: None):
                inside.set()

        thread = threading.Thread(target=second)
        thread.start()
        assert inside.wait(10.0)
        thread.join(10.0)
