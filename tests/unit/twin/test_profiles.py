"""A twin that takes the current over depth, and one that is given it at one depth alone."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.conventions import NonsenseError, Origin, towards
from seacage.dynamics import settle
from seacage.ocean import over_depth
from seacage.records import CampaignRecord, FieldRecord, Record, bin_keys
from seacage.twin import Metocean, Training, Twin, train
from seacage.twin._faults._residuals import responses
from seacage.twin._profiles import DRAWS, Profiles

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 8})
BINS = np.array([5.0, 15.0, 25.0])
WITH_PROFILE = Training(inputs=("current", "profile"), restarts=0)
START = np.datetime64("2020-01-18T00:00:00", "us")


def campaign_of(plan: Plan) -> CampaignRecord:
    response = settle(CAGE, plan.seas)
    names = ("node_position", "bridle_tension", "net_force", "volume", "residual", "result")
    return CampaignRecord(
        cage_toml=CAGE.to_toml(),
        seas=plan.seas,
        law="kristiansen-faltinsen",
        seed=0,
        version="0",
        **{name: getattr(response, name) for name in names},
    )


def buoy_of(mean: np.ndarray, shear: np.ndarray) -> Record:
    """A buoy that tells the current at the surface, and at three depths."""
    surface, *bins = np.moveaxis(over_depth(mean, shear, np.array([0.0, *BINS])), 1, 0)
    keys = [("current_speed_m_s", "current_to_deg"), *map(bin_keys, BINS.tolist())]
    values = {}
    for (speed, to), velocity in zip(keys, (surface, *bins), strict=True):
        values[speed] = np.linalg.norm(velocity, axis=1)
        values[to] = np.rad2deg(np.arctan2(*velocity.T)) % 360.0
    time = START + np.arange(len(mean)) * np.timedelta64(600, "s")
    return Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED)


@pytest.fixture(scope="module")
def water() -> Record:
    rng = np.random.default_rng(0)
    mean = towards(rng.uniform(0.1, 0.8, 300), rng.uniform(0.0, 360.0, 300))
    return buoy_of(mean, rng.normal(scale=0.15, size=(300, 2)))


@pytest.fixture(scope="module")
def level_1() -> Twin:
    return train(CAGE, campaign_of(Plan.named("profile", 0, 60)), training=WITH_PROFILE)


@pytest.fixture(scope="module")
def twin(level_1: Twin, water: Record) -> Twin:
    """Level 2 of one depth sensor, that reads a little deeper than the simulation."""
    depth = level_1.predict(Metocean.of_record(water)).sensor_low.mean[:, 0]
    noise = np.random.default_rng(1).normal(scale=0.02, size=len(depth))
    values = {"depth_m": 1.1 * depth + noise}
    name = level_1.sensor_names[0]
    sensor = Record(stream=name, time=water.time, values=values, origin=Origin.MEASURED)
    field = FieldRecord(cage=CAGE.name, buoy=water, sensors={name: sensor}, origin=Origin.MEASURED)
    return train(CAGE, None, field, base=level_1, training=WITH_PROFILE)


def test_level_1_knows_what_a_shear_does(level_1: Twin):
    plan = Plan.named("profile", 7, 12)
    found = level_1.predict(plan.seas).sensor_low.mean
    nodes = [sensor.node for sensor in CAGE.depth_sensors]
    true = -settle(CAGE, plan.seas).node_position[:, nodes, 2]
    uniform = [replace(sea, current_shear=0.0, shear_to=0.0) for sea in plan.seas]
    without = -settle(CAGE, uniform).node_position[:, nodes, 2]
    error = np.abs(found[:, : len(nodes)] - true).mean()
    assert error < 0.5 * np.abs(without - true).mean()


def test_a_twin_that_is_given_one_depth_answers_for_all_profiles_and_is_wider(
    twin: Twin, water: Record
):
    known = Metocean.of_record(water.rows(slice(0, 40)))
    one_depth = replace(known, profile=None)
    sharp, wide = twin.predict(known), twin.predict(one_depth)
    assert twin.models.upper
    assert np.all(sharp.valid)
    assert np.all(wide.valid)
    assert wide.sensor.std[:, 0].mean() > 2.0 * sharp.sensor.std[:, 0].mean()
    # the mean over the members, one by one, by total variance
    each = twin.predict(twin.models.profiles.members(one_depth))
    mean, std = (one.reshape(40, DRAWS, -1) for one in (each.sensor.mean, each.sensor.std))
    np.testing.assert_allclose(wide.sensor.mean, mean.mean(axis=1), rtol=1e-9)
    variance = (std**2).mean(axis=1) + mean.var(axis=1)
    np.testing.assert_allclose(wide.sensor.std**2, variance, rtol=1e-9)
    # and rows with a profile do not feel those beside them that have none
    mixed = replace(known, profile=known.profile.copy())
    mixed.profile[::2] = np.nan
    both = twin.predict(mixed).sensor.mean
    np.testing.assert_allclose(both[1::2], sharp.sensor.mean[1::2], rtol=1e-9)
    np.testing.assert_allclose(both[::2], wide.sensor.mean[::2], rtol=1e-9)


def test_profiles_keep_their_mean_and_turn_with_the_current():
    rng = np.random.default_rng(2)
    current = towards(rng.uniform(0.1, 0.8, 4000), rng.uniform(0.0, 360.0, 4000))
    along = current / np.linalg.norm(current, axis=1, keepdims=True)
    shear = -0.2 * along + rng.normal(scale=0.05, size=(4000, 2))
    profiles = Profiles.of(current, np.hstack([current + 0.5 * shear, shear]))
    members = profiles.members(Metocean.without_waves(np.array([[0.0, 0.5], [0.4, 0.0]])))
    north, east = members.profile.reshape(2, DRAWS, 4).mean(axis=1)
    np.testing.assert_allclose(north, [0.0, 0.4, 0.0, -0.2], atol=0.03)
    np.testing.assert_allclose(east, [0.3, 0.0, -0.2, 0.0], atol=0.03)


def test_a_twin_with_profiles_is_the_same_after_its_folder(twin: Twin, water: Record, tmp_path):
    twin.write(tmp_path / "twin")
    again = Twin.read(tmp_path / "twin")
    some = water.rows(slice(0, 20))
    for one in (some, replace(some, values=dict(list(some.values.items())[:2]), flags={})):
        before, after = (each.predict_record(one) for each in (twin, again))
        np.testing.assert_array_equal(before.sensor.mean, after.sensor.mean)
        np.testing.assert_array_equal(before.sensor.std, after.sensor.std)


def test_a_live_sample_with_bins_is_answered_as_its_record(twin: Twin, water: Record):
    rows = water.rows(slice(0, 6))
    state = twin.start()
    for sample in rows.samples():
        state, events = twin.step(state, sample, sample.t)
    last = next(one for one in events if hasattr(one, "answer"))
    record = twin.predict_record(rows)
    np.testing.assert_allclose(last.answer.sensor.mean[0], record.sensor.mean[-1], rtol=1e-9)
    assert last.metocean is not None
    assert last.metocean.profile is not None


def test_a_bin_that_failed_its_checks_is_no_part_of_the_profile(twin: Twin, water: Record):
    rows = water.rows(slice(0, 3))
    sample = list(rows.samples())[-1]
    bad = replace(sample, values={**sample.values, "current_speed_15m_m_s": 9.0}, flags={})
    _, events = twin.step(twin.start(), bad, datetime(2020, 1, 18, 0, 21, tzinfo=UTC))
    answered = next(one for one in events if hasattr(one, "answer"))
    assert answered.answer.valid[0]
    two = {key: rows.values[key] for key in rows.values if "15m" not in key}
    expected = twin.predict_record(replace(rows, values=two, flags={}))
    found = answered.answer.sensor.mean[0]
    np.testing.assert_allclose(found, expected.sensor.mean[-1], rtol=1e-9)


def test_what_has_no_profile_cannot_train_one(level_1: Twin, water: Record):
    with pytest.raises(NonsenseError, match="--plan profile"):
        train(CAGE, campaign_of(Plan.named("current", 0, 24)), training=WITH_PROFILE)
    plain = replace(water, values=dict(list(water.values.items())[:2]), flags={})
    field = FieldRecord(cage=CAGE.name, buoy=plain, sensors={}, origin=Origin.MEASURED)
    with pytest.raises(NonsenseError, match="current_speed_5m_m_s"):
        train(CAGE, None, field, base=level_1, training=WITH_PROFILE)


def test_a_little_more_current_is_felt_where_the_profile_is_known(twin: Twin, water: Record):
    found = responses(twin, [*twin.models.upper], Metocean.of_record(water).rows(np.array([5, 7])))
    assert found["gradient"].shape == (2, 1, 2)
    assert np.all(np.linalg.norm(found["gradient"], axis=2) > 1.0)
    assert np.all(found["half_drag"] > 0.1)
