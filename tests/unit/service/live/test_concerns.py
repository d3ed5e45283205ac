from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from running_service import NOON
from seacage.conventions import Flag
from seacage.ocean import SeaState
from seacage.records import Sample
from seacage.service._live._answers import state_of, summary_of
from seacage.service._live._concerns import concerns_of
from seacage.service._schemas._state import AlarmBrief
from seacage.testing import stand_in_twin
from seacage.twin import AlarmPolicy, Answered
from seacage.twin._interval_factors import Tracked

SEA = {"current_speed_m_s": 0.5, "current_to_deg": 90.0}


def at(minutes: float):
    return NOON + timedelta(minutes=minutes)


def shackle(minutes: float, kilonewtons: float) -> Sample:
    return Sample(stream="shackle-2", t=at(minutes), values={"tension_kn": kilonewtons})


def depth(minutes: float, metres: float) -> Sample:
    return Sample(stream="depth-2", t=at(minutes), values={"depth_m": metres})


def seen(*samples: Sample, minutes: float = 0.0, least_volume: float = 0.0, unlike: str = ""):
    """State and concerns of a cage that has received samples, in a current of 0.5 m/s."""
    twin = stand_in_twin()
    memory = twin.start()
    for sample in (Sample(stream="buoy-1", t=NOON, values=SEA), *samples):
        memory, _ = twin.step(memory, sample, max(sample.t, memory.clock or sample.t))
    memory, events = twin.step(memory, None, at(minutes))
    answered = next(event for event in reversed(events) if isinstance(event, Answered))
    state = state_of("ace", twin, answered, memory)
    policy = AlarmPolicy.default(twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)
    found = concerns_of(state, memory, policy=policy, least_volume=least_volume, unlike=unlike)
    return state, {one.kind: one for one in found}


def test_a_cage_with_a_valid_reading_and_everything_within_its_limits_has_no_concern():
    assert seen(depth(0, 14.2))[1] == {}


def test_a_net_below_the_least_volume_is_a_concern_with_its_limit():
    _, concerns = seen(depth(0, 14.2), least_volume=0.999)
    assert concerns.keys() == {"volume"}
    assert concerns["volume"].message.endswith("100 % is the limit.")


def test_a_measured_load_at_its_alarms_limit_is_a_concern_before_any_alarm_is_raised():
    state, concerns = seen(shackle(0, 128.0))
    assert state.alarms == []
    text = "bridle-8 bears 80 % of its capacity, measured by shackle-2; 80 % is the limit."
    assert concerns["load"].message == text
    assert concerns["load"].key == "load_measured"
    values = {"line": "bridle-8", "shackle": "shackle-2", "load_share": 0.8, "limit_share": 0.8}
    assert concerns["load"].values == values
    assert summary_of("ace", state).max_utilisation == pytest.approx(0.8)


def test_a_measured_load_holds_until_its_shackle_is_silent_as_its_alarm_takes_it():
    for minutes, measured in ((14.0, 60.0), (16.0, None)):
        state, _ = seen(shackle(0, 60.0), minutes=minutes)
        assert state.bridles[7].measured_kn == measured


def test_waves_count_by_their_mean_over_the_last_minute():
    state, _ = seen(*(shackle(k / 12, 50.0 + 20.0 * (k % 2)) for k in range(12)), minutes=1.0)
    assert state.bridles[7].measured_kn == pytest.approx(60.0)


def test_a_load_of_a_shackle_that_reads_irregularly_is_not_believed():
    state, _ = seen(shackle(0, 128.0))
    alarm = AlarmBrief(
        id="irregular.shackle-2",
        severity=500,
        title="shackle-2 reads irregularly",
        message="",
        active=True,
        acknowledged=False,
        shelved=False,
        since=NOON,
    )
    state = state.model_copy(update={"alarms": [alarm]})
    assert summary_of("ace", state).max_utilisation < 0.5


def test_a_cage_of_which_no_sensor_has_given_a_valid_reading_is_not_measured():
    assert seen()[1]["measured"].title == "Nothing measured"
    assert seen(depth(0, 14.2), minutes=16)[1]["measured"].title == "Nothing measured"


def test_a_sensor_that_sends_nothing_valid_within_its_timeout_is_named_though_it_is_not_silent():
    ill = tuple(depth(minutes, -40.0 - minutes) for minutes in range(0, 20, 5))
    state, concerns = seen(shackle(15, 20.0), *ill, minutes=16)
    assert state.silent == []
    assert concerns["measured"].title == "Partly measured"
    assert "depth-2" in concerns["measured"].message


def test_one_bad_reading_after_a_good_one_is_no_concern():
    bad = replace(depth(5, -40.0), flags={"depth_m": Flag.FAIL}, remarks=())
    assert seen(depth(0, 14.2), bad, minutes=6)[1] == {}


def test_a_cage_unlike_those_of_the_family_is_a_concern_where_it_has_intervals():
    concern = seen(depth(0, 14.2), unlike="It differs.")[1]["unlike"]
    assert concern.title == "Unlike other cages"
    assert "may be off by more than its interval says" in concern.message
    state, concerns = seen(depth(0, 14.2), minutes=600, unlike="It differs.")
    assert not state.valid
    assert "unlike" not in concerns


def fitting(factors: dict[str, float], *, silent: frozenset[str] = frozenset()):
    """Concerns of a healthy cage whose sensors' intervals are widened by factors."""
    state, _ = seen(depth(0, 14.2))
    twin = stand_in_twin()
    memory = twin.start()
    for sample in (Sample(stream="buoy-1", t=NOON, values=SEA), depth(0, 14.2)):
        memory, _ = twin.step(memory, sample, NOON)
    tracked = {name: Tracked(factor=factor) for name, factor in factors.items()}
    memory = replace(memory, tracked=tracked, silent=silent)
    policy = AlarmPolicy.default(twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)
    found = concerns_of(state, memory, policy=policy, least_volume=0.0, unlike="")
    return {one.kind: one for one in found}


def test_sensors_whose_intervals_are_twice_as_wide_as_trained_are_a_concern():
    concern = fitting({"depth-1": 2.3, "depth-2": 1.99, "shackle-4": 2.0})["fit"]
    assert concern.title == "Twin no longer fits"
    assert concern.message.startswith("Readings of depth-1, shackle-4 miss the twin's intervals")
    assert "widened 2.3 times" in concern.message
    assert concern.message.endswith("Train the twin anew.")
    assert concern.key == "fit"
    assert concern.values == {"sensors": ["depth-1", "shackle-4"], "factor": 2.3}


def test_a_sensor_that_is_silent_or_of_another_cage_says_nothing_of_the_fit():
    assert "fit" not in fitting({"depth-1": 2.3}, silent=frozenset({"depth-1"}))
    assert "fit" not in fitting({"depth-9": 3.0})


@pytest.mark.parametrize(("rises", "fits"), [(0.0, True), (1.5, False)])
def test_a_net_that_hangs_higher_than_in_training_no_longer_fits_within_a_day(rises, fits):
    """A depth sensor reads a metre and a half less than predicted, every ten minutes."""
    twin = stand_in_twin()
    memory, random = twin.start(), np.random.default_rng(3)
    for minutes in range(0, 1440, 10):
        sea = SeaState(current_speed=0.4 + 0.1 * np.cos(minutes / 120.0), current_to=90.0)
        metres = twin.predict(sea).sensor.mean[0, 1] - rises + 0.03 * random.standard_normal()
        water = {**SEA, "current_speed_m_s": sea.current_speed}
        buoy = Sample(stream="buoy-1", t=at(minutes), values=water)
        for sample in (buoy, depth(minutes, metres)):
            memory, _ = twin.step(memory, sample, sample.t)
    memory, events = twin.step(memory, None, at(1440))
    answered = next(event for event in reversed(events) if isinstance(event, Answered))
    policy = AlarmPolicy.default(twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)
    state = state_of("ace", twin, answered, memory)
    found = [
        one.kind for one in concerns_of(state, memory, policy=policy, least_volume=0.0, unlike="")
    ]
    assert ("fit" not in found) == fits
