"""Records in binary formats: written by the libraries of others, read back as they were."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from .record_files import (
    FORCE,
    UNEVEN,
    VELOCITY,
    clock,
    function,
    read,
    write_matlab73,
    write_tdms,
    write_uff,
)

# --- UFF ---------------------------------------------------------------------------------------


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


# --- TDMS --------------------------------------------------------------------------------------


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


# --- all ---------------------------------------------------------------------------------------


def test_a_record_is_known_by_its_content(tmp_path: Path) -> None:
    wavfile = pytest.importorskip("scipy.io.wavfile")
    wavfile.write(tmp_path / "a.mat", 48_000, np.arange(100, dtype=np.int16))
    assert read(tmp_path / "a.mat")[0] == "WAV"
