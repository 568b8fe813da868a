"""The cache of compiled code: damaged entries are compiled again, errors name its folder."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fem_reference.common.cache import FORMS, LOOPS, VARIABLE, is_whole

ROOT = Path(__file__).parents[2]
FORM = """
from fem_reference.common.fenicsx import Domain
import numpy as np, ufl
square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
domain = Domain(square, np.array([[0, 1, 2, 3]]), components=1)
u, v = ufl.TrialFunction(domain.space), ufl.TestFunction(domain.space)
assert abs(domain.matrix(u * v * ufl.dx).sum() - 1.0) < 1e-12
"""
LOOP = "from fem_reference.explicit import kernel; assert kernel.load(2).layout(0) > 0"


def run(code: str, cache: Path, **changes: str) -> subprocess.CompletedProcess[str]:
    lines = ["from fem_reference.common.cache import use_writable_cache as use; use()", code]
    return subprocess.run(
        [sys.executable, "-c", "\n".join(lines)],
        cwd=ROOT,
        env={**os.environ, VARIABLE: str(cache), **changes},
        capture_output=True,
        text=True,
        check=False,
    )


def half(library: Path) -> None:
    os.truncate(library, library.stat().st_size // 2)


def end_of_zeros(library: Path) -> None:
    """As after a power failure: the size is right, the last blocks were never written."""
    size = library.stat().st_size
    os.truncate(library, size - 3000)
    os.truncate(library, size)


def zeros(library: Path) -> None:
    library.write_bytes(b"\0" * library.stat().st_size)


DAMAGES: list[Callable[[Path], None]] = [
    lambda library: os.truncate(library, 0),
    half,
    end_of_zeros,
    lambda library: os.truncate(library, library.stat().st_size - 1),
    zeros,
    Path.unlink,
]


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cache")
    for code in (FORM, LOOP):
        made = run(code, folder)
        assert made.returncode == 0, made.stderr
    return folder


def test_a_damaged_library_is_not_whole(cache: Path, tmp_path: Path) -> None:
    made = next((cache / LOOPS).glob("*.so"))
    assert is_whole(made)
    for damage in DAMAGES:
        copy = tmp_path / made.name
        copy.write_bytes(made.read_bytes())
        damage(copy)
        assert not is_whole(copy)


@pytest.mark.parametrize(("folder", "code"), [(FORMS, FORM), (LOOPS, LOOP)])
def test_damaged_code_is_compiled_again(cache: Path, folder: Path, code: str) -> None:
    libraries = list((cache / folder).glob("*.so"))
    assert libraries
    for library in libraries:
        half(library)
    again = run(code, cache)
    assert again.returncode == 0, again.stderr
    assert all(map(is_whole, libraries))


def test_what_a_full_disk_left_is_compiled_again(cache: Path) -> None:
    """The mark of a compiled form was made, but could not be written: the form counts as failed."""
    source = next((cache / FORMS).glob("libffcx_forms_*.c"))
    source.replace(source.with_suffix(".c.failed"))
    again = run(FORM, cache)
    assert again.returncode == 0, again.stderr


@pytest.mark.parametrize(("folder", "code"), [(FORMS, FORM), (LOOPS, LOOP)])
def test_a_full_cache_is_named(tmp_path: Path, folder: Path, code: str) -> None:
    # MPI makes files of its own when it starts
    limit = "from fem_reference.common.supported import MPI; import resource\n"
    limit += "resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))\n"
    full = run(limit + code, tmp_path)
    assert full.returncode != 0
    assert "SolverError" in full.stderr
    assert f"the cache folder {tmp_path / folder}" in full.stderr.splitlines()[-1]


def test_a_cache_that_cannot_be_written_is_replaced_by_a_temporary_one(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "temporary").mkdir()
    there = run(LOOP, tmp_path / "file" / "cache", TMPDIR=str(tmp_path / "temporary"))
    assert there.returncode == 0, there.stderr
    assert list((tmp_path / "temporary").glob(f"impactcheck-cache-*/{LOOPS}/kernel-2-*.so"))
