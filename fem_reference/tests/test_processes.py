"""Runs end with the program that started them; what a run imports is what ``versions`` asks for."""

from __future__ import annotations

import ast
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any

import pytest

from fem_reference.common.parent import PARENT
from fem_reference.common.processes import busy_cores, crowded
from fem_reference.common.versions import MODULES
from fem_reference.tests.conftest import document
from fem_reference.tests.program import ROOT

PROGRAM = f"""
import os, subprocess, sys
with open(sys.argv[1], "w") as log:
    environment = {{**os.environ, "{PARENT}": str(os.getpid())}}
    subprocess.run(sys.argv[2:], stdout=log, stderr=log, env=environment)
"""
"""Starts a run as the program does, but does not read what it says: it must not need a reader."""


def _processes() -> dict[str, tuple[str, str]]:
    """State and parent of every process, by its number; a bare container has no `ps`."""
    found = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, parent = stat.read_text().rpartition(")")[2].split()[:2]
            found[stat.parent.name] = (state, parent)
    return found


def _descendants(pid: str) -> list[str]:
    children = [number for number, (_, parent) in _processes().items() if parent == pid]
    return children + [other for child in children for other in _descendants(child)]


def _running(pids: list[str]) -> list[str]:
    """Those that are no zombies: a container may not bury what it has not born."""
    found = _processes()
    return [pid for pid in pids if pid in found and found[pid][0] != "Z"]


@pytest.mark.parametrize("processes", [1, 2])
def test_a_run_ends_with_the_program_that_started_it(tmp_path: Path, processes: int) -> None:
    changes: dict[str, Any] = {"run": {"end_time": 0.1}}
    if processes > 1:
        reference = {"geometry": "solid", "elements_per_contact_radius": 2, "element_order": 1}
        changes.update(plate__radius=0.012, outer__radius=0.005, reference=reference)
        changes.update(inner__radius=0.005)
    scene, log = tmp_path / "scene.json", tmp_path / "log"
    scene.write_text(json.dumps(document(**changes)), encoding="utf-8")
    solve = [sys.executable, "-m", "fem_reference", "solve", "--resolution", "coarse"]
    solve += ["--scene", str(scene), "--out", str(tmp_path / "out"), "--np", str(processes)]
    program = subprocess.Popen([sys.executable, "-c", PROGRAM, str(log), *solve], cwd=ROOT)
    start = time.monotonic()
    while not log.exists() or '"stepping"' not in log.read_text(encoding="utf-8"):
        assert time.monotonic() - start < 600.0, log.read_text(encoding="utf-8")
        assert program.poll() is None, log.read_text(encoding="utf-8")
        time.sleep(0.05)
    run = _descendants(str(program.pid))
    assert len(_running(run)) >= (1 if processes == 1 else 1 + processes)
    os.kill(program.pid, signal.SIGKILL)
    program.wait()
    # far less than the run would take by itself
    deadline = time.monotonic() + 120.0
    while _running(run) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _running(run)


def test_a_run_started_by_hand_is_left_alone() -> None:
    code = (
        f"import os; os.environ.pop({PARENT!r}, None); from fem_reference.common.parent import *; "
    )
    read = "import ctypes; s = ctypes.c_int(); ctypes.CDLL(None).prctl(2, ctypes.byref(s)); "
    printed = subprocess.run(
        [sys.executable, "-c", f"{code} end_with_parent(); {read} print(s.value)"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert printed.stdout.strip() == "0"


def test_processes_that_would_wait_for_each_other_are_named(tmp_path: Path) -> None:
    """Two processes beside one busy program on two cores took three times as long as one."""
    assert crowded(1, 2.0, 2) is None
    assert crowded(2, 0.1, 2) is None
    said = crowded(2, 1.0, 2)
    assert said is not None and said.startswith("other programs keep 1.0 of 2 cores busy: 2 proce")
    assert 0.0 <= busy_cores() <= (os.cpu_count() or 1)
    assert busy_cores(tmp_path) == 0.0


def _imported(source: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module)
    return {name.split(".")[0] for name in names}


def test_versions_cover_everything_that_is_imported() -> None:
    folder = ROOT / "fem_reference"
    # what ParaView runs, also beside a solution's fields, we do not import;
    # MuJoCo has an environment of its own; no reference depends on the readers of records and units
    others = {"tests", "paraview", "solutions", "flight", "records", "units"}
    sources = [path for path in folder.rglob("*.py") if others.isdisjoint(path.parts)]
    imported = set().union(*map(_imported, sources)) - sys.stdlib_module_names
    assert len(imported) > 5
    assert imported <= set(MODULES)


def test_a_compilation_that_was_killed_does_not_stop_the_next_run(tmp_path: Path) -> None:
    cache = tmp_path / "fenics"
    cache.mkdir()
    library = f"libffcx_forms_1{EXTENSION_SUFFIXES[0]}"
    names = ("libffcx_forms_0.c", "libffcx_forms_1.c", "libffcx_forms_1.c.cached", "other.c")
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    code = "import fem_reference.common.jit_cache as j; j.clear_unusable(); "

    def left() -> list[str]:
        for name in names:
            (cache / name).touch()
        shutil.copy(sys.executable, cache / library)
        command = [sys.executable, "-c", code]
        subprocess.run(command, cwd=ROOT, env=environment, check=True)
        return sorted(path.name for path in cache.iterdir() if not path.name.startswith("."))

    assert left() == sorted([*names[1:], library])
    # While another run lives, which may be compiling, all stay.
    other = [sys.executable, "-c", code + "print(flush=True); input()"]
    pipe = subprocess.PIPE
    with subprocess.Popen(other, cwd=ROOT, env=environment, stdin=pipe, stdout=pipe) as living:
        assert living.stdout is not None
        living.stdout.readline()
        assert left() == sorted([*names, library])


def test_a_missing_module_is_reported_before_a_run(tmp_path: Path) -> None:
    (tmp_path / "meshio.py").write_text("raise ImportError('not here')", encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"}
    command = [sys.executable, "-m", "fem_reference", "versions"]
    done = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    found = json.loads(done.stdout)
    assert found["meshio"] is None
    assert found["fem_reference"] is None
    assert found["dolfinx"]
