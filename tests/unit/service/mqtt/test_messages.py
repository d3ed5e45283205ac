import json
import math
from collections import Counter
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from broken_messages import SEEDS, mutate
from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._mqtt._messages import (
    LARGEST,
    Settled,
    acknowledgement_text,
    read_observed,
    read_settled,
    samples_text,
)
from sizes import pick_size

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
STREAMS = {"buoy-1": ("current_speed_m_s", "current_to_deg"), "depth-2": ("depth_m",)}
GOOD = b'{"t": "2020-02-01T11:00:00Z", "seq": 7, "values": {"current_speed_m_s": 0.5}}'


def read(payload, stream="buoy-1"):
    return read_observed(stream, payload, STREAMS, until=NOON)


def sample(minutes=0.0, speed=0.5, **rest):
    t = NOON - timedelta(minutes=minutes)
    return Sample(stream="buoy-1", t=t, values={"current_speed_m_s": speed}, **rest)


def test_one_sample_or_a_list_of_them_are_read():
    one, _ = read(GOOD)
    assert [(s.stream, s.seq, s.values["current_speed_m_s"]) for s in one] == [("buoy-1", 7, 0.5)]
    two, _ = read(b"[" + GOOD + b"," + GOOD + b"]")
    assert len(two) == 2


def test_what_is_written_is_read_again():
    written = [sample(1.0, math.nan, seq=2), sample(2.0)]
    back, _ = read(samples_text(written))
    assert [(s.t, s.seq) for s in back] == [(s.t, s.seq) for s in written]
    assert math.isnan(back[0].values["current_speed_m_s"])


def test_a_bad_sample_does_not_take_its_neighbours_with_it():
    strange = GOOD.replace(b"0.5", b'"fast"')
    samples, refused = read(b"[" + strange + b"," + GOOD + b"]")
    assert len(samples) == 1
    assert "is no number" in refused[0].rejected


@pytest.mark.parametrize(
    ("payload", "reason"),
    [
        (b"", "Invalid JSON"),
        (b"\xff\xfe", "Invalid JSON"),
        (b"[" * 100_000, "recursion"),
        (b"[]", "at least 1"),
        (b"7", "valid array"),
        (b"{}", "t: Field required"),
        (GOOD.replace(b'"seq"', b'"sequence"'), "Extra inputs"),
        (GOOD.replace(b"7", b"-7"), "greater than or equal to 0"),
        (GOOD.replace(b"7", b"true"), "valid integer"),
        (GOOD.replace(b"00Z", b"00"), "says its zone"),
        (GOOD.replace(b"2020-02-01T11:00:00Z", b"0001-01-01T00:00:00+14:00"), "the year 1"),
        (GOOD.replace(b"0.5", b"9" * 5000), "number out of range"),
        (b" " * (LARGEST + 1), "of one message"),
    ],
)
def test_a_message_that_cannot_be_read_says_why(payload, reason):
    with pytest.raises(InputError, match=reason):
        read(payload)


def test_an_unknown_stream_and_a_fast_clock_are_refused():
    _, (unknown,) = read(GOOD, stream="nonsense")
    assert "No stream is called" in unknown.rejected
    _, (ahead,) = read(GOOD.replace(b"T11", b"T13"))
    assert "ahead of the cage's clock" in ahead.rejected
    assert ahead.retry


def test_acknowledgements_come_back_as_they_went():
    settled = (
        Settled(stream="buoy-1", t=NOON, seq=None),
        Settled(stream="buoy-1", t=NOON, seq=3, rejected="No."),
        Settled(stream="buoy-1", t=NOON, seq=4, rejected="Not yet.", retry=True),
    )
    assert json.loads(acknowledgement_text(settled[:1])) == {"t": NOON.isoformat(), "seq": None}
    assert read_settled("buoy-1", acknowledgement_text(settled[:1])) == settled[:1]
    assert read_settled("buoy-1", acknowledgement_text(settled)) == settled


def test_an_acknowledgement_that_is_none_is_reported():
    with pytest.raises(InputError, match="buoy-1: an acknowledgement cannot be read"):
        read_settled("buoy-1", b"thanks")


@pytest.mark.long
@pytest.mark.timeout(pick_size(120, 3600))
def test_whatever_comes_is_read_or_refused():
    random = np.random.default_rng(7)
    outcomes = Counter()
    for number in range(pick_size(20_000, 1_000_000)):
        try:
            samples, refused = read(mutate(random, SEEDS[number % len(SEEDS)]))
        except InputError:
            outcomes["nothing"] += 1
        else:
            assert samples or refused
            outcomes[bool(samples), bool(refused)] += 1
    assert len(outcomes) == 4, "the mutations reach every way out"
