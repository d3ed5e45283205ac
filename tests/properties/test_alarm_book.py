"""A book of alarms survives a restart to the bit."""

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import InputError
from seacage.twin import Alarm, AlarmBook
from seacage.twin._faults._baseline import Baseline
from seacage.twin._faults._cusum import Evidence
from seacage.twin._faults._detector import FaultDetector
from seacage.twin._faults._residuals import BlockSums
from seacage.twin._faults._sensor import SensorMonitor

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
COUNTS = st.integers(0, 10**9)
TIMES = st.integers(0, 4 * 10**15).map(lambda us: EPOCH + timedelta(microseconds=us))
NAMES = st.text(min_size=1, max_size=20)


def _keywords(**strategies: st.SearchStrategy[object]) -> st.SearchStrategy[dict[str, object]]:
    """Arguments, not values: what checks types draws at random, which strategies may not."""
    return st.fixed_dictionaries(strategies)


ALARMS = _keywords(
    name=NAMES,
    active=st.booleans(),
    acknowledged=st.booleans(),
    since=st.none() | TIMES,
    crossed=st.none() | TIMES,
    notified=st.none() | TIMES,
    value=st.none() | NUMBERS,
    worst=st.none() | NUMBERS,
    shelved_until=st.none() | TIMES,
    shelved_once=st.booleans(),
    in_service=st.booleans(),
    comment=st.text(),
    detail=st.text(),
)
MONITORS = _keywords(
    latest=st.none() | TIMES,
    values=st.lists(NUMBERS, max_size=5).map(tuple),
    since=st.none() | TIMES,
    repeats=COUNTS,
    count=COUNTS,
    error=NUMBERS,
)
SIZES = st.lists(NUMBERS, max_size=3).map(tuple)
TABLES = st.lists(SIZES, max_size=3).map(tuple)
EVIDENCE = _keywords(cusum=NUMBERS, size=SIZES, covariance=TABLES)
BASELINES = _keywords(
    sensors=st.lists(NAMES, max_size=3).map(tuple),
    size=SIZES,
    covariance=TABLES,
    mean_square=SIZES,
    running_mean=SIZES,
    long_run_variance=SIZES,
)


@settings(max_examples=60)
@given(
    alarms=st.lists(ALARMS, max_size=3),
    t=st.none() | TIMES,
    monitors=st.dictionaries(NAMES, MONITORS, max_size=3),
    evidence=st.dictionaries(NAMES, EVIDENCE, max_size=3),
    sums=_keywords(number=st.none() | COUNTS, ticks=COUNTS, east=NUMBERS, north=NUMBERS),
    baseline=BASELINES,
    active=st.lists(NAMES, max_size=3).map(tuple),
    waited=COUNTS,
)
def test_a_book_comes_back_as_it_was_written(
    alarms, t, monitors, evidence, sums, baseline, active, waited
):
    book = AlarmBook(
        alarms={one["name"]: Alarm(**one) for one in alarms},
        t=t,
        detector=FaultDetector(
            monitors={name: SensorMonitor(**one) for name, one in monitors.items()},
            evidence={name: Evidence(**one) for name, one in evidence.items()},
            sums=BlockSums(**sums),
            baseline=Baseline(**baseline),
            active=active,
            waited=waited,
        ),
    )
    assert AlarmBook.from_json(book.to_json()) == book


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "Begin with AlarmBook.new"),
        ("[]", "Begin with AlarmBook.new"),
        ('{"alarms": {"a": {"active": 3}}}', "alarms.a"),
        ('{"format": "another"}', "this is 'another'"),
    ],
)
def test_another_text_is_refused_in_a_sentence(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        AlarmBook.from_json(text)
