"""Records in binary formats: written by the libraries of others, read back as they were."""

from __future__ import annotations

import argparse
import json
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

from fem_reference.common.errors import SceneError, SolverError
from fem_reference.records.command import COLUMNS
from fem_reference.records.guard import guarded
from fem_reference.records.record import convert

FORCE = 40.0 * np.sin(np.linspace(0.0, 3.0, 57)) ** 2
VELOCITY = np.linspace(-1.5, 0.25, 57)
UNEVEN = np.cumsum(np.linspace(1e-6, 5e-6, 57))


def read(file: Path) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """Format, descriptions and numbers, by name; the place of a column is under ``place``."""
    out = file.with_name("columns")
    convert(file, out)
    head, _, data = out.read_bytes().partition(b"\n")
    document = json.loads(head)
    numbers = np.frombuffer(data, "<f8")
    ends = np.cumsum([column["rows"] for column in document["columns"]])
    assert ends[-1] == numbers.size
    about, values = {}, {}
    for k, column in enumerate(document["columns"]):
        name = column.pop("name")
        assert name not in about
        about[name] = {**column, "place": k}
        values[name] = numbers[ends[k] - column["rows"] : ends[k]]
    return document["format"], about, values


def refused(file: Path) -> str:
    """The sentence that refuses a file."""
    with pytest.raises((SceneError, SolverError)) as caught:
        convert(file, file.with_name("columns"))
    message = str(caught.value)
    assert file.name in message and "\n" not in message
    return message


def clock(column: dict[str, Any]) -> tuple[Any, Any, Any]:
    return column["start"], column["interval"], column["time"]


# --- UFF ---------------------------------------------------------------------------------------


def function(values: Any, times: Any, **more: Any) -> dict[str, Any]:
    """A function over time at node 12 in +Z, as pyuff writes it."""
    return {
        **{"type": 58, "func_type": 1, "rsp_node": 12, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3},
        **{"data": values, "x": times, "abscissa_spec_data_type": 17, "id1": "hammer"},
        **{"ordinate_spec_data_type": 13, "orddenom_spec_data_type": 0, "abscissa_spacing": 1},
        **{"ordinate_axis_units_lab": "N", "abscissa_axis_units_lab": "s"},
        **more,
    }


def write_uff(file: Path, *functions: dict[str, Any]) -> None:
    pyuff = pytest.importorskip("pyuff")
    # to overwrite a file, pyuff would write the first binary function without its header
    file.unlink(missing_ok=True)
    pyuff.UFF(str(file)).write_sets(list(functions), mode="add")


@pytest.mark.parametrize("binary", [0, 1])
def test_uff_has_even_and_uneven_functions_over_time(tmp_path: Path, binary: int) -> None:
    even = 0.25e-3 + 2e-5 * np.arange(57)
    spectrum = function(FORCE + 0j, even, func_type=4, abscissa_spec_data_type=18, id1="spectrum")
    write_uff(
        tmp_path / "a.uff",
        function(FORCE, even, binary=binary),
        spectrum | {"binary": binary},
        function(
            *(VELOCITY, UNEVEN),
            **{"abscissa_spacing": 0, "id1": "laser", "ordinate_axis_units_lab": "m/s"},
            binary=binary,
        ),
    )
    form, about, values = read(tmp_path / "a.uff")
    assert form == "UFF" and list(about) == ["hammer", "laser", "laser time"]
    assert (about["hammer"]["unit"], about["laser"]["unit"]) == ("N", "m/s")
    assert clock(about["hammer"]) == (pytest.approx(0.25e-3), pytest.approx(2e-5), None)
    assert clock(about["laser"]) == (None, None, about["laser time"]["place"])
    exact = 0.0 if binary else 1e-11
    assert values["hammer"] == pytest.approx(FORCE, rel=exact, abs=0.0)
    assert values["laser"] == pytest.approx(VELOCITY, rel=exact, abs=0.0)
    # text has six digits of an uneven abscissa
    assert values["laser time"] == pytest.approx(UNEVEN, rel=0.0 if binary else 1e-5, abs=0.0)


def test_uff_functions_of_one_name_are_told_apart_by_their_node(tmp_path: Path) -> None:
    even = 1e-5 * np.arange(57)
    turned = function(VELOCITY, even, rsp_node=7, rsp_dir=-1)
    write_uff(tmp_path / "a.unv", function(FORCE, even), turned)
    assert list(read(tmp_path / "a.unv")[1]) == ["hammer 12+Z", "hammer 7-X"]


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


# --- TDMS --------------------------------------------------------------------------------------


def write_tdms(file: Path, channels: dict[tuple[str, str], tuple[Any, dict[str, Any]]]) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(str(file)) as writer:
        writer.write_segment(
            [nptdms.ChannelObject(*path, *content) for path, content in channels.items()]
        )


def test_tdms_has_waveforms_of_several_rates_and_a_channel_of_times(tmp_path: Path) -> None:
    wave = {"wf_start_offset": -1e-3, "wf_increment": 2e-6, "unit_string": "N"}
    write_tdms(
        tmp_path / "a.tdms",
        {
            ("scope", "force"): (FORCE, wave),
            ("scope", "slow"): (FORCE[:9].astype(np.float32), {"wf_increment": 1e-3}),
            ("laser", "v [mm/s]"): (VELOCITY, {}),
            ("laser", "Time"): (UNEVEN, {"unit_string": "s"}),
            ("laser", "counts"): (np.arange(9, dtype=np.int16), {}),
            ("laser", "note"): (["a", "b"], {}),
        },
    )
    form, about, values = read(tmp_path / "a.tdms")
    assert form == "TDMS"
    assert set(about) == {
        *("scope/force", "scope/slow", "laser/v [mm/s]", "laser/Time", "laser/counts")
    }
    units = {name: column["unit"] for name, column in about.items() if column["unit"]}
    assert units == {"scope/force": "N", "laser/v [mm/s]": "mm/s", "laser/Time": "s"}
    assert clock(about["scope/force"]) == (-1e-3, 2e-6, None)
    assert clock(about["scope/slow"]) == (0.0, 1e-3, None)
    assert clock(about["laser/v [mm/s]"]) == (None, None, about["laser/Time"]["place"])
    assert clock(about["laser/counts"]) == clock(about["laser/Time"]) == (None, None, None)
    assert np.array_equal(values["scope/force"], FORCE)
    assert np.array_equal(values["scope/slow"], FORCE[:9].astype(np.float32).astype(float))
    assert np.array_equal(values["laser/v [mm/s]"], VELOCITY)
    assert np.array_equal(values["laser/counts"], np.arange(9.0))


def test_tdms_of_several_segments_is_one_record(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        for part in (FORCE[:20], FORCE[20:45], FORCE[45:]):
            writer.write_segment([nptdms.ChannelObject("g", "c", part, {"wf_increment": 1e-6})])
    _, about, values = read(tmp_path / "a.tdms")
    assert np.array_equal(values["g/c"], FORCE) and about["g/c"]["interval"] == 1e-6


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


# --- MATLAB 5 ----------------------------------------------------------------------------------


@pytest.mark.parametrize("compressed", [False, True])
def test_matlab_has_vectors_matrices_and_structures(tmp_path: Path, compressed: bool) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    channel = {"y": FORCE[:30], "dt": 1e-6, "Tstart": 2e-3, "name": "force"}
    content = {
        **{"t": UNEVEN, "force": FORCE.reshape(-1, 1), "pair": np.stack([FORCE, VELOCITY], 1)},
        **{"scope": channel, "counts": np.arange(9, dtype=np.int16), "note": "words"},
        **{"several": np.array([{"v": VELOCITY[:5]}, {"v": VELOCITY[:6]}], dtype=object)},
        **{"spectrum": np.array([1.0, 1j])},
    }
    scipy_io.savemat(tmp_path / "a.mat", content, do_compression=compressed)
    form, about, values = read(tmp_path / "a.mat")
    assert form == "MATLAB 5"
    assert {"t", "force", "pair(1)", "pair(2)", "scope.y", "counts"} == set(about)
    times = about["t"]["place"]
    assert all(about[name]["time"] == times for name in ("force", "pair(1)", "pair(2)"))
    assert clock(about["scope.y"]) == (2e-3, 1e-6, None)
    assert clock(about["counts"]) == clock(about["t"]) == (None, None, None)
    assert np.array_equal(values["pair(2)"], VELOCITY) and np.array_equal(values["force"], FORCE)
    assert np.array_equal(values["scope.y"], FORCE[:30]) and np.array_equal(values["t"], UNEVEN)


def test_matlab_s_rate_is_taken_where_it_is_one_only(tmp_path: Path) -> None:
    scipy_io = pytest.importorskip("scipy.io")
    file = tmp_path / "a.mat"
    scipy_io.savemat(file, {"a": FORCE, "Fs": 5e5})
    assert clock(read(file)[1]["a"]) == (0.0, 2e-6, None)
    scipy_io.savemat(file, {"a": FORCE, "Fs": 5e5, "dt": 2e-6})
    assert clock(read(file)[1]["a"]) == (0.0, 2e-6, None)
    scipy_io.savemat(file, {"a": FORCE, "Fs": 5e5, "sample_rate": 1e5})
    assert clock(read(file)[1]["a"]) == (None, None, None)


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


# --- HDF5 and MATLAB 7.3 -----------------------------------------------------------------------


def test_hdf5_has_groups_units_and_rates(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    file = tmp_path / "a.h5"
    with h5py.File(file, "w") as made:
        made["scope/force"] = FORCE
        made["scope/force"].attrs["unit"] = "N"
        made["scope/fs"] = 500.0
        made["scope/fs"].attrs["units"] = "kHz"
        made["laser/inner/v"] = VELOCITY.astype(np.float32)[None, :]
        made["laser/inner/v"].attrs["units"] = np.bytes_("m/s")
        made["laser/time"] = UNEVEN
        made["own"] = np.stack([FORCE, VELOCITY])
        made["own"].attrs["XDelta"] = 4e-6
        made["words"] = "text"
        made["elsewhere"] = h5py.ExternalLink("secret.h5", "/a")
    form, about, values = read(file)
    assert form == "HDF5"
    assert set(about) == {"scope/force", "laser/inner/v", "laser/time", "own(1)", "own(2)"}
    assert clock(about["scope/force"]) == (0.0, 2e-6, None)
    assert clock(about["laser/inner/v"]) == (None, None, about["laser/time"]["place"])
    assert clock(about["own(2)"]) == (0.0, 4e-6, None)
    assert [about[name]["unit"] for name in ("scope/force", "laser/inner/v")] == ["N", "m/s"]
    assert np.array_equal(values["own(2)"], VELOCITY)
    assert np.array_equal(values["laser/inner/v"], VELOCITY.astype(np.float32).astype(float))


def write_matlab73(file: Path, content: dict[str, tuple[str, Any]]) -> None:
    """A file as MATLAB writes it: 512 bytes of its own, matrices transposed, classes stated."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(file, "w", userblock_size=512) as made:
        for name, (kind, values) in content.items():
            made[name] = np.atleast_2d(values).T
            made[name].attrs["MATLAB_class"] = np.bytes_(kind)
    with file.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512))


def test_matlab_7_3_has_structures_and_no_text(tmp_path: Path) -> None:
    words = np.frombuffer(b"words", np.uint8).astype(np.uint16)
    content = {
        "force": ("double", FORCE.reshape(-1, 1)),
        "scope/v": ("double", VELOCITY),
        "scope/Ts": ("double", 1e-6),
        "square": ("int16", np.arange(9).reshape(3, 3)),
        "note": ("char", words),
        "#refs#/a": ("double", FORCE),
    }
    write_matlab73(tmp_path / "a.mat", content)
    form, about, values = read(tmp_path / "a.mat")
    assert form == "MATLAB 7.3"
    assert set(about) == {"force", "scope.v", "square(1)", "square(2)", "square(3)"}
    assert clock(about["scope.v"]) == (0.0, 1e-6, None)
    assert clock(about["force"]) == (None, None, None)
    assert np.array_equal(values["square(1)"], [0.0, 3.0, 6.0])
    assert np.array_equal(values["scope.v"], VELOCITY)


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


# --- Parquet -----------------------------------------------------------------------------------


def test_parquet_has_units_gaps_and_instants(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    file = tmp_path / "a.parquet"
    gaps = [None if k == 3 else float(v) for k, v in enumerate(FORCE)]
    # microseconds, some time in 2023
    instants = 1_700_000_000_000_000 + np.round(1e6 * UNEVEN).astype(np.int64)
    columns = {
        "force [N]": pa.array(gaps),
        "v": pa.array(VELOCITY.astype(np.float32)),
        "when": pa.array(instants, pa.timestamp("us", tz="UTC")),
        "on": pa.array([None, *([True, False] * 28)]),
        "words": pa.array(["a"] * 57),
    }
    table = pa.table(columns)
    stated = table.schema.field("v").with_metadata({"unit": "m/s"})
    parquet.write_table(table.cast(table.schema.set(1, stated)), file)
    form, about, values = read(file)
    assert form == "Parquet" and list(about) == ["force [N]", "v", "when", "on"]
    assert [about[name]["unit"] for name in about] == ["N", "m/s", "s", None]
    assert [about[name]["time"] for name in about] == [2, 2, None, 2]
    assert np.isnan(values["force [N]"][3])
    assert np.array_equal(np.delete(values["force [N]"], 3), np.delete(FORCE, 3))
    assert values["when"] == pytest.approx(UNEVEN - UNEVEN[0], abs=1e-6)
    assert np.array_equal(values["on"][1:3], [1.0, 0.0]) and np.isnan(values["on"][0])


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


# --- WAV ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "unit", "zero"), [("i2", 2**15, 0), ("i4", 2**31, 0), ("u1", 128, 128), ("f4", 1, 0)]
)
def test_wav_is_scaled_to_full_scale(tmp_path: Path, kind: str, unit: int, zero: int) -> None:
    wavfile = pytest.importorskip("scipy.io.wavfile")
    samples = np.array([[0.0, -1.0], [0.5, 0.25], [-0.125, 0.75]])
    wavfile.write(tmp_path / "a.wav", 96_000, (samples * unit + zero).astype(kind))
    form, about, values = read(tmp_path / "a.wav")
    assert form == "WAV" and list(about) == ["channel 1", "channel 2"]
    for k, name in enumerate(about):
        assert np.array_equal(values[name], samples[:, k])
        assert clock(about[name]) == (0.0, 1 / 96_000, None)


def test_wav_of_24_bits_is_scaled_to_full_scale(tmp_path: Path) -> None:
    pytest.importorskip("scipy")
    import wave

    with wave.open(str(tmp_path / "a.wav"), "wb") as made:
        made.setnchannels(1)
        made.setsampwidth(3)
        made.setframerate(51_200)
        for value in (0.5, -1.0, 2.0**-23):
            made.writeframes(int(value * 2**23).to_bytes(3, "little", signed=True))
    assert list(read(tmp_path / "a.wav")[2]["channel 1"]) == [0.5, -1.0, 2.0**-23]


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


# --- all ---------------------------------------------------------------------------------------


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


def test_a_record_is_known_by_its_content(tmp_path: Path) -> None:
    wavfile = pytest.importorskip("scipy.io.wavfile")
    wavfile.write(tmp_path / "a.mat", 48_000, np.arange(100, dtype=np.int16))
    assert read(tmp_path / "a.mat")[0] == "WAV"


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
