"""What every reader of files promises, whoever wrote it."""

import os
import time
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from seacage.conventions import TABLE_BYTES, Flag, InputError, RecordError, read_bytes
from seacage.records import Reader, Record, check_record, moment
from seacage.testing._surrogates import check_refused

_set_clock = getattr(time, "tzset", bool)  # Windows has none


def check_reader(
    reader: Reader, example: Path, *, first: datetime, values: Mapping[str, float]
) -> None:
    """Hold a reader to what the commands rely on; an assertion names the first broken promise.

    Parameters
    ----------
    reader
        As its entry point names it.
    example
        A file of the format, with at least three rows of good values in order of time.
    first
        Time of its first row, which says its zone.
    values
        Of its first row, by door key: what a person reads in the file, in the key's unit.
    """
    record, whole = reader.read(example, "example"), read_bytes(example, most=TABLE_BYTES)
    assert isinstance(record, Record), f"it gives a {type(record).__name__}, not a Record"
    assert record.stream == "example", f"the stream is called {record.stream}, not as asked"
    assert len(record) > 2, f"the example has {len(record)} rows; three are needed"
    assert moment(record.time[0]) == first, f"the first time is {record.time[0]} UTC, not {first}"
    found = {key: float(column[0]) for key, column in record.values.items()}
    assert found.keys() == values.keys(), f"it reads {sorted(found)}, not {sorted(values)}"
    for key, value in values.items():
        np.testing.assert_allclose(found[key], value, rtol=1e-6, err_msg=f"first {key}")
    for key, flags in check_record(record).flags.items():
        bad = np.mean(flags == Flag.FAIL)
        assert bad < 0.5, f"{bad:.0%} of {key} fail the checks: is it in its key's unit?"
    if reader.recognises is not None:
        assert reader.recognises(whole[:4096]), "it does not recognise the example"
        for other in (b"", b"time,hs_m\n2020-01-01T00:00:00Z,1.0\n", bytes(range(256))):
            assert not reader.recognises(other), f"it takes {other[:20]!r} for its own format"
    assert reader.endings or reader.recognises, "no file is ever given to it"
    assert all(one == one.lower() and one[:1] == "." for one in reader.endings), "an ending"
    _check_clock(reader, example, record)
    with TemporaryDirectory() as folder:
        _check_broken_files(reader, whole, record, Path(folder) / example.name)


def _check_clock(reader: Reader, example: Path, record: Record) -> None:
    """Read again, on a computer whose clock is set elsewhere."""
    zone = os.environ.get("TZ")
    try:
        os.environ["TZ"] = "Asia/Kathmandu"
        _set_clock()
        again = reader.read(example, "example")
    finally:
        os.environ.pop("TZ") if zone is None else os.environ.update(TZ=zone)
        _set_clock()
    assert again.sha256 == record.sha256, "read twice, or in another time zone, it differs"


def _check_broken_files(reader: Reader, whole: bytes, record: Record, path: Path) -> None:
    for about, content in (("an empty file", b""), ("noise", bytes(range(256)) * 16)):
        path.write_bytes(content)
        check_refused(lambda: reader.read(path, "example"), error=RecordError, about=about)
    end = len(whole)
    for size in {*np.linspace(1, end - 1, 12, dtype=int).tolist(), *range(max(1, end - 16), end)}:
        path.write_bytes(whole[:size])
        try:
            cut = reader.read(path, "example")
        except InputError:
            continue
        last = len(cut) - 1
        about = f"cut after {size} bytes, "
        np.testing.assert_array_equal(cut.time[:last], record.time[:last], err_msg=about + "times")
        for key, column in cut.values.items():
            whole_column = record.values[key][: last + 1]
            np.testing.assert_array_equal(column[:last], whole_column[:last], err_msg=about + key)
            kept = np.array_equal(column[last:], whole_column[last:], equal_nan=True)
            assert cut.flags[key][last] >= Flag.SUSPECT or (
                kept and cut.time[last] == record.time[last]
            ), f"{about}a part of a row is a good {key}: flag the last row where no line end is"
