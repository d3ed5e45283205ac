"""Campaigns on disk."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray

from seacage.conventions import RecordError, Result
from seacage.ocean import SeaState
from seacage.records import (
    CampaignRecord,
    campaign_results,
    create_campaign,
    export_campaign,
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


def test_only_converged_cases_are_learned_from(tmp_path: Path) -> None:
    record = read_campaign(finished(tmp_path / "campaign"))
    mixed = replace(record, result=np.array([0, 1, 2, 0, 0, 0, 0]))
    assert mixed.converged.tolist() == [True, False, False, True, True, True, True]


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
    assert len({record.sha256, *(one.sha256 for one in changed)}) == 5
    assert replace(record).sha256 == record.sha256
