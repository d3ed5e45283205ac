"""What goes wrong at a chosen time."""

from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.campaigns._virtual_field._events import Event, check_events, read_events
from seacage.conventions import InputError, Origin
from seacage.dynamics import Damage
from seacage.records import Record, instant

ACE = Cage.named("ace")
START = datetime(2020, 1, 18, tzinfo=UTC)
NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def stream(name: str, key: str, *, days: float = 48.0) -> Record:
    time = instant(START) + np.arange(days * 24.0).astype("timedelta64[h]")
    values = {key: 7.0 + 0.1 * np.arange(len(time))}
    return Record(stream=name, time=time, values=values, origin=Origin.VIRTUAL_FIELD)


BUOY = stream("buoy-1", "current_speed_m_s")
DEPTH = stream("depth-2", "depth_m")


def event(kind: str, target: str, at: datetime = NOON, **more: Any) -> Event:
    return Event(kind=kind, target=target, at=at, **more)


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("bridle-cut bridle-8 2020-02-01T12:00Z", event("bridle-cut", "bridle-8")),
        (
            "net-hole ring-3/spoke-8 2020-02-01T13:00+01:00",
            event("net-hole", "ring-3/spoke-8", size=2.0),
        ),
        (
            "drift depth-2 2020-02-01T12:00Z m_per_day=-0.25",
            event("drift", "depth-2", size=-0.25),
        ),
        ("stuck shackle-1 2020-02-01T12:00:00Z", event("stuck", "shackle-1")),
        (
            "silent buoy-1 2020-02-01T12:00:30Z until=2020-02-02T00:00Z",
            event(
                "silent",
                "buoy-1",
                NOON + timedelta(seconds=30),
                until=datetime(2020, 2, 2, tzinfo=UTC),
            ),
        ),
    ],
)
def test_words_are_read_and_written_again(text: str, means: Event) -> None:
    assert Event.parse(text) == means
    assert Event.parse(str(means)) == means


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("bridle-cut bridle-8", "give kind, target, time"),
        ("bridle-cut bridle-8 2020-02-01T12:00Z now", "give kind, target, time"),
        ("bridle-break bridle-8 2020-02-01T12:00Z", "'bridle-break' is no kind of event. There"),
        ("bridle-cut bridle-8 yesterday", "'yesterday' is no time. Write it like 2020-02-01"),
        ("bridle-cut bridle-8 2020-02-01T12:00", "does not say its zone"),
        ("drift depth-2 2020-02-01T12:00Z panels=2", "the key 'panels' is unknown"),
        ("drift depth-2 2020-02-01T12:00Z m_per_day=fast", "'fast' is no number"),
        ("drift depth-2 2020-02-01T12:00Z m_per_day=0", "drift has no size 0"),
        ("net-hole ring-3/spoke-8 2020-02-01T12:00Z panels=1.5", "net-hole has no size 1.5"),
        ("stuck shackle-1 2020-02-01T12:00Z size=2", "stuck has no size 2"),
        ("stuck shackle-1 2020-02-01T12:00Z until=2020-02-01T12:00Z", "cannot end at 2020"),
        ("drift depth-2 2020-02-01T12:00Z until=2020-02-02T12:00Z", "cannot end at 2020"),
    ],
)
def test_a_mistake_in_the_words_is_one_clear_sentence(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        Event.parse(text)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("bridle-cut bridle-13 2020-02-01T12:00Z", "no 'bridle-13' for it. It is one of bridle-1"),
        ("net-hole collar 2020-02-01T12:00Z", "no netting there .* ring-0/spoke-0 to ring-7"),
        ("net-hole ring-8/spoke-1 2020-02-01T12:00Z panels=2", "no netting there"),
        ("net-hole ring-1/spoke-32 2020-02-01T12:00Z", "no netting there"),
        ("drift shackle-1 2020-02-01T12:00Z", "no 'shackle-1' for it. It is one of depth-1"),
        ("stuck depth-9 2020-02-01T12:00Z", "no 'depth-9' for it"),
        ("silent buoy-2 2020-02-01T12:00Z", "no 'buoy-2' for it. .* buoy-1"),
        ("silent buoy-1 2020-01-17T12:00Z", "not within the record, 2020-01-18T00:00Z to"),
        ("silent buoy-1 2020-04-01T12:00Z", "not within the record"),
        ("stuck shackle-1 2020-02-01T12:00Z until=2020-02-01T18:00Z", "would not be seen"),
    ],
)
def test_an_event_that_would_meet_nothing_is_refused(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        check_events([Event.parse(text)], ACE, BUOY, TruthParameters.read())


def test_events_that_meet_something_pass() -> None:
    awake = "stuck shackle-1 2020-01-22T23:00Z"  # a tenth of the 48 days is 22 January, 19:06
    words = ["bridle-cut bridle-12 2020-01-18T00:00Z", "silent depth-1 2020-03-05T00:00Z", awake]
    check_events([Event.parse(text) for text in words], ACE, BUOY, TruthParameters.read())


def test_only_what_breaks_the_cage_is_damage() -> None:
    assert event("bridle-cut", "bridle-8").damage(ACE) == Damage(bridle=7)
    assert event("net-hole", "ring-3/spoke-8", size=3).damage(ACE) == Damage(hole=(3, 8, 3))
    for harmless in (event("drift", "depth-2"), event("stuck", "shackle-1")):
        assert harmless.damage(ACE) is None


def test_a_drift_grows_from_its_time_on() -> None:
    drifted = event("drift", "depth-2", size=0.5).apply_to(DEPTH)
    days = (DEPTH.time - instant(NOON)) / np.timedelta64(1, "D")
    exact = DEPTH.values["depth_m"] + 0.5 * np.maximum(days, 0.0)
    np.testing.assert_array_equal(drifted.values["depth_m"], exact)


def test_what_is_stuck_says_one_thing_until_it_recovers() -> None:
    changed = event("stuck", "depth-2", until=NOON + timedelta(hours=6)).apply_to(DEPTH)
    different = changed.values["depth_m"] != DEPTH.values["depth_m"]
    at = int(np.searchsorted(DEPTH.time, instant(NOON)))
    np.testing.assert_array_equal(np.flatnonzero(different), np.arange(at + 1, at + 6))
    assert set(changed.values["depth_m"][at : at + 6]) == {DEPTH.values["depth_m"][at]}


def test_what_is_silent_says_nothing_until_it_recovers() -> None:
    changed = event("silent", "buoy-1", until=NOON + timedelta(hours=6)).apply_to(BUOY)
    missing = np.setdiff1d(BUOY.time, changed.time)
    np.testing.assert_array_equal(missing, instant(NOON) + np.arange(6).astype("timedelta64[h]"))
    assert len(event("silent", "buoy-1", START).apply_to(BUOY)) == 0


def test_an_event_leaves_other_streams_alone() -> None:
    for one in (event("silent", "buoy-1"), event("bridle-cut", "bridle-8")):
        assert one.apply_to(DEPTH) is DEPTH


def test_a_file_holds_events_in_any_order(tmp_path: Path) -> None:
    (tmp_path / "events.toml").write_text(
        '[[event]]\nkind = "silent"\ntarget = "buoy-1"\nat = 2020-02-03T00:00:00Z\n'
        "until = 2020-02-03T06:00:00Z\n"
        '[[event]]\nkind = "net-hole"\ntarget = "ring-3/spoke-8"\nat = "2020-02-01T12:00Z"\n'
        "panels = 4\n"
    )
    hole, silence = read_events(tmp_path / "events.toml")
    assert str(hole) == "net-hole ring-3/spoke-8 2020-02-01T12:00Z panels=4"
    assert str(silence) == "silent buoy-1 2020-02-03T00:00Z until=2020-02-03T06:00Z"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[event]", "not TOML"),
        ("", "as a table"),
        ('[event]\nkind = "stuck"\n', "as a table"),
        ("event = [3]\n", "as a table"),
        ('[[event]]\nkind = "stuck"\ntarget = "depth-1"\n', "1: the key 'at' is missing"),
        ('[[event]]\nkind = "stuck"\ntarget = "depth-1"\nat = 3\n', "3 is no time"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "events.toml").write_text(text)
    with pytest.raises(InputError, match=says):
        read_events(tmp_path / "events.toml")
