"""Samples may come twice and out of order: the twin ends where order would have led it."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.records import Sample
from seacage.testing import stand_in_twin

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


# A speed, a direction and a depth, a few of them bad; samples are built outside of strategies.
WORDS = st.tuples(
    st.sampled_from(["buoy-1", "depth-1"]),
    st.sampled_from([0.1, 0.3, 0.35, 0.9, -1.0]),
    st.sampled_from([0.0, 80.0, 412.0]),
    st.sampled_from([7.0, 6.0]),
)


def sample(second, word):
    stream, speed, to, metres = word
    buoy = {"current_speed_m_s": speed, "current_to_deg": to}
    values = buoy if stream == "buoy-1" else {"depth_m": metres}
    return Sample(stream=stream, t=NOON + timedelta(seconds=second), values=values)


def final(samples):
    """State and answer of a tick an hour on, the clock following the latest sample."""
    twin = stand_in_twin()
    twin = replace(twin, models=replace(twin.models, upper={}))  # level 1 answers sooner
    state = twin.start()
    for one in samples:
        now = one.t if state.clock is None else max(one.t, state.clock)
        state, _ = twin.step(state, one, now)
    return twin.step(state, None, NOON + timedelta(hours=1))


@settings(max_examples=25)
@given(
    said=st.dictionaries(st.integers(0, 3000), WORDS, min_size=1, max_size=20),
    delays=st.lists(st.integers(0, 600), min_size=20, max_size=20),
    repeats=st.lists(st.integers(0, 19), max_size=5),
)
def test_duplicates_and_disorder_within_ten_minutes_change_nothing(said, delays, repeats):
    samples = [sample(second, said[second]) for second in sorted(said)]
    arrivals = sorted(range(len(samples)), key=lambda k: (sorted(said)[k] + delays[k], k))
    mixed = [samples[k] for k in arrivals]
    for place in repeats:
        mixed.insert(place + 1, mixed[place % len(mixed)])

    state, events = final(samples)
    mixed_state, mixed_events = final(mixed)
    assert mixed_state.streams == state.streams
    answer, mixed_answer = events[-1].answer, mixed_events[-1].answer
    assert mixed_answer.reason == answer.reason
    np.testing.assert_array_equal(mixed_answer.sensor.mean, answer.sensor.mean)
