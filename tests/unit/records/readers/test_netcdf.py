"""Streams on disk: to the last bit, for anyone's tools, or refused."""

from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Origin, RecordError
from seacage.records import Record, check_record, instant, read_record, write_record

xarray = pytest.importorskip("xarray")

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


@pytest.fixture
def buoy():
    return check_record(
        Record(
            stream="buoy-1",
            time=instant(NOON)
            + np.array([0, 360_000_001, 1_080_000_000]) * np.timedelta64(1, "us"),
            values={
                "current_speed_m_s": np.array([0.1, 0.2, np.nan]),
                "current_to_deg": np.array([77.0, 412.0, 1.0 / 3.0]),
            },
            origin=Origin.VIRTUAL_FIELD,
            notes=("made for a test.",),
        )
    )


def test_a_stream_comes_back_to_the_last_bit(tmp_path, buoy):
    write_record(buoy, tmp_path / "buoy.nc")
    back = read_record(tmp_path / "buoy.nc")
    assert (back.stream, back.origin, back.notes) == (buoy.stream, buoy.origin, buoy.notes)
    np.testing.assert_array_equal(back.time, buoy.time)
    for key, values in buoy.values.items():
        np.testing.assert_array_equal(back.values[key], values)
        np.testing.assert_array_equal(back.flags[key], buoy.flags[key])


def test_an_empty_stream_comes_back(tmp_path, buoy):
    write_record(buoy.between(NOON, NOON), tmp_path / "buoy.nc")
    assert len(read_record(tmp_path / "buoy.nc")) == 0


def test_plain_xarray_reads_it_with_units_names_and_flags(tmp_path, buoy):
    write_record(buoy, tmp_path / "buoy.nc")
    with xarray.open_dataset(tmp_path / "buoy.nc", engine="h5netcdf") as dataset:
        to, flag = dataset["current_to_deg"], dataset["current_to_deg_flag"]
        assert str(dataset["time"].values[0]).startswith("2018-01-26T12:00:00")
        assert to.attrs["standard_name"] == "sea_water_velocity_to_direction"
        assert to.attrs["units"] == "degree"
        assert to.attrs["ancillary_variables"] == "current_to_deg_flag"
        assert flag.attrs["flag_values"].tolist() == [1, 2, 3, 4, 9]
        assert flag.attrs["flag_meanings"] == "good not_evaluated suspect fail missing"
        assert flag.values.tolist() == [1, 4, 1]
        assert dataset.attrs["origin"] == "virtual field"
        assert "virtual field" in dataset.attrs["title"]


def test_no_half_written_file_is_left(tmp_path, buoy):
    write_record(buoy, tmp_path / "buoy.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["buoy.nc"]


@pytest.mark.parametrize("content", [b"", b"not a NetCDF file", b"\x89HDF\r\n\x1a\n" + bytes(99)])
def test_a_file_that_is_no_netcdf_is_refused(tmp_path, content):
    (tmp_path / "buoy.nc").write_bytes(content)
    with pytest.raises(RecordError, match="this is no stream that seacage wrote"):
        read_record(tmp_path / "buoy.nc")


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(RecordError, match="this is no stream that seacage wrote"):
        read_record(tmp_path / "buoy.nc")


def test_a_foreign_netcdf_is_refused(tmp_path):
    xarray.Dataset({"u": ("time", [0.1])}).to_netcdf(tmp_path / "u.nc", engine="h5netcdf")
    with pytest.raises(RecordError, match="it does not say seacage's schema"):
        read_record(tmp_path / "u.nc")


def test_a_stream_in_another_unit_is_refused(tmp_path, buoy):
    write_record(buoy, tmp_path / "buoy.nc")
    dataset = xarray.load_dataset(tmp_path / "buoy.nc", engine="h5netcdf")
    dataset["current_speed_m_s"].attrs["units"] = "cm s-1"
    dataset.to_netcdf(tmp_path / "cm.nc", engine="h5netcdf")
    with pytest.raises(RecordError, match="current_speed_m_s is in 'cm s-1', not in 'm s-1'"):
        read_record(tmp_path / "cm.nc")


def test_a_stream_without_its_flags_is_refused(tmp_path, buoy):
    write_record(buoy, tmp_path / "buoy.nc")
    dataset = xarray.load_dataset(tmp_path / "buoy.nc", engine="h5netcdf", decode_times=False)
    dataset.drop_vars("current_to_deg_flag").to_netcdf(tmp_path / "bare.nc", engine="h5netcdf")
    with pytest.raises(RecordError, match="current_to_deg_flag"):
        read_record(tmp_path / "bare.nc")
