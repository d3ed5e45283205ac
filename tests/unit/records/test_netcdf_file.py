"""Files whose few bytes ask for the whole memory, or for other files."""

import json
import os
import subprocess
import sys

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from seacage.conventions import Origin, RecordError
from seacage.records import NetcdfMap, inspect_file, read_history, read_record
from seacage.records._netcdf_file import check_netcdf

FOREIGN = NetcdfMap(origin=Origin.MEASURED)


def huge_axis(path, length=900_000_000):
    """A time axis of 7 GB of which nothing was ever written."""
    with h5py.File(path, "w") as file:
        time = file.create_dataset("time", (length,), "f8", chunks=(1_000_000,))
        time.make_scale("time")
        time.attrs["units"] = "seconds since 2020-01-01"
        speed = file.create_dataset("speed", (length,), "f8", chunks=(1_000_000,))
        speed.dims[0].attach_scale(time)
    assert path.stat().st_size < 20_000
    return path


def deflated_axis(path):
    """As above, with zeros that were written and packed."""
    with h5py.File(path, "w") as file:
        file.create_dataset(
            "time", data=np.zeros(4_000_000), chunks=(4_000_000,), compression=9, shuffle=True
        )
        file.create_dataset("more", (300_000_000,), "f8", chunks=(4_000_000,))
    return path


def one_text(path):
    with h5py.File(path, "w") as file:
        file.create_dataset("t", (100_000,), h5py.string_dtype(), fillvalue="x" * 100_000)
    return path


def linked(path):
    with h5py.File(path, "w") as file:
        file["time"] = h5py.ExternalLink("/etc/other.h5", "/time")
    return path


def outside(path):
    with h5py.File(path, "w") as file:
        file.create_dataset("time", (8,), "u1", external=[("/etc/passwd", 0, 8)])
    return path


def virtual(path):
    layout = h5py.VirtualLayout((8,), "f8")
    layout[:] = h5py.VirtualSource("/etc/other.h5", "time", (8,))
    with h5py.File(path, "w") as file:
        file.create_virtual_dataset("time", layout)
    return path


BOMBS = {
    huge_axis: "declares 14400000000",
    deflated_axis: "declares",
    one_text: "holds 100000 texts",
    linked: "is a link to another file",
    outside: "lie in other files",
    virtual: "lie in other files",
}


@pytest.mark.parametrize("make", BOMBS, ids=lambda one: one.__name__)
def test_a_netcdf_file_is_refused_by_what_it_declares(tmp_path, make):
    path = make(tmp_path / "bomb.nc")
    for read in (
        lambda: read_record(path),
        lambda: read_record(path, columns=FOREIGN),
        lambda: inspect_file(path),
        lambda: read_history(path),
    ):
        with pytest.raises(RecordError, match=f"bomb.nc: .*{BOMBS[make]}"):
            read()


def test_one_point_of_a_large_grid_is_read_though_the_whole_is_not(tmp_path):
    path = tmp_path / "grid.nc"
    with h5py.File(path, "w") as file:
        file.create_dataset("hs", (1000, 1000, 1000), "f8", chunks=(100, 10, 10))
    check_netcdf(path, whole=False)
    with pytest.raises(ValueError, match="declares 8000000000"):
        check_netcdf(path, whole=True)


def repeated_cells(path):
    index = pa.array(np.zeros(12_000_000, dtype=np.int32))
    table = pa.table({"a": pa.DictionaryArray.from_arrays(index, pa.array([1.0]))})
    pq.write_table(table, path, compression="zstd")
    return path


def long_list(path):
    values = pa.ListArray.from_arrays(pa.array([0, 12_000_000], pa.int32()), pa.nulls(12_000_000))
    pq.write_table(pa.table({"a": values}), path, compression="zstd")
    return path


def long_text(path):
    pq.write_table(pa.table({"a": ["x" * (140 << 20)]}), path, compression="zstd")
    return path


@pytest.mark.parametrize(
    "make", [repeated_cells, long_list, pytest.param(long_text, marks=pytest.mark.slow)]
)
def test_a_parquet_file_is_refused_by_what_it_declares(tmp_path, make):
    path = make(tmp_path / "bomb.parquet")
    assert path.stat().st_size < 1_000_000
    with pytest.raises(RecordError, match=r"bomb\.parquet: .*it declares \d+ cells and \d+ bytes"):
        read_record(path)


def test_a_text_that_is_repeated_is_kept_once(tmp_path):
    path = tmp_path / "buoy.parquet"
    index = pa.array([*[0] * 50_000, None], pa.int32())
    text = pa.DictionaryArray.from_arrays(index, pa.array(["x" * 1_000_000]))
    pq.write_table(pa.table({"a": text}), path)  # as cells of their own these were 50 GB
    with pytest.raises(RecordError, match="no shipped column map"):
        read_record(path)


@pytest.mark.parametrize("name", ["buoy.csv", "buoy.parquet", "buoy.json", "own.nc"])
@pytest.mark.parametrize("target", ["pipe", "/dev/zero"])
def test_a_link_to_no_file_is_refused_at_once(tmp_path, name, target):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / name).symlink_to(tmp_path / target)
    with pytest.raises(RecordError, match=name):
        read_record(tmp_path / name)


def test_refusing_a_bomb_takes_no_memory(tmp_path):
    paths = [
        huge_axis(tmp_path / "axis.nc"),
        deflated_axis(tmp_path / "deflated.nc"),
        repeated_cells(tmp_path / "cells.parquet"),
        long_list(tmp_path / "list.parquet"),
    ]
    deep = tmp_path / "deep.json"
    deep.write_text("[" * 1_000_000)
    script = (
        "import resource, sys, h5py, xarray, h5netcdf, pyarrow.parquet, seacage.records as r\n"
        "most = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024\n"
        "before, refused = most(), 0\n"
        "for path in sys.argv[1:]:\n"
        "    try:\n"
        "        r.read_record(path)\n"
        "    except ValueError:\n"
        "        refused += 1\n"
        "print('[%d, %d]' % (refused, most() - before))\n"
    )
    ran = subprocess.run(
        [sys.executable, "-c", script, *map(str, [*paths, deep])],
        capture_output=True,
        text=True,
        check=True,
    )
    refused, grown_mib = json.loads(ran.stdout)
    assert refused == 5
    assert grown_mib < 200  # 6,600 MiB for the first alone before sizes were looked at
