"""Samples of the store and of the archive, as if they were all in one."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from itertools import groupby

from seacage.records import Sample
from seacage.service._store._archive import Archive, key_of
from seacage.service._store._database._rows import MICROSECOND, Bounds


def with_archive(
    found: Sequence[Sample], archive: Archive, cage: str, stream: str | None, bounds: Bounds
) -> list[Sample]:
    """Add what only the archive has to what was found in the store, under the same bounds."""
    if found and len(found) >= bounds.limit:  # what lies beyond would be cut off again
        beyond = {"start": found[0].t} if bounds.newest else {"end": found[-1].t + MICROSECOND}
        bounds = replace(bounds, **beyond)
    held = {key_of(one): one for one in found}
    days = archive.days(cage, stream, bounds)
    added, reached = 0, None
    for day, name in reversed(days) if bounds.newest else days:
        if added >= bounds.limit and day != reached:
            break
        reached = day
        older = archive.read(cage, name, day, bounds)
        added += len(older)
        held = {key_of(one): one for one in older} | held
    ordered = [held[key] for key in sorted(held)]
    return ordered[-bounds.limit :] if bounds.newest else ordered[: bounds.limit]


def latest_of(
    latest: Mapping[str, Sample], archive: Archive, cage: str, *, at: datetime | None
) -> dict[str, Sample]:
    """Put what the archive has later in the place of a stream's newest in the store."""
    bounds = Bounds(end=at and at + MICROSECOND, limit=1, newest=True)
    newest = dict(latest)
    for stream in archive.streams(cage):
        found = [latest[stream]] if stream in latest else []
        both = with_archive(found, archive, cage, stream, bounds)
        newest |= {one.stream: one for one in both}
    return newest


def read_archive_between(
    archive: Archive, cage: str, stream: str | None, bounds: Bounds
) -> Iterator[Sample]:
    """Read archived samples in time order, a day at a time."""
    for day, group in groupby(archive.days(cage, stream, bounds), key=lambda one: one[0]):
        samples = [one for _, name in group for one in archive.read(cage, name, day, bounds)]
        yield from sorted(samples, key=key_of)
