"""Where a publisher's samples come from: a record, a growing file, or lines of JSON."""

import heapq
import os
import time
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime, timedelta

from pydantic import ValidationError

from seacage.conventions import InputError
from seacage.records import KEYS, Record, Sample
from seacage.service._publish._publisher import Batch
from seacage.service._schemas._samples import BATCH_LIMIT, SampleIn, read_samples
from seacage.service._tail import Refuse, Tail

_SECOND = timedelta(seconds=1)
_ALWAYS = datetime.max.replace(tzinfo=UTC)


def pace(
    records: Sequence[Record],  # one per stream
    *,
    speed: float | None,  # against real time; None is as fast as they are taken
    since: datetime | None = None,  # samples before this are left out
) -> Iterator[list[Sample]]:
    """Give out samples in time order, in batches: those that are due, or as many as go at once."""
    merged = heapq.merge(*(one.samples() for one in records), key=lambda sample: sample.t)
    began, start, batch = time.monotonic(), None, list[Sample]()
    for sample in merged:
        if since is not None and sample.t < since:
            continue
        start = start or sample.t
        due_s = 0.0 if speed is None else (sample.t - start) / _SECOND / speed
        ahead_s = due_s - (time.monotonic() - began)
        if batch and (ahead_s > 0.0 or len(batch) == BATCH_LIMIT):
            yield batch
            batch = []
        if ahead_s > 0.0:
            time.sleep(max(0.0, due_s - (time.monotonic() - began)))
        batch.append(sample)
    if batch:
        yield batch


def record_batches(
    records: Sequence[Record], *, source: str, place: str | None, speed: float | None
) -> Iterator[Batch]:
    """Read a record from where a publisher stopped; its place is the time of the last sample."""
    since = None if place is None else datetime.fromisoformat(place)
    for samples in pace(records, speed=speed, since=since):
        yield Batch(samples=tuple(samples), source=source, place=samples[-1].t.isoformat())


def tail_batches(tail: Tail, *, source: str, every_s: float = 1.0) -> Iterator[Batch]:
    """Follow a growing file for ever."""
    while True:
        before = tail.place
        samples = tail.poll()
        if tail.place != before:
            yield Batch(samples=samples, source=source, place=str(tail.place))
        else:
            time.sleep(every_s)


def arriving(descriptor: int) -> Iterator[list[bytes]]:
    """Read lines as they come, as many at once as are there; the last may lack its end."""
    rest = b""
    while content := os.read(descriptor, 1 << 16):
        *whole, rest = (rest + content).split(b"\n")
        if whole:
            yield [line + b"\n" for line in whole]
    if rest:
        yield [rest]


def line_batches(arrived: Iterable[Sequence[bytes]], *, refuse: Refuse) -> Iterator[Batch]:
    """Read one sample from each line of JSON, as in a request to the service.

    Whether its time has come, the service says: its clock counts, and not this machine's.

    ``arrived``: lines, each with its end; one without counts as cut. ``refuse``: is told which
    line, the line, and why it cannot be read.
    """
    number = 0
    for lines in arrived:
        samples = list[Sample]()
        for line in lines:
            number += 1
            try:
                samples += _read(line)
            except InputError as error:
                refuse(f"line {number}", line, str(error))
        if samples:
            yield Batch(samples=tuple(samples), source="lines", place=str(number))


def _read(line: bytes) -> Sequence[Sample]:
    """The sample of a line, or none of an empty one."""
    if not line.endswith(b"\n"):
        raise InputError("The input ended inside this line.")
    if not line.strip():
        return ()
    try:
        incoming = SampleIn.model_validate_json(line)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}.") from error
    samples, rejected = read_samples([incoming], {incoming.stream: tuple(KEYS)}, until=_ALWAYS)
    if rejected:
        raise InputError(rejected[0].reason)
    return samples
