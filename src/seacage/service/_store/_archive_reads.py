"""Samples of the store and of the archive, as if they were all in one."""

from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime, timedelta
from itertools import groupby

from seacage.records import Sample
from seacage.service._store._archive import Archive, key_of, order_of

_MICROSECOND = timedelta(microseconds=1)


def with_archive(
    found: Sequence[Sample],
    archive: Archive,
    cage: str,
    *,
    stream: str | None,
    start: datetime | None,
    end: datetime | None,
    limit: int,
    newest: bool,
) -> list[Sample]:
    """Add what only the archive has to what was found in the store, under the same bounds."""
    if found and len(found) >= limit:  # what lies beyond would be cut off again
        start = found[0].t if newest else start
        end = end if newest else found[-1].t + _MICROSECOND
    held = {key_of(one): one for one in found}
    days = archive.days(cage, stream=stream, start=start, end=end)
    added, reached = 0, None
    for day, name in reversed(days) if newest else days:
        if added >= limit and day != reached:
            break
        reached = day
        older = archive.read(cage, name, day, start=start, end=end, limit=limit, newest=newest)
        added += len(older)
        held = {key_of(one): one for one in older} | held
    ordered = [held[key] for key in sorted(held, key=order_of)]
    return ordered[-limit:] if newest else ordered[:limit]


def latest_of(
    latest: Mapping[str, Sample], archive: Archive, cage: str, *, at: datetime | None
) -> dict[str, Sample]:
    """Put what the archive has later in the place of a stream's newest in the store."""
    end = None if at is None else at + _MICROSECOND
    newest = dict(latest)
    for stream in archive.streams(cage):
        found = [latest[stream]] if stream in latest else []
        both = with_archive(
            found, archive, cage, stream=stream, start=None, end=end, limit=1, newest=True
        )
        newest |= {one.stream: one for one in both}
    return newest


def read_archive_between(
    archive: Archive,
    cage: str,
    *,
    stream: str | None,
    start: datetime | None,
    end: datetime | None,
) -> Iterator[Sample]:
    """Read the archived samples of start <= t < end in time order, a day at a time."""
    days = archive.days(cage, stream=stream, start=start, end=end)
    for day, group in groupby(days, key=lambda one: one[0]):
        samples = [
            sample
            for _, name in group
            for sample in archive.read(cage, name, day, start=start, end=end)
        ]
        yield from sorted(samples, key=lambda one: order_of(key_of(one)))
