"""Simulations on disk: for anyone's tools, or refused."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import Origin, RecordError
from seacage.ocean import SeaState
from seacage.records import LINES, STATISTICS, HistoryRecord, read_history, write_history

xarray = pytest.importorskip("xarray")

SHAPES = {"node_position": (5, 3), "bridle_tension": (4,), "net_force": (3,), "volume": ()}


@pytest.fixture
def history() -> HistoryRecord:
    random = np.random.default_rng(0)

    def single(*shape):
        """Numbers that single precision holds, as a simulation's series are."""
        return random.random(shape).astype(np.float32).astype(np.float64)

    statistics = {
        f"{name}_{kind}": np.asarray(
            random.random((2, *shape) if kind == "quantile" else shape), dtype=np.float64
        )
        for name, shape in SHAPES.items()
        for kind in STATISTICS
    }
    return HistoryRecord(
        cage_name="small",
        cage_toml='name = "small"\n',
        bridle_names=tuple(f"bridle-{n}" for n in range(1, 5)),
        sea=SeaState(current_speed=0.5, current_to=77.0, hs=2.0, tp=7.3, wave_from=359.0),
        time=0.5 * np.arange(6),
        kept_node=np.array([0, 4]),
        node_position=single(6, 2, 3),
        bridle_tension=single(6, 4),
        surface_elevation=single(6),
        statistics=statistics,
        quantile_level=np.array([0.05, 0.95]),
        node_displacement=random.random((5, 3)),
        volume_fraction=0.75,
        result=0,
        diverged_at=float("nan"),
        settings={"law": "loland", "seed": 7, "duration_s": 3.0},
        version="0.1.0",
    )


def test_a_simulation_comes_back_to_the_last_bit(tmp_path, history):
    write_history(history, tmp_path / "a.nc")
    back = read_history(tmp_path / "a.nc")
    assert back.sea == history.sea
    assert dict(back.settings) == dict(history.settings)
    assert (back.cage_name, back.cage_toml) == (history.cage_name, history.cage_toml)
    assert (back.bridle_names, back.version) == (history.bridle_names, history.version)
    assert (back.volume_fraction, back.result) == (history.volume_fraction, history.result)
    assert np.isnan(back.diverged_at)
    assert back.origin is Origin.COMPUTED
    for name in (
        "time",
        "kept_node",
        "node_position",
        "bridle_tension",
        "surface_elevation",
        "quantile_level",
        "node_displacement",
    ):
        np.testing.assert_array_equal(getattr(back, name), getattr(history, name), err_msg=name)
    for name, values in history.statistics.items():
        np.testing.assert_array_equal(back.statistics[name], values, err_msg=name)


def test_plain_xarray_reads_it_with_units_names_and_cell_methods(tmp_path, history):
    write_history(history, tmp_path / "a.nc")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as dataset:
        assert dataset.attrs["Conventions"].startswith("CF-1.11")
        assert dataset.attrs["origin"] == "computed"
        assert dataset.attrs["law"] == "loland"
        assert dataset.attrs["seed"] == 7
        series = dataset["bridle_tension_series"]
        assert series.dims == ("time", "bridle")
        assert series.dtype == np.float32
        assert series.sel(bridle="bridle-2").sizes == {"time": 6}
        mean = dataset["bridle_tension_mean"]
        assert mean.attrs["units"] == "N"
        assert mean.attrs["cell_methods"] == "time: mean"
        assert dataset["node_position_quantile"].dims == ("quantile_level", "node", "axis")
        assert dataset["hs"].attrs["standard_name"] == "sea_surface_wave_significant_height"
        assert float(dataset["time"][1]) == 0.5
        assert dataset["result"].attrs["flag_meanings"] == (
            "converged not_converged diverged drowned outside_validity slack"
        )


def test_a_simulation_without_series_comes_back(tmp_path, history):
    none = replace(
        history,
        time=history.time[:0],
        node_position=history.node_position[:0],
        bridle_tension=history.bridle_tension[:0],
        surface_elevation=history.surface_elevation[:0],
    )
    write_history(none, tmp_path / "a.nc")
    back = read_history(tmp_path / "a.nc")
    assert back.node_position.shape == (0, 2, 3)
    assert back.bridle_tension.shape == (0, 4)


def test_a_file_is_replaced_whole(tmp_path, history):
    (tmp_path / "a.nc").write_text("what was there")
    write_history(history, tmp_path / "a.nc")
    assert read_history(tmp_path / "a.nc").sea == history.sea
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]


def test_another_file_is_refused_with_what_to_give(tmp_path):
    path = tmp_path / "other.nc"
    xarray.Dataset({"x": ("t", np.zeros(3))}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(RecordError, match="seacage simulate --out"):
        read_history(path)
    (tmp_path / "text.nc").write_text("no NetCDF")
    with pytest.raises(RecordError, match="no simulation that seacage wrote"):
        read_history(tmp_path / "text.nc")
    with pytest.raises(RecordError):
        read_history(tmp_path / "missing.nc")


def test_a_history_without_one_of_its_statistics_is_refused(history):
    some = dict(history.statistics)
    del some["volume_std"]
    with pytest.raises(RecordError, match="volume_std"):
        replace(history, statistics=some)


def test_lines_come_back_by_their_names(tmp_path, history):
    lines = {name: np.array([1.0, np.nan]) + n for n, name in enumerate(LINES)}
    more = replace(
        history,
        line_names=("bridle-1", "frame-1"),
        line_kinds=("bridle", "frame line"),
        lines=lines,
    )
    write_history(more, tmp_path / "a.nc")
    back = read_history(tmp_path / "a.nc")
    assert (back.line_names, back.line_kinds) == (more.line_names, more.line_kinds)
    for name, values in lines.items():
        np.testing.assert_array_equal(back.lines[name], values, err_msg=name)


def test_a_file_without_lines_has_none(tmp_path, history):
    write_history(history, tmp_path / "a.nc")
    back = read_history(tmp_path / "a.nc")
    assert (back.line_names, dict(back.lines)) == ((), {})


def test_lines_lacking_a_number_are_refused(history):
    with pytest.raises(RecordError, match="lines has mean"):
        replace(history, line_names=("a",), line_kinds=("line",), lines={"mean": np.zeros(1)})
