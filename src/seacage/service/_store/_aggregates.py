"""Aggregates of the store: of one minute and of ten, exact at every query.

A commit of samples only marks the ten minutes that they fall into. The writer renews marked
aggregates from the samples when these have rested, and whoever asks before that gets them made
from the samples. So late, repeated and amended samples need no thought, and ingest waits for no
sums.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from datetime import timedelta

from seacage.conventions import Flag, InputError
from seacage.records import KEYS
from seacage.service._schemas._samples import AggregateOut
from seacage.service._store._database._rows import DAY_US, SAMPLES, Bounds, moment_of, pairs_of
from seacage.service._store._database._session import AbstractSession
from seacage.service._store._integrity._verify import recount

WIDTHS_S = (60, 600)  # of the spans; each divides the next, and the last divides a day
WIDEST_US = WIDTHS_S[-1] * 1_000_000
_SPEED, _TO = "current_speed_m_s", "current_to_deg"
_EAST, _NORTH = "current_east_m_s", "current_north_m_s"
_DIRECTIONS = frozenset(name for name, key in KEYS.items() if key.unit == "deg")
# What is aggregated: every key but the directions, whose mean would mean nothing
QUANTITIES = (*(key for key in KEYS if key not in _DIRECTIONS), _EAST, _NORTH)
_USELESS = (Flag.FAIL, Flag.MISSING)
# Quantity, width [s], t [µs], n, mean, least, most
Summary = tuple[str, int, int, int, float, float, float]
RESTED = timedelta(seconds=30)  # a span is summed up when nothing has come for it for so long
_AT_ONCE = 20  # spans in one transaction: ten minutes at 2 s are 300 samples each
_MARKED = "SELECT cage, stream, t FROM mark WHERE touched < ? ORDER BY touched LIMIT ?"
_MARKED_IN = "SELECT t, touched, crc FROM mark WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_SEALED_IN = "SELECT t, crc FROM sealed WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_UNMARK = "DELETE FROM mark WHERE cage = ? AND stream = ? AND t = ?"
_SAMPLES = f"{SAMPLES} AND stream = ? AND t >= ? AND t < ?"
_CLEAR = "DELETE FROM aggregate WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_KEEP = "INSERT INTO aggregate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"

_KEPT = """
SELECT t, n, mean, least, most, crc FROM aggregate
WHERE cage = ? AND stream = ? AND quantity = ? AND width = ? AND t >= ? AND t < ?
ORDER BY t LIMIT ?"""

Span = tuple[str, str, int]  # cage, stream, and where ten minutes begin [µs]


def check_aggregate(key: str, width_s: int) -> None:
    """Refuse a quantity or a width that is not aggregated.

    Raises InputError: with what there is instead.
    """
    if key in _DIRECTIONS:
        raise InputError(
            f"aggregates: {key} is a direction, and the mean of 350 and 10 deg is not 180 deg. "
            f"Ask for {_EAST} and {_NORTH} and turn their means into a direction."
        )
    if key not in QUANTITIES:
        raise InputError(f"aggregates: {key!r} is no quantity. There are {', '.join(QUANTITIES)}.")
    if width_s not in WIDTHS_S:
        raise InputError(
            f"aggregates: width_s = {width_s} s is not kept. Ask for "
            f"{' or '.join(map(str, WIDTHS_S))} s."
        )


def summaries(rows: Iterable[tuple[int, str]]) -> list[Summary]:
    """Aggregate samples, given as t [µs] and readings, in spans of every width.

    The answer does not depend on the order of the samples, to the last bit.
    """
    readings: dict[tuple[str, int, int], list[float]] = {}
    for t, text in rows:
        for quantity, value in _usable(text):
            for width in WIDTHS_S:
                begins = t - t % (width * 1_000_000)
                readings.setdefault((quantity, width, begins), []).append(value)
    return [(*key, *_summary(values)) for key, values in sorted(readings.items())]


def _usable(readings: str) -> Iterator[tuple[str, float]]:
    good = {
        key: value
        for key, (value, flag) in pairs_of(readings).items()
        if flag not in _USELESS and math.isfinite(value)
    }
    for key, value in good.items():
        if key in QUANTITIES:  # none at a depth
            yield key, value
    if _SPEED in good and _TO in good:
        angle = math.radians(good[_TO])
        yield _EAST, good[_SPEED] * math.sin(angle)
        yield _NORTH, good[_SPEED] * math.cos(angle)


def _summary(values: list[float]) -> tuple[int, float, float, float]:
    n, least, most = len(values), min(values) + 0.0, max(values) + 0.0  # SQLite knows no -0.0
    try:
        mean = math.fsum(values) / n
    except OverflowError:  # the sum of numbers that are each still one
        mean = math.fsum(value / n for value in values)
    return n, min(max(mean, least), most) + 0.0, least, most


def renew_rested(session: AbstractSession, *, now_us: int) -> int:
    """Sum up some of the spans that have rested; how many."""
    before = now_us - RESTED // timedelta(microseconds=1)
    marked = session.rows(_MARKED + session.passing, (before, _AT_ONCE))
    _renew(session, marked)
    return len(marked)


def renew_between(session: AbstractSession, cage: str, stream: str, start: int, end: int) -> None:
    """Sum up every marked span of a stream in start <= t < end [µs]."""
    _renew(session, [(cage, stream, t) for t in _marks(session, cage, stream, start, end)])


def aggregates_between(
    session: AbstractSession, of: tuple[str, str], key: str, width_s: int, bounds: Bounds
) -> list[AggregateOut]:
    """Read spans of a cage's stream in time order, as ``Store.aggregates`` says."""
    first, last = bounds.us
    marked = _marks(session, *of, first - first % WIDEST_US, last)
    # A marked span may turn out empty, so as many more are read as could fall away.
    enough = bounds.limit + len(marked) * WIDTHS_S[-1] // width_s
    spans: dict[int, list[Sequence[float]]] = {t: [] for t in marked}
    kept = (*of, key, width_s)
    for row in session.intact("aggregate", _KEPT, (*kept, first, last), head=4, limit=enough):
        spans.setdefault(row[0] - row[0] % WIDEST_US, []).append(row)
    found: list[Sequence[float]] = []
    for t in sorted(spans):
        if t not in marked:
            found += spans[t]
        else:
            found += (
                row
                for quantity, width, *row in _sum_up(session, (*of, t))
                if (quantity, width) == (key, width_s) and first <= row[0] < last
            )
        if len(found) >= bounds.limit:
            break
    return [
        AggregateOut(t=moment_of(int(t)), count=int(n), mean=mean, least=least, most=most)
        for t, n, mean, least, most in found[: bounds.limit]
    ]


def _marks(session: AbstractSession, cage: str, stream: str, start: int, end: int) -> set[int]:
    """Where the marked spans of a stream begin, but for those of sealed days."""
    of = (cage, stream)
    days = session.intact("sealed", _SEALED_IN, (*of, start - start % DAY_US, end), head=2)
    sealed = {t for (t,) in days}
    marked = {t for t, _ in session.intact("mark", _MARKED_IN, (*of, start, end), head=2)}
    return {t for t in marked if t - t % DAY_US not in sealed} if sealed else marked


def _renew(session: AbstractSession, spans: Sequence[Span]) -> None:
    # A late sample's mark may have crossed a seal on its way.
    live = [span for span in spans if span[2] in _marks(session, *span, span[2] + 1)]
    fresh = [(*span[:2], *summary) for span in live for summary in _sum_up(session, span)]
    session.each(_CLEAR, [(*span, span[2] + WIDEST_US) for span in live])
    session.keep("aggregate", _KEEP, *fresh)
    recount(session, "aggregate", live)
    session.each(_UNMARK, spans)


def _sum_up(session: AbstractSession, span: Span) -> list[Summary]:
    rows = session.intact("sample", _SAMPLES, (*span, span[2] + WIDEST_US))
    return summaries((row[1], row[3]) for row in rows)
