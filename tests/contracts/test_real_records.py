"""The public records that the project is tried on: read by shipped maps, and mostly good."""

import csv
import re

import numpy as np
import pytest

from public_files import public_file
from seacage.conventions import Flag, Origin, RecordError
from seacage.records import (
    Column,
    ColumnMap,
    NetcdfMap,
    ProfilerMap,
    bin_keys,
    current_bins,
    inspect_file,
    read_record,
    shipped_maps,
)


def counted(record, key):
    flags, counts = np.unique(record.flags[key], return_counts=True)
    return {Flag(flag).name: int(count) for flag, count in zip(flags, counts, strict=True)}


def test_the_winter_of_2018_is_read_whole_and_good(shared):
    record = read_record(shared / "data" / "buoy_current_s08010_2018.csv")
    assert counted(record, "current_speed_m_s") == {"GOOD": 3912}
    assert counted(record, "current_to_deg") == {"GOOD": 3912}
    assert record.origin is Origin.MEASURED
    # said of the record: mean 0.50, maximum 1.33 (1.325) m/s; steps of 6 to 30 minutes, median 12
    speed = record.values["current_speed_m_s"]
    assert np.mean(speed) == pytest.approx(0.50, abs=0.005)
    assert np.max(speed) == pytest.approx(1.325)
    assert np.median(np.diff(record.time)) == np.timedelta64(12, "m")
    assert np.max(record.values["current_to_deg"]) < 360.0


def test_the_gaps_of_2016_are_reported(shared):
    record = read_record(shared / "data" / "buoy_current_s08010_2016.csv")
    # of 429 rows the first after each of the 40 silences of more than 3 h
    assert counted(record, "current_speed_m_s") == {"GOOD": 389, "SUSPECT": 40}
    assert np.all(record.usable("current_speed_m_s"))
    assert "comes after 5.3 h of silence" in record.notes[0]


def test_the_waves_of_a_buoy_are_read_with_where_they_come_from(shared):
    record = read_record(shared / "data" / "buoy_waves_ndbc46097_2019_08.csv")
    assert counted(record, "hs_m") == {"GOOD": 744}
    first = {key: values[0] for key, values in record.values.items()}
    assert first == {"hs_m": 1.07, "tp_s": 8.3, "wave_from_deg": 295.0}


def test_the_shelf_current_is_turned_from_where_it_comes_to_where_it_goes(shared):
    path = shared / "data" / "shelf_current_profile_norkyst_2018q1.csv"
    record = read_record(path)
    assert record.origin is Origin.COMPUTED
    # its first row: 0.03 m/s at 5 m, from 66.49 degrees
    assert record.values["current_to_deg"][0] == pytest.approx(246.49)
    assert "read at a depth of 5 m" in record.notes[0]
    deep = read_record(path, columns=shipped_maps()["norkyst_current_profile"].taken_at(30.0))
    assert deep.values["current_to_deg"][0] == pytest.approx(221.83)


def test_a_hindcast_rounded_to_decimetres_is_suspect_only_where_it_stands_still(shared):
    record = read_record(shared / "data" / "waves_nora10_1977_1979.csv")
    assert counted(record, "hs_m") == {"GOOD": 4595, "SUSPECT": 21}
    assert np.all(record.usable("tp_s"))


def test_a_profilers_bin_is_read_once_its_zone_is_declared(shared):
    pytest.importorskip("xarray")
    path = shared / "data" / "adcp_awac_snippet.nc"
    found = inspect_file(path)
    finding = "Suspicious: its attribute 'comments' says 'times PDT', and times in CF are UTC."
    assert finding in found.findings
    assert 'time_zone = "?"  # "UTC" if CF holds, "-07:00" if the attribute' in found.map_text
    assert found.open_questions == 3
    for question in ("origin", "time_zone", "range_m"):
        assert f'{question} = "?"' in found.map_text
    # Its header says PDT, CF says UTC: 7 h, half a tide and more, that nobody guesses.
    message = re.escape("its attribute 'comments' says 'times PDT', and times in CF are UTC")
    with pytest.raises(RecordError, match=message):
        read_record(path, columns=NetcdfMap(origin=Origin.MEASURED, range_m=5.4))
    choice = NetcdfMap(origin=Origin.MEASURED, range_m=5.4, time_zone="-07:00")
    record = read_record(path, columns=choice)
    assert len(record) == 100
    assert str(record.time[0]) == "2012-06-12T19:00:00.000000"
    # its first ping in that bin: 0.556 m/s to the west, 0.779 m/s to the south
    assert record.values["current_speed_m_s"][0] == pytest.approx(np.hypot(0.556, 0.779), abs=1e-3)
    assert record.values["current_to_deg"][0] == pytest.approx(180.0 + 35.5, abs=0.1)


@pytest.mark.parametrize(
    ("name", "columns", "unit_m_s", "goes_to"),
    [
        ("portsbuoy.csv", ("speed_cm_s", "direction_to_deg"), 0.01, True),
        (
            "norkyst.csv",
            ("current_speed_5m", "current_direction_5m"),
            1.0,
            False,
        ),
    ],
)
def test_a_day_turned_into_the_other_sense_reads_as_the_same_vectors(
    tmp_path, name, columns, unit_m_s, goes_to
):
    """A public file's text, and the same numbers as a file that points the other way."""
    path = public_file(tmp_path, name, rows=120)
    rows = list(csv.DictReader(path.read_text().splitlines()))
    known = read_record(path)
    speed, angle = (np.array([float(row[column]) for row in rows]) for column in columns)
    opposite = (angle + 180.0) % 360.0
    turned = "".join(
        f"{t}Z,{a!r},{b!r}\n"
        for t, a, b in zip(known.time[: len(rows)], speed.tolist(), opposite.tolist(), strict=True)
    )
    (tmp_path / "turned.csv").write_text(f"time,a,b\n{turned}")
    declared = ColumnMap(
        title="turned",
        origin=Origin.COMPUTED,
        time_column="time",
        time_format="iso",
        time_zone="stated",
        columns=(
            Column(name="a", quantity="current_speed", unit="cm/s" if goes_to else "m/s"),
            Column(
                name="b",
                quantity="current_direction",
                unit="deg",
                sense="from" if goes_to else "towards",
            ),
        ),
    )
    read = read_record(tmp_path / "turned.csv", columns=declared)
    sign = 1.0 if goes_to else -1.0
    east = sign * unit_m_s * speed * np.sin(np.radians(angle))
    north = sign * unit_m_s * speed * np.cos(np.radians(angle))
    for one in (known, read):
        to = np.radians(one.values["current_to_deg"][: len(rows)])
        size = one.values["current_speed_m_s"][: len(rows)]
        # half a turn there and back in floats
        np.testing.assert_allclose(size * np.sin(to), east, atol=1e-12)
        np.testing.assert_allclose(size * np.cos(to), north, atol=1e-12)


def test_the_same_day_has_the_same_vectors_whichever_way_its_file_points(tmp_path):
    """A FROM-file, and the same day written as TO, as components and in knots."""
    known = read_record(public_file(tmp_path, "norkyst.csv", rows=12))
    time = [f"{t}Z" for t in known.time.astype("datetime64[s]")]
    speed, to = known.values["current_speed_m_s"], known.values["current_to_deg"]
    east, north = speed * np.sin(np.radians(to)), speed * np.cos(np.radians(to))
    files = {
        "from": (speed / 0.01, (to + 180.0) % 360.0, "current_speed", "cm/s", "from"),
        "to": (speed * 3600.0 / 1852.0, to, "current_speed", "knot", "towards"),
        "components": (east / 0.001, north / 0.001, "current_east", "mm/s", ""),
    }
    assert len(known) == 12
    for name, (first, second, quantity, unit, sense) in files.items():
        rows = "".join(
            f"{t},{a!r},{b!r}\n"
            for t, a, b in zip(time, first.tolist(), second.tolist(), strict=True)
        )
        (tmp_path / f"{name}.csv").write_text(f"time,a,b\n{rows}")
        other = (
            Column(name="b", quantity="current_direction", unit="deg", sense=sense)
            if sense
            else Column(name="b", quantity="current_north", unit=unit)
        )
        columns = ColumnMap(
            title=name,
            origin=Origin.COMPUTED,
            time_column="time",
            time_format="iso",
            time_zone="stated",
            columns=(Column(name="a", quantity=quantity, unit=unit), other),
        )
        read = read_record(tmp_path / f"{name}.csv", columns=columns)
        for got, want in ((np.sin, east), (np.cos, north)):
            angle = np.radians(read.values["current_to_deg"])
            # rounding of the units' conversion there and back
            np.testing.assert_allclose(
                read.values["current_speed_m_s"] * got(angle), want, atol=1e-12
            )


@pytest.mark.parametrize(
    ("name", "depths", "share"),
    [
        ("adcp_long_beach_2019.txt", (6.5, 24.5), 0.98),
        ("adcp_western_shoal_2022.txt", (3.5, 7.5), 0.99),
    ],
)
def test_profiles_over_the_bottom_are_read_at_depths(shared, name, depths, share):
    # first bin and length are not in these files; 2 and 1 m stand for them
    options = {"time_zone": "UTC", "looking": "up", "declination_deg": 0.0}
    columns = ProfilerMap(first_bin_m=2.0, bin_m=1.0, **options)
    record = read_record(shared / "data" / name, columns=columns)
    there = [depth for depth in current_bins(record.values) if depths[0] <= depth <= depths[1]]
    assert len(there) >= depths[1] - depths[0]
    for depth in there:
        assert np.mean(record.usable(bin_keys(depth)[0])) > share


def test_a_profile_that_mhkit_saved_is_read_at_depths_by_its_pressure(shared):
    pytest.importorskip("xarray")
    path = shared / "data" / "adcp_awac_snippet.nc"
    columns = ProfilerMap(time_zone="-07:00", looking="up", declination_deg=0.0, average_s=10.0)
    record = read_record(path, columns=columns)
    assert str(record.time[0]) == "2012-06-12T19:00:05.000000"
    assert current_bins(record.values)[-1] < 16.0  # above the instrument
    assert "the instrument at 15.9 to 18.6 m" in record.notes[0]
