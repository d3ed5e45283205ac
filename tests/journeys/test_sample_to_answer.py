"""A buoy's file becomes samples, the samples step a twin, and the twin answers."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.records import read_record
from seacage.testing import stand_in_twin
from seacage.twin import Answered, Flagged, StreamBack, StreamSilent, Twin, replay

ROWS = """time,speed_cm_s,direction_to_deg
2018-01-26T23:08:00Z,11.0,77
2018-01-26T23:26:00Z,18.0,52
2018-01-26T23:38:00Z,14.9,412
2018-01-26T23:56:00Z,28.1,12
2018-01-27T05:20:00Z,104.0,20
"""


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "ace"
    stand_in_twin().write(folder)
    return Twin.read(folder)


@pytest.fixture
def buoy(tmp_path):
    path = tmp_path / "buoy.csv"
    path.write_text(ROWS)
    return read_record(path)


def test_a_file_is_replayed_into_answers_flags_and_silences(twin, buoy):
    events = list(replay(twin, buoy.samples()))
    answers = [event for event in events if isinstance(event, Answered)]
    assert [event.answer.valid[0] for event in answers] == [True, True, False, True, True]
    assert [event.answer.in_domain[0] for event in answers] == [True, True, False, True, False]
    bad = next(event for event in events if isinstance(event, Flagged))
    assert bad.sample.values["current_to_deg"] == 412.0
    assert bad.sample.t == datetime(2018, 1, 26, 23, 38, tzinfo=UTC)
    # Five hours passed before the last row, by the record's own clock.
    kinds = [type(event) for event in events if isinstance(event, StreamSilent | StreamBack)]
    assert kinds == [StreamSilent, StreamBack]


def test_ticks_between_samples_notice_the_silence(twin, buoy):
    state, report = twin.start(), []
    now = datetime(2018, 1, 26, 23, tzinfo=UTC)
    samples = list(buoy.samples())
    while now < datetime(2018, 1, 27, 6, tzinfo=UTC):
        now += timedelta(minutes=15)
        while samples and samples[0].t <= now:
            state, events = twin.step(state, samples.pop(0), now)
            report += events
        state, events = twin.step(state, None, now)
        report += events
    kinds = [type(event) for event in report if isinstance(event, StreamSilent | StreamBack)]
    assert kinds == [StreamSilent, StreamBack]
    valid = {event.t.hour: event.answer.valid[0] for event in report if isinstance(event, Answered)}
    assert valid[1]
    assert not valid[4]
    assert valid[5]


def test_the_public_buoy_record_is_answered_in_every_row(twin, shared):
    buoy = read_record(shared / "data" / "buoy_current_s08010_2018.csv")
    answer = twin.predict_record(buoy)
    assert len(answer) == 3912
    assert answer.valid.mean() > 0.99
    for numbers in (answer.sensor.mean, answer.sensor.std, answer.bridle_tension.mean):
        assert np.isfinite(numbers[answer.valid]).all()
        assert np.isnan(numbers[~answer.valid]).all()
    fast = buoy.values["current_speed_m_s"] > 1.0
    assert fast.sum() > 50
    assert not answer.in_domain[fast].any()
