"""Samples of the store: appended, amended, read."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from seacage.conventions import SeacageError
from seacage.records import AHEAD, DEFAULT_LIMITS, Amendment, Limits, Sample
from seacage.service._store import _quality
from seacage.service._store._adaptations import Refold, ask_refold, cut_adaptations
from seacage.service._store._aggregates import WIDEST_US
from seacage.service._store._database import _rows
from seacage.service._store._database._checksum import checksum, with_checksum
from seacage.service._store._database._session import AbstractSession
from seacage.service._store._integrity._verify import count_new
from seacage.service._store._quality import Checked, Key, Of, QualityControl
from seacage.twin import adapted_at_us

# A bucket of a sealed day is left as it is: of its samples only the late ones are still here.
_MARK = """
INSERT INTO mark SELECT ?, ?, ?, ?, ? WHERE NOT EXISTS (
    SELECT 1 FROM sealed WHERE cage = ? AND stream = ? AND t = ?
) ON CONFLICT (cage, stream, t) DO UPDATE SET touched = excluded.touched, crc = excluded.crc"""

_REPLACE = """
UPDATE sample SET readings = ?, remarks = ?, t_ingest = ?, crc = ?
WHERE cage = ? AND stream = ? AND t = ? AND seq = ?"""
_ONE = f"{_rows.SAMPLES} AND stream = ? AND t = ? AND seq = ?"
_REMARKED = (
    f"{_rows.SAMPLES} AND stream = ? AND t > ? AND t <= ? AND remarks <> '[]' ORDER BY t, seq"
)

# Goes down the index from name to name: a DISTINCT would read every sample
NAMED = """
WITH RECURSIVE named(name) AS (
    SELECT min({name}) FROM sample WHERE {of}
    UNION ALL
    SELECT (SELECT min({name}) FROM sample WHERE {of} AND {name} > named.name)
    FROM named WHERE named.name IS NOT NULL
)"""

# In each stream to its newest: no scan of the samples. In SQLite's words, and in those that
# PostgreSQL plans well.
_LATEST = f"""{NAMED.format(name="stream", of="cage = ?")}
SELECT s.stream, s.t, s.seq, s.readings, s.remarks, s.t_ingest, s.crc FROM named """  # noqa: S608
_NEWEST = {
    False: """JOIN sample s ON s.cage = ? AND s.stream = named.name AND (s.t, s.seq) = (
    SELECT t, seq FROM sample
    WHERE cage = s.cage AND stream = named.name AND t <= ? AND remarks NOT LIKE ?
    ORDER BY t DESC, seq DESC LIMIT 1
)""",
    True: """CROSS JOIN LATERAL (
    SELECT * FROM sample
    WHERE cage = ? AND stream = named.name AND t <= ? AND remarks NOT LIKE ?
    ORDER BY t DESC, seq DESC LIMIT 1
) s""",
}


@dataclass(frozen=True, slots=True)
class Append:
    """Samples to store, and what to check them with; None stores their flags as they are."""

    cage: str
    samples: tuple[Sample, ...]
    ingested: datetime
    limits: Limits | None


@dataclass(frozen=True, slots=True)
class Stored:
    """What has become of samples that were to be stored."""

    new: tuple[bool, ...]  # for each sample whether it was not known before
    samples: tuple[Sample, ...]  # the same samples, those that are new with their flags
    # Flags of samples before them, of the same streams, that have changed; those who stored in one
    # transaction have them in common
    amendments: tuple[Amendment, ...]
    late: bool = False  # whether any came too late for what the intervals were adapted to
    again: bool = False  # whether samples before them were checked again

    @property
    def fresh(self) -> list[Sample]:
        """Those that were not known before."""
        return [sample for sample, new in zip(self.samples, self.new, strict=True) if new]


def append_all(
    session: AbstractSession, works: Sequence[Append], control: QualityControl, *, touched: int
) -> list[Stored]:
    """Store the samples of many who asked at once."""
    streams = _by_stream(works)
    checked = {of: _check(session, control, of, one) for of, one in sorted(streams.items())}
    rows = list[_rows.Row]()
    for of, result in checked.items():
        ingested = streams[of].ingested
        fresh = {
            key: _rows.row_of(of[0], sample, ingested[key], result.amended.get(key, {}))
            for key, sample in result.fresh.items()
        }
        rows += [row for key, row in fresh.items() if key not in result.again]
        _replace(session, [fresh[key] for key in result.again if key in fresh])
    inserted = dict(zip((row[:4] for row in rows), session.insert(rows), strict=True))
    count_new(session, (row[:3] for row in rows if inserted[row[:4]]))
    # What the disk has changed is not known any more: the sample takes its place.
    spoilt = [row for row in rows if not inserted[row[:4]] and not _one(session, row[:4])]
    _replace(session, spoilt)
    inserted |= dict.fromkeys((row[:4] for row in spoilt), True)
    for of, result in checked.items():
        for key in [key for key in result.fresh if not inserted.get((*of, *key), True)]:
            del result.fresh[key]
    mark(session, _times_changed(checked), touched)
    late = _mark_refold(session, streams, checked)
    return [_outcome(work, checked, late=work.cage in late) for work in works]


@dataclass(slots=True)
class _Incoming:
    """Samples of one stream that came together, of equal ones the first."""

    limits: Limits | None
    samples: dict[Key, Sample]
    ingested: dict[Key, datetime]


def _by_stream(works: Sequence[Append]) -> dict[Of, _Incoming]:
    streams = dict[Of, _Incoming]()
    for work in works:
        for sample in work.samples:
            of = streams.setdefault((work.cage, sample.stream), _Incoming(work.limits, {}, {}))
            key = _rows.key_of(sample)
            of.samples.setdefault(key, sample)
            of.ingested.setdefault(key, work.ingested)
    return streams


def _check(
    session: AbstractSession, control: QualityControl, of: Of, incoming: _Incoming
) -> Checked:
    if incoming.limits is not None:
        return control.check(session, of, incoming.samples, incoming.limits)
    control.forget(of)
    return Checked(fresh=dict(incoming.samples))


def _times_changed(checked: Mapping[Of, Checked]) -> set[tuple[str, str, int]]:
    return {
        (*of, t)
        for of, one in checked.items()
        for t in (*(t for t, _ in one.fresh), *(_rows.microseconds(a.t) for a in one.amendments))
    }


def _outcome(work: Append, checked: Mapping[Of, Checked], *, late: bool) -> Stored:
    new, samples = list[bool](), list[Sample]()
    streams = dict.fromkeys((work.cage, sample.stream) for sample in work.samples)
    for sample in work.samples:
        # Of two that ask for the same sample the first gets it, as it is taken out here.
        fresh = checked[work.cage, sample.stream].fresh.pop(_rows.key_of(sample), None)
        new.append(fresh is not None)
        samples.append(sample if fresh is None else fresh)
    amendments = tuple(one for of in streams for one in checked[of].amendments)
    return Stored(
        new=tuple(new),
        samples=tuple(samples),
        amendments=amendments,
        late=late,
        again=bool(amendments) or any(checked[of].walked for of in streams),
    )


def _mark_refold(
    session: AbstractSession, streams: Mapping[Of, _Incoming], checked: Mapping[Of, Checked]
) -> set[str]:
    """Mark from when on intervals were adapted without samples that came too late for it."""
    late = dict[str, tuple[int, int]]()
    for of, incoming in streams.items():
        for key in checked[of].fresh:
            due, now = adapted_at_us(key[0]), _rows.microseconds(incoming.ingested[key])
            if incoming.limits is not None and due <= now:
                first, last = late.get(of[0], (due, now))
                late[of[0]] = min(first, due), max(last, now)
    for cage, (t, touched) in sorted(late.items()):
        ask_refold(session, cage, Refold(t=_rows.moment_of(t), touched=_rows.moment_of(touched)))
    return set(late)


def withdraw_samples(
    session: AbstractSession, control: QualityControl, of: Of, *, clock: datetime, after: datetime
) -> int:
    """Withdraw samples of a stream after a time, as ``Store.withdraw`` says; how many."""
    cut_adaptations(session, of[0], after)
    until = _rows.microseconds(after)
    checked = control.withdraw(session, of, clock=clock, after=until)
    changed = _times_changed({of: checked})
    mark(session, changed, _rows.microseconds(clock))
    return len(changed)


def reinstate_samples(
    session: AbstractSession, control: QualityControl, of: Of, *, clock: datetime, until: datetime
) -> int:
    """Take back that samples of a stream were withdrawn, as ``Store.reinstate`` says; how many."""
    samples = _quality.withdrawn_samples(session, of, clock=clock, until=_rows.microseconds(until))
    checked = {of: control.check(session, of, samples, DEFAULT_LIMITS)}
    rows = [
        _rows.row_of(of[0], sample, until, checked[of].amended.get(key, {}))
        for key, sample in checked[of].fresh.items()
    ]
    _replace(session, rows)
    mark(session, _times_changed(checked), _rows.microseconds(until))
    incoming = _Incoming(DEFAULT_LIMITS, samples, dict.fromkeys(samples, until))
    _mark_refold(session, {of: incoming}, checked)
    return len(rows)


def newest_samples(session: AbstractSession, of: Of, at: datetime) -> list[Sample]:
    """Read samples as ``Store.newest_of_each`` says, with the flags known at that time."""
    keys = sorted(_quality.newest_keys(session, of, _rows.microseconds(at)))
    return _read(session, of[0], [row for key in keys for row in _one(session, (*of, *key))], at)


def samples_between(
    session: AbstractSession,
    cage: str,
    bounds: _rows.Bounds,
    *,
    stream: str | None,
    withdrawn: bool,
    known_at: datetime | None = None,
) -> list[Sample]:
    """Read samples in time order, as ``Store.samples`` says."""
    sql, values = f"{_rows.SAMPLES} AND t >= ? AND t < ?", (cage, *bounds.us)
    if stream is not None:
        sql, values = f"{sql} AND stream = ?", (*values, stream)
    if not withdrawn:
        sql, values = f"{sql} AND remarks NOT LIKE ?", (*values, f"%{AHEAD}%")
    order = "DESC" if bounds.newest else "ASC"
    sql += f" ORDER BY t {order}, stream {order}, seq {order} LIMIT ?"
    rows = session.intact("sample", sql, values, limit=bounds.limit)
    return _read(session, cage, reversed(rows) if bounds.newest else rows, known_at)


def amendments_since(
    session: AbstractSession, of: Of, start: datetime, *, known_at: datetime
) -> tuple[Amendment, ...]:
    """Read what later samples, until a time, have made worse, as ``Store.amendments`` says."""
    first, last = _rows.microseconds(start), _rows.microseconds(known_at)
    rows = session.intact("sample", _REMARKED, (*of, first, last))
    return tuple(one for row in rows for one in _rows.amendments_of_row(row, until=last))


def latest_samples(
    session: AbstractSession, cage: str, *, at: datetime | None
) -> dict[str, Sample]:
    """Read the newest sample of each stream until a time, it included; none that is withdrawn."""
    until = _rows.microseconds(at) if at else _rows.Bounds().us[1]
    query = _LATEST + _NEWEST[session.lateral]
    bounds = _rows.Bounds(end=at and at + _rows.MICROSECOND, limit=1, newest=True)
    samples = list[Sample]()
    for row in session.rows(query, (cage, cage, cage, until, f"%{AHEAD}%")):
        good = session.whole("sample", [row], (cage,))
        samples += _read(session, cage, good) or samples_between(
            session, cage, bounds, stream=row[0], withdrawn=False
        )
    return {one.stream: one for one in samples}


def _read(
    session: AbstractSession, cage: str, rows: Iterable[_rows.SampleRow], at: datetime | None = None
) -> list[Sample]:
    found = list[Sample]()
    for row in rows:
        try:
            found.append(_rows.sample_of_row(row, at=at and _rows.microseconds(at)))
        except (ValueError, TypeError, OverflowError, AttributeError, SeacageError):
            session.damage.note("sample", (cage, *row))
    return found


def _one(session: AbstractSession, key: tuple[object, ...]) -> list[_rows.SampleRow]:
    return session.intact("sample", _ONE, key)


def _replace(session: AbstractSession, rows: Iterable[_rows.Row]) -> None:
    session.each(_REPLACE, [(*row[4:], checksum("sample", row), *row[:4]) for row in rows])


def mark(session: AbstractSession, changed: set[tuple[str, str, int]], touched: int) -> None:
    """Mark the ten minutes of samples that have changed, by cage, stream and time [us]."""
    # In order, so that two processes never wait for each other.
    spans = sorted({(cage, stream, t - t % WIDEST_US) for cage, stream, t in changed})
    rows = [
        (*with_checksum("mark", *span, touched), *span[:2], span[2] - span[2] % _rows.DAY_US)
        for span in spans
    ]
    session.each(_MARK, rows)
