"""A sample as a row of the store, and back."""

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

from seacage.conventions import Flag, InputError, SeacageError
from seacage.records import Amendment, Sample

DAY_US = 86_400_000_000
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
MICROSECOND = timedelta(microseconds=1)
_NO_SEQ = -1
_SEQS = range(2**63)
_ALL = 2**62
# Begins what selects samples of a cage, each a whole row but for the cage
SAMPLES = "SELECT stream, t, seq, readings, remarks, t_ingest, crc FROM sample WHERE cage = ?"
# Cage, stream, t, seq, readings, remarks, t_ingest: as in the schema
Row = tuple[str, str, int, int, str, str, int]
SampleRow = tuple[Any, ...]  # stream, t, seq, readings, remarks and t_ingest
# The flag that a value got from its own check, and when the sample came that amended it [us]
Own = tuple[int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds:
    """Times of the rows that are read, start <= t < end, and how many are read at most."""

    # Open where None
    start: datetime | None = None
    end: datetime | None = None
    # At most so many, the first; with ``newest`` the last
    limit: int = _ALL
    newest: bool = False

    @property
    def us(self) -> tuple[int, int]:
        """Start and end in microseconds since 1970 UTC."""
        start = -_ALL if self.start is None else microseconds(self.start)
        return start, _ALL if self.end is None else microseconds(self.end)


def row_of(cage: str, sample: Sample, ingested: datetime, amended: Mapping[str, Own]) -> Row:
    """Write a sample, with the flags that it has now, as a row.

    ``amended``: by key, where a later sample changed a flag: the flag before, and the later one's
    time.
    """
    texts = readings_text(sample, amended), remarks_text(sample)
    return (cage, sample.stream, *key_of(sample), *texts, microseconds(ingested))


def key_of(sample: Sample) -> tuple[int, int]:
    """Time [us] and number: what a sample is known by in its stream."""
    return microseconds(sample.t), _NO_SEQ if sample.seq is None else sample.seq


def check_seq(sample: Sample) -> None:
    """Refuse a number that no row holds.

    Raises InputError: it is negative or has more than 63 bits.
    """
    if sample.seq is not None and sample.seq not in _SEQS:
        raise InputError(
            f"{sample.stream}: seq = {sample.seq} is not within 0 and 2^63 - 1. "
            "Count samples from 0, or leave seq out."
        )


def readings_text(sample: Sample, amended: Mapping[str, Own]) -> str:
    """Write the column ``readings``: value and flag by key, and what a flag was before."""
    return json.dumps(
        {
            key: [v, int(sample.flags[key]), *amended.get(key, ())]
            for key, v in sample.values.items()
        }
    )


def remarks_text(sample: Sample) -> str:
    """Write the column ``remarks``: why values are not good."""
    return json.dumps(sample.remarks)


def sample_of_row(row: tuple[Any, ...], *, at: int | None = None) -> Sample:
    """Read a sample.

    ``row``: as stored. ``at``: give the flags that the samples until then had shown [us]; all
    samples where None.
    """
    stream, t, seq, readings, remarks, *_ = row
    pairs: dict[str, list[Any]] = json.loads(readings)
    return Sample(
        stream=stream,
        t=moment_of(t),
        values={key: value for key, (value, *_) in pairs.items()},
        flags={key: _flag(flag, own, at) for key, (_, flag, *own) in pairs.items()},
        remarks=tuple(json.loads(remarks)),
        seq=None if seq == _NO_SEQ else seq,
    )


def readable(rows: Iterable[SampleRow]) -> Iterator[tuple[SampleRow, Sample]]:
    """Pair rows with their samples; what the disk has spoilt is left out."""
    for row in rows:
        try:
            yield row, sample_of_row(row)
        except (ValueError, TypeError, OverflowError, AttributeError, SeacageError):
            continue


def own_flags(readings: str) -> dict[str, Flag]:
    """Read the flags that a sample got from its own check, before any amendment."""
    pairs: dict[str, list[Any]] = json.loads(readings)
    return {key: _flag(flag, own, -_ALL) for key, (_, flag, *own) in pairs.items()}


def amendments_of_row(row: SampleRow, *, until: int) -> Iterator[Amendment]:
    """What samples until a time [us] have made worse of a stored one."""
    stream, t_us, _, readings, remarks, *_ = row
    pairs, t = json.loads(readings), moment_of(t_us)
    later = [(key, flag, *own) for key, (_, flag, *own) in pairs.items() if own]
    # The remarks of amendments are the last, one for each value.
    why: list[str] = json.loads(remarks)[-len(later) :] if later else []
    for (key, flag, was, by), remark in zip(later, why, strict=True):
        if by <= until:
            yield Amendment(
                stream=stream, t=t, key=key, flag=Flag(flag), was=Flag(was), remark=remark
            )


def _flag(flag: int, own: list[int], at: int | None) -> Flag:
    return Flag(own[0] if own and at is not None and own[1] > at else flag)


def pairs_of(readings: str) -> dict[str, tuple[float, int]]:
    """Read values and flags by key; none where the disk has changed them.

    The writer reads so: one bad row must not keep it from writing others.
    """
    try:
        return {key: (float(v), int(flag)) for key, (v, flag, *_) in json.loads(readings).items()}
    except (ValueError, TypeError, AttributeError, OverflowError):
        return {}


def microseconds(t: datetime) -> int:
    """Since 1970 UTC."""
    return (t - _EPOCH) // MICROSECOND


def moment_of(t: int) -> datetime:
    """From microseconds since 1970 UTC."""
    return _EPOCH + t * MICROSECOND
