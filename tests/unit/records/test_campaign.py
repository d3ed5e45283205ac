"""Campaigns on disk."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray

from seacage.cage import MooringLines
from seacage.conventions import RecordError, Result
from seacage.ocean import SeaState
from seacage.records import (
    LINES,
    CampaignRecord,
    campaign_results,
    campaign_unsummed,
    campaign_variable,
    create_campaign,
    export_campaign,
    finish_campaign,
    read_campaign,
    write_cases,
)

SEAS = tuple(
    SeaState(current_speed=0.1 * n, current_to=36.0 * n, hs=n / 3.0, wave_from=12.5)
    for n in range(7)
)
ATTRIBUTES = {"cage": 'name = "small"', "law": "loland", "seed": 4, "product_version": "0.1.0"}


def created(path: Path) -> Path:
    create_campaign(path, seas=SEAS, nodes=5, lines=3, block=4, attributes=ATTRIBUTES)
    return path


def answers(first: int, last: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(first)
    cases = last - first
    return {
        "node_position": rng.normal(size=(cases, 5, 3)),
        "bridle_tension": rng.normal(size=(cases, 3)),
        "net_force": rng.normal(size=(cases, 3)),
        "volume": rng.normal(size=cases),
        "residual": rng.normal(size=cases),
        "result": np.full(cases, Result.CONVERGED),
    }


def finished(path: Path) -> Path:
    created(path)
    write_cases(path, 4, answers(4, 7))
    write_cases(path, 0, answers(0, 4))
    return path


SPREADS = {"node_position": (5, 3), "bridle_tension": (3,)}


def created_in_time(
    path: Path, *, seeds: list[int] | None = None, mooring: MooringLines | None = None
) -> Path:
    create_campaign(
        path,
        seas=SEAS,
        nodes=5,
        lines=3,
        block=4,
        attributes={**ATTRIBUTES, "quantile_levels": [0.1, 0.9]},
        wave_seeds=seeds or list(range(7)),
        quantile_levels=(0.1, 0.9),
        second_moment=True,
        mooring=mooring,
    )
    return path


def answers_in_time(first: int, last: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(first)
    cases, values = last - first, answers(first, last)
    del values["residual"]
    for name, shape in SPREADS.items():
        for statistic in ("std", "minimum", "maximum"):
            values[f"{name}_{statistic}"] = rng.normal(size=(cases, *shape)).astype(np.float32)
        values[f"{name}_quantile"] = rng.normal(size=(cases, 2, *shape)).astype(np.float32)
    values["net_force_std"] = rng.normal(size=(cases, 3)).astype(np.float32)
    values["volume_std"] = rng.normal(size=cases).astype(np.float32)
    values["diverged_at"] = np.full(cases, np.nan)
    values["result"][0], values["diverged_at"][0] = Result.DIVERGED, 12.5
    return values


def moment(first: int) -> np.ndarray:
    return np.random.default_rng(first).normal(size=(15, 15)).astype(np.float32).astype(float)


def written_in_time(path: Path) -> Path:
    created_in_time(path)
    for first, last in ((4, 7), (0, 4)):
        values = answers_in_time(first, last)
        write_cases(path, first, values, moment=moment(first), core_seconds=first + 1.0)
    return path


def test_a_campaign_in_time_is_read_with_all_its_statistics(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    finish_campaign(path)
    record = read_campaign(path)
    for name, first in answers_in_time(0, 4).items():
        both = np.concatenate([first, answers_in_time(4, 7)[name]])
        np.testing.assert_array_equal(getattr(record, name), both)
    assert record.wave_seed.tolist() == list(range(7))
    assert record.quantile.tolist() == [0.1, 0.9]
    assert record.residual is None
    assert campaign_variable(path, "core_seconds").tolist() == [1.0, 5.0]


def test_the_second_moment_is_the_blocks_sum_over_the_converged_cases(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    with pytest.raises(RecordError, match="seacage campaign finish"):
        read_campaign(path)
    assert campaign_unsummed(path)
    for _ in range(2):  # a second time changes nothing
        finish_campaign(path)
        assert not campaign_unsummed(path)
        np.testing.assert_array_equal(
            read_campaign(path).second_moment, (moment(0) + moment(4)) / 5.0
        )
    assert [one.name for one in tmp_path.iterdir()] == ["campaign"]


def test_a_campaign_with_cases_left_is_not_summed(tmp_path: Path) -> None:
    path = created_in_time(tmp_path / "campaign")
    write_cases(path, 4, answers_in_time(4, 7), moment=moment(4))
    finish_campaign(path)
    assert campaign_unsummed(path)
    assert np.isnan(campaign_variable(path, "second_moment")).all()


def test_what_kills_left_behind_is_cleared_up_at_the_end(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    for name in (".campaign.0123abcd.unborn", ".campaign.0123abcd.spent"):
        (tmp_path / name / "deep").mkdir(parents=True)
    (tmp_path / ".campaign.zarr.0123abcd.unborn").mkdir()  # of another campaign
    finish_campaign(path)
    assert {one.name for one in tmp_path.iterdir()} == {
        "campaign",
        ".campaign.zarr.0123abcd.unborn",
    }


@pytest.mark.parametrize("gone", ["blocks/moment/c/0", "blocks/moment"])
def test_who_comes_second_to_the_sum_leaves_it_to_the_first(tmp_path: Path, gone: str) -> None:
    path = written_in_time(tmp_path / "campaign")
    shutil.rmtree(path / gone)  # as the first does, while the second adds up
    finish_campaign(path)
    assert np.isnan(campaign_variable(path, "second_moment")).all()


def test_who_comes_second_to_the_creation_finds_what_the_first_made(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    created_in_time(path, seeds=[9] * 7)
    finish_campaign(path)
    assert read_campaign(path).wave_seed.tolist() == list(range(7))
    assert [one.name for one in tmp_path.iterdir()] == ["campaign"]


def test_a_campaign_without_an_attribute_of_later_versions_is_still_read(tmp_path: Path) -> None:
    path = finished(tmp_path / "campaign")
    shutil.rmtree(path / "core_seconds")
    write_cases(path, 4, answers(4, 7))
    assert read_campaign(path).second_moment is None
    assert campaign_variable(path, "core_seconds") is None


def test_statistics_over_time_say_so_in_the_words_of_cf(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    finish_campaign(path)
    export_campaign(path, tmp_path / "campaign.nc")
    with xarray.open_dataset(tmp_path / "campaign.nc") as dataset:
        assert dataset.node_position_std.cell_methods == "time: standard_deviation"
        assert dataset.bridle_tension_maximum.cell_methods == "time: maximum"
        assert dataset.bridle_tension_quantile.sel(quantile=0.9).dims == ("case", "line")
        assert dataset.node_position_std.dtype == np.float32
        assert dataset.node_position.dtype == dataset.second_moment.dtype == np.float64
        assert dataset.wave_seed.dtype == np.int64
        for variable in dataset.variables.values():
            assert {"units", "long_name"} <= variable.attrs.keys()
    assert read_campaign(tmp_path / "campaign.nc").sha256 == read_campaign(path).sha256


def test_the_loads_of_all_lines_are_read_from_the_store_and_from_its_export(
    tmp_path: Path,
) -> None:
    mooring = MooringLines(
        names=("bridle-1", "anchor-1"),
        kinds=("bridle", "anchor line"),
        breaking_load=np.array([480e3, np.nan]),
        capacity=np.array([160e3, np.nan]),
        pretension=np.array([10e3, 50e3]),
        tn_slope=np.array([np.nan, 13.46]),
        tn_load=np.array([np.nan, 2e6]),
    )
    path, random = tmp_path / "campaign", np.random.default_rng(0)
    created_in_time(path, mooring=mooring)
    changing = [name for name in LINES if name not in ("capacity", "tn_slope")]
    loads = {name: random.normal(size=(7, 2)).astype(np.float32) for name in changing}
    for first, last in ((0, 4), (4, 7)):
        mine = {f"line_{name}": values[first:last] for name, values in loads.items()}
        write_cases(path, first, answers_in_time(first, last) | mine, moment=moment(first))
    finish_campaign(path)
    export_campaign(path, tmp_path / "campaign.nc")
    for record in (read_campaign(path), read_campaign(tmp_path / "campaign.nc")):
        assert (record.line_names, record.line_kinds) == (mooring.names, mooring.kinds)
        assert set(record.lines) == set(LINES)
        for name, values in loads.items():
            np.testing.assert_array_equal(record.lines[name], values)
        np.testing.assert_array_equal(record.lines["capacity"], mooring.capacity)
        np.testing.assert_array_equal(record.lines["tn_slope"], mooring.tn_slope)


def test_a_campaign_that_kept_no_lines_has_none(tmp_path: Path) -> None:
    path = written_in_time(tmp_path / "campaign")
    finish_campaign(path)
    record = read_campaign(path)
    assert (record.line_names, record.line_kinds, dict(record.lines)) == ((), (), {})


def test_what_was_written_is_read_whatever_the_order_of_the_blocks(tmp_path: Path) -> None:
    record = read_campaign(finished(tmp_path / "campaign"))
    assert record.seas == SEAS
    for name, first in answers(0, 4).items():
        both = np.concatenate([first, answers(4, 7)[name]])
        np.testing.assert_array_equal(getattr(record, name), both)
    assert (record.cage_toml, record.law, record.seed) == ('name = "small"', "loland", 4)
    assert len(record) == len(SEAS)


def test_an_unfinished_campaign_says_which_blocks_are_there_and_is_not_read(
    tmp_path: Path,
) -> None:
    path = created(tmp_path / "campaign")
    write_cases(path, 0, answers(0, 4))
    attributes, result, block = campaign_results(path)
    assert attributes["law"] == "loland"
    assert result.tolist() == [0, 0, 0, 0, -1, -1, -1]
    assert block == 4
    with pytest.raises(RecordError, match=r"3 of 7 cases .* have not been run"):
        read_campaign(path)


def test_a_block_torn_before_its_results_counts_as_not_run(tmp_path: Path) -> None:
    path = created(tmp_path / "campaign")
    torn = answers(0, 4)
    del torn["result"]
    with pytest.raises(KeyError):
        write_cases(path, 0, torn)
    assert campaign_results(path)[1].tolist() == [-1] * 7


def test_a_campaign_appears_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("zarr.consolidate_metadata", fail)
    with pytest.raises(KeyboardInterrupt):
        created(tmp_path / "campaign")
    assert not (tmp_path / "campaign").exists()
    monkeypatch.undo()
    assert campaign_results(created(tmp_path / "campaign"))[1].tolist() == [-1] * 7


def test_plain_xarray_opens_a_campaign_with_its_units_and_coordinates(tmp_path: Path) -> None:
    with xarray.open_zarr(finished(tmp_path / "campaign")) as dataset:
        assert dataset.node_position.dims == ("case", "node", "axis")
        assert dataset.bridle_tension.dims == ("case", "line")
        assert dataset.Conventions == "CF-1.11, ACDD-1.3"
        assert set(dataset.coords) == {"current_speed", "current_to", "hs", "tp", "wave_from"}
        assert dataset.current_to.standard_name == "sea_water_velocity_to_direction"
        for variable in dataset.variables.values():
            assert {"units", "long_name"} <= variable.attrs.keys()


def test_an_exported_campaign_is_the_same_campaign(tmp_path: Path) -> None:
    store = finished(tmp_path / "campaign")
    export_campaign(store, tmp_path / "campaign.nc")
    assert read_campaign(tmp_path / "campaign.nc").sha256 == read_campaign(store).sha256
    assert sorted(path.name for path in tmp_path.iterdir()) == ["campaign", "campaign.nc"]
    with xarray.open_dataset(tmp_path / "campaign.nc", engine="h5netcdf") as dataset:
        assert dataset.result.flag_values.dtype == dataset.result.dtype
        assert dataset.result.flag_meanings.split()[1] == "converged"


@pytest.mark.parametrize("make", ["nothing", "a folder", "a file"])
def test_what_is_no_campaign_is_refused_in_one_sentence(tmp_path: Path, make: str) -> None:
    path = tmp_path / "something"
    if make == "a folder":
        path.mkdir()
    elif make == "a file":
        path.write_text("x")
    for read in (read_campaign, campaign_results):
        with pytest.raises(RecordError, match="there is no campaign here"):
            read(path)


def test_only_cases_with_an_answer_are_learned_from(tmp_path: Path) -> None:
    record = read_campaign(finished(tmp_path / "campaign"))
    mixed = replace(record, result=np.array([0, 1, 2, 3, 4, 5, 0]))
    assert mixed.converged.tolist() == [True, False, False, False, True, True, True]


def test_the_hash_knows_every_part(tmp_path: Path) -> None:
    record = read_campaign(finished(tmp_path / "campaign"))
    moved = record.node_position.copy()
    moved[3, 2, 1] += 1e-12
    changed: list[CampaignRecord] = [
        replace(record, node_position=moved),
        replace(record, law="aarsnes"),
        replace(record, seed=5),
        replace(record, seas=record.seas[::-1]),
    ]
    changed.append(replace(record, volume_std=np.ones(7)))
    assert len({record.sha256, *(one.sha256 for one in changed)}) == 6
    assert replace(record).sha256 == record.sha256
