"""What the store promises, in SQLite and in PostgreSQL alike."""

import math
import statistics
import threading
from contextlib import closing, contextmanager
from datetime import timedelta

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import Flag, InputError, Origin
from seacage.records import DEFAULT_LIMITS, Record, Sample, check_record, instant
from seacage.service._store import _quality, _samples
from seacage.service._store._adaptations import Adaptation, Refold
from seacage.service._store._aggregates import renew_rested
from seacage.service._store._database._checksum import with_checksum
from seacage.service._store._database._rows import DAY_US, microseconds
from seacage.service._store._days import delete, rows_of_day
from seacage.service._store._integrity._verify import verify
from seacage.service._store._store import StoreError, open_store
from seacage.twin import Action, AlarmEvent
from stores import NOON, put, sample, schema

BOTH = ["sqlite", pytest.param("postgres", marks=pytest.mark.postgres)]


@pytest.fixture(params=BOTH)
def store(request, tmp_path):
    if request.param == "sqlite":
        one = open_store(tmp_path / "samples.sqlite")
        yield one
        one.close()
    else:
        with schema(request.getfixturevalue("postgres")) as url:
            one = open_store(url)
            yield one
            one.close()


@pytest.fixture(params=BOTH, scope="module")
def place(request, tmp_path_factory):
    """Where the examples of hypothesis open a store one after the other.

    None is open while an example is drawn: checked shapes use chance, also the writer's.
    """
    if request.param == "sqlite":
        yield tmp_path_factory.mktemp("store") / "samples.sqlite"
    else:
        with schema(request.getfixturevalue("postgres")) as url:
            yield url


@contextmanager
def emptied(place):
    with closing(open_store(place)) as store:
        store.forget("ace")
        yield store


def renewed(store):
    """Sum up every marked span, as the writer does when it has rested."""
    far = 2**61
    while store._writer.ask(lambda session: renew_rested(session, now_us=far)).result(timeout=20):
        pass


# --- samples ---


def test_a_sample_comes_back_as_it_went_in(store):
    flagged = sample(
        metres=-1e300, seq=3, flags={"depth_m": Flag.FAIL}, remarks=("depth-1: too high.",)
    )
    put(store, flagged)
    assert store.samples("ace", limit=9) == [flagged]


def test_a_value_that_is_no_number_keeps_its_place_and_flag(store):
    put(store, sample(metres=math.nan, flags={"depth_m": Flag.MISSING}))
    (read,) = store.samples("ace", limit=9)
    assert math.isnan(read.values["depth_m"])
    assert read.flags["depth_m"] == Flag.MISSING


def test_words_that_no_database_likes_are_kept(store):
    odd = sample(remarks=("a 'quote', a \x00, a \\ and ? and %s and 99 %",))
    put(store, odd)
    assert store.samples("ace", limit=9) == [odd]


@pytest.mark.parametrize("seq", [-1, 2**63])
def test_a_number_that_no_row_holds_is_refused(store, seq):
    with pytest.raises(InputError, match="not within"):
        put(store, sample(seq=seq))
    assert store.fault is None


def test_a_spike_is_amended_in_the_transaction_of_the_sample_after_it(store):
    checked = {"ingested": NOON, "limits": DEFAULT_LIMITS}
    store.append("ace", [sample(0), sample(1)], **checked).result(timeout=20)
    jump = store.append("ace", [sample(2, 30.0)], **checked).result(timeout=20)
    assert jump.samples[0].flags == {"depth_m": Flag.SUSPECT}
    after = store.append("ace", [sample(3)], **checked).result(timeout=20)
    (amendment,) = after.amendments
    assert (amendment.t, amendment.was, amendment.flag) == (sample(2).t, Flag.SUSPECT, Flag.FAIL)
    assert "stands out" in amendment.remark
    spike = store.samples("ace", limit=9)[2]
    assert spike.flags == {"depth_m": Flag.FAIL}
    assert spike.values == {"depth_m": 30.0}
    assert len(spike.remarks) == 2
    assert store.amendments("ace", "depth-1", start=NOON, known_at=sample(3).t) == (amendment,)
    # Before that sample nobody could know it.
    before = store.samples("ace", limit=9, known_at=sample(3).t - timedelta(seconds=1))[2]
    assert before.flags == {"depth_m": Flag.SUSPECT}
    assert store.amendments("ace", "depth-1", start=NOON, known_at=sample(2).t) == ()


def test_a_late_sample_beside_a_spike_shows_that_it_was_none(store):
    checked = {"ingested": NOON, "limits": DEFAULT_LIMITS}
    first = [sample(0), sample(1), sample(2, 20.0), sample(4)]
    store.append("ace", first, **checked).result(timeout=20)
    assert store.samples("ace", limit=9)[2].flags == {"depth_m": Flag.FAIL}
    late = store.append("ace", [sample(3, 20.1)], **checked).result(timeout=20)
    assert {(one.t, one.was, one.flag) for one in late.amendments} >= {
        (sample(2).t, Flag.FAIL, Flag.SUSPECT)
    }


def test_what_a_transaction_lost_is_not_compared_with_when_it_comes_again(store, monkeypatch):
    put(store, sample(0), sample(1), limits=DEFAULT_LIMITS)

    def fail(*_, **__):
        raise StoreError("The disk is full.")

    with monkeypatch.context() as failing:
        failing.setattr(_samples, "mark", fail)
        with pytest.raises(StoreError):
            put(store, sample(2, 24.0), limits=DEFAULT_LIMITS)
    future = store.append("ace", [sample(3, 24.0)], ingested=NOON, limits=DEFAULT_LIMITS)
    (jump,) = future.result(timeout=20).samples
    assert jump.flags == {"depth_m": Flag.SUSPECT}


@pytest.fixture(scope="module", autouse=True)
def small_steps():
    """Checkpoints after few samples, so that short histories meet many of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(_quality, "EVERY", 4)
        yield


HISTORIES = st.lists(
    st.tuples(
        st.integers(0, 60),  # minutes
        st.integers(0, 1),  # sequence
        st.sampled_from([7.0, 7.0, 7.1, 9.5, 30.0, 900.0, math.nan]),
    ),
    min_size=1,
    max_size=40,
    unique_by=lambda one: one[:2],
)


def checked_in(place, batches):
    """What is stored of batches; the store is closed and opened wherever one is None."""
    with emptied(place) as store:
        pass
    store = open_store(place)
    try:
        for batch in batches:
            if batch is None:
                store.close()
                store = open_store(place)
            else:
                put(store, *batch, limits=DEFAULT_LIMITS)
        with store._database.reading() as session:
            rows = session.rows(
                "SELECT t, seq, readings, remarks FROM sample WHERE cage = 'ace' ORDER BY t, seq"
            )
            renewed(store)
        return rows, aggregates(store, width_s=600)
    finally:
        store.close()


@settings(max_examples=30)
@given(drawn=HISTORIES, order=st.randoms(use_true_random=False), stops=st.integers(0, 3))
def test_flags_do_not_depend_on_what_came_when_or_on_where_the_store_was_closed(
    place, drawn, order, stops
):
    samples = [
        sample(minutes, metres, seq=seq)
        for minutes, seq, metres in sorted(drawn, key=lambda o: o[:2])
    ]
    expected = checked_in(place, [samples])
    mixed = [*samples, *order.sample(samples, min(3, len(samples)))]
    order.shuffle(mixed)
    cuts = sorted(order.randrange(len(mixed) + 1) for _ in range(4))
    parts = [mixed[a:b] for a, b in zip([0, *cuts], [*cuts, len(mixed)], strict=True)]
    for _ in range(stops):
        parts.insert(order.randrange(len(parts) + 1), None)
    assert checked_in(place, parts) == expected


def test_samples_one_by_one_are_flagged_as_the_record_of_them(store):
    metres = [7.0, 7.1, 7.1, 30.0, 7.2, *[7.2] * 30, math.nan, 7.1, 900.0, 7.3, 12.0, 12.1]
    for k, value in enumerate(metres):
        put(store, sample(6 * k, value), limits=DEFAULT_LIMITS)
    stored = store.samples("ace", limit=999)
    record = Record(
        stream="depth-1",
        time=np.array([instant(one.t) for one in stored]),
        values={"depth_m": np.array(metres)},
        origin=Origin.MEASURED,
    )
    flags = check_record(record).flags["depth_m"].tolist()
    assert [int(one.flags["depth_m"]) for one in stored] == flags
    assert {3, 4, 9} <= set(flags)


def test_a_late_sample_for_a_day_that_has_left_is_checked_alone(store):
    old, new = sample(-60 * 24 * 2, 7.0), sample(0, 9.9)
    put(store, old, new, limits=DEFAULT_LIMITS)
    store.retire("ace", before=NOON)
    before = store.samples("ace", limit=9)
    put(store, sample(-60 * 24 * 2 + 1, 30.0), limits=DEFAULT_LIMITS)
    late, *rest = store.samples("ace", limit=9)
    assert late.flags == {"depth_m": Flag.GOOD}
    assert rest == before


# --- clocks that step ---


def withdraw(store, clock_minutes):
    clock, count = NOON + timedelta(minutes=clock_minutes), 0
    span = {"clock": clock, "now": clock}
    while changed := store.withdraw("ace", "depth-1", **span).result(timeout=20):
        count += changed
    return count


def test_what_is_withdrawn_is_kept_and_counts_no_more_until_it_is_sent_again(store):
    sent = [sample(0), sample(1), sample(180, 20.0), sample(181, 20.1)]
    put(store, *sent, limits=DEFAULT_LIMITS)
    assert withdraw(store, 2) == 2
    stored = store.samples("ace", limit=9)
    assert [one.values["depth_m"] for one in stored] == [14.0, 14.0, 20.0, 20.1]
    assert [int(one.flags["depth_m"]) for one in stored] == [1, 1, 4, 4]
    assert "ahead of the clock" in stored[2].remarks[0]
    assert store.latest("ace") == {"depth-1": stored[1]}
    assert len(store.samples("ace", limit=9, withdrawn=False)) == 2
    renewed(store)
    assert [one.count for one in aggregates(store, width_s=600)] == [2]
    # Nothing is compared with them, and what is sent again takes their place.
    future = store.append("ace", [sample(2, 14.1)], ingested=NOON, limits=DEFAULT_LIMITS)
    assert future.result(timeout=20).samples[0].flags == {"depth_m": Flag.GOOD}
    assert put(store, sample(180, 14.2), limits=DEFAULT_LIMITS) == (True,)
    assert put(store, sample(180, 14.2), limits=DEFAULT_LIMITS) == (False,)
    again = store.samples("ace", limit=9)[3]
    assert (again.values, again.flags) == ({"depth_m": 14.2}, {"depth_m": Flag.SUSPECT})
    assert "silence" in again.remarks[0]


def test_a_spike_shown_by_what_is_withdrawn_is_none_any_more(store):
    put(store, sample(0), sample(1), sample(2, 30.0), sample(180), limits=DEFAULT_LIMITS)
    put(store, sample(0.5), sample(3, 14.0, seq=1), limits=DEFAULT_LIMITS)
    assert store.samples("ace", limit=9)[3].flags == {"depth_m": Flag.FAIL}
    withdraw(store, 1)
    flags = [int(one.flags["depth_m"]) for one in store.samples("ace", limit=9)]
    assert flags == [1, 1, 1, 3, 4, 4]


def test_what_was_withdrawn_by_a_clock_that_was_wrong_itself_comes_back(store):
    sent = [sample(0), sample(1), sample(2, 30.0), sample(3), sample(180), sample(181)]
    put(store, *sent, limits=DEFAULT_LIMITS)
    renewed(store)
    before = store.samples("ace", limit=9), aggregates(store)
    withdraw(store, -60 * 24 * 365 * 20)
    assert {int(one.flags["depth_m"]) for one in store.samples("ace", limit=9)} == {4}
    assert store.latest("ace") == {}
    clock, now = NOON - timedelta(days=365 * 20), NOON + timedelta(minutes=181)
    span = {"clock": clock, "now": now}
    assert store.reinstate("ace", "depth-1", **span).result(timeout=20) == 6
    assert store.reinstate("ace", "depth-1", **span).result(timeout=20) == 0
    renewed(store)
    assert (store.samples("ace", limit=9), aggregates(store)) == before


@settings(max_examples=25)
@given(
    minutes=st.lists(st.integers(0, 12), min_size=1, max_size=30),
    cuts=st.lists(st.integers(0, 30), max_size=4),
)
def test_any_order_batching_and_repetition_leaves_the_same_samples(place, minutes, cuts):
    parts = zip([0, *sorted(cuts)], [*sorted(cuts), len(minutes)], strict=True)
    with emptied(place) as store:
        new = [put(store, *map(sample, minutes[a:b])) for a, b in parts]
        read = store.samples("ace", limit=99)
    assert read == [sample(minute) for minute in sorted(set(minutes))]
    assert sum(map(sum, new)) == len(read)


def test_of_two_samples_with_one_key_the_first_stays(store):
    assert put(store, sample(metres=1.0), sample(metres=2.0)) == (True, False)
    assert put(store, sample(metres=3.0), sample(1)) == (False, True)
    assert store.samples("ace", limit=1) == [sample(metres=1.0)]


def test_samples_differ_by_stream_time_sequence_and_cage(store):
    put(store, sample(), sample(stream="depth-2"), sample(1), sample(seq=1))
    put(store, sample(), cage="ice")
    assert len(store.samples("ace", limit=9)) == 4
    assert len(store.samples("ice", limit=9)) == 1


def test_a_span_takes_its_start_and_leaves_its_end(store):
    put(store, *map(sample, range(5)))
    span = {"start": NOON + timedelta(minutes=1), "end": NOON + timedelta(minutes=3)}
    assert store.samples("ace", limit=9, **span) == [sample(1), sample(2)]


def test_the_newest_of_many_come_in_time_order_too(store):
    put(store, *map(sample, range(5)))
    assert store.samples("ace", limit=2, newest=True) == [sample(3), sample(4)]
    assert store.samples("ace", limit=2) == [sample(0), sample(1)]


def test_samples_of_all_ages_find_a_place(store):
    ages = [sample(60 * 24 * days) for days in (-18_000, -4000, -31, 0, 29, 2_000_000)]
    put(store, *reversed(ages))
    assert store.samples("ace", limit=9) == ages


def test_many_who_ask_at_once_each_get_their_own(store):
    futures = [store.append("ace", [sample(k % 10)], ingested=NOON) for k in range(30)]
    report = [one.result(timeout=20).new for one in futures]
    assert report == [(k < 10,) for k in range(30)]


def test_readers_do_not_wait_for_the_writer(store):
    put(store, *map(sample, range(50)))
    seen = []

    def look():
        seen.extend(len(store.samples("ace", limit=999)) for _ in range(20))

    threads = [threading.Thread(target=look) for _ in range(12)]
    for thread in threads:
        thread.start()
    for k in range(20):
        put(store, sample(100 + k))
    for thread in threads:
        thread.join()
    assert len(seen) == 240
    assert min(seen) >= 50


# --- the newest ---


def test_the_newest_of_each_stream_comes_in_one_call(store):
    put(store, sample(0), sample(2), sample(1), sample(1, stream="depth-2"))
    put(store, sample(9, stream="depth-3"), cage="ice")
    assert store.latest("ace") == {"depth-1": sample(2), "depth-2": sample(1, stream="depth-2")}


def test_the_newest_until_a_time_takes_that_time_too(store):
    put(store, *map(sample, range(4)), sample(3, stream="depth-2"))
    put(store, sample(2, metres=1.0, seq=7))
    assert store.latest("ace", at=NOON + timedelta(minutes=2)) == {
        "depth-1": sample(2, metres=1.0, seq=7)
    }
    assert store.latest("ace", at=NOON - timedelta(minutes=1)) == {}
    assert store.latest("nowhere") == {}


# --- aggregates ---


def aggregates(store, key="depth_m", width_s=60, stream="depth-1", limit=10_000, **span):
    return store.aggregates("ace", stream=stream, key=key, width_s=width_s, limit=limit, **span)


def expected(samples, key, width_s):
    """The plain way: sort usable readings into spans."""
    spans = {}
    for one in samples:
        good = {
            name: value
            for name, value in one.values.items()
            if one.flags[name] not in {Flag.FAIL, Flag.MISSING} and math.isfinite(value)
        }
        if "current_speed_m_s" in good and "current_to_deg" in good:
            angle = math.radians(good["current_to_deg"])
            good["current_east_m_s"] = good["current_speed_m_s"] * math.sin(angle)
            good["current_north_m_s"] = good["current_speed_m_s"] * math.cos(angle)
        if key in good:
            seconds = one.t.timestamp() // width_s * width_s
            spans.setdefault(seconds, []).append(good[key])
    return [
        (t, len(v), pytest.approx(statistics.fmean(v), rel=1e-12, abs=1e-12), min(v), max(v))
        for t, v in sorted(spans.items())
    ]


def reading(seconds, seq, speed, to, flags):
    keys = ("current_speed_m_s", "current_to_deg")
    return Sample(
        stream="buoy-1",
        t=NOON + timedelta(seconds=seconds),
        values=dict(zip(keys, (speed, to), strict=True)),
        flags=dict(zip(keys, flags, strict=True)),
        seq=seq,
    )


readings = st.tuples(
    st.integers(-1500, 1500),
    st.integers(0, 1),
    st.one_of(st.floats(0.0, 2.0), st.just(math.nan)),
    st.floats(0.0, 359.9),
    st.tuples(*[st.sampled_from(list(Flag))] * 2),
)


places = st.lists(st.integers(0, 24), max_size=8)


@pytest.mark.parametrize("limits", [None, DEFAULT_LIMITS])
@settings(max_examples=20)
@given(
    drawn=st.lists(readings, min_size=1, max_size=25, unique_by=lambda one: one[:2]),
    script=st.lists(st.tuples(places, st.booleans()), max_size=5),
)
def test_aggregates_are_those_of_the_stored_samples_whatever_came_when(
    place, drawn, script, limits
):
    samples = [reading(*one) for one in drawn]
    with emptied(place) as store:
        for sent, renew in [*script, (range(len(samples)), False)]:
            put(store, *(samples[k % len(samples)] for k in sent), limits=limits)
            if renew:
                renewed(store)
        check_aggregates(store)
        renewed(store)
        check_aggregates(store)


def check_aggregates(store):
    stored = store.samples("ace", limit=999)
    for key in ("current_speed_m_s", "current_east_m_s", "current_north_m_s"):
        for width_s in (60, 600):
            read = aggregates(store, key=key, width_s=width_s, stream="buoy-1")
            rows = [(a.t.timestamp(), a.count, a.mean, a.least, a.most) for a in read]
            assert rows == expected(stored, key, width_s)
            few = aggregates(store, key=key, width_s=width_s, stream="buoy-1", limit=2)
            assert few == read[:2]


def test_a_mean_across_north_stays_north(store):
    both = [
        Sample(
            stream="buoy-1",
            t=NOON + timedelta(seconds=k),
            values={"current_speed_m_s": 0.4, "current_to_deg": to},
        )
        for k, to in enumerate((350.0, 10.0))
    ]
    put(store, *both)
    (east,) = aggregates(store, key="current_east_m_s", stream="buoy-1")
    (north,) = aggregates(store, key="current_north_m_s", stream="buoy-1")
    assert east.mean == pytest.approx(0.0, abs=1e-15)
    assert north.mean == pytest.approx(0.4 * math.cos(math.radians(10.0)))


def test_a_direction_has_no_mean_and_the_refusal_says_what_has(store):
    with pytest.raises(InputError, match="current_east_m_s and current_north_m_s"):
        aggregates(store, key="current_to_deg", stream="buoy-1")


@pytest.mark.parametrize(
    ("query", "message"), [({"key": "salt"}, "salt"), ({"width_s": 61}, "61 s")]
)
def test_what_is_not_aggregated_is_refused(store, query, message):
    with pytest.raises(InputError, match=message):
        aggregates(store, **query)


def test_the_spans_requested_begin_within_the_bounds(store):
    put(store, *map(sample, range(40)))
    span = {"start": NOON + timedelta(minutes=15), "end": NOON + timedelta(minutes=30)}
    for _ in range(2):
        minutes = aggregates(store, **span)
        assert [one.t for one in minutes] == [sample(k).t for k in range(15, 30)]
        (tens,) = aggregates(store, width_s=600, **span)
        assert (tens.t, tens.count) == (NOON + timedelta(minutes=20), 10)
        renewed(store)


def test_numbers_whose_sum_is_none_have_a_mean(store):
    put(store, *(sample(0, 1.7e308, seq=seq) for seq in range(3)))
    assert aggregates(store)[0].mean == pytest.approx(1.7e308)


# --- days that leave ---

MIDNIGHT = NOON + timedelta(hours=12)


def test_a_day_that_leaves_keeps_its_aggregates(store):
    put(store, *map(sample, range(0, 60 * 14, 7)))
    before = [aggregates(store, width_s=width_s) for width_s in (60, 600)]
    assert store.retire("ace", before=MIDNIGHT) == 103
    assert [aggregates(store, width_s=width_s) for width_s in (60, 600)] == before
    assert store.samples("ace", limit=999) == [sample(k) for k in range(721, 840, 7)]


def test_a_day_that_has_not_ended_stays_whole(store):
    put(store, sample(0), sample(1, stream="depth-2"))
    assert store.retire("ace", before=MIDNIGHT - timedelta(seconds=1)) == 0
    assert store.retire("ice", before=MIDNIGHT) == 0
    assert len(store.samples("ace", limit=9)) == 2


def test_what_comes_after_its_day_has_left_is_kept_but_changes_no_aggregate(store):
    put(store, sample(0), sample(1), sample(10))
    store.retire("ace", before=MIDNIGHT)
    final = [aggregates(store, width_s=width_s) for width_s in (60, 600)]
    assert put(store, sample(0), sample(2)) == (True, True)
    renewed(store)
    assert store.samples("ace", limit=9) == [sample(0), sample(2)]
    assert [aggregates(store, width_s=width_s) for width_s in (60, 600)] == final


def test_a_mark_that_crossed_a_seal_changes_no_aggregate(store):
    put(store, sample(0), sample(1))
    store.retire("ace", before=MIDNIGHT)
    final = aggregates(store)
    put(store, sample(0))
    t = int(NOON.timestamp()) * 10**6
    mark, row = "INSERT INTO mark VALUES (?, ?, ?, ?, ?)", ("ace", "depth-1", t, 0)
    crossed = with_checksum("mark", *row)
    store._writer.ask(lambda session: session.rows(mark, crossed)).result(timeout=20)
    assert aggregates(store) == final
    renewed(store)
    assert aggregates(store) == final


def test_a_sample_amended_while_its_day_leaves_stays_until_the_next_time(store):
    put(store, sample(0), sample(1), sample(2, 30.0), limits=DEFAULT_LIMITS)
    with store._database.reading() as session:
        rows = rows_of_day(session, "ace", "depth-1", microseconds(NOON) // DAY_US * DAY_US)
    put(store, sample(3), limits=DEFAULT_LIMITS)
    store._writer.ask(lambda session: delete(session, "ace", rows)).result(timeout=20)
    left, _ = store.samples("ace", limit=9)
    assert left.flags == {"depth_m": Flag.FAIL}


# --- alarms ---

RAISED = AlarmEvent(alarm="load.bridle-3", action=Action.RAISED, t=NOON, value=0.9)
SEEN = AlarmEvent(
    alarm="load.bridle-3",
    action=Action.ACKNOWLEDGED,
    t=NOON + timedelta(minutes=2),
    who="the operator",
    why="Seen; 'net' \x00 is fouled",
    quiet=True,
)


def test_the_book_of_alarms_is_the_last_that_was_kept(store):
    assert store.alarm_book("ace") is None
    store.keep_alarms("ace", book='{"a": 1}', journal=[]).result(timeout=20)
    store.keep_alarms("ace", book='{"a": 2}', journal=[]).result(timeout=20)
    store.keep_alarms("ice", book="{}", journal=[]).result(timeout=20)
    assert store.alarm_book("ace") == '{"a": 2}'


def kept_at(store, minutes, cage="ace"):
    found = store.adaptation(cage, at=NOON + timedelta(minutes=minutes))
    return found and (found.t, found.factors)


def test_how_far_intervals_were_adapted_is_known_for_every_time(store):
    assert kept_at(store, 0) is None
    rows = [
        Adaptation(t=NOON + timedelta(minutes=10 * k), factors=f'{{"depth-1": {k}}}')
        for k in range(4)
    ]
    store.keep_adaptations("ace", rows).result(timeout=20)
    assert kept_at(store, -1) is None
    assert kept_at(store, 9) == (NOON, '{"depth-1": 0}')
    assert kept_at(store, 1000) == (rows[3].t, '{"depth-1": 3}')
    assert kept_at(store, 1000, cage="ice") is None
    store.forget("ace")
    assert kept_at(store, 1000) is None


def test_samples_that_come_too_late_ask_for_intervals_adapted_anew(store):
    rows = [Adaptation(t=NOON + timedelta(minutes=10 * k), factors=f"{{{k}}}") for k in range(6)]
    store.keep_adaptations("ace", rows).result(timeout=20)
    late = NOON + timedelta(minutes=39)
    put(store, sample(25), limits=DEFAULT_LIMITS, ingested=late)
    assert store.refold("ace") is None
    put(store, sample(19), limits=DEFAULT_LIMITS, ingested=late)
    put(store, sample(15), limits=DEFAULT_LIMITS, ingested=late + timedelta(seconds=9))
    refold = store.refold("ace")
    assert refold == Refold(t=NOON + timedelta(minutes=30), touched=late + timedelta(seconds=9))
    anew = [Adaptation(t=refold.t, factors="{anew}")]
    touched = put(store, sample(14), limits=DEFAULT_LIMITS, ingested=late + timedelta(seconds=19))
    assert touched == (True,)
    store.keep_adaptations("ace", anew, refold=refold).result(timeout=20)
    assert kept_at(store, 1000) == (refold.t, "{anew}")
    assert kept_at(store, 29) == (rows[2].t, "{2}")
    # Another came meanwhile.
    assert store.refold("ace").touched == late + timedelta(seconds=19)
    store.keep_adaptations("ace", anew, refold=store.refold("ace")).result(timeout=20)
    assert store.refold("ace") is None


def test_the_journal_comes_back_in_order_within_its_bounds(store):
    store.keep_alarms("ace", book="{}", journal=[SEEN, RAISED]).result(timeout=20)
    store.keep_alarms("ace", book="{}", journal=[RAISED]).result(timeout=20)
    assert store.journal("ace", limit=9) == [RAISED, RAISED, SEEN]
    assert store.journal("ace", limit=1, newest=True) == [SEEN]
    assert store.journal("ace", limit=9, start=SEEN.t) == [SEEN]
    assert store.journal("ace", limit=9, end=SEEN.t) == [RAISED, RAISED]
    assert store.journal("ice", limit=9) == []


def test_lines_of_one_moment_stay_in_their_order(store):
    lines = [
        AlarmEvent(alarm="volume.net", action=action, t=NOON)
        for action in (Action.RAISED, Action.CLEARED, Action.COMMENTED)
    ]
    store.keep_alarms("ace", book="{}", journal=lines).result(timeout=20)
    assert store.journal("ace", limit=9) == lines
    assert store.journal("ace", limit=2, newest=True) == lines[1:]


# --- one process for a cage ---


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr("seacage.service._store._store._PATIENCE_S", 0.3)


@pytest.fixture(params=BOTH)
def two(request, tmp_path):
    """Two stores in one place, as two processes open them."""
    if request.param == "sqlite":
        with two_of(tmp_path / "samples.sqlite") as stores:
            yield stores
    else:
        with schema(request.getfixturevalue("postgres")) as url, two_of(url) as stores:
            yield stores


@contextmanager
def two_of(place):
    with closing(open_store(place)) as first, closing(open_store(place)) as second:
        yield first, second


def test_a_cage_is_served_by_one_process_and_then_by_the_next(two, impatient):
    first, second = two
    first.claim("ace")
    first.claim("ace")
    with pytest.raises(StoreError, match="ace is served from this store by another process"):
        second.claim("ace")
    first.close()
    second.claim("ace")


def test_who_comes_a_moment_early_waits_for_the_one_before(two):
    first, second = two
    first.claim("ace")
    late = threading.Timer(0.5, first.close)
    late.start()
    second.claim("ace")
    late.join()


# --- the whole ---


def test_forgetting_a_cage_leaves_the_others(store):
    for cage in ("ace", "ice"):
        put(store, sample(), cage=cage)
        store.keep_alarms(cage, book="{}", journal=[RAISED]).result(timeout=20)
    renewed(store)
    store.forget("ace")
    assert store.samples("ace", limit=9) == aggregates(store) == store.journal("ace", limit=9) == []
    assert store.alarm_book("ace") is None
    assert store.samples("ice", limit=9) == [sample()]
    assert store.journal("ice", limit=9) == [RAISED]


def test_a_closed_store_takes_nothing_and_says_so(store):
    store.close()
    with pytest.raises(StoreError, match="closed"):
        put(store, sample())


def test_a_sample_that_nobody_waits_for_any_more_is_stored_all_the_same(store):
    future = store.append("ace", [sample()], ingested=NOON)
    future.cancel()
    put(store, sample(1))
    assert len(store.samples("ace", limit=9)) == 2


# --- damage ---


def spoil(store, sql, *values):
    """Change what is on disk behind the store's back."""
    store._writer.ask(lambda session: session.rows(sql, values)).result(timeout=20)


def looked_through(store):
    """Verify everything at once."""
    for _ in verify(store._read):
        pass


RAISED = AlarmEvent(alarm="volume.net", action=Action.RAISED, t=NOON)


def test_a_sample_that_the_disk_has_changed_is_left_out_and_counted_and_the_rest_is_served(store):
    put(store, *map(sample, range(6)))
    assert store.lost is None
    spoil(store, "UPDATE sample SET readings = replace(readings, '14', '94') WHERE t = ?", at(1))
    spoil(store, "UPDATE sample SET readings = '{' WHERE t = ?", at(5))
    whole = [sample(k) for k in (0, 2, 3, 4)]
    assert store.samples("ace", limit=3) == whole[:3]
    assert store.samples("ace", limit=3, newest=True) == whole[1:]
    assert store.latest("ace") == {"depth-1": sample(4)}
    assert store.latest("ace", at=sample(1).t) == {"depth-1": sample(0)}
    assert sum(one.count for one in aggregates(store, width_s=60)) == 4
    assert store.damage.count == 2
    assert "2 stored rows are not as they were written" in store.lost
    assert store.fault is None


@pytest.mark.parametrize("column", ["t", "seq", "remarks", "t_ingest", "crc"])
def test_every_column_of_a_sample_is_covered(store, column):
    put(store, sample(0), sample(1), sample(2))
    value = "'[1]'" if column == "remarks" else f"{column} + 1"
    spoil(store, f"UPDATE sample SET {column} = {value} WHERE t = ?", at(1))
    assert store.samples("ace", limit=9) == [sample(0), sample(2)]
    assert store.damage.count == 1


def test_a_row_without_a_checksum_is_damaged(store):
    put(store, sample(0), sample(1))
    spoil(store, "UPDATE sample SET crc = NULL WHERE t = ?", at(0))
    looked_through(store)
    assert store.damage.count == 1
    assert store.samples("ace", limit=9) == [sample(1)]


def test_a_damaged_sample_that_is_sent_again_takes_its_place(store):
    put(store, sample(0), sample(1), sample(2), limits=DEFAULT_LIMITS)
    before = store.samples("ace", limit=9)
    spoil(store, "UPDATE sample SET readings = replace(readings, '14', '94') WHERE t = ?", at(1))
    assert put(store, sample(0), sample(1), limits=DEFAULT_LIMITS) == (False, True)
    assert store.samples("ace", limit=9) == before


def test_rows_of_0_1_0_are_served_and_stay_unverified(store):
    put(store, sample(0), sample(1), sample(2, 30.0), limits=DEFAULT_LIMITS)
    spoil(store, "UPDATE sample SET crc = -1")
    put(store, sample(3), limits=DEFAULT_LIMITS)  # which amends the one before it
    assert store.samples("ace", limit=9)[2].flags == {"depth_m": Flag.FAIL}
    bare = sum(unverified for _, unverified in verify(store._read))
    assert bare == 3
    assert store.lost is None


def test_rows_that_are_gone_are_missed(store):
    put(store, *map(sample, range(6)))
    renewed(store)
    store.keep_alarms("ace", book="{}", journal=[RAISED] * 3).result(timeout=20)
    looked_through(store)
    assert store.damage.count == 0
    spoil(store, "DELETE FROM sample WHERE t IN (?, ?)", at(1), at(2))
    spoil(store, "DELETE FROM journal WHERE number = (SELECT max(number) FROM journal)")
    spoil(store, "DELETE FROM aggregate WHERE width = 60 AND t = ?", at(1))
    looked_through(store)
    assert store.damage.count == 2 + 1 + 1
    assert "4 are missing" in store.lost


@pytest.mark.parametrize(
    ("table", "change"),
    [
        ("alarm_book", "book = '{ }'"),
        ("journal", "line = replace(line, 'volume', 'Volume')"),
        ("adaptation", "factors = '{ }'"),
        ("aggregate", "mean = mean + 1"),
        ("sealed", "t = t + 86400000000"),
        ("quality", "memory = memory || ' '"),
        ("refold", "touched = touched + 1"),
        ("mark", "touched = touched + 1"),
    ],
)
def test_every_table_is_verified(store, table, change):
    put(store, *map(sample, range(9)), limits=DEFAULT_LIMITS, ingested=NOON + timedelta(hours=1))
    renewed(store)
    put(store, *(sample(24 * 60 + k) for k in range(300)), limits=DEFAULT_LIMITS)
    store.keep_alarms("ace", book="{}", journal=[RAISED]).result(timeout=20)
    store.keep_adaptations("ace", [Adaptation(t=NOON, factors="{}")]).result(timeout=20)
    store.retire("ace", before=MIDNIGHT)
    looked_through(store)
    assert store.damage.count == 0
    spoil(store, f"UPDATE {table} SET {change}")
    looked_through(store)
    assert store.damage.count > 0
    assert store.alarm_book("ace") == (None if table == "alarm_book" else "{}")
    assert store.journal("ace", limit=9) == ([] if table == "journal" else [RAISED])
    kept = store.adaptation("ace", at=NOON)
    assert (kept is None) == (table == "adaptation")


def test_reads_that_fail_are_a_fault_until_they_succeed(store, monkeypatch):
    put(store, sample())

    def fail():
        raise StoreError("The disk does not answer.")

    with monkeypatch.context() as failing:
        failing.setattr(store._database, "reading", fail)
        with pytest.raises(StoreError):
            store.samples("ace", limit=9)
        assert store.fault == "The disk does not answer."
    assert store.samples("ace", limit=9) == [sample()]
    assert store.fault is None


def at(minutes):
    return microseconds(sample(minutes).t)
