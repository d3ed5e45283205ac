"""Samples of one stream as a Parquet table, and back."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any

from seacage.conventions import Flag
from seacage.records import KEYS, Sample
from seacage.service._store._rows import microseconds, moment_of
from seacage.service._store._session import StoreError


class ArchiveError(StoreError):
    """The archive cannot be written or read."""


def packed(cage: str, stream: str, samples: Sequence[Sample]) -> bytes:
    """Write samples as the bytes of a Parquet file.

    Beside t, seq and remarks there are a column and its flags for each quantity. A quantity
    that a sample lacks is null there; one that is no number is NaN.
    """
    pa = _arrow()
    columns: dict[str, Any] = {
        "t": pa.array([microseconds(one.t) for one in samples], pa.int64()).cast(
            pa.timestamp("us", tz="UTC")
        ),
        "seq": pa.array([one.seq for one in samples], pa.int64()),
    }
    for key in KEYS:
        if any(key in one.values for one in samples):
            values = [one.values.get(key) for one in samples]
            flags = [int(one.flags[key]) if key in one.flags else None for one in samples]
            columns[key] = pa.array(values, pa.float64())
            columns[f"{key}_flag"] = pa.array(flags, pa.uint8())
    columns["remarks"] = pa.array([list(one.remarks) for one in samples], pa.list_(pa.string()))
    table = pa.table(columns).replace_schema_metadata({"cage": cage, "stream": stream})
    sink = pa.BufferOutputStream()
    import_module("pyarrow.parquet").write_table(table, sink, compression="zstd")
    return sink.getvalue().to_pybytes()


def unpacked(
    content: bytes, stream: str, *, start: int, end: int, limit: int, newest: bool
) -> list[Sample]:
    """Read the samples of a Parquet file in start <= t < end [µs], the first or the last."""
    pa = _arrow()
    table = import_module("pyarrow.parquet").read_table(pa.BufferReader(content), use_threads=False)
    times: list[int] = table["t"].cast(pa.int64()).to_pylist()  # in order, as they were written
    first = next((k for k, t in enumerate(times) if t >= start), len(times))
    last = next((k for k in range(len(times), first, -1) if times[k - 1] < end), first)
    if newest:
        first = max(first, last - limit)
    chosen: Any = table.slice(first, min(last - first, limit))
    keys = [key for key in KEYS if key in chosen.column_names]
    columns = [(key, chosen[key].to_pylist(), chosen[f"{key}_flag"].to_pylist()) for key in keys]
    rows = zip(
        times[first:], chosen["seq"].to_pylist(), chosen["remarks"].to_pylist(), strict=False
    )
    return [
        Sample(
            stream=stream,
            t=moment_of(t),
            values={key: values[k] for key, values, _ in columns if values[k] is not None},
            flags={key: Flag(flags[k]) for key, _, flags in columns if flags[k] is not None},
            remarks=tuple(remarks),
            seq=seq,
        )
        for k, (t, seq, remarks) in enumerate(rows)
    ]


def _arrow() -> Any:
    # It has no types of its own, and a barge may do without it.
    try:
        return import_module("pyarrow")
    except ImportError as error:
        raise ArchiveError(
            "The archive is made of Parquet files, and pyarrow is not installed. "
            "Install it: pip install 'seacage[archive]'."
        ) from error
