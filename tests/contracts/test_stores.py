"""What the store promises, in SQLite and in PostgreSQL alike."""

import math
import statistics
import threading
from contextlib import closing, contextmanager
from datetime import timedelta

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import Flag, InputError
from seacage.records import Amendment, Sample
from seacage.service._store._days import delete, rows_of_day
from seacage.service._store._kept_aggregates import renew_rested
from seacage.service._store._rows import DAY_US, microseconds
from seacage.service._store._store import StoreError, open_store
from seacage.twin import Action, Happened
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


def test_what_a_sample_taught_of_an_earlier_one_is_stored_with_it(store):
    spike = Sample(
        stream="buoy-1",
        t=NOON,
        values={"current_speed_m_s": 1.7, "hs_m": math.nan},
        flags={"current_speed_m_s": Flag.SUSPECT, "hs_m": Flag.MISSING},
        remarks=("It jumped.",),
    )
    put(store, spike, sample(0))
    for flag in (Flag.FAIL, Flag.FAIL, Flag.SUSPECT):  # only the first makes anything worse
        change = Amendment(
            stream="buoy-1", t=NOON, key="current_speed_m_s", flag=flag, remark="It is a spike."
        )
        assert len(put(store, sample(1), amendments=[change])) == 1
    read, other = store.samples("ace", end=NOON + timedelta(seconds=1), limit=9)
    assert read.flags == {"current_speed_m_s": Flag.FAIL, "hs_m": Flag.MISSING}
    assert read.remarks == ("It jumped.", "It is a spike.")
    assert read.values["current_speed_m_s"] == 1.7
    assert math.isnan(read.values["hs_m"])
    assert other == sample(0)


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


def test_many_who_ask_at_once_are_each_told_of_their_own(store):
    asked = [store.append("ace", [sample(k % 10)], ingested=NOON) for k in range(30)]
    told = [one.result(timeout=20) for one in asked]
    assert told == [(k < 10,) for k in range(30)]


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


@settings(max_examples=30)
@given(
    drawn=st.lists(readings, min_size=1, max_size=25, unique_by=lambda one: one[:2]),
    script=st.lists(st.tuples(places, places, st.booleans()), max_size=5),
)
def test_aggregates_are_those_of_the_stored_samples_whatever_came_when(place, drawn, script):
    samples = [reading(*one) for one in drawn]
    with emptied(place) as store:
        for sent, amended, renew in [*script, (range(len(samples)), [], False)]:
            put(
                store,
                *(samples[k % len(samples)] for k in sent),
                amendments=[spike(samples[k % len(samples)]) for k in amended],
            )
            if renew:
                renewed(store)
        check_aggregates(store)
        renewed(store)
        check_aggregates(store)


def spike(one):
    return Amendment(
        stream="buoy-1", t=one.t, key="current_speed_m_s", flag=Flag.FAIL, remark="A spike."
    )


def check_aggregates(store):
    stored = store.samples("ace", limit=999)
    for key in ("current_speed_m_s", "current_east_m_s", "current_north_m_s"):
        for width_s in (60, 600):
            read = aggregates(store, key=key, width_s=width_s, stream="buoy-1")
            told = [(a.t.timestamp(), a.count, a.mean, a.least, a.most) for a in read]
            assert told == expected(stored, key, width_s)
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


@pytest.mark.parametrize(("asked", "said"), [({"key": "salt"}, "salt"), ({"width_s": 61}, "61 s")])
def test_what_is_not_aggregated_is_refused(store, asked, said):
    with pytest.raises(InputError, match=said):
        aggregates(store, **asked)


def test_the_spans_asked_for_begin_within_the_bounds(store):
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
    mark = "INSERT INTO mark VALUES ('ace', 'depth-1', ?, 0)"
    store._writer.ask(lambda session: session.rows(mark, (t,))).result(timeout=20)
    assert aggregates(store) == final
    renewed(store)
    assert aggregates(store) == final


def test_a_sample_amended_while_its_day_leaves_stays_until_the_next_time(store):
    put(store, sample(0), sample(1))
    with store._database.reading() as session:
        rows = rows_of_day(session, "ace", "depth-1", microseconds(NOON) // DAY_US * DAY_US)
    spike = Amendment(stream="depth-1", t=NOON, key="depth_m", flag=Flag.FAIL, remark="A spike.")
    put(store, amendments=[spike])
    store._writer.ask(lambda session: delete(session, "ace", rows)).result(timeout=20)
    (left,) = store.samples("ace", limit=9)
    assert left.flags == {"depth_m": Flag.FAIL}


# --- alarms ---

RAISED = Happened(alarm="load.bridle-3", action=Action.RAISED, t=NOON, value=0.9)
SEEN = Happened(
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


def test_what_was_adapted_is_the_last_that_was_kept(store):
    assert store.adapted("ace") is None
    for factors in ('{"depth-1": 1}', '{"depth-1": 2}'):
        store.keep_adapted("ace", factors).result(timeout=20)
    assert store.adapted("ace") == '{"depth-1": 2}'
    assert store.adapted("ice") is None
    store.forget("ace")
    assert store.adapted("ace") is None


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
        Happened(alarm="volume.net", action=action, t=NOON)
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
    asked = store.append("ace", [sample()], ingested=NOON)
    asked.cancel()
    put(store, sample(1))
    assert len(store.samples("ace", limit=9)) == 2
