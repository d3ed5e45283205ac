from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Flag, InputError, Origin
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Training, align, train

FEW = Training(high_fidelity_points=25, days=1.0, restarts=0)


def coarse():
    return stand_in_twin().cage


def taught_by(field, *, training=FEW, cases=40):
    campaign = stand_in_campaign(coarse(), stand_in_seas(cases))
    return train(coarse(), campaign, field, training=training)


def with_sensors(field, *names):
    return replace(field, sensors={name: field.sensors[name] for name in names})


def test_level_two_is_nearer_to_every_sensor_than_level_one_on_days_that_did_not_teach():
    twin, field = stand_in_twin(), stand_in_field(coarse())
    for column, name in enumerate(twin.sensor_names):
        pairs = align(field, name, start=twin.provenance.lessons[name].end)
        answer = twin.predict(pairs.metocean)
        low, multi = (
            np.mean(np.abs(said.mean[:, column] - pairs.value))
            for said in (answer.sensor_low, answer.sensor)
        )
        assert multi < 0.4 * low, name


def test_the_interval_of_a_reading_holds_most_unseen_readings():
    twin, field = stand_in_twin(), stand_in_field(coarse())
    for column, name in enumerate(("depth-1", "depth-2", "depth-3")):
        pairs = align(field, name, start=twin.provenance.lessons[name].end)
        lower, upper = twin.predict(pairs.metocean).sensor_interval()
        held = (lower[:, column] <= pairs.value) & (pairs.value <= upper[:, column])
        # One tide's lesson; block to block the share moves by a few per cent.
        assert 0.9 < held.mean() < 1.0


def test_a_shackle_teaches_with_its_first_window_alone():
    lesson = stand_in_twin().provenance.lessons["shackle-1"]
    assert (lesson.end - lesson.start).total_seconds() < 43200.0


def test_without_a_field_record_everything_answers_at_level_one():
    twin = taught_by(None)
    answer = twin.predict(stand_in_seas(3))
    assert twin.origin == Origin.COMPUTED
    assert set(answer.sensor_level) == set(answer.bridle_level) == {1}
    assert answer.sensor.mean == pytest.approx(answer.sensor_low.mean)


def test_a_sensor_with_too_few_sound_readings_stays_at_level_one():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1", "depth-2")
    bad = field.sensors["depth-2"]
    flags = {"depth_m": np.full(len(bad), Flag.FAIL)}
    flags["depth_m"][:10] = Flag.GOOD
    broken = replace(field, sensors={**field.sensors, "depth-2": replace(bad, flags=flags)})
    twin = taught_by(broken)
    assert twin.predict(stand_in_seas(2)).sensor_level[:2].tolist() == [2, 1]
    assert list(twin.provenance.lessons) == ["depth-1"]


def test_a_sensor_without_any_sound_reading_stays_at_level_one():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1")
    flags = {"depth_m": np.full(len(field.sensors["depth-1"]), Flag.FAIL)}
    silent = replace(field.sensors["depth-1"], flags=flags)
    twin = taught_by(replace(field, sensors={"depth-1": silent}))
    assert twin.provenance.lessons == {}
    assert twin.origin == Origin.COMPUTED


def test_a_sensor_moved_to_another_bridle_is_trained_from_the_same_campaign():
    cage = coarse()
    moved = replace(
        cage, shackle=tuple(replace(one, bridle=one.bridle % 12 + 1) for one in cage.shackle)
    )
    campaign = stand_in_campaign(cage, stand_in_seas(40))
    field = with_sensors(stand_in_field(moved, days=1.0), "shackle-1")
    answer = train(moved, campaign, field, training=FEW).predict(stand_in_seas(2))
    assert np.flatnonzero(answer.bridle_level == 2).tolist() == [moved.shackles[0].bridle]


def test_training_twice_with_one_seed_gives_one_twin():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1", "shackle-1")
    once, twice = (taught_by(field).predict(stand_in_seas(5, seed=9)) for _ in range(2))
    np.testing.assert_array_equal(once.sensor.mean, twice.sensor.mean)
    np.testing.assert_array_equal(once.node_position, twice.node_position)


def test_the_papers_choice_is_the_first_readings_in_a_row():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1")
    spread, paper = (
        taught_by(field, training=replace(FEW, choice=choice)) for choice in ("spread", "paper")
    )
    pairs = align(field, "depth-1", mean_s=60.0)
    misses = [
        np.mean(np.abs(twin.predict(pairs.metocean).sensor.mean[:, 0] - pairs.value))
        for twin in (spread, paper)
    ]
    # An hour of one current teaches little about a tide.
    assert misses[0] < misses[1]


def test_waves_may_be_among_the_inputs():
    seas = stand_in_seas(40)
    random = np.random.default_rng(0)
    wavy = tuple(
        replace(sea, hs=hs, tp=None, wave_from=to)
        for sea, hs, to in zip(
            seas,
            random.uniform(0, 3, 40).tolist(),
            random.uniform(0, 360, 40).tolist(),
            strict=True,
        )
    )
    campaign = stand_in_campaign(coarse(), wavy)
    twin = train(coarse(), campaign, training=replace(FEW, inputs=("current", "waves")))
    assert twin.predict(wavy[3]).in_domain.all()
    high = replace(wavy[3], hs=6.0, tp=None)
    assert "waves up to" in twin.predict(high).reason[0]


def test_cases_that_did_not_converge_teach_nothing():
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    result = np.zeros(40, dtype=int)
    result[5:] = 2
    lost = replace(campaign, result=result)
    with pytest.raises(InputError, match="5 of the campaign's 40 cases converged"):
        train(coarse(), lost)


def test_the_cage_must_be_the_one_that_was_simulated():
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    with pytest.raises(InputError, match="81 nodes, that of ace 321"):
        train(Cage.named("ace"), campaign)


def test_training_tells_how_far_it_is():
    told = []
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    train(coarse(), campaign, training=FEW, progress=lambda *step: told.append(step))
    assert told == [("train bridles", 1, 2), ("train shape", 2, 2)]
