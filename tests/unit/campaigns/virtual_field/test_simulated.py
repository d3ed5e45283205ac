"""The virtual field in time, with a formula in the simulator's place."""

import json
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from follower import Follower
from seacage.cage import Cage
from seacage.campaigns import (
    Event,
    Timetable,
    TruthParameters,
    VirtualField,
    generated_current,
    generated_waves,
    virtual_field,
    virtual_field_share,
)
from seacage.campaigns._virtual_field import _stretches
from seacage.conventions import InputError, Origin, SeacageError
from seacage.records import FieldRecord, Record, TrueMeans

SHIPPED = TruthParameters.read()
HIDDEN = replace(SHIPPED, shackle=replace(SHIPPED.shackle, windows=((0.05, 2.5), (0.72, 4.0))))
START = datetime(2020, 1, 18, tzinfo=UTC)
BUOY = generated_current(0, start=START, days=1.0)
WAVES = generated_waves(0, start=START, days=1.0)
STEP = 60.0
CUT = Event.parse("bridle-cut bridle-8 2020-01-18T12:10Z")


class StoppedError(Exception):
    """The user's patience."""


@dataclass(frozen=True, kw_only=True)
class Maker:
    """Makes fields of a small cage, calm unless waves are given."""

    cage: Cage
    follower: Follower

    def __call__(self, buoy: Record = BUOY, **asked: Any) -> VirtualField:
        usual = {"seed": 1, "hidden": HIDDEN, "every_s": STEP, "workers": 1}
        asked = {**usual, "timetable": Timetable(), **asked}  # cut into hours
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(_stretches, "follow", self.follower.follow)
            return virtual_field(self.cage, buoy, **asked)


@pytest.fixture
def made(small_cage: Cage) -> Maker:
    return Maker(cage=small_cage, follower=Follower())


@pytest.fixture(scope="module")
def field(small_cage: Cage) -> VirtualField:
    """A calm day."""
    return Maker(cage=small_cage, follower=Follower())()


@pytest.fixture(scope="module")
def rough(small_cage: Cage) -> VirtualField:
    """The same day with waves."""
    return Maker(cage=small_cage, follower=Follower())(waves=WAVES)


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def values(record: FieldRecord, name: str) -> np.ndarray:
    (column,) = record.sensors[name].values.values()
    return column


def test_the_field_says_what_it_is_and_the_truth_never_pauses(
    small_cage: Cage, field: VirtualField
) -> None:
    for record in (field.record, field.truth):
        assert record.origin is Origin.VIRTUAL_FIELD
        assert record.hidden_sha256 == HIDDEN.sha256
        assert record.notes[0].startswith("Virtual field, seed 1, simulated in time")
        assert tuple(record.sensors) == small_cage.sensor_names
    for sensor in field.truth.sensors.values():
        assert set(np.diff(sensor.time)) == {np.timedelta64(60, "s")}
        assert sensor.time[0] == BUOY.time[0]
        assert BUOY.time[-1] - sensor.time[-1] <= np.timedelta64(60, "s")


def test_the_truth_is_what_was_followed(small_cage: Cage, made: Maker) -> None:
    field = made()
    weather = made.follower.calls[0]["weathers"][1]
    second = 3600.0 + 1200.0
    current = weather.current(second)[0]
    row = int(second / STEP)
    depth = -small_cage.design_position[small_cage.depth_sensors[1].node, 2]
    # single precision
    assert values(field.truth, "depth-2")[row] == pytest.approx(
        depth - np.linalg.norm(current), abs=1e-5
    )
    bridle = small_cage.shackles[2].bridle
    assert values(field.truth, "shackle-3")[row] == pytest.approx(
        10.0 + current[0] * bridle, abs=1e-5
    )


def test_sensors_have_their_errors_and_shackles_their_windows(
    field: VirtualField,
) -> None:
    for name, outcome in field.record.sensors.items():
        exact = field.truth.sensors[name]
        error = (
            values(field.record, name)
            - values(field.truth, name)[np.isin(exact.time, outcome.time)]
        )
        # gain and bias of a shackle; noise and the air's pressure of a depth sensor
        assert 0.0 < abs(np.median(error)) < (0.6 if name.startswith("shackle") else 0.4)
    hours = {name: len(outcome) * STEP / 3600.0 for name, outcome in field.record.sensors.items()}
    assert hours["shackle-1"] < 6.5
    assert 20.0 < hours["depth-1"] < 24.0


@pytest.mark.slow
def test_a_depth_sensor_takes_waves_for_depth_and_the_truth_does_not(
    field: VirtualField, rough: VirtualField
) -> None:
    np.testing.assert_array_equal(values(field.truth, "depth-1"), values(rough.truth, "depth-1"))
    jumps = {
        name: [np.median(np.abs(np.diff(values(one.record, name)))) for one in (field, rough)]
        for name in ("depth-1", "depth-3")
    }
    assert jumps["depth-1"][1] > 1.2 * jumps["depth-1"][0]
    # 30 m down the waves are gone, all but a swell's
    assert jumps["depth-3"][1] == pytest.approx(jumps["depth-3"][0], rel=0.1)


def test_the_buoy_carries_the_waves_held_and_is_not_always_received(
    rough: VirtualField,
) -> None:
    whole, received = rough.truth.buoy, rough.record.buoy
    np.testing.assert_array_equal(whole.time, BUOY.time)
    np.testing.assert_array_equal(whole.values["hs_m"][:6], WAVES.values["hs_m"][[0] * 5 + [1]])
    assert any("Generated waves" in note for note in whole.notes)
    assert len(received) < len(whole)
    assert set(received.values) == {*BUOY.values, "hs_m", "tp_s", "wave_from_deg"}


@pytest.mark.slow
def test_a_buoy_that_measures_waves_needs_no_other_record(made: Maker, rough: VirtualField) -> None:
    again = made(rough.truth.buoy)
    for name in ("depth-1", "shackle-1"):
        assert len(values(again.record, name)) == len(values(rough.record, name))
    assert again.means is not None
    assert rough.means is not None
    # the same sea, but for the hours between the waves' rows
    np.testing.assert_allclose(again.means.hs, rough.means.hs, rtol=0.3)


@pytest.mark.slow
def test_the_means_are_those_of_the_readings_and_of_the_water(
    small_cage: Cage, made: Maker
) -> None:
    field = made(waves=WAVES)
    means, exact = field.means, field.truth
    assert means is not None
    assert len(means.time) == 142  # ten minutes each, but for the day's last 12 minutes
    shackle = small_cage.shackles[2]
    first = values(exact, shackle.name)[:10] * 1e3
    assert means.bridle_tension_mean[0, shackle.bridle] == pytest.approx(first.mean())
    assert means.bridle_tension_max[0, shackle.bridle] == pytest.approx(first.max())
    weather = made.follower.calls[0]["weathers"][0]
    looks = [weather.current(30.0 + 60.0 * number) for number in range(10)]
    np.testing.assert_allclose(means.current_velocity[0], np.mean(looks, axis=0), atol=1e-12)
    assert np.all(np.diff(means.growth) > 0.0)  # a day without a cleaning
    # what a draw of 64 components leaves of the record's height
    assert means.hs[0] == pytest.approx(WAVES.values["hs_m"][0], rel=0.2)


def test_a_sparse_field_is_the_whole_one_with_gaps_and_keeps_the_shackles_hours(
    made: Maker, field: VirtualField
) -> None:
    whole, sparse = field, made(timetable=Timetable(one_in=8))
    for name, exact in sparse.truth.sensors.items():
        same = np.isin(whole.truth.sensors[name].time, exact.time)
        np.testing.assert_array_equal(values(sparse.truth, name), values(whole.truth, name)[same])
        assert 0.1 < same.mean() < 0.8
    count = len(sparse.record.sensors["shackle-1"])
    assert count > 0.9 * len(whole.record.sensors["shackle-1"])
    assert any("one was simulated" in note for note in sparse.record.notes)
    assert not any("one was simulated" in note for note in whole.record.notes)


def test_a_sparse_field_can_be_filled_later(made: Maker, tmp_path: Path) -> None:
    made(timetable=Timetable(one_in=4), kept=tmp_path / "kept")
    sparse = len(made.follower.starts)
    made(kept=tmp_path / "kept")
    assert len(made.follower.starts) == len(set(made.follower.starts)) == 24
    assert sparse < 24


@pytest.fixture(scope="module")
def broken(small_cage: Cage, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What is written of a day on which a bridle is cut, made in one go."""
    folder = tmp_path_factory.mktemp("broken")
    Maker(cage=small_cage, follower=Follower())(events=[CUT]).write(folder)
    return contents(folder)


# 13 hours before the cut, the hour that begins with it, 11 hours after
@pytest.mark.slow
@pytest.mark.parametrize("stop_after", [0, 13, 25])
def test_a_stopped_field_goes_on_and_ends_with_the_same_bytes(
    made: Maker, broken: dict[str, bytes], tmp_path: Path, stop_after: int
) -> None:
    def stop(stage: str, done: int, total: int) -> None:
        assert (stage, total) == ("virtual field, simulated hours", 25)
        if done == stop_after:
            raise StoppedError

    body = {"events": [CUT], "kept": tmp_path / "kept"}
    with pytest.raises(StoppedError):
        made(**body, progress=stop)
    made(**body).write(tmp_path / "stopped")
    assert contents(tmp_path / "stopped") == broken


def test_shares_leave_nothing_to_do(
    small_cage: Cage,
    made: Maker,
    field: VirtualField,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(_stretches, "follow", made.follower.follow)
    body: dict[str, Any] = {"hidden": HIDDEN, "seed": 1, "every_s": STEP, "kept": tmp_path}
    body |= {"timetable": Timetable()}
    for which in (2, 0, 1):
        virtual_field_share(small_cage, BUOY, share=(which, 3), workers=1, **body)
    assert sorted(made.follower.starts) == [3600.0 * number for number in range(24)]
    made.follower.calls.clear()
    shared = made(kept=tmp_path)
    assert not made.follower.calls
    for name in small_cage.sensor_names:
        np.testing.assert_array_equal(values(shared.record, name), values(field.record, name))


@pytest.mark.parametrize("share", [(3, 3), (-1, 2), (0, 0)])
def test_a_share_that_does_not_exist_is_refused(
    small_cage: Cage, tmp_path: Path, share: tuple[int, int]
) -> None:
    with pytest.raises(InputError, match="Shares count from 0"):
        virtual_field_share(
            small_cage, BUOY, hidden=HIDDEN, seed=1, kept=tmp_path, share=share, every_s=STEP
        )


def test_an_event_is_noted_by_the_truth_and_not_by_the_record(
    made: Maker,
) -> None:
    silent = Event.parse("silent buoy-1 2020-01-18T16:00Z until=2020-01-18T22:00Z")
    field = made(events=[CUT, silent])
    assert [call["breaking"] for call in made.follower.calls if call["breaking"]] == [
        (CUT.damage(made.follower.calls[0]["cage"]),)
    ]
    assert f"Event: {CUT}." in field.truth.notes
    assert not any("vent" in note for note in field.record.notes)
    quiet = np.datetime64("2020-01-18T16:00"), np.datetime64("2020-01-18T22:00")
    received, report = (
        np.sum((one.buoy.time >= quiet[0]) & (one.buoy.time < quiet[1]))
        for one in (field.record, field.truth)
    )
    assert (received, report) == (0, 30)


def test_a_lost_stretch_is_a_gap_that_the_notes_name(
    made: Maker,
) -> None:
    made.follower.loses = {5 * 3600.0}
    field = made()
    gap = np.datetime64("2020-01-18T05:00"), np.datetime64("2020-01-18T06:00")
    for exact in field.truth.sensors.values():
        assert not np.any((exact.time >= gap[0]) & (exact.time < gap[1]))
    (note,) = (note for note in field.record.notes if "finite" in note)
    assert note.startswith("1 of 24 stretches")
    assert "2020-01-18T05:00:00Z" in note


def test_a_cage_that_is_always_lost_makes_no_field(
    made: Maker,
) -> None:
    made.follower.loses = {3600.0 * number for number in range(24)}
    with pytest.raises(SeacageError, match="all 24 simulations"):
        made()


def test_the_seed_changes_the_weather_and_the_noise(made: Maker, field: VirtualField) -> None:
    one, again, two = field, made(), made(seed=2)
    for record in ("record", "truth"):
        first, same, other = (
            values(getattr(field, record), "depth-1")[:50] for field in (one, again, two)
        )
        np.testing.assert_array_equal(first, same)
        assert np.all(first != other)


def test_nothing_that_is_hidden_is_in_what_is_written(field: VirtualField, tmp_path: Path) -> None:
    field.write(tmp_path)
    described = json.loads((tmp_path / "field.json").read_text("utf-8"))
    assert described["hidden_sha256"] == HIDDEN.sha256
    names = (resources.files("seacage.campaigns._virtual_field") / "hidden_ace.toml").read_text(
        "utf-8"
    )
    keys = {line.split("=")[0].strip() for line in names.splitlines() if "=" in line}
    text = json.dumps(described)
    assert not [key for key in keys - {"law", "seed", "components"} if key in text]


def test_a_written_field_is_read_back_with_its_truth(field: VirtualField, tmp_path: Path) -> None:
    field.write(tmp_path)
    read = FieldRecord.read(tmp_path / "truth")
    np.testing.assert_array_equal(values(read, "depth-1"), values(field.truth, "depth-1"))
    means = TrueMeans.read(tmp_path / "truth")
    assert field.means is not None
    np.testing.assert_array_equal(means.time, field.means.time)


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"waves": WAVES.between(START, START + timedelta(hours=12))}, "not as long as the"),
        (
            {"waves": replace(WAVES, time=WAVES.time + np.timedelta64(1, "h"))},
            "not as long as the",
        ),
        ({"events": [Event.parse("bridle-cut bridle-99 2020-01-18T12:10Z")]}, "bridle-99"),
        ({"every_s": 7.0}, "no whole number of 7 s"),
        ({"method": "settle", "waves": WAVES}, "settled field has no waves"),
        ({"method": "settle", "events": [CUT]}, "settled field has no waves, no events"),
    ],
)
def test_what_cannot_be_made_is_refused(made: Maker, asked: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        made(**asked)
