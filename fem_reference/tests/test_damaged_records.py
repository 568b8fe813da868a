"""Damaged records, and those that claim or unpack to more than is read: one sentence each."""

from __future__ import annotations

import argparse
import os
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.common.errors import SceneError
from fem_reference.records.command import COLUMNS
from fem_reference.records.guard import guarded

from .record_files import FORCE, VELOCITY, function, refused, write_tdms, write_uff


def test_uff_without_times_or_cut_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.uff"
    even = 1e-5 * np.arange(57)
    write_uff(file, function(FORCE, even, abscissa_spec_data_type=18, func_type=2))
    assert "none of its 1 functions is real and over time" in refused(file)
    write_uff(file, function(FORCE, even), function(FORCE, even))
    whole = file.read_bytes()
    file.write_bytes(whole[:-300])
    assert "it is cut: its last line is not the end of a data set" in refused(file)
    file.write_bytes(whole.replace(b"        57", b"3000000000"))
    assert "has 3000000000 samples; at most 20000000 are read" in refused(file)
    file.write_bytes(whole.replace(b"        57", b"        58"))
    assert "has 57 samples, its header states 58" in refused(file)


def test_tdms_that_is_cut_or_claims_too_much_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.tdms"
    write_tdms(file, {("g", "c"): (FORCE, {})})
    whole = file.read_bytes()
    file.write_bytes(whole[:-100])
    assert f"has {len(whole)} bytes, the file {len(whole) - 100}" in refused(file)
    # the segment has 3 GB
    file.write_bytes(whole[:12] + struct.pack("<Q", 3_000_000_000) + whole[20:])
    assert "it is cut: the segment at byte 0 has 3000000028 bytes" in refused(file)
    # the channel has 3e9 samples in a segment of 57
    file.write_bytes(whole.replace(struct.pack("<Q", 57), struct.pack("<Q", 3_000_000_000)))
    assert "has 57 samples, its header states 3000000000" in refused(file)
    write_tdms(file, {("g", "c"): (["only", "words"], {})})
    assert "it has no channel of numbers" in refused(file)


def test_matlab_that_is_cut_or_claims_too_much_is_refused(tmp_path: Path) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    file = tmp_path / "a.mat"
    scipy_io.savemat(file, {"a": FORCE, "b": FORCE})
    whole = file.read_bytes()
    file.write_bytes(whole[:-40])
    assert f"ends at byte {len(whole)}, the file {len(whole) - 40}" in refused(file)
    file.write_bytes(whole[:100])
    assert "its 128 bytes of header are not whole" in refused(file)
    file.write_bytes(whole.replace(struct.pack("<II", 1, 57), struct.pack("<II", 1, 400_000_000)))
    assert "channel 'a' has 400000000 samples; at most 20000000 are read" in refused(file)
    scipy_io.savemat(file, {"a": "words"})
    assert "it has no channel of numbers" in refused(file)


def test_a_bomb_in_a_structure_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    monkeypatch.setattr("fem_reference.records.matlab.MOST_BYTES", 160_000_000)
    file = tmp_path / "a.mat"
    scipy_io.savemat(file, {"s": {"a": FORCE}}, do_compression=True)
    engine, million = zlib.compressobj(1), bytes(1 << 20)
    head = zlib.decompress(file.read_bytes()[136:])
    packed = b"".join([engine.compress(head), *(engine.compress(million) for _ in range(160))])
    packed += engine.flush()
    file.write_bytes(file.read_bytes()[:128] + struct.pack("<II", 15, len(packed)) + packed)
    assert file.stat().st_size < 1e6
    assert "its variables have more than 160000000 bytes" in refused(file)


def test_hdf5_that_is_cut_or_claims_too_much_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    file = tmp_path / "a.hdf5"
    huge = {"dtype": "f8", "compression": "gzip"}

    def with_data(**more: Any) -> None:
        with h5py.File(file, "w") as made:
            made.create_dataset("a", **more)

    with_data(shape=(400_000_000,), chunks=(1_000_000,), **huge)
    assert file.stat().st_size < 10_000
    assert "channel 'a' has 400000000 samples; at most 20000000 are read" in refused(file)
    with_data(shape=(20_000_000, 19_000_000), chunks=(1000, 1000), **huge)
    assert "at most 200000000 are read" in refused(file)
    with_data(shape=(57,), maxshape=(None,), chunks=(400_000_000,), **huge)
    assert "chunks of 400000000 numbers; at most 20000000" in refused(file)
    with h5py.File(file, "w") as made:
        for k in range(11):
            made.create_dataset(f"a{k}", shape=(20_000_000,), chunks=(1_000_000,), **huge)
    assert "its 11 channels have 220000000 samples; at most 200000000" in refused(file)
    with_data(data=FORCE)
    file.write_bytes(file.read_bytes()[:-200])
    assert "truncated" in refused(file)


def test_parquet_that_is_cut_is_refused(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    file = tmp_path / "a.parquet"
    parquet.write_table(pa.table({"a": FORCE}), file)
    file.write_bytes(file.read_bytes()[:-9])
    assert "cannot be read as a Parquet file" in refused(file)
    # twenty-five million zeros take a few bytes
    parquet.write_table(pa.table({"a": np.zeros(25_000_000, np.int8)}), file)
    assert file.stat().st_size < 1e5
    assert "channel 'a' has 25000000 samples; at most 20000000 are read" in refused(file)


def test_wav_that_is_cut_or_claims_too_much_is_refused(tmp_path: Path) -> None:
    wavfile = pytest.importorskip("scipy.io.wavfile")
    file = tmp_path / "a.wav"
    wavfile.write(file, 48_000, np.arange(100, dtype=np.int16))
    whole = file.read_bytes()
    file.write_bytes(whole[:-30])
    assert "its part 'data' ends at byte 244, the file 214" in refused(file)
    file.write_bytes(whole[:40] + struct.pack("<I", 3_000_000_000) + whole[44:])
    assert "its part 'data' ends at byte 3000000044, the file 244" in refused(file)
    file.write_bytes(whole[:24] + bytes(4) + whole[28:])
    assert "it states 1 channels at 0 Hz" in refused(file)


@pytest.mark.parametrize(
    "suffix", ["uff", "unv", "tdms", "mat", "h5", "hdf5", "parquet", "wav", "bin"]
)
def test_rubbish_is_refused_whatever_it_is_called(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"a.{suffix}"
    file.write_bytes(bytes(range(200, 256)) * 9)
    assert "is in no binary format" in refused(file) or "file: it begins with" in refused(file)


@pytest.mark.parametrize(
    ("suffix", "begin", "library"),
    [
        *[("uff", b"    -1\n    58b\n", "pyuff"), ("tdms", b"TDSm", "nptdms")],
        *[("mat", b"MATLAB 5.0 ".ljust(126) + b"IM", "scipy"), ("mat", b"MATLAB 7.3 ", "h5py")],
        *[("h5", b"\x89HDF\r\n\x1a\n", "h5py"), ("parquet", b"PAR1", "pyarrow")],
        ("wav", b"RIFF\xff\xff\xff\xffWAVEfmt ", "scipy"),
    ],
)
def test_rubbish_after_the_right_beginning_is_refused(
    tmp_path: Path, suffix: str, begin: bytes, library: str
) -> None:
    pytest.importorskip(library)
    file = tmp_path / f"a.{suffix}"
    noise = np.random.default_rng(4).bytes(5000)
    for rest in (noise, b"\xff" * 5000, bytes(5000), b""):
        file.write_bytes(begin + rest)
        assert "cannot be read as a" in refused(file)


def test_a_missing_library_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nptdms", None)
    monkeypatch.delitem(sys.modules, "fem_reference.records.tdms", raising=False)
    file = tmp_path / "a.tdms"
    file.write_bytes(b"TDSm")
    assert "is a TDMS file; npTDMS reads it: pip install npTDMS" in refused(file)


def run(file: Path) -> subprocess.CompletedProcess[str]:
    out = file.parent / "made" / "columns"
    command = [sys.executable, "-m", "fem_reference", "columns", str(file), "--out", str(out)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_command_writes_all_or_one_sentence(tmp_path: Path) -> None:
    wavfile = pytest.importorskip("scipy.io.wavfile")
    file = tmp_path / "a.wav"
    file.write_bytes(b"no record")
    ended = run(file)
    assert ended.returncode == 3 and ended.stdout == "" and not list((tmp_path / "made").iterdir())
    begins = r"it begins with 'no recor', such a file with 'RIFF'"
    assert ended.stderr == f"error: {file} is no WAV file: {begins}\n"
    wavfile.write(file, 48_000, np.array([1, -2], np.int16))
    ended = run(file)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
    assert [path.name for path in (tmp_path / "made").iterdir()] == ["columns"]
    data = (tmp_path / "made" / "columns").read_bytes().partition(b"\n")[2]
    assert data == struct.pack("<2d", 2.0**-15, -(2.0**-14))
    file.unlink()
    assert "a.wav cannot be read: No such file" in refused(file)


def test_a_record_is_not_replaced_by_its_columns(tmp_path: Path) -> None:
    file = tmp_path / "a.wav"
    file.write_bytes(b"precious")
    with pytest.raises(SceneError, match="is the record itself"):
        COLUMNS.run(argparse.Namespace(file=file, out=file))
    assert file.read_bytes() == b"precious"


def test_a_library_that_crashes_or_does_not_end_is_survived(tmp_path: Path) -> None:
    file = tmp_path / "a.h5"
    with pytest.raises(SceneError, match=r"a\.h5 cannot be read: its library crashes"):
        guarded(lambda: os.kill(os.getpid(), signal.SIGSEGV), file, 30.0)
    with pytest.raises(SceneError, match=r"a\.h5 cannot be read: its library does not end"):
        guarded(lambda: time.sleep(60.0), file, 0.2)


def cut(file: Path) -> None:
    """A file without its last third."""
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) * 2 // 3])


def cut_uff(file: Path) -> None:
    write_uff(file, function(FORCE, 1e-5 * np.arange(57)), function(VELOCITY, 1e-5 * np.arange(57)))
    cut(file)


def cut_tdms(file: Path) -> None:
    write_tdms(file, {("g", "c"): (FORCE, {})})
    cut(file)


def claiming_tdms(file: Path) -> None:
    write_tdms(file, {("g", "c"): (FORCE, {})})
    file.write_bytes(file.read_bytes().replace(struct.pack("<Q", 57), struct.pack("<Q", 10**8)))


def cut_matlab(file: Path) -> None:
    pytest.importorskip("scipy.io").savemat(file, {"a": FORCE, "b": VELOCITY})
    cut(file)


def cut_hdf5(file: Path) -> None:
    with pytest.importorskip("h5py").File(file, "w") as made:
        made["a"], made["b"] = FORCE, VELOCITY
    cut(file)


def bomb_hdf5(file: Path) -> None:
    """A chunk of 57 numbers that unpacks to a gigabyte."""
    engine, million = zlib.compressobj(1), bytes(1 << 20)
    packed = b"".join([*(engine.compress(million) for _ in range(1024)), engine.flush()])
    with pytest.importorskip("h5py").File(file, "w") as made:
        data = made.create_dataset("a", (57,), "f8", chunks=(57,), compression="gzip")
        data.id.write_direct_chunk((0,), packed)


def cut_parquet(file: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    pytest.importorskip("pyarrow.parquet").write_table(pa.table({"a": FORCE}), file)
    cut(file)


def cut_wav(file: Path) -> None:
    pytest.importorskip("scipy.io.wavfile").write(file, 48_000, np.arange(99, dtype=np.int16))
    cut(file)


def claiming_wav(file: Path) -> None:
    pytest.importorskip("scipy.io.wavfile").write(file, 48_000, np.arange(99, dtype=np.int16))
    whole = file.read_bytes()
    file.write_bytes(whole[:40] + struct.pack("<I", 3_000_000_000) + whole[44:])


@pytest.mark.parametrize(
    ("name", "make", "part"),
    [
        ("cut.uff", cut_uff, "it is cut: its last line is not the end of a data set (-1)"),
        ("cut.tdms", cut_tdms, "it is cut: the segment at byte 0 has"),
        ("claims.tdms", claiming_tdms, "has 57 samples, its header states 100000000"),
        ("cut.mat", cut_matlab, "it is cut: a variable ends at byte"),
        ("cut.h5", cut_hdf5, "truncated file"),
        ("bomb.h5", bomb_hdf5, "filter returned failure"),
        ("cut.parquet", cut_parquet, "magic bytes not found in footer"),
        ("cut.wav", cut_wav, "it is cut: its part 'data' ends at byte 242"),
        ("claims.wav", claiming_wav, "its part 'data' ends at byte 3000000044"),
    ],
)
def test_a_bad_file_ends_in_a_sentence_within_bounded_memory(
    tmp_path: Path, name: str, make: Any, part: str
) -> None:
    file = tmp_path / name
    make(file)
    # a quarter of the bound for users, and of what the bomb unpacks to
    bounded = (
        "import sys, fem_reference.records.guard as guard; guard.MOST_MEMORY = 300_000_000\n"
        "from fem_reference.__main__ import main; sys.exit(main())"
    )
    command = ["columns", str(file), "--out", str(tmp_path / "columns")]
    ended = subprocess.run(
        [sys.executable, "-c", bounded, *command], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 3, ended.stderr
    assert ended.stderr.count("\n") == 1 and part in ended.stderr and name in ended.stderr
    assert not (tmp_path / "columns").exists()
