"""Files of a record as instruments and programs write them: what `records.py` has read.

Layouts of text are those that the makers describe, or that public readers of such files expect; the
source stands at each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import nptdms
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pyuff
from record_signals import Record
from scipy import io
from scipy.io import wavfile

OUTER, INNER = "outer_velocity", "inner_velocity"


@dataclass(frozen=True)
class Form:
    """A form of files."""

    suffix: str
    write: Callable[[Path, Record], None]
    map: str = ""
    """Of `--map`; where it is empty the headings say enough."""


def even(record: Record) -> tuple[float, float]:
    """First time and interval of a record, s."""
    time = record.time
    return float(time[0]), float((time[-1] - time[0]) / (len(time) - 1))


def rows(
    record: Record,
    separator: str = ",",
    *,
    units: tuple[float, float, float] = (1.0, 1.0, 1.0),
    form: tuple[str, str, str] = ("%.9e", "%.7e", "%.7e"),
    decimal: str = ".",
) -> list[str]:
    """Time, outer and inner velocity of every sample, in units of that size."""
    columns = (record.time, record.values[OUTER], record.values[INNER])
    lines = []
    for row in zip(*columns, strict=True):
        cells = [f % (v / unit) for f, v, unit in zip(form, row, units, strict=True)]
        lines.append(separator.join(cells).replace(".", decimal))
    return lines


def write(file: Path, lines: list[str], *, encoding: str = "utf-8", newline: str = "\n") -> None:
    """Write lines of text."""
    file.write_bytes((newline.join(lines) + newline).encode(encoding))


def plain(file: Path, record: Record) -> None:
    """As the guide shows it."""
    write(file, ["time,outer_velocity,inner_velocity", *rows(record)])


def tektronix(file: Path, record: Record) -> None:
    """MDO3000 and MSO 4: settings, then TIME and channels.

    Files of an MDO3014 in write-ups of its exports ("Model,MDO3014 / Firmware Version,1.20").
    """
    _, interval = even(record)
    settings = [
        "Model,MDO3014",
        "Firmware Version,1.20",
        "",
        "Waveform Type,ANALOG,,,",
        "Point Format,Y,,,",
        "Horizontal Units,s,,,",
        "Horizontal Scale,0.0001,,,",
        "Horizontal Delay,0,,,",
        f"Sample Interval,{interval:.4e},,,",
        f"Record Length,{len(record.time):e},,,",
        "Gating,0.0% to 100.0%,,,",
        "Probe Attenuation,1,1,,",
        "Vertical Units,V,V,,",
        "Vertical Offset,0,0,,",
        "Vertical Scale,0.2,0.2,,",
        "Vertical Position,0,0,,",
        ",,,,",
        ",,,,",
        ",,,,",
        "Label,,,,",
        "TIME,CH1,CH2",
    ]
    write(file, settings + rows(record))


def tektronix_old(file: Path, record: Record) -> None:
    """TDS 1000 and 2000: one channel a file, settings beside the first rows.

    The layout that the project's own reader knows; as the TDS2000 manual shows "F0000CH1.CSV".
    """
    start, interval = even(record)
    count = len(record.time)
    beside = [
        f"Record Length,{count:e}",
        f"Sample Interval,{interval:e}",
        f"Trigger Point,{-start / interval:e}",
        "Source,CH1",
        "Vertical Units,V",
        "Vertical Scale,2.000000e-01",
        "Horizontal Units,s",
        "Horizontal Scale,1.000000e-04",
        "Pt Fmt,Y",
        "Yzero,0.000000e+00",
        "Probe Atten,1.000000e+00",
        "Model Number,TDS2014C",
        "Serial Number,C000000",
        "Firmware Version,FV:v24.26",
    ]
    values = record.values[INNER]
    lines = []
    for k, (time, value) in enumerate(zip(record.time, values, strict=True)):
        lines.append(f"{beside[k] if k < len(beside) else ','},,{time:017.12f},{value:10.7f},")
    write(file, lines, newline="\r\n")


def keysight(file: Path, record: Record) -> None:
    """InfiniiVision: "x-axis,1,2" and a row of units (3000T X-Series User's Guide, chapter 24)."""
    lines = rows(record, form=("%+.9E", "%+.6E", "%+.6E"))
    write(file, ["x-axis,1,2", "second,Volt,Volt", *lines])


def lecroy(file: Path, record: Record) -> None:
    """Spreadsheet export of one trace: 9300C manual, E-11; of an HDO9404 today."""
    values = zip(record.time, record.values[INNER], strict=True)
    head = [
        "LECROYHDO9404,30152,Waveform",
        f"Segments,1,SegmentSize,{len(record.time)}",
        "Segment,TrigTime,TimeSinceSegment1",
        "#1,28-Dec-2020 13:34:10,0                 ",
        "Time,Ampl",
    ]
    write(file, head + [f"{t:.9e},{v:.8f}" for t, v in values], newline="\r\n")


def rigol(file: Path, record: Record) -> None:
    """DS1000Z: numbers of samples, start and interval beside the units; as its readers quote it."""
    start, interval = even(record)
    both = zip(record.values[OUTER], record.values[INNER], strict=True)
    head = ["X,CH1,CH2,Start,Increment,", f"Sequence,Volt,Volt,{start:.6e},{interval:.6e}"]
    write(file, head + [f"{k},{o:.6e},{i:.6e}," for k, (o, i) in enumerate(both)], newline="\r\n")


def digilent(file: Path, record: Record) -> None:
    """WaveForms: comments, an empty line, units in the headings; as its readers expect it."""
    _, interval = even(record)
    head = [
        "#Digilent WaveForms Oscilloscope Acquisition",
        "#Device Name: Discovery2",
        "#Serial Number: SN:000000000000",
        "#Date Time: 2026-09-28 00:00:00.000.000.000",
        f"#Sample rate: {1.0 / interval:.6g}Hz",
        f"#Samples: {len(record.time)}",
        "#Trigger: Source: Channel 1 Type: Edge Condition: Rising Level: 0 V",
        "",
        "Time (s),Channel 1 (V),Channel 2 (V)",
    ]
    write(file, head + rows(record), newline="\r\n")


def picoscope(file: Path, record: Record) -> None:
    """PicoScope 6 of a German system: units in brackets below the headings, an empty line."""
    lines = rows(record, ";", units=(1e-3, 1e-3, 1e-3), form=("%.8f", "%.8f", "%.8f"), decimal=",")
    write(file, ["Zeit;Kanal A;Kanal B", "(ms);(mV);(mV)", "", *lines], newline="\r\n")


def catman(file: Path, record: Record) -> None:
    """HBM catmanEasy: Latin-1, tabs, headings in line 9, values from line 39.

    As public readers skip it: headings at `lines[8]`, values at `lines[38:]`.
    """
    count = len(record.time)
    names = ["Time  1 - default sample rate", "Kugel außen", "Kugel innen"]
    head = [
        "HBM_CATMAN_DATAFILE",
        "",
        "File: Stoß.TXT",
        "T0 = 28.09.2026 11:00:00",
        "Channels: 3",
        f"Length: {count}",
        "",
        "",
        "\t".join([*names, ""]),
        "\t".join(["s", "m/s", "m/s", ""]),
        "\t".join([f"Messwerte: {count}"] * 3 + [""]),
        "\t".join(["Kanal=0", "Kanal=1", "Kanal=2", ""]),
        *["\t".join([f"Sensor-Info {k}: µ"] * 3 + [""]) for k in range(26)],
    ]
    lines = [row + "\t" for row in rows(record, "\t", decimal=",")]
    write(file, head + lines, encoding="latin-1", newline="\r\n")


def labview(file: Path, record: Record) -> None:
    """LVM: NI's "Specification for the LabVIEW Measurement File", one column of times."""
    start, interval = even(record)
    pairs = {
        "LabVIEW Measurement": "",
        "Writer_Version": "2",
        "Reader_Version": "2",
        "Separator": "Tab",
        "Decimal_Separator": ".",
        "Multi_Headings": "No",
        "X_Columns": "One",
        "Time_Pref": "Absolute",
        "Operator": "lab",
        "Date": "2026/09/28",
        "Time": "14:41:45.5111323470585990021",
        "***End_of_Header***": "",
    }
    of_channels = {
        "Channels": ("2", ""),
        "Samples": (str(len(record.time)),) * 2,
        "Date": ("2026/09/28",) * 2,
        "Time": ("14:41:45.5111323470585990021",) * 2,
        "Y_Unit_Label": ("m/s", "m/s"),
        "X_Dimension": ("Time", "Time"),
        "X0": (f"{start:.16E}",) * 2,
        "Delta_X": (f"{interval:.10E}",) * 2,
        "***End_of_Header***": ("", ""),
    }
    head = [f"{name}\t{value}" for name, value in pairs.items()] + ["\t"]
    head += [f"{name}\t{a}\t{b}\t" for name, (a, b) in of_channels.items()]
    head += ["X_Value\tLDV outer\tLDV inner\tComment"]
    lines = rows(record, "\t")
    write(file, [*head, lines[0] + "\tran", *lines[1:]], newline="\r\n")


def decimal_commas(file: Path, record: Record) -> None:
    """Semicolons and decimal commas, units in the headings."""
    lines = rows(record, ";", units=(1e-6, 1e-3, 1e-3), form=("%.4f", "%.5f", "%.5f"), decimal=",")
    write(file, ["time [us];outer_velocity [mm/s];inner_velocity [mm/s]", *lines])


def quoted(file: Path, record: Record) -> None:
    """Decimal commas between quotation marks, commas between columns."""
    lines = rows(
        record, '","', units=(1e-6, 1e-3, 1e-3), form=("%.4f", "%.5f", "%.5f"), decimal=","
    )
    # the commas between the columns are no decimal signs
    write(
        file, ["time [us],outer_velocity [mm/s],inner_velocity [mm/s]"] + [f'"{x}"' for x in lines]
    )


def utf16(file: Path, record: Record) -> None:
    """Tabs in UTF-16, as Excel's "Unicode text"."""
    lines = rows(record, "\t", units=(1e-6, 1.0, 1.0), form=("%.4f", "%.7f", "%.7f"))
    head = "time [µs]\touter_velocity [m/s]\tinner_velocity [m/s]"
    write(file, [head, *lines], encoding="utf-16", newline="\r\n")


def latin1(file: Path, record: Record) -> None:
    """Spaces in Latin-1, comments before the headings."""
    lines = rows(record, "   ", units=(1e-6, 1.0, 1.0), form=("%12.4f", "%11.7f", "%11.7f"))
    head = ["# Stoß, gemessen in µs", "# time outer_velocity inner_velocity", "# µs m/s m/s"]
    write(file, head + lines, encoding="latin-1")


def index_and_units(file: Path, record: Record) -> None:
    """A column of row numbers and a row of units."""
    lines = rows(record, units=(1e-6, 1e-3, 1e-3), form=("%.4f", "%.5f", "%.5f"))
    head = [",time,outer_velocity,inner_velocity", ",us,mm/s,mm/s"]
    write(file, head + [f"{k},{line}" for k, line in enumerate(lines)])


def uff(file: Path, record: Record, binary: int = 0) -> None:
    """Data sets 58, one a signal; 58b is binary."""
    start, interval = even(record)
    functions: list[dict[str, Any]] = []
    for node, name in enumerate((OUTER, INNER), start=1):
        functions.append(
            {"type": 58, "binary": binary, "func_type": 1, "id1": name}
            | {"rsp_node": node, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3}
            | {"data": record.values[name], "x": record.time, "num_pts": len(record.time)}
            | {"abscissa_spacing": 1, "abscissa_min": start, "abscissa_inc": interval}
            | {"abscissa_spec_data_type": 17, "abscissa_axis_units_lab": "s"}
            | {"ordinate_spec_data_type": 11, "ordinate_axis_units_lab": "m/s"}
            | {"orddenom_spec_data_type": 0, "ord_data_type": 4}
        )
    file.unlink(missing_ok=True)
    pyuff.UFF(str(file)).write_sets(functions, mode="add")


def uff_binary(file: Path, record: Record) -> None:
    """Data sets 58b."""
    uff(file, record, binary=1)


def tdms(file: Path, record: Record) -> None:
    """Waveforms of a group, as LabVIEW writes them."""
    start, interval = even(record)
    waveform = {"wf_start_offset": start, "wf_increment": interval, "unit_string": "mm/s"}
    channels = [
        nptdms.ChannelObject("impact", name, 1e3 * record.values[name], properties=waveform)
        for name in (OUTER, INNER)
    ]
    with nptdms.TdmsWriter(str(file)) as writer:
        writer.write_segment(channels)


def matlab5(file: Path, record: Record) -> None:
    """Vectors, sampling rate and start."""
    start, interval = even(record)
    content: dict[str, Any] = {name: record.values[name] for name in (OUTER, INNER)}
    io.savemat(file, content | {"Fs": 1.0 / interval, "t0": start}, do_compression=True)


def matlab73(file: Path, record: Record) -> None:
    """Rows of numbers behind a header of 512 bytes."""
    content = {"time": record.time} | {name: record.values[name] for name in (OUTER, INNER)}
    with h5py.File(file, "w", userblock_size=512) as made:
        for name, values in content.items():
            made[name] = values[:, None]
            made[name].attrs["MATLAB_class"] = np.bytes_("double")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Sep 28 11:00:00 2026 HDF5"
    with file.open("r+b") as stream:
        stream.write(head.ljust(124) + b"\x00\x02IM")


def hdf5(file: Path, record: Record) -> None:
    """Data sets with units."""
    content = {"time": (record.time, 1e-6, "us"), OUTER: (record.values[OUTER], 1e-3, "mm/s")}
    content[INNER] = (record.values[INNER], 1.0, "m/s")
    with h5py.File(file, "w") as made:
        for name, (values, size, unit) in content.items():
            made[name] = values / size
            made[name].attrs["unit"] = unit


def parquet(file: Path, record: Record) -> None:
    """Columns with units in their names."""
    columns = {"time [us]": 1e6 * record.time, f"{OUTER} [mm/s]": 1e3 * record.values[OUTER]}
    pq.write_table(pa.table(columns | {f"{INNER} [m/s]": record.values[INNER]}), file)


def wav(file: Path, record: Record) -> None:
    """16 bits, two channels, full scale 1 m/s; it knows no start."""
    _, interval = even(record)
    both = np.column_stack([record.values[OUTER], record.values[INNER]])
    wavfile.write(file, round(1.0 / interval), np.round(both * 2**15).astype(np.int16))


def volts(outer: str, inner: str, time: str = "", unit: str = "V") -> str:
    """Columns of a map: headings or numbers of both signals, which have 1 m/s a volt."""

    def column(name: str) -> str:
        return name if name.isdigit() else f'"{name}"'

    sensor = f'unit = "{unit}", sensitivity = "1 m/s/V"'
    lines = ["[columns]", time] if time else ["[columns]"]
    if outer:
        lines.append(f"{OUTER} = {{ column = {column(outer)}, {sensor} }}")
    lines.append(f"{INNER} = {{ column = {column(inner)}, {sensor} }}")
    return "\n".join(lines) + "\n"


def forms(record: Record) -> dict[str, Form]:
    """All forms, with maps for a record."""
    seconds = 'time = {{ column = {}, unit = "s" }}'.format
    direct = f'[columns]\n{seconds(1)}\n{OUTER} = {{ column = 2, unit = "m/s" }}\n'
    direct += f'{INNER} = {{ column = 3, unit = "m/s" }}\n'
    full = '{} = {{ column = {}, sensitivity = "1 m/s" }}\n'.format
    start, interval = even(record)
    zero = f'[time]\nstart = "{start:.9e} s"\ninterval = "{interval:.9e} s"\n[columns]\n'
    tdms_map = f'[columns]\n{OUTER} = {{ column = "impact/{OUTER}" }}\n'
    tdms_map += f'{INNER} = {{ column = "impact/{INNER}" }}\n'
    milli = 'time = { column = "Zeit" }'
    return {
        "plain CSV": Form("csv", plain),
        "Tektronix MDO3000": Form("csv", tektronix, volts("CH1", "CH2", seconds('"TIME"'))),
        "Tektronix TDS2000, inner alone": Form("csv", tektronix_old, volts("", "5", seconds(4))),
        "Keysight InfiniiVision": Form(
            "csv", keysight, volts("2", "3", seconds('"x-axis"'), "Volt")
        ),
        "LeCroy, inner alone": Form("csv", lecroy, volts("", "Ampl", seconds('"Time"'))),
        "Rigol DS1000Z": Form("csv", rigol, volts("CH1", "CH2")),
        "Digilent WaveForms": Form(
            "csv", digilent, volts("Channel 1 (V)", "Channel 2 (V)", seconds('"Time (s)"'))
        ),
        "PicoScope 6, German": Form("csv", picoscope, volts("Kanal A", "Kanal B", milli, "mV")),
        "HBM catman": Form("txt", catman, direct),
        "NI LVM": Form("lvm", labview, direct),
        "`;` and decimal commas": Form("csv", decimal_commas),
        "quoted decimal commas": Form("csv", quoted),
        "tabs, UTF-16": Form("txt", utf16),
        "spaces, Latin-1": Form("dat", latin1),
        "row numbers, row of units": Form("csv", index_and_units),
        "UFF 58": Form("uff", uff),
        "UFF 58b": Form("uff", uff_binary),
        "TDMS": Form("tdms", tdms, tdms_map),
        "MATLAB 5": Form("mat", matlab5),
        "MATLAB 7.3": Form("mat", matlab73),
        "HDF5": Form("h5", hdf5),
        "Parquet": Form("parquet", parquet),
        "WAV": Form("wav", wav, zero + full(OUTER, 1) + full(INNER, 2)),
    }
