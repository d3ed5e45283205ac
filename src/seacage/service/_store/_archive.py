"""The archive: one Parquet file per cage, stream and UTC day, and a manifest of each stream."""

import hashlib
import json
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from datetime import date, datetime
from importlib import import_module
from itertools import groupby
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

from seacage.conventions import Flag, SeacageError
from seacage.records import KEYS, Sample
from seacage.service._small_files import system_locks, write_small
from seacage.service._store._database._rows import MICROSECOND, Bounds, microseconds, moment_of
from seacage.service._store._database._session import StoreError

_MANIFEST = "manifest.json"
_ALL = Bounds()
# By UTC day: ``file``, ``sha256`` and how many ``samples``
Manifest = Mapping[date, Mapping[str, Any]]


class Archive:
    """A folder of days that do not change any more, or seldom.

    A file's name carries its hash. It is written and synchronised beside its final name; only
    then the manifest of its stream, replaced in one step, points to it. So whatever is cut off,
    the manifest names whole files.

    ``folder``: made where there is none.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._known: dict[Path, tuple[tuple[int, int], Manifest]] = {}

    def write(self, cage: str, stream: str, day: date, samples: Sequence[Sample]) -> None:
        """Add samples to a day; of two with one time and number the one given now counts.

        Raises ArchiveError: the disk does not take them, or pyarrow is not installed.
        """
        folder = self._folder(cage, stream)
        with _translate_errors(folder, "cannot be written"), _lock(folder):
            manifest = self._manifest(folder)
            there = self._read(folder, stream, day, manifest[day]) if day in manifest else []
            both = {key_of(one): one for one in (*there, *samples)}
            content = encode_parquet(cage, stream, sorted(both.values(), key=key_of))
            digest = hashlib.sha256(content).hexdigest()
            name = f"{day.isoformat()}-{digest[:12]}.parquet"
            entry = {"file": name, "sha256": digest, "samples": len(both)}
            write_small(folder / name, content, mode=0o644)
            entries = {kept.isoformat(): one for kept, one in {**manifest, day: entry}.items()}
            text = json.dumps(entries, indent=1, sort_keys=True).encode()
            write_small(folder / _MANIFEST, text, mode=0o644)
            for left in folder.glob(f"{day.isoformat()}-*"):
                if left.name != name:
                    left.unlink()

    def days(self, cage: str, stream: str | None, bounds: Bounds) -> list[tuple[date, str]]:
        """Days and streams that may hold samples within bounds, in time order."""
        streams, start, end = self.streams(cage), bounds.start, bounds.end
        return sorted(
            (day, one)
            for one in (streams if stream is None else [stream])
            for day in self._manifest(self._folder(cage, one))
            if (start is None or day >= start.date()) and (end is None or day <= end.date())
        )

    def read(self, cage: str, stream: str, day: date, bounds: Bounds = _ALL) -> list[Sample]:
        """Read samples of one day in time order.

        Raises ArchiveError: the file is not there, or is not what was written.
        """
        folder = self._folder(cage, stream)
        for again in (True, False):
            entry = self._manifest(folder).get(day)
            if entry is None:
                return []
            try:
                return self._read(folder, stream, day, entry, bounds)
            except ArchiveError:
                # Another process may just have put a fuller file in its place.
                if not again or self._manifest(folder).get(day) == entry:
                    raise
        return []

    def with_samples(
        self, found: Sequence[Sample], cage: str, stream: str | None, bounds: Bounds
    ) -> list[Sample]:
        """Add what only the archive has to what was found in the store, under the same bounds."""
        if found and len(found) >= bounds.limit:  # what lies beyond would be cut off again
            beyond = {"start": found[0].t} if bounds.newest else {"end": found[-1].t + MICROSECOND}
            bounds = replace(bounds, **beyond)
        held = {key_of(one): one for one in found}
        days = self.days(cage, stream, bounds)
        added, reached = 0, None
        for day, name in reversed(days) if bounds.newest else days:
            if added >= bounds.limit and day != reached:
                break
            reached = day
            older = self.read(cage, name, day, bounds)
            added += len(older)
            held = {key_of(one): one for one in older} | held
        ordered = sorted(held.values(), key=key_of)
        return ordered[-bounds.limit :] if bounds.newest else ordered[: bounds.limit]

    def with_latest(
        self, latest: Mapping[str, Sample], cage: str, *, at: datetime | None
    ) -> dict[str, Sample]:
        """Put what the archive has later in the place of a stream's newest in the store."""
        bounds = Bounds(end=at and at + MICROSECOND, limit=1, newest=True)
        newest = dict(latest)
        for stream in self.streams(cage):
            found = [latest[stream]] if stream in latest else []
            newest |= {one.stream: one for one in self.with_samples(found, cage, stream, bounds)}
        return newest

    def samples(self, cage: str, stream: str | None, bounds: Bounds) -> Iterator[Sample]:
        """Read archived samples in time order, a day at a time."""
        for day, group in groupby(self.days(cage, stream, bounds), key=lambda one: one[0]):
            samples = [one for _, name in group for one in self.read(cage, name, day, bounds)]
            yield from sorted(samples, key=key_of)

    def cages(self) -> list[str]:
        """The cages that it has days of."""
        return _folder_names(self.folder)

    def streams(self, cage: str) -> list[str]:
        """The streams of a cage that it has days of."""
        return _folder_names(self.folder / _quote_name(cage))

    def faults(self) -> Iterator[tuple[str, str | None]]:
        """Look at every file: its path, and what is wrong with it, or None.

        Raises ArchiveError: pyarrow is not installed, which is no fault of a file.
        """
        _arrow()
        for cage in self.cages():
            for stream in self.streams(cage):
                folder = self._folder(cage, stream)
                try:
                    manifest = self._manifest(folder)
                except ArchiveError as error:
                    yield str(folder / _MANIFEST), str(error)
                    continue
                for day, entry in sorted(manifest.items()):
                    yield str(folder / entry["file"]), self._fault(folder, stream, day, entry)
                named = {entry["file"] for entry in manifest.values()}
                for left in sorted(folder.glob("*.parquet")):
                    if left.name not in named:
                        yield str(left), f"{left} is named by no manifest; a write was cut off."

    def files(self) -> Iterator[Path]:
        """Each manifest and the files that it names; a stream's do not change until the next's."""
        for cage in self.cages():
            for stream in self.streams(cage):
                folder = self._folder(cage, stream)
                with _lock(folder):
                    manifest = self._manifest(folder)
                    if manifest:
                        yield folder / _MANIFEST
                    yield from (folder / entry["file"] for entry in manifest.values())

    def _fault(self, folder: Path, stream: str, day: date, entry: Mapping[str, Any]) -> str | None:
        try:
            count = len(self._read(folder, stream, day, entry))
        except ArchiveError as error:
            return str(error)
        if count != entry["samples"]:
            return f"{folder / entry['file']} has {count} samples, not {entry['samples']}."
        return None

    def _read(
        self, folder: Path, stream: str, day: date, entry: Mapping[str, Any], bounds: Bounds = _ALL
    ) -> list[Sample]:
        path = folder / entry["file"]
        with _translate_errors(path, f"cannot be read, so {stream} has no samples of {day}"):
            content = path.read_bytes()
            if hashlib.sha256(content).hexdigest() != entry["sha256"]:
                raise ArchiveError(
                    f"{path} is not what was written: its hash differs from the manifest's. "
                    "Restore it from a copy."
                )
            return decode_parquet(content, stream, bounds)

    def _manifest(self, folder: Path) -> Manifest:
        path = folder / _MANIFEST
        with _translate_errors(path, "cannot be read"):
            try:
                state = path.stat()
            except FileNotFoundError:
                return {}
            stamp = (state.st_mtime_ns, state.st_ino)
            if folder not in self._known or self._known[folder][0] != stamp:
                entries = json.loads(path.read_bytes())
                read = {date.fromisoformat(day): entry for day, entry in entries.items()}
                self._known[folder] = (stamp, read)
            return self._known[folder][1]

    def _folder(self, cage: str, stream: str) -> Path:
        return self.folder / _quote_name(cage) / _quote_name(stream)


def key_of(sample: Sample) -> tuple[datetime, str, int]:
    """What a sample is known by, in the order of samples."""
    return (sample.t, sample.stream, -1 if sample.seq is None else sample.seq)


def _quote_name(name: str) -> str:
    quoted = quote(name, safe="")
    return quoted.replace(".", "%2E", 1) if quoted.startswith(".") else quoted


def _folder_names(folder: Path) -> list[str]:
    if not folder.is_dir():
        return []
    return sorted(unquote(one.name) for one in folder.iterdir() if one.is_dir())


@contextmanager
def _lock(folder: Path) -> Generator[None]:
    """Let one process at a time change the days of a stream."""
    locks = system_locks()
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".lock").open("w") as file:
        locks.flock(file, locks.LOCK_EX)
        yield


@contextmanager
def _translate_errors(path: Path, what: str) -> Generator[None]:
    try:
        yield
    except ArchiveError:
        raise
    except (OSError, ValueError, KeyError, TypeError, SeacageError) as error:
        raise ArchiveError(
            f"{path} {what} ({error}). Check the disk, or restore it from a copy."
        ) from error


class ArchiveError(StoreError):
    """The archive cannot be written or read."""


def encode_parquet(cage: str, stream: str, samples: Sequence[Sample]) -> bytes:
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
    bins = {key for one in samples for key in one.values} - KEYS.keys()
    for key in (*KEYS, *sorted(bins)):
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


def decode_parquet(content: bytes, stream: str, bounds: Bounds) -> list[Sample]:
    """Read the samples of a Parquet file."""
    start, end = bounds.us
    pa = _arrow()
    table = import_module("pyarrow.parquet").read_table(pa.BufferReader(content), use_threads=False)
    times: list[int] = table["t"].cast(pa.int64()).to_pylist()  # in order, as they were written
    first = next((k for k, t in enumerate(times) if t >= start), len(times))
    last = next((k for k in range(len(times), first, -1) if times[k - 1] < end), first)
    if bounds.newest:
        first = max(first, last - bounds.limit)
    chosen: Any = table.slice(first, min(last - first, bounds.limit))
    keys = [key for key in chosen.column_names if f"{key}_flag" in chosen.column_names]
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
