"""What no sensor of a virtual field sees, in files."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
import xarray

from seacage.conventions import RecordError
from seacage.records import TrueMeans

RNG = np.random.default_rng(0)
MEANS = TrueMeans(
    time=np.datetime64("2020-01-18") + np.array([0, 600, 4200]) * np.timedelta64(1, "s"),
    length=600.0,
    bridle_names=("bridle-1", "bridle-2"),
    level_depth=np.array([0.0, 5.0, 15.0, 31.0]),
    bridle_tension_mean=RNG.uniform(size=(3, 2)) * 1e4,
    bridle_tension_std=RNG.uniform(size=(3, 2)) * 1e3,
    bridle_tension_max=RNG.uniform(size=(3, 2)) * 2e4,
    node_position=RNG.normal(size=(3, 5, 3)),
    current_velocity=RNG.normal(size=(3, 4, 2)),
    hs=RNG.uniform(size=3),
    growth=np.array([0.1, 0.2, 0.3]),
)


def test_what_is_written_is_read_back_in_single_precision(tmp_path: Path) -> None:
    MEANS.write(tmp_path)
    read = TrueMeans.read(tmp_path)
    for field in fields(TrueMeans):
        wrote, found = getattr(MEANS, field.name), getattr(read, field.name)
        if isinstance(wrote, np.ndarray) and wrote.dtype == np.float64:
            np.testing.assert_allclose(found, wrote, rtol=1e-7)
        else:
            np.testing.assert_array_equal(found, wrote)


def test_plain_xarray_opens_the_files_with_times_units_and_what_they_are(tmp_path: Path) -> None:
    MEANS.write(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "bridles.nc",
        "shape.nc",
        "water.nc",
    ]
    with xarray.open_dataset(tmp_path / "bridles.nc", engine="h5netcdf") as bridles:
        assert bridles.time.values[1] == np.datetime64("2020-01-18T00:10:00")
        assert bridles.bridle_tension_max.attrs["units"] == "N"
        assert bridles.bridle_tension_max.attrs["cell_methods"] == "time: maximum"
        assert list(bridles.bridle.values) == ["bridle-1", "bridle-2"]
        assert bridles.attrs["origin"] == "virtual field"
    with xarray.open_dataset(tmp_path / "water.nc", engine="h5netcdf") as water:
        np.testing.assert_array_equal(water.level, MEANS.level_depth)
        assert water.growth.dims == ("time",)


@pytest.mark.parametrize("file", ["bridles.nc", "shape.nc", "water.nc"])
def test_a_file_that_is_missing_or_damaged_is_refused(tmp_path: Path, file: str) -> None:
    MEANS.write(tmp_path)
    (tmp_path / file).write_bytes(b"no NetCDF")
    with pytest.raises(RecordError, match="no true means of a virtual field"):
        TrueMeans.read(tmp_path)
    (tmp_path / file).unlink()
    with pytest.raises(RecordError, match="no true means of a virtual field"):
        TrueMeans.read(tmp_path)


def test_files_of_two_fields_are_refused(tmp_path: Path) -> None:
    later = replace(MEANS, time=MEANS.time + np.timedelta64(1, "D"))
    MEANS.write(tmp_path / "one")
    later.write(tmp_path / "two")
    (tmp_path / "two" / "shape.nc").rename(tmp_path / "one" / "shape.nc")
    with pytest.raises(RecordError, match="times are not those of the file before"):
        TrueMeans.read(tmp_path / "one")
