"""Samples may come twice and out of order: the twin ends where order would have led it."""

from datetime import UTC, datetime, timedelta

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.records import Sample
from seacage.testing import stand_in_twin

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@st.composite
def readings(draw):
    """Samples of a buoy and a depth sensor, a few of them bad, each at its own second."""
    seconds = draw(st.lists(st.integers(0, 3000), min_size=1, max_size=25, unique=True))
    return [draw(sample(second)) for second in sorted(seconds)]


@st.composite
def sample(draw, second):
    t = NOON + timedelta(seconds=second)
    if draw(st.booleans()):
        speed = draw(st.sampled_from([0.1, 0.3, 0.35, 0.9, -1.0]))
        to = draw(st.sampled_from([0.0, 80.0, 412.0]))
        values = {"current_speed_m_s": speed, "current_to_deg": to}
        return Sample(stream="buoy-1", t=t, values=values)
    return Sample(stream="depth-1", t=t, values={"depth_m": draw(st.sampled_from([7.0, 6.0]))})


def final(samples):
    """State and answer of a tick an hour on, the clock following the latest sample."""
    twin = stand_in_twin()
    state = twin.start()
    for one in samples:
        now = one.t if state.clock is None else max(one.t, state.clock)
        state, _ = twin.step(state, one, now)
    return twin.step(state, None, NOON + timedelta(hours=1))


@settings(max_examples=25)
@given(samples=readings(), data=st.data())
def test_duplicates_and_disorder_within_ten_minutes_change_nothing(samples, data):
    late = data.draw(
        st.lists(st.integers(0, 600), min_size=len(samples), max_size=len(samples)), "delays"
    )
    arrival = [(one.t + timedelta(seconds=wait), one) for one, wait in zip(samples, late)]
    mixed = [one for _, one in sorted(arrival, key=lambda pair: pair[0])]
    again = data.draw(st.lists(st.sampled_from(range(len(mixed))), max_size=5), "repeats")
    for place in again:
        mixed.insert(place + 1, mixed[place])

    state, events = final(samples)
    mixed_state, mixed_events = final(mixed)
    assert mixed_state.streams == state.streams
    answer, mixed_answer = events[-1].answer, mixed_events[-1].answer
    assert mixed_answer.reason == answer.reason
    np.testing.assert_array_equal(mixed_answer.sensor.mean, answer.sensor.mean)
