"""Records in binary formats for tests: written by the libraries of others, and read back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fem_reference.common.errors import SceneError, SolverError
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


def write_tdms(file: Path, channels: dict[tuple[str, str], tuple[Any, dict[str, Any]]]) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(str(file)) as writer:
        writer.write_segment(
            [nptdms.ChannelObject(*path, *content) for path, content in channels.items()]
        )


def write_matlab73(file: Path, content: dict[str, tuple[str, Any]]) -> None:
    """A file as MATLAB writes it: 512 bytes of its own, matrices transposed, classes stated."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(file, "w", userblock_size=512) as made:
        for name, (kind, values) in content.items():
            made[name] = np.atleast_2d(values).T
            made[name].attrs["MATLAB_class"] = np.bytes_(kind)
    with file.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512))
