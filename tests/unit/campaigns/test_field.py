"""The virtual field."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Hidden, VirtualField, generated_current, virtual_field
from seacage.campaigns._field import current_at_cage
from seacage.conventions import Flag, InputError, Origin, compass
from seacage.records import Record
from stand_in import StandIn

HIDDEN = Hidden.read()
EXACT = replace(
    HIDDEN,
    buoy=replace(HIDDEN.buoy, speed_sd_m_s=0.0, direction_sd_deg=0.0),
    current=replace(HIDDEN.current, residual_sd_m_s=0.0),
)
BUOY = generated_current(0, start=datetime(2020, 1, 18, tzinfo=UTC), days=10.0)
STEP = 300.0


def steady(speed: float, to: float) -> Record:
    time = np.datetime64("2020-01-18") + np.arange(300) * np.timedelta64(720, "s")
    values = {"current_speed_m_s": np.full(300, speed), "current_to_deg": np.full(300, to)}
    return Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED)


def at_cage(buoy: Record, seconds: np.ndarray, hidden: Hidden = EXACT) -> np.ndarray:
    return current_at_cage(buoy, seconds, hidden=hidden, rng=np.random.default_rng(0))


@pytest.fixture(scope="module")
def field(small_cage: Cage) -> Iterator[VirtualField]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
        yield virtual_field(small_cage, BUOY, hidden=HIDDEN, seed=1, workers=1, every_s=STEP)


def test_the_current_is_slowed_and_turned_by_its_direction() -> None:
    changed = [at_cage(steady(0.5, to), np.array([0.0, 60.0]))[0] for to in np.arange(0.0, 360.0)]
    factor = np.linalg.norm(changed, axis=1) / 0.5
    turn = (compass(np.array(changed)) - np.arange(360.0) + 180.0) % 360.0 - 180.0
    assert (factor.min(), factor.max()) == pytest.approx((0.75, 1.15), abs=1e-3)
    assert (turn.min(), turn.max()) == pytest.approx((-15.0, 20.0), abs=0.05)
    assert np.argmin(factor) == pytest.approx(150, abs=1)


@pytest.mark.parametrize(("speed", "lag"), [(1.0, 400.0), (0.5, 800.0), (0.1, 1800.0)])
def test_the_current_arrives_as_late_as_the_water_needs(speed: float, lag: float) -> None:
    buoy = steady(speed, 0.0)
    change = 150 * 720.0
    to = np.where(np.arange(300) < 150, 0.0, 90.0)
    turned = replace(buoy, values={**buoy.values, "current_to_deg": to})
    seconds = np.arange(change - 1000.0, change + 3000.0, 10.0)
    north = at_cage(turned, seconds)[:, 1] > 0.9 * at_cage(buoy, seconds)[0, 1]
    # The buoy's vector turns within the 12 minutes between two of its readings.
    left = seconds[np.argmin(north)]
    assert change - 720.0 < left - lag < change


def test_eddies_and_the_buoys_error_are_as_large_as_hidden() -> None:
    seconds = np.arange(0.0, 200_000.0, 60.0)
    clean, real = at_cage(steady(0.5, 10.0), seconds), at_cage(steady(0.5, 10.0), seconds, HIDDEN)
    assert 0.03 < np.std(real - clean, axis=0).mean() < 0.06


def test_rows_that_failed_are_bridged() -> None:
    buoy = steady(0.5, 0.0)
    speed = buoy.values["current_speed_m_s"].copy()
    flags = np.full(300, Flag.GOOD, np.uint8)
    speed[100], flags[100] = -50.0, Flag.FAIL
    broken = replace(
        buoy,
        values={**buoy.values, "current_speed_m_s": speed},
        flags={**buoy.flags, "current_speed_m_s": flags},
    )
    seconds = np.arange(0.0, 200_000.0, 60.0)
    np.testing.assert_array_equal(at_cage(broken, seconds), at_cage(buoy, seconds))


def test_still_water_stays_still_but_for_the_eddies() -> None:
    np.testing.assert_array_equal(at_cage(steady(0.0, 0.0), np.array([0.0, 60.0])), 0.0)


def test_a_buoy_without_a_usable_current_is_refused() -> None:
    silent = steady(np.nan, 0.0)
    with pytest.raises(InputError, match="0 usable currents in 300 rows"):
        at_cage(silent, np.array([0.0, 60.0]))


def test_the_field_says_what_it_is(field: VirtualField) -> None:
    for record in (field.record, field.truth):
        assert record.origin is Origin.VIRTUAL_FIELD
        assert record.hidden_sha256 == HIDDEN.sha256
        assert record.notes[0].startswith("Virtual field")
        assert {sensor.origin for sensor in record.sensors.values()} == {Origin.VIRTUAL_FIELD}
        assert sum("the error is" in note for note in record.notes) == 8
        assert record.cage == "ace"


def test_the_buoys_stream_passes_through_unchanged(field: VirtualField) -> None:
    assert field.record.buoy is BUOY
    assert field.truth.buoy is BUOY


def test_every_sensor_of_the_cage_speaks_and_the_truth_never_pauses(
    small_cage: Cage, field: VirtualField
) -> None:
    assert tuple(field.record.sensors) == small_cage.sensor_names
    assert tuple(field.truth.sensors) == small_cage.sensor_names
    for name, sensor in field.truth.sensors.items():
        assert set(np.diff(sensor.time)) == {np.timedelta64(300, "s")}
        (values,) = sensor.values.values()
        assert np.isfinite(values).all()
        assert len(field.record.sensors[name]) < len(sensor)


def test_the_truth_is_near_what_the_sensors_say(field: VirtualField) -> None:
    for name, said in field.record.sensors.items():
        (key,) = said.values
        exact = field.truth.sensors[name]
        error = said.values[key] - exact.values[key][np.isin(exact.time, said.time)]
        assert abs(np.median(error)) < (0.6 if key == "tension_kn" else 0.1)


def test_the_seed_changes_the_noise_and_neither_the_cage_nor_its_responses(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    options = {"hidden": EXACT, "responses": tmp_path, "workers": 1, "every_s": 600.0}
    one = virtual_field(small_cage, BUOY, seed=1, **options)
    settled = len(stand_in.settled)
    two = virtual_field(small_cage, BUOY, seed=2, **options)
    assert len(stand_in.settled) == settled
    exact = [field.truth.sensors["depth-2"].values["depth_m"] for field in (one, two)]
    np.testing.assert_array_equal(*exact)
    said = [field.record.sensors["depth-2"].values["depth_m"][0] for field in (one, two)]
    assert said[0] != said[1]


@pytest.mark.parametrize(("minutes", "every_s"), [(0, 60.0), (5, 60.0), (60, 0.0), (60, 3600.0)])
def test_a_record_too_short_for_two_readings_is_refused(
    small_cage: Cage, minutes: int, every_s: float
) -> None:
    start = datetime(2020, 1, 18, tzinfo=UTC)
    short = BUOY.between(start, start + timedelta(minutes=minutes))
    with pytest.raises(InputError, match="holds no two readings"):
        virtual_field(small_cage, short, hidden=HIDDEN, seed=1, every_s=every_s)
