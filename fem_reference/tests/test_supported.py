"""Which FEniCSx is used, how its MPI is started, and what is reported where it does not fit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from fem_reference.common import processes
from fem_reference.common.supported import fault
from fem_reference.tests.conftest import document
from fem_reference.tests.program import ROOT


def call(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """The package as a program, with modules of ``folder`` in the place of those installed."""
    environment = {**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}
    command = [sys.executable, "-m", "fem_reference", *map(str, arguments)]
    return subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("release", "scalar", "words"),
    [
        ("0.5.2", np.float64, None),
        ("0.9.0", np.float64, None),
        ("0.11.0.post0", np.float64, None),
        ("0.4.1", np.float64, "0.4.1 is not supported, only 0.5 to 0.11"),
        ("0.12.0.dev0", np.float64, "0.12.0.dev0 is not supported"),
        ("1.0", np.float64, "1.0 is not supported"),
        ("unknown", np.float64, "unknown is not supported"),
        ("0.11.0", np.complex128, "complex scalars"),
    ],
)
def test_releases_and_scalars_are_supported_or_refused(
    release: str, scalar: type, words: str | None
) -> None:
    reason = fault(release, scalar)
    assert reason is None if words is None else words in str(reason)


def test_an_unsupported_release_ends_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "dolfinx.py").write_text("__version__ = '0.12.0'", encoding="utf-8")
    found = json.loads(call(tmp_path, "versions").stdout)
    assert found["dolfinx"] == "0.12.0" and "0.12.0 is not supported" in found["refused"]
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps(document()), encoding="utf-8")
    ended = call(tmp_path, "solve", "--scene", scene, "--out", tmp_path / "out")
    assert ended.returncode == 12
    assert "0.12.0 is not supported" in json.loads(ended.stdout.splitlines()[-1])["message"]
    assert "Traceback" not in ended.stderr


def test_an_unexpected_error_is_a_sentence_with_its_place(tmp_path: Path) -> None:
    (tmp_path / "gmsh.py").write_text("def initialize(*_, **__): raise TypeError('moved')")
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps(document()), encoding="utf-8")
    ended = call(tmp_path, "solve", "--scene", scene, "--out", tmp_path / "out")
    assert ended.returncode == 1
    message = json.loads(ended.stdout.splitlines()[-1])["message"]
    assert message.startswith("unexpected TypeError (mesher.py, line ") and "moved" in message


def test_a_module_that_cannot_be_loaded_is_named_with_its_reason(tmp_path: Path) -> None:
    text = "raise ImportError('libGLU.so.1: cannot open shared object file')"
    (tmp_path / "gmsh.py").write_text(text, encoding="utf-8")
    found = json.loads(call(tmp_path, "versions").stdout)
    assert found["gmsh"] is None
    reason = "gmsh cannot be imported: libGLU.so.1: cannot open shared object file"
    assert found["refused"].startswith(reason + "; as root: apt-get install libgl1 libglu1-mesa")


def test_the_launcher_is_that_of_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own, other = tmp_path / "own", tmp_path / "other"
    for folder in (own, other):
        folder.mkdir()
        (folder / "mpirun").write_text("#!/bin/sh")
        (folder / "mpirun").chmod(0o755)
    monkeypatch.setenv("PATH", str(other))
    monkeypatch.setattr(sysconfig, "get_path", lambda _: str(tmp_path))
    monkeypatch.setattr(sys, "executable", str(own / "python"))
    assert processes.launcher() == str(own / "mpirun")
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    assert processes.launcher() == str(other / "mpirun")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert processes.launcher() is None


def test_a_process_alone_among_several_is_refused(tmp_path: Path) -> None:
    # What the mpirun of another MPI sets: this process is one of two, its MPI knows of one.
    scene = tmp_path / "scene.json"
    solid = {"geometry": "solid", "elements_per_contact_radius": 2}
    scene.write_text(json.dumps(document(reference=solid)), encoding="utf-8")
    command = [sys.executable, "-m", "fem_reference", "solve", "--np", "2"]
    command += ["--scene", str(scene), "--out", str(tmp_path / "out")]
    environment = {**os.environ, "SLURM_STEP_NUM_TASKS": "2"}
    ended = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 12
    assert "belongs to another MPI" in json.loads(ended.stdout.splitlines()[-1])["message"]


def test_linear_algebra_has_one_thread() -> None:
    environment = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"}
    code = "import os, fem_reference; print(os.environ['OPENBLAS_NUM_THREADS'])"
    printed = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert printed.stdout.strip() == "1"
