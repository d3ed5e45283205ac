from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from seacage.records import Sample
from seacage.testing import stand_in_twin
from seacage.twin import Action, Alarm, AlarmPolicy, FaultDetectorSettings, Limit, alarm_text
from twin_harness import TwinHarness

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
AT_ONCE = Limit(raise_at=1.0, clear_at=0.0)


def at(minutes: float) -> datetime:
    return NOON + timedelta(minutes=minutes)


def buoy(minutes: float, speed: float = 0.4) -> Sample:
    return Sample(
        stream="buoy-1",
        t=at(minutes),
        values={"current_speed_m_s": speed, "current_to_deg": 90.0},
    )


def shackle(minutes: float, kilonewtons: float, **rest: object) -> Sample:
    return Sample(stream="shackle-2", t=at(minutes), values={"tension_kn": kilonewtons}, **rest)


def assessed(**limits: Limit) -> TwinHarness:
    """With these limits by kind, the others as usual."""
    policy = AlarmPolicy.default(stand_in_twin().cage)
    policy = replace(policy, limits={**policy.limits, **limits})
    return TwinHarness(stand_in_twin(), policy=policy)


def events_of(happened):
    return [(line.alarm, line.action) for line in happened]


@pytest.mark.slow
def test_nothing_is_raised_where_nothing_is_wrong():
    watch = assessed()
    for minutes in range(0, 60, 2):
        if minutes % 12 == 0:
            watch.hear(buoy(minutes))
        assert watch.tick(at(minutes)) == []
    assert not any(alarm.active for alarm in watch.book.alarms.values())


def test_a_computed_load_beyond_its_limit_raises_its_bridle_alone():
    watch = assessed()
    watch.hear(buoy(0))
    watch.tick(at(0))
    name, alarm = max(
        (one for one in watch.book.alarms.items() if one[1].kind == "load"),
        key=lambda one: one[1].value,
    )
    limit = Limit(raise_at=0.9 * alarm.value, clear_at=0.5 * alarm.value)
    watch = assessed(**{name: limit})
    watch.hear(buoy(0))
    assert events_of(watch.tick(at(0))) == [(name, Action.RAISED)]


def test_a_measured_load_counts_where_it_is_the_larger():
    watch = assessed(load=Limit(raise_at=0.8, clear_at=0.7, on_delay_s=60.0))
    watch.hear(buoy(0))
    for minutes in range(4):
        watch.hear(shackle(minutes, 140.0))
        watch.tick(at(minutes))
    assert watch.raised == ["load.bridle-8"]
    assert watch.book.alarms["load.bridle-8"].value == pytest.approx(140.0 / 160.0)


def test_a_suspect_reading_never_wakes_anyone():
    watch = assessed(load=Limit(raise_at=0.8, clear_at=0.7))
    watch.hear(buoy(0), shackle(0, 20.0))
    watch.tick(at(0))
    watch.hear(shackle(0.1, 450.0))  # beyond what a bridle ever bears: flagged
    watch.tick(at(0.1))
    assert watch.raised == []


def test_without_valid_input_a_load_neither_raises_nor_clears():
    watch = assessed(load=Limit(raise_at=0.01, clear_at=0.0), input=AT_ONCE)
    watch.hear(buoy(0))
    before = sum(action is Action.RAISED for _, action in events_of(watch.tick(at(0))))
    assert before > 0
    watch.hear(buoy(12, speed=-3.0))
    assert events_of(watch.tick(at(12))) == [("input.buoy-1", Action.RAISED)]
    assert "flagged" in alarm_text(watch.book.alarms["input.buoy-1"], watch.policy).message


@pytest.mark.parametrize(("stuck_s", "raised"), [(1800.0, []), (600.0, ["irregular.shackle-2"])])
def test_the_settings_of_the_twin_say_when_a_sensor_is_stuck(stuck_s, raised):
    settings = FaultDetectorSettings(stuck_s=stuck_s)
    watch = TwinHarness(replace(stand_in_twin(), fault_detector=settings))
    watch.hear(buoy(0))
    for minutes in range(0, 16, 2):
        watch.hear(shackle(minutes, 20.0))
        watch.tick(at(minutes))
    assert watch.raised == raised


def test_a_silent_stream_is_named_and_its_return_clears_it():
    watch = assessed()
    watch.hear(buoy(0), shackle(0, 20.0))
    for minutes in range(21):
        watch.tick(at(minutes))
    assert watch.raised == ["silent.shackle-2"]
    watch.hear(shackle(21, 20.0))
    assert events_of(watch.tick(at(21))) == [("silent.shackle-2", Action.CLEARED)]


def test_a_silent_buoy_raises_one_alarm_and_not_as_missing_input_too():
    watch = assessed()
    watch.hear(buoy(0))
    for minutes in range(0, 400, 5):
        watch.tick(at(minutes))
    assert watch.raised == ["silent.buoy-1"]


def test_water_outside_the_training_domain_is_raised_when_it_lasts_and_labels_the_loads():
    watch = assessed(load=Limit(raise_at=0.01, clear_at=0.0, on_delay_s=60.0))
    for minutes in range(30):
        watch.hear(buoy(minutes, speed=1.3))
        watch.tick(at(minutes))
    assert "domain.input" in watch.raised
    loads = [alarm for alarm in watch.book.alarms.values() if alarm.kind == "load" and alarm.active]
    assert loads
    assert all("Extrapolating" in alarm_text(alarm, watch.policy).message for alarm in loads)


def test_a_fault_of_the_service_lasts_as_long_as_it_is_named():
    watch = assessed()
    trouble = {"history.store": "The database was moved aside; its history is lost."}
    assert events_of(watch.tick(at(0), trouble=trouble)) == [("history.store", Action.RAISED)]
    assert "moved aside" in alarm_text(watch.book.alarms["history.store"], watch.policy).message
    assert events_of(watch.tick(at(1))) == [("history.store", Action.CLEARED)]


@pytest.mark.parametrize("hours", [-1, 1])
def test_a_clock_that_jumps_by_an_hour_raises_and_clears_nothing(hours):
    watch = assessed(load=Limit(raise_at=0.8, clear_at=0.7, on_delay_s=60.0, off_delay_s=60.0))
    watch.hear(buoy(0))
    for minutes in (0, 0.5):  # a load that is about to be raised
        watch.hear(shackle(minutes, 140.0))
        assert watch.tick(at(minutes)) == []
    assert watch.tick(at(0.6 + 60 * hours)) == []


def test_a_clock_that_went_back_does_not_keep_an_unseen_alarm_quiet():
    limit = Limit(raise_at=1.0, clear_at=0.0, repeat_after_s=600.0)
    watch = assessed(history=limit)
    trouble = {"history.store": "The disk is full."}
    watch.tick(at(0), trouble=trouble)
    watch.tick(at(-300), trouble=trouble)
    assert events_of(watch.tick(at(-289), trouble=trouble)) == [("history.store", Action.REPEATED)]


def test_every_alarm_of_a_cage_is_described_in_words_active_or_not():
    policy = AlarmPolicy.default(stand_in_twin().cage)
    for name in policy.names:
        for active in (False, True):
            text = alarm_text(Alarm(name=name, active=active, value=0.9, worst=0.95), policy)
            assert text.title
            assert text.advice.endswith(".")
            assert "{" not in text.title + text.message


@pytest.mark.parametrize(
    ("alarm", "key", "values"),
    [
        (
            Alarm(name="load.bridle-7", active=True, value=0.85, worst=0.9, detail="By the mean."),
            "load.active",
            {
                "source": "bridle-7",
                "value_share": 0.85,
                "worst_share": 0.9,
                "raise_at_share": 0.8,
                "clear_at_share": 0.7,
                "detail": "By the mean.",
            },
        ),
        (
            Alarm(name="silent.buoy-1", value=120.0),
            "silent.calm",
            {"source": "buoy-1", "value_s": 120.0},
        ),
        (Alarm(name="volume.net"), "volume.unknown", {}),
        (
            Alarm(name="disk.vault", active=True, value=1.0, detail="It is full."),
            "fault.active",
            {"source": "vault", "detail": "It is full."},
        ),
    ],
)
def test_a_text_has_the_key_and_the_values_that_another_language_needs(alarm, key, values):
    text = alarm_text(alarm, AlarmPolicy.default(stand_in_twin().cage))
    assert (text.key, text.values) == (key, values)


def test_a_cause_is_shown_while_it_lasts_and_names_stand_as_the_sentence_needs_them():
    policy = AlarmPolicy.default()
    raised = Alarm(name="domain.input", active=True, value=1.0, detail="Extrapolating: …")
    assert "Extrapolating" in alarm_text(raised, policy).message
    assert "Extrapolating" not in alarm_text(replace(raised, active=False), policy).message
    load = Alarm(name="load.bridle-7", active=True, value=0.85, worst=0.9)
    text = alarm_text(load, policy)
    assert text.title == "High load on bridle-7"
    assert text.message.startswith("Bridle-7 bears 85 % of its capacity, 90 % at worst")
