"""A sample as a row of the store, and back."""

import json
from datetime import UTC, datetime, timedelta
from typing import Any

from seacage.conventions import Flag, InputError
from seacage.records import Sample

DAY_US = 86_400_000_000
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)
_NO_SEQ = -1
_SEQS = range(2**63)

Row = tuple[str, str, int, int, str, str, int]
"""Cage, stream, t, seq, readings, remarks, t_ingest: as in the schema."""


def row_of(cage: str, sample: Sample, ingested: datetime) -> Row:
    """Write a sample as a row.

    Raises
    ------
    InputError
        Its number is negative or has more than 63 bits.
    """
    if sample.seq is not None and sample.seq not in _SEQS:
        raise InputError(
            f"{sample.stream}: seq = {sample.seq} is not within 0 and 2^63 - 1. "
            "Count samples from 0, or leave seq out."
        )
    return (
        cage,
        sample.stream,
        microseconds(sample.t),
        _NO_SEQ if sample.seq is None else sample.seq,
        json.dumps({key: [v, int(sample.flags[key])] for key, v in sample.values.items()}),
        json.dumps(sample.remarks),
        microseconds(ingested),
    )


def sample_of_row(row: tuple[Any, ...]) -> Sample:
    """Read a sample from stream, t, seq, readings and remarks."""
    stream, t, seq, readings, remarks = row
    pairs: dict[str, tuple[float, int]] = json.loads(readings)
    return Sample(
        stream=stream,
        t=moment_of(t),
        values={key: value for key, (value, _) in pairs.items()},
        flags={key: Flag(flag) for key, (_, flag) in pairs.items()},
        remarks=tuple(json.loads(remarks)),
        seq=None if seq == _NO_SEQ else seq,
    )


def pairs_of(readings: str) -> dict[str, tuple[float, int]]:
    """Read values and flags by key; none where the disk has changed them.

    The writer reads so: one bad row must not keep it from writing others.
    """
    try:
        return {key: (float(v), int(flag)) for key, (v, flag) in json.loads(readings).items()}
    except (ValueError, TypeError, AttributeError, OverflowError):
        return {}


def microseconds(t: datetime) -> int:
    """Since 1970 UTC."""
    return (t - _EPOCH) // _MICROSECOND


def moment_of(t: int) -> datetime:
    """From microseconds since 1970 UTC."""
    return _EPOCH + t * _MICROSECOND
