"""Foreign formats: NDBC, CO-OPS, Parquet and CF-NetCDF, each refused where it leaves a doubt."""

import json
from importlib.resources import files

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from seacage.conventions import Flag, Origin, RecordError
from seacage.ocean import MAX_CURRENT_SPEED
from seacage.records import (
    DEFAULT_LIMITS,
    Column,
    ColumnMap,
    NetcdfMap,
    read_limits,
    read_map,
    read_record,
    shipped_maps,
)

xarray = pytest.importorskip("xarray")

NDBC = """#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD   APD MWD   PRES  ATMP
#yr  mo dy hr mn degT m/s  m/s     m   sec   sec degT   hPa  degC
2014 09 11 16 50 120  5.0  6.0   0.6     6   4.2 134 1016.5  29.3
2014 09 11 17 50 120  5.0  6.0    MM    MM   4.2  MM 1016.5  29.3
"""
OLD_NDBC = """YY MM DD hh WD   WSPD GST  WVHT  DPD   APD  MWD  BAR
98 01 01 00 120  5.0  6.0  2.00  9.00  6.00 999  1016.5
98 01 01 01 120  5.0  6.0 99.00 99.00  6.00 134  1016.5
"""
ADCP = """#YY  MM DD hh mm DEP01 DIR01 SPD01 DEP02 DIR02 SPD02
#yr  mo dy hr mn     m  degT  cm/s     m  degT  cm/s
2014 09 11 16 50   2.5   90    30.0   6.5   100   20.0
2014 09 11 17 50   2.5   95    31.0   6.5   105   21.0
"""
COOPS = "Date Time, Speed, Direction, Bin\n2018-01-26 23:08, 11.0, 77, 4\n"


def written(path, text):
    path.write_text(text)
    return path


def test_waves_of_ndbc_are_read_with_their_missing_values(tmp_path):
    record = read_record(written(tmp_path / "46097.txt", NDBC))
    np.testing.assert_allclose(record.values["hs_m"], [0.6, np.nan])
    np.testing.assert_allclose(record.values["tp_s"], [6.0, np.nan])
    np.testing.assert_allclose(record.values["wave_from_deg"], [134.0, np.nan])
    assert record.flags["hs_m"].tolist() == [Flag.GOOD, Flag.MISSING]
    assert str(record.time[0]) == "2014-09-11T16:50:00.000000"
    assert record.origin is Origin.MEASURED


def test_older_files_of_ndbc_have_short_years_no_minutes_and_nines(tmp_path):
    record = read_record(written(tmp_path / "46097h1998.txt", OLD_NDBC))
    assert str(record.time[1]) == "1998-01-01T01:00:00.000000"
    np.testing.assert_allclose(record.values["hs_m"], [2.0, np.nan])
    np.testing.assert_allclose(record.values["wave_from_deg"], [np.nan, 134.0])


def test_currents_of_ndbc_are_read_at_the_upper_bin_towards(tmp_path):
    record = read_record(written(tmp_path / "42001.txt", ADCP))
    np.testing.assert_allclose(record.values["current_speed_m_s"], [0.30, 0.31])
    assert record.values["current_to_deg"].tolist() == [90.0, 95.0]
    assert "File of NDBC: read at a depth of 2.5 m." in record.notes


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("     m   sec   sec degT", "    ft   sec   sec degT", "line 2: the unit of WVHT is 'ft'"),
        ("WVHT   DPD   APD MWD ", "FOO1   FOO   APD FOO3", "neither waves .WVHT, DPD, MWD. nor"),
        ("2014 09 11 17 50", "2014 13 11 17 50", "line 4: YY MM DD hh mm = '2014 13 11 17 50' is"),
        ("hh mm WDIR", "hh mm' WDIR", "line 1: the columns mm' are not as NDBC documents them"),
        ("GST  WVHT", "FOO  WVHT", "line 1: the columns FOO are not as NDBC documents them"),
        ("120  5.0  6.0    MM", "120  5.0  6.0", "line 4: 13 cells in a table of 14"),
    ],
)
def test_a_fault_in_a_file_of_ndbc_is_reported(tmp_path, old, new, sentence):
    assert old in NDBC
    with pytest.raises(RecordError, match=sentence):
        read_record(written(tmp_path / "46097.txt", NDBC.replace(old, new)))


def test_a_bin_of_ndbc_whose_depth_moves_is_refused(tmp_path):
    moved = ADCP.replace("17 50   2.5", "17 50   3.5")
    with pytest.raises(RecordError, match="DEP01 holds 2 depths, and a stream has one"):
        read_record(written(tmp_path / "42001.txt", moved))


def test_an_answer_of_co_ops_does_not_say_its_unit_so_the_user_does(tmp_path):
    path = written(tmp_path / "s08010.csv", COOPS)
    with pytest.raises(RecordError, match="fits the column maps coops_current_english_gmt and"):
        read_record(path)
    metric = read_record(path, columns=shipped_maps()["coops_current_metric_gmt"])
    assert metric.values["current_speed_m_s"].tolist() == [0.11]
    english = read_record(path, columns=read_map("coops_current_english_gmt"))
    assert english.values["current_speed_m_s"] == pytest.approx(11.0 * 1852.0 / 3600.0)


def test_the_json_of_co_ops_is_the_same_table(tmp_path):
    answer = {
        "metadata": {"id": "s08010"},
        "data": [{"t": "2018-01-26 23:08", "s": "11.0", "d": "77", "b": "4"}],
    }
    path = written(tmp_path / "s08010.json", json.dumps(answer))
    record = read_record(path, columns=shipped_maps()["coops_current_metric_gmt"])
    assert record.values["current_speed_m_s"].tolist() == [0.11]
    assert record.values["current_to_deg"].tolist() == [77.0]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{", "this is no JSON"),
        ("[1]", "no answer of NOAA's CO-OPS"),
        ('{"error": {"message": "No data was found."}}', "no answer of NOAA's CO-OPS"),
        ('{"data": []}', "are none, or of unequal kinds"),
        ('{"data": [{"t": "1"}, {"s": "1"}]}', "are none, or of unequal kinds"),
    ],
)
def test_other_json_is_refused(tmp_path, text, sentence):
    with pytest.raises(RecordError, match=sentence):
        read_record(written(tmp_path / "x.json", text))


def test_parquet_is_read_to_the_last_bit(tmp_path):
    time = np.datetime64("2018-01-26T23:08:00", "us") + np.arange(3) * np.timedelta64(12, "m")
    speed = np.array([0.1, 1.0 / 3.0, np.nan])
    table = pa.table(
        {
            "time": pa.array(time, type=pa.timestamp("us", tz="UTC")),
            "current_speed_m_s": speed,
            "current_to_deg": pa.array([10, 20, None]),
        }
    )
    parquet.write_table(table, tmp_path / "buoy.parquet")
    record = read_record(tmp_path / "buoy.parquet")
    np.testing.assert_array_equal(record.time, time)
    np.testing.assert_array_equal(record.values["current_speed_m_s"], speed)
    np.testing.assert_array_equal(record.values["current_to_deg"], [10.0, 20.0, np.nan])
    (tmp_path / "cut.parquet").write_bytes((tmp_path / "buoy.parquet").read_bytes()[:200])
    with pytest.raises(RecordError, match="this is no Parquet file that can be read"):
        read_record(tmp_path / "cut.parquet")


@pytest.mark.parametrize("zone", [None, "Europe/Oslo"])
def test_parquet_of_a_logger_is_declared(tmp_path, zone):
    # As pandas writes: times in nanoseconds, floats of 32 bits; 23:08 in Oslo's winter is 22:08.
    time = np.datetime64("2018-01-26T22:08:00.000000007", "ns") + np.arange(2) * np.timedelta64(
        12, "m"
    )
    table = pa.table(
        {
            "Tid": pa.array(time, type=pa.timestamp("ns", tz=zone)),
            "Fart": np.array([25.0, 50.0], dtype=np.float32),
            "Retn": [350, 170],
            "Batteri": ["good", None],
        }
    )
    parquet.write_table(table, tmp_path / "logger.parquet")
    declared = ColumnMap(
        title="Logger",
        origin=Origin.MEASURED,
        time_column="Tid",
        time_format="iso",
        time_zone="stated" if zone else "UTC",
        columns=(
            Column(name="Fart", quantity="current_speed", unit="cm/s"),
            Column(name="Retn", quantity="current_direction", unit="deg", sense="from"),
        ),
        ignored=("Batteri",),
    )
    record = read_record(tmp_path / "logger.parquet", columns=declared)
    np.testing.assert_array_equal(record.time, time.astype("datetime64[us]"))
    np.testing.assert_array_equal(record.values["current_speed_m_s"], [0.25, 0.5])
    np.testing.assert_array_equal(record.values["current_to_deg"], [170.0, 350.0])


def test_european_tables_are_declared(tmp_path):
    text = "Logger 7\nTid;Fart;Retn\n26.01.2018 23:08;0,25;77\n26.01.2018 23:18;1.234,5;78\n"
    (tmp_path / "logger.csv").write_bytes(text.encode("utf-16"))
    columns = ColumnMap(
        title="Logger",
        origin=Origin.MEASURED,
        time_column="Tid",
        time_format="%d.%m.%Y %H:%M",
        time_zone="+01:00",
        columns=(
            Column(name="Fart", quantity="current_speed", unit="m/s"),
            Column(name="Retn", quantity="current_direction", unit="deg", sense="towards"),
        ),
        delimiter=";",
        decimal=",",
        encoding="utf-16",
        skip_lines=1,
    )
    record = read_record(tmp_path / "logger.csv", columns=columns)
    np.testing.assert_array_equal(record.values["current_speed_m_s"], [0.25, np.nan])
    assert "first on line 4: '1.234,5'" in record.notes[0]


def test_components_become_speed_and_where_it_goes(tmp_path):
    columns = ColumnMap(
        title="Components",
        origin=Origin.COMPUTED,
        time_column="t",
        time_format="unix",
        time_zone="UTC",
        columns=(
            Column(name="u", quantity="current_east", unit="cm/s"),
            Column(name="v", quantity="current_north", unit="cm/s"),
        ),
    )
    text = "t,u,v\n0,30,40\n60,-30,0\n120,0,-30\n180,,1\n"
    record = read_record(written(tmp_path / "uv.csv", text), columns=columns)
    np.testing.assert_allclose(record.values["current_speed_m_s"], [0.5, 0.3, 0.3, np.nan])
    np.testing.assert_allclose(
        record.values["current_to_deg"], [np.degrees(np.arctan2(3, 4)), 270.0, 180.0, np.nan]
    )


def test_half_a_vector_is_refused():
    with pytest.raises(RecordError, match="current_east with current_north"):
        ColumnMap(
            title="Half",
            origin=Origin.MEASURED,
            time_column="t",
            time_format="iso",
            time_zone="UTC",
            columns=(Column(name="u", quantity="current_east", unit="cm/s"),),
        )


def test_the_last_row_of_a_file_without_a_line_end_is_suspect(tmp_path):
    text = (
        "time,current_speed_m_s,current_to_deg\n2018-01-26T23:08Z,0.1,77\n2018-01-26T23:20Z,0.1,7"
    )
    record = read_record(written(tmp_path / "cut.csv", text))
    assert record.flags["current_to_deg"].tolist() == [Flag.GOOD, Flag.SUSPECT]
    assert "The file ends without a line end, on line 3" in record.notes[0]


# --- CF-NetCDF ---------------------------------------------------------------------------------


def hindcast(**changes):
    """Waves as MET Norway's hindcasts write them: directions that waves go to."""
    time = ("time", [0.0, 1.0], {"units": "hours since 2018-01-26 00:00:00"})
    dims = ("time", "rlat", "rlon")
    variables = {
        "hs": (dims, np.full((2, 1, 1), 1.5), "sea_surface_wave_significant_height", "m"),
        "tp": (
            dims,
            np.full((2, 1, 1), 8.0),
            "sea_surface_wave_peak_period_from_variance_spectral_density",
            "s",
        ),
        "thq": (dims, np.full((2, 1, 1), 90.0), "sea_surface_wave_to_direction", "degree"),
        "ff": (dims, np.full((2, 1, 1), 9.0), "wind_speed", "m s-1"),
    } | changes
    return xarray.Dataset(
        {
            name: (dims, values, {"standard_name": standard, "units": units})
            for name, (dims, values, standard, units) in variables.items()
        },
        coords={"time": time},
    )


def stored(path, dataset, engine="h5netcdf"):
    dataset.to_netcdf(path, engine=engine)
    return path


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_a_hindcast_is_read_by_standard_names_and_turned(tmp_path, engine):
    path = stored(tmp_path / "nora3.nc", hindcast(), engine)
    record = read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED))
    assert {key: values.tolist() for key, values in record.values.items()} == {
        "hs_m": [1.5, 1.5],
        "tp_s": [8.0, 8.0],
        "wave_from_deg": [270.0, 270.0],
    }
    assert str(record.time[1]) == "2018-01-26T01:00:00.000000"
    assert "wave_direction is read from thq [deg, towards]." in record.notes


def test_a_hindcasts_origin_is_reported_by_the_user(tmp_path):
    with pytest.raises(RecordError, match="nothing says how its numbers were made"):
        read_record(stored(tmp_path / "nora3.nc", hindcast()), columns=NetcdfMap())


@pytest.mark.parametrize(
    ("changes", "choice", "sentence"),
    [
        (
            {"hs": (("time",), [1.0, 1.0], "sea_surface_wave_significant_height", "furlong")},
            {},
            "hs has the units 'furlong'",
        ),
        (
            {"swh": (("time",), [1.0, 1.0], "sea_surface_wave_significant_height", "m")},
            {},
            "hs and swh are both hs. Say which",
        ),
        (
            {"u": (("time", "depth"), np.ones((2, 3)), "eastward_sea_water_velocity", "m s-1")},
            {},
            "u runs over 3 values of 'depth'",
        ),
        (
            {"u": (("time",), [1.0, 1.0], "eastward_sea_water_velocity", "m s-1")},
            {},
            "current_east with current_north",
        ),
        (
            {},
            {"columns": (Column(name="h", quantity="hs", unit="m"),)},
            "there is no variable 'h' of numbers over time",
        ),
        (
            {},
            {"columns": (Column(name="hs", quantity="hs", unit="cm"),)},
            "the map says that hs is in cm, and the file says 'm'",
        ),
    ],
)
def test_what_a_netcdf_file_leaves_open_is_refused(tmp_path, changes, choice, sentence):
    path = stored(tmp_path / "x.nc", hindcast(**changes))
    with pytest.raises(RecordError, match=sentence):
        read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED, **choice))


def profile():
    size = (2, 3)
    names = {"u": "eastward_sea_water_velocity", "v": "northward_sea_water_velocity"}
    return xarray.Dataset(
        {
            name: (
                ("time", "depth"),
                np.broadcast_to([0.3, 0.2, 0.1], size) * (name == "u"),
                {"standard_name": standard, "units": "m s-1"},
            )
            for name, standard in names.items()
        },
        coords={
            "time": ("time", [0, 1], {"units": "days since 2018-1-1 00:00:00 +01:00"}),
            "depth": ("depth", [0.0, 5.0, 15.0], {"units": "m", "positive": "down"}),
        },
    )


def test_a_depth_of_a_profile_is_chosen_and_never_interpolated(tmp_path):
    path = stored(tmp_path / "norkyst.nc", profile())
    record = read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED, depth_m=5.0))
    assert record.values["current_speed_m_s"].tolist() == [0.2, 0.2]
    assert record.values["current_to_deg"].tolist() == [90.0, 90.0]
    assert str(record.time[0]) == "2017-12-31T23:00:00.000000"
    assert "current_east is read from u [m/s], at a depth of 5 m." in record.notes
    for depth, got in ((None, "none is chosen"), (7.0, "7 m is none of them")):
        with pytest.raises(RecordError, match=f"a profile over depths of 0, 5, 15 m, and {got}"):
            read_record(path, columns=NetcdfMap(origin=Origin.COMPUTED, depth_m=depth))


@pytest.mark.parametrize(
    ("units", "calendar", "sentence"),
    [
        ("days", "standard", "the time has the units 'days'"),
        ("months since 2018-01-01", "standard", "the time has the units 'months since"),
        ("days since yesterday", "standard", "since 'yesterday', which is no date"),
        ("days since 2018-01-01", "360_day", "the calendar '360_day' is not the world's"),
    ],
)
def test_a_time_that_cannot_be_determined_is_refused(tmp_path, units, calendar, sentence):
    dataset = hindcast()
    dataset["time"].attrs.update(units=units, calendar=calendar)
    with pytest.raises(RecordError, match=sentence):
        read_record(stored(tmp_path / "x.nc", dataset), columns=NetcdfMap(origin=Origin.COMPUTED))


def test_a_map_of_a_netcdf_file_is_read_from_toml(tmp_path):
    text = (
        'kind = "netcdf"\norigin = "measured"\ntime_zone = "-07:00"\nrange_m = 5.4\n'
        '[at]\nrlat = 2\n[columns.hs]\nquantity = "hs"\nunit = "m"\n'
    )
    choice = read_map(written(tmp_path / "map.toml", text))
    assert isinstance(choice, NetcdfMap)
    assert (choice.time_zone, choice.range_m, choice.at) == ("-07:00", 5.4, {"rlat": 2})
    assert choice.columns == (Column(name="hs", quantity="hs", unit="m"),)
    with pytest.raises(RecordError, match=r'map.toml: origin is still "\?"'):
        read_map(written(tmp_path / "map.toml", 'kind = "netcdf"\norigin = "?"\n'))


def test_a_map_of_the_other_kind_is_refused(tmp_path):
    with pytest.raises(RecordError, match=r"this is a table, and its map is of NetCDF.*--inspect"):
        read_record(written(tmp_path / "x.csv", COOPS), columns=NetcdfMap())
    with pytest.raises(RecordError, match=r"this is NetCDF, and its map is of a table.*--inspect"):
        read_record(tmp_path / "x.nc", columns=shipped_maps()["nora10_waves"])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[ranges.hs_m]\nfail = [0, 5, 6]", r"fail = \[0.0, 5.0, 6.0\] is no range"),
        ("[ranges.hs]\nfail = [0, 5]", "the key 'hs' is unknown. Did you mean 'hs_m'"),
        ("[steadiness.waves]\njmp = 1", "the key 'jmp' is unknown. Did you mean 'jump'"),
        ("[steadiness.waves]\njump = true", "jump = True is no number"),
        ("x", "this is not TOML"),
        ("[[climatology.hs_m]]\nmonths = [0, 1]", r"months = \[0.0, 1.0\] are none"),
        ("[climatology]\nhs_m = [1]", "hs_m is no list of tables"),
    ],
)
def test_limits_that_cannot_be_meant_are_refused(tmp_path, text, sentence):
    with pytest.raises(RecordError, match=sentence):
        read_limits(written(tmp_path / "limits.toml", text))


def test_the_shipped_limits_are_a_file_that_a_site_may_begin_with():
    shipped = files("seacage.records") / "limits.toml"
    assert read_limits(str(shipped)) == DEFAULT_LIMITS
    assert DEFAULT_LIMITS.ranges["current_speed_m_s"].fail[1] == MAX_CURRENT_SPEED


def test_a_sites_limits_change_what_they_name_alone(tmp_path):
    text = (
        "[ranges.hs_m]\nsuspect = [0, 5]\n[steadiness.waves]\njump = 0.4\n"
        "[[climatology.hs_m]]\nmonths = [6, 7]\nsuspect = [0, 4]\n"
    )
    limits = read_limits(written(tmp_path / "limits.toml", text))
    assert limits.ranges["hs_m"].suspect == (0.0, 5.0)
    assert limits.ranges["hs_m"].fail == (0.0, 20.0)
    assert limits.steadiness["waves"].jump == 0.4
    assert limits.steadiness["current"].jump == 0.3
    (season,) = limits.climatology["hs_m"]
    assert (season.months, season.range.suspect) == ((6, 7), (0.0, 4.0))
