"""Current profilers: bins at a distance from an instrument that moves become depths."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from pd0 import ensemble
from seacage.conventions import Origin, RecordError, towards
from seacage.records import (
    ColumnMap,
    NetcdfMap,
    ProfilerMap,
    Record,
    bin_keys,
    current_bins,
    read_map,
    read_record,
    shipped_maps,
)

MAP = """\
kind = "profiler"
title = "ADCP"
origin = "measured"
time_zone = "+01:00"
looking = "up"
declination_deg = 0
first_bin_m = 2.0
bin_m = 1.0
"""
START = datetime(2020, 1, 18, 12, tzinfo=UTC)  # by the instrument's clock
BOTTOM = 20.0  # m


def true_current(depth):
    """Straight over depth, with a veer (east, north) [m/s]."""
    return np.stack([0.5 - 0.01 * depth, 0.1 + 0.005 * depth], axis=-1)


def tide(row):
    return BOTTOM + 1.5 * np.sin(row / 3.0)


def text(rows=40, bins=17):
    """Three rows a time, of an instrument on the bottom under a tide."""
    lines = [
        f"Num,Year,Month,Day,Hour,Min,Sec,{kind}"
        for kind in ("SensorDepth", "WaterSpeed", "WaterDirection")
    ]
    for row in range(rows):
        t = START + timedelta(minutes=10 * row)
        lead = f"{row + 1},{t:%Y,%m,%d,%H,%M},00.00,"
        current = true_current(tide(row) - 2.0 - np.arange(bins))
        speed, to = np.hypot(*current.T), np.degrees(np.arctan2(*current.T)) % 360.0
        lines += [lead + f"{tide(row):.4f}"]
        lines += [lead + ",".join(f"{one:.5f}" for one in each) for each in (speed, to)]
    return "\n".join(lines) + "\n"


def written(folder, content, name="adcp.txt"):
    path = folder / name
    path.write_text(content) if isinstance(content, str) else path.write_bytes(content)
    return path


def test_bins_over_the_bottom_become_depths_whatever_the_tide(tmp_path):
    (tmp_path / "map.toml").write_text(MAP + "depth_m = 8.25\n")
    chosen = read_map(tmp_path / "map.toml")
    record = read_record(written(tmp_path, text()), columns=chosen)
    assert str(record.time[0]) == "2020-01-18T11:00:00.000000"  # an hour less than its clock
    depths = current_bins(record.values)
    assert len(depths) > 12
    for depth in depths:
        speed, to = (record.values[key] for key in bin_keys(depth))
        known = np.isfinite(speed)
        found = towards(speed[known], to[known])
        np.testing.assert_allclose(
            found, np.broadcast_to(true_current(depth), found.shape), atol=1.1e-3
        )
    middle = towards(record.values["current_speed_m_s"], record.values["current_to_deg"])
    np.testing.assert_allclose(middle - true_current(8.25), 0.0, atol=1.1e-3)


def test_bins_that_may_see_the_surface_are_left_out(tmp_path):
    path = written(tmp_path, text())
    clean = read_record(path, columns=ProfilerMap.from_toml(MAP))
    whole = read_record(path, columns=ProfilerMap.from_toml(MAP + "beam_deg = 0\n"))
    # beyond cos(25) of the way of 20 m, less a bin
    assert min(current_bins(clean.values)) > 20.0 * (1.0 - np.cos(np.radians(25.0)))
    assert min(current_bins(whole.values)) < 2.5


def test_magnetic_directions_are_turned_and_profiles_averaged(tmp_path):
    path = written(tmp_path, text(rows=36))
    true = read_record(path, columns=ProfilerMap.from_toml(MAP))
    turned = MAP.replace("declination_deg = 0", "declination_deg = 10") + "average_s = 3600\n"
    record = read_record(path, columns=ProfilerMap.from_toml(turned))
    assert len(record) == 6
    assert str(record.time[0]) == "2020-01-18T11:30:00.000000"  # the middle of its hour
    key = bin_keys(current_bins(true.values)[3])[1]
    assert record.values[key][0] == pytest.approx((true.values[key][0] + 10.0) % 360.0, abs=2.0)


def test_a_raw_file_is_read_at_depths_below_a_buoy(tmp_path):
    pytest.importorskip("mhkit")
    velocity = true_current(1.0 + 2.5 + 2.0 * np.arange(8))
    velocity[6] = np.nan
    options = {"depth_m": 1.0, "first_bin_m": 2.5, "bin_m": 2.0, "up": False}
    profiles = [
        ensemble(row + 1, START + timedelta(minutes=10 * row), velocity, **options)
        for row in range(30)
    ]
    path = written(tmp_path, b"".join(profiles), "buoy.000")
    lines = [one for one in MAP.splitlines() if "bin_m" not in one]
    down = "\n".join(lines).replace('"up"', '"down"')
    record = read_record(path, columns=ProfilerMap.from_toml(down))
    assert current_bins(record.values) == (3.5, 5.5, 7.5, 9.5, 11.5, 13.5, 17.5)
    assert [one.name for one in tmp_path.iterdir()] == ["buoy.000"]  # no index beside it
    found = towards(*(record.values[key] for key in bin_keys(5.5)))
    np.testing.assert_allclose(found - true_current(5.5), 0.0, atol=1.1e-3)
    with pytest.raises(RecordError, match="looks down, and the map declares up"):
        read_record(path, columns=ProfilerMap.from_toml("\n".join(lines)))


@pytest.mark.parametrize(
    ("content", "name", "sentence"),
    [
        ("a,b\n1,2\n", "adcp.txt", "three headers"),
        (text().rsplit("\n", 2)[0] + "\n", "adcp.txt", "three headers"),
        (text().replace("12,10,00.00,0.3", "12,20,00.00,0.3", 1), "adcp.txt", "differ in time"),
        (text().replace(",20.0", ",x", 1), "adcp.txt", "'x000'"),
        (text().replace("2020,01,18,12", "2020,13,18,12"), "adcp.txt", "no time"),
        (b"\x7f\x7f no such thing" * 9, "adcp.000", "MHKiT cannot read"),
    ],
)
def test_what_is_no_profilers_file_is_refused(tmp_path, content, name, sentence):
    with pytest.raises(RecordError, match=sentence):
        read_record(written(tmp_path, content, name), columns=ProfilerMap.from_toml(MAP))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("", "depth_m = 40"), "outside its bins"),
        (("first_bin_m = 2.0", ""), "gives first_bin_m and bin_m"),
        (('"up"', '"sideways"'), 'Say "up" or "down"'),
        (('"+01:00"', '"Europe/Oslo"'), "is not one offset"),
        (("declination_deg = 0", ""), "declination_deg is missing"),
        (("declination_deg = 0", "declination_deg = 400"), "180 degrees"),
        (("bin_m = 1.0", "bin_m = -1.0"), "bin_m = -1 must be above 0"),
        (("", "instrument_depth_m = 500"), "no bin below the surface"),
        (("looking", "lookings"), "Did you mean 'looking'"),
    ],
)
def test_a_map_that_cannot_be_is_refused(tmp_path, change, sentence):
    old, new = change
    changed = MAP.replace(old, new, 1) if old else MAP + new
    if "500" in new:
        changed = changed.replace("bin_m = 1.0", "bin_m = 300.0").replace("2.0", "600.0")
    with pytest.raises(RecordError, match=sentence):
        read_record(written(tmp_path, text()), columns=ProfilerMap.from_toml(changed))


def test_a_table_of_our_keys_keeps_its_depths(tmp_path):
    keys = ["current_speed_m_s", "current_to_deg", *bin_keys(5.0), *bin_keys(12.5)]
    rows = "2020-01-18T12:00:00Z,0.3,10,0.2,20,0.1,30\n2020-01-18T12:10:00Z,0.3,11,0.2,21,0.1,31\n"
    record = read_record(written(tmp_path, f"time,{','.join(keys)}\n{rows}", "buoy.csv"))
    assert list(record.values) == keys
    half = f"time,{bin_keys(5.0)[0]}\n2020-01-18T12:00:00Z,0.2\n"
    with pytest.raises(RecordError, match="the current at 5 m is not speed with direction"):
        read_record(written(tmp_path, half, "half.csv"))


def test_one_map_reads_every_depth_of_a_table(tmp_path):
    columns = ColumnMap.from_toml(
        'title = "Model"\norigin = "computed"\nprofile = true\ndepth_m = 5\n'
        '[time]\ncolumn = "t"\nformat = "iso"\nzone = "UTC"\n'
        + "".join(
            f'[columns.{name}{depth}]\nquantity = "current_{kind}"\n'
            f'unit = "m/s"\ndepth_m = {depth}\n'
            for depth in (0, 5, 15)
            for name, kind in (("u", "east"), ("v", "north"))
        )
    )
    content = "t,u0,v0,u5,v5,u15,v15\n2020-01-18T12:00,0.3,0,0,0.2,-0.1,0\n"
    record = read_record(written(tmp_path, content, "model.csv"), columns=columns)
    assert current_bins(record.values) == (0.0, 5.0, 15.0)
    assert record.values["current_to_15m_deg"][0] == 270.0
    assert record.values["current_to_deg"][0] == record.values["current_to_5m_deg"][0] == 0.0
    assert len(current_bins(plain(columns, tmp_path).values)) == 0


def plain(columns: ColumnMap, folder) -> Record:
    return read_record(folder / "model.csv", columns=replace(columns, profile=False))


def test_the_shipped_map_of_a_profile_reads_all_of_it():
    whole = replace(shipped_maps()["norkyst_current_profile"], profile=True)
    assert list(whole.bins) == [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0]


def test_every_depth_of_a_netcdf_file_is_read_and_one_is_the_buoys(tmp_path):
    xarray = pytest.importorskip("xarray")
    names = {"u": "eastward_sea_water_velocity", "v": "northward_sea_water_velocity"}
    variables = {
        name: (
            ("time", "depth"),
            np.broadcast_to([0.3, 0.2, 0.1], (2, 3)) * (name == "u"),
            {"standard_name": standard, "units": "m s-1"},
        )
        for name, standard in names.items()
    }
    coordinates = {
        "time": ("time", [0, 1], {"units": "hours since 2020-01-18"}),
        "depth": ("depth", [0.0, 5.0, 15.0], {"units": "m", "positive": "down"}),
    }
    path = tmp_path / "model.nc"
    xarray.Dataset(variables, coordinates).to_netcdf(path, engine="h5netcdf")
    record = read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED, depth_m=5.0, profile=True))
    assert current_bins(record.values) == (0.0, 5.0, 15.0)
    assert record.values["current_speed_m_s"].tolist() == [0.2, 0.2]
    assert record.values["current_speed_15m_m_s"].tolist() == [0.1, 0.1]
    with pytest.raises(RecordError, match="here 0, 5, 15 m, and one of them"):
        read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED, profile=True))
