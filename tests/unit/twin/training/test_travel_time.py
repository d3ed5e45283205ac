"""The travel time of the current is found in the sensors' readings."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.campaigns import generated_current
from seacage.conventions import Origin
from seacage.records import FieldRecord, Record
from seacage.testing import stand_in_campaign, stand_in_seas, stand_in_twin
from seacage.twin import Training, TravelTime, train
from seacage.twin._training._travel_time import fit_travel_time

START = datetime(2020, 1, 18, tzinfo=UTC)
TRAINING = Training(days=10.0, restarts=0, high_fidelity_points=60)


def field(travel, *, days=8.0, seed=3, noise=0.03):
    """Depths that follow the square of the current that has arrived."""
    buoy = generated_current(seed, start=START, days=days)
    time = np.arange(buoy.time[0], buoy.time[-1], np.timedelta64(120, "s"))
    velocity = travel.water_at(buoy, time).current_velocity
    random = np.random.default_rng(seed)
    depths = {f"depth-{k}": 14.0 - k * np.sum(velocity**2, axis=1) - velocity[:, 0] for k in (1, 2)}
    sensors = {
        name: Record(
            stream=name,
            time=time,
            values={"depth_m": depth + noise * random.standard_normal(len(time))},
            origin=Origin.VIRTUAL_FIELD,
        )
        for name, depth in depths.items()
    }
    return FieldRecord(cage="ace", buoy=buoy, sensors=sensors, origin=Origin.VIRTUAL_FIELD)


@pytest.mark.parametrize("seed", [3, 4, 5])
@pytest.mark.parametrize(
    "travel",
    [
        TravelTime(distance_m=200.0, longest_s=1800.0),
        TravelTime(distance_m=700.0, longest_s=1800.0),
        TravelTime(distance_m=400.0, longest_s=900.0),
    ],
)
def test_distance_and_limit_are_found(travel, seed):
    found = fit_travel_time(field(travel, seed=seed), ["depth-1", "depth-2"], TRAINING)
    assert found.distance_m == pytest.approx(travel.distance_m, abs=50.0)
    assert found.longest_s == travel.longest_s


@pytest.mark.parametrize("seed", range(3, 9))
def test_where_the_water_comes_at_once_next_to_nothing_is_found(seed):
    record = field(TravelTime(), seed=seed)
    found = fit_travel_time(record, ["depth-1", "depth-2"], TRAINING)
    assert found.distance_m <= 50.0


def test_sensors_that_do_not_feel_the_current_show_none_but_by_chance():
    found = list[TravelTime]()
    for seed in range(12):
        record = field(TravelTime(), seed=seed)
        random = np.random.default_rng(seed)
        wander = np.cumsum(random.standard_normal(len(record.sensors["depth-1"].time))) * 0.01
        sensor = replace(record.sensors["depth-1"], values={"depth_m": 20.0 + wander})
        other = replace(record, sensors={"depth-1": sensor})
        found.append(fit_travel_time(other, ["depth-1"], TRAINING))
    assert sum(one.distance_m > 0.0 for one in found) <= 2


def test_it_takes_four_days_of_a_sensor_that_changes():
    travel = TravelTime(distance_m=400.0, longest_s=1800.0)
    assert fit_travel_time(field(travel, days=3.5), ["depth-1"], TRAINING) == TravelTime()
    record = field(travel)
    still = {
        name: replace(one, values={"depth_m": np.full(len(one), 10.0)})
        for name, one in record.sensors.items()
    }
    stuck = replace(record, sensors=still)
    assert fit_travel_time(stuck, ["depth-1", "depth-2"], TRAINING) == TravelTime()


def test_readings_of_every_other_day_and_a_sensor_without_errors_do_not_break_it():
    travel = TravelTime(distance_m=400.0, longest_s=1800.0)
    record = field(travel)
    first = record.sensors["depth-1"]
    even = first.rows(first.time.astype("datetime64[D]").astype(int) % 2 == 0)
    assert fit_travel_time(replace(record, sensors={"depth-1": even}), ["depth-1"], TRAINING) == (
        TravelTime()
    )
    exact = field(travel, noise=0.0)
    assert fit_travel_time(exact, ["depth-1"], TRAINING).longest_s == 1800.0


def test_a_twin_is_trained_with_it_and_keeps_that_of_the_level_2_it_is_given():
    travel = TravelTime(distance_m=400.0, longest_s=1800.0)
    cage = stand_in_twin().cage
    campaign = stand_in_campaign(cage, stand_in_seas(120))
    twin = train(cage, campaign, field(travel), training=TRAINING)
    assert twin.travel_time.distance_m == pytest.approx(400.0, abs=50.0)
    again = train(cage, None, field(TravelTime()), base=twin, training=TRAINING)
    assert again.travel_time == twin.travel_time
    paper = replace(TRAINING, choice="paper")
    assert train(cage, campaign, field(travel), training=paper).travel_time == TravelTime()
