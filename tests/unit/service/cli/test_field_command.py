"""``seacage field virtual``, with a formula in the simulator's place."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from follower import Follower
from seacage.cage import Cage
from seacage.records import FieldRecord, TrueMeans
from seacage.service._cli._app import app


@pytest.fixture(autouse=True)
def own_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands keep their hands off the process's logs: their stream closes with the test."""
    monkeypatch.setattr("seacage.service._logs.begin_logs", lambda _: None)


@pytest.fixture
def follower(monkeypatch: pytest.MonkeyPatch) -> Follower:
    fake = Follower()
    monkeypatch.setattr("seacage.campaigns._virtual_field._stretches.follow", fake.follow)
    return fake


@pytest.fixture
def words(tmp_path: Path) -> list[str]:
    """Three hours of a small cage, in this process."""
    mesh = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
    Cage.named("ace").altered(mesh=mesh).write(tmp_path / "small.toml")
    cage = ["--cage", str(tmp_path / "small.toml"), "--workers", "1"]
    return ["field", "virtual", str(tmp_path / "out"), *cage, "--days", "0.14"]


def run(*words: str) -> Any:
    return CliRunner().invoke(app, list(words), catch_exceptions=False)


def test_a_field_is_made_with_its_truth_and_its_waves(
    follower: Follower, words: list[str], tmp_path: Path
) -> None:
    result = run(*words, "--json")
    assert result.exit_code == 0, result.stderr
    answer = json.loads(result.stdout)
    assert answer["origin"] == "virtual field"
    assert answer["streams"]["depth-1"] > 5000
    record = FieldRecord.read(tmp_path / "out")
    assert record.buoy.values.keys() >= {"current_speed_m_s", "hs_m"}
    assert len(TrueMeans.read(tmp_path / "out" / "truth").time) == 18
    # three hours, in as many lanes as may be
    assert follower.starts == [600.0 * number for number in range(18)]


def test_a_calm_sea_has_no_waves(follower: Follower, words: list[str], tmp_path: Path) -> None:
    assert run(*words, "--calm").exit_code == 0
    assert "hs_m" not in FieldRecord.read(tmp_path / "out").buoy.values


@pytest.mark.slow
def test_a_record_drives_the_field_in_its_first_days_with_its_own_waves(
    follower: Follower, words: list[str], tmp_path: Path
) -> None:
    rows = [f"2018-01-26T{hour:02d}:{minute:02d}:00Z" for hour in range(9) for minute in (0, 30)]
    (tmp_path / "buoy.csv").write_text(
        "time,current_speed_m_s,current_to_deg,hs_m,tp_s,wave_from_deg\n"
        + "".join(f"{time},0.4,80,1.5,6,240\n" for time in rows)
    )
    result = run(*words, "--record", str(tmp_path / "buoy.csv"))
    assert result.exit_code == 0, result.stderr
    truth = FieldRecord.read(tmp_path / "out" / "truth")
    assert (
        truth.buoy.time[[0, -1]].tolist()
        == np.array(["2018-01-26T00:00", "2018-01-26T03:00"], "datetime64[us]").tolist()
    )
    np.testing.assert_array_equal(truth.buoy.values["hs_m"], 1.5)


@pytest.mark.slow
def test_events_come_from_words_and_from_a_file(
    follower: Follower, words: list[str], tmp_path: Path
) -> None:
    (tmp_path / "events.toml").write_text(
        '[[event]]\nkind = "drift"\ntarget = "depth-2"\nat = 2020-01-18T02:00:00Z\n'
    )
    cut = "bridle-cut bridle-8 2020-01-18T01:30Z"
    result = run(*words, "--event", cut, "--events", str(tmp_path / "events.toml"))
    assert result.exit_code == 0, result.stderr
    notes = FieldRecord.read(tmp_path / "out" / "truth").notes
    assert [note.split()[1] for note in notes if note.startswith("Event")] == [
        "bridle-cut",
        "drift",
    ]


@pytest.mark.slow
def test_a_share_simulates_its_part_and_writes_no_record(
    follower: Follower, words: list[str], tmp_path: Path
) -> None:
    assert run(*words, "--share", "1/2").exit_code == 0
    assert follower.starts == [600.0 * number for number in range(1, 18, 2)]
    assert not (tmp_path / "out" / "field.json").exists()
    follower.calls.clear()
    assert run(*words).exit_code == 0
    assert follower.starts == [600.0 * number for number in range(0, 18, 2)]


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (["--event", "bridle-cut bridle-8 2021-01-01T00:00Z"], "not within the record"),
        (["--event", "sinks cage-1 2020-01-18T01:00Z"], "sinks"),
        (["--share", "5/2"], "Share 5 of 2 does not exist"),
        (["--method", "settle", "--one-in", "8"], "are for --method simulate"),
        (["--method", "settle", "--event", "drift depth-1 2020-01-18T01:00Z"], "no events"),
    ],
)
def test_what_cannot_be_made_ends_with_1_and_one_sentence(
    follower: Follower, words: list[str], more: list[str], sentence: str
) -> None:
    result = run(*words, *more)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert sentence in result.stderr
    assert not follower.calls


def test_a_folder_of_another_seed_is_refused(follower: Follower, words: list[str]) -> None:
    assert run(*words).exit_code == 0
    result = run(*words, "--seed", "1")
    assert result.exit_code == 1
    assert "stretches of a field with another seed and buoy record" in result.stderr
