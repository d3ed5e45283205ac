"""One stream over time."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Bool, Shaped

from seacage.conventions import Flag, InputError, Origin
from seacage.records._brief import brief
from seacage.records._keys import check_keys, is_direction
from seacage.records._sample import Sample, check_stream
from seacage.records._times import instant

_USABLE = (Flag.GOOD, Flag.NOT_EVALUATED, Flag.SUSPECT)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """Values of one stream over time, in house units.

    Raises InputError: arrays of unequal length, unknown keys, times that do not ascend.
    """

    stream: str  # such as ``buoy-1``
    # UTC, datetime64[us], strictly ascending; irregular steps stay irregular
    time: Shaped[np.ndarray, " t"]
    # By door key, float64, raw: a bad value stays as it came, and NaN stands for none. Lengths are
    # compared below, with a sentence, so the types leave them open.
    values: Mapping[str, Shaped[np.ndarray, " _"]]
    # By the same keys, ``Flag`` as uint8; ``NOT_EVALUATED`` where left out
    flags: Mapping[str, Shaped[np.ndarray, " _"]] = field(default_factory=dict[str, np.ndarray])
    origin: Origin  # how the numbers were made
    notes: tuple[str, ...] = ()  # what reader and check noticed, one sentence each

    def __post_init__(self) -> None:
        check_stream(self.stream)
        check_keys(self.values, where=self.stream)
        time = np.asarray(self.time, dtype="datetime64[us]")
        if np.any(np.diff(time) <= np.timedelta64(0, "us")) or np.any(np.isnat(time)):
            raise InputError(
                f"{self.stream}: the times of a record ascend, each once. "
                "Sort them and keep one row of each time, or use read_record, which does."
            )
        values = {key: np.asarray(one, dtype=np.float64) for key, one in self.values.items()}
        for key in filter(is_direction, values):  # as in a sample
            values[key] = np.where(values[key] == 360.0, 0.0, values[key])
        unseen = np.full(time.shape, Flag.NOT_EVALUATED, dtype=np.uint8)
        flags = {key: np.asarray(self.flags.get(key, unseen), dtype=np.uint8) for key in values}
        for key, column in values.items():
            if column.shape != time.shape or flags[key].shape != time.shape:
                raise InputError(
                    f"{self.stream}: {key} has {column.size} values and {flags[key].size} "
                    f"flags for {time.size} times. Give one of each per time."
                )
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "flags", flags)

    __repr__ = brief

    def __len__(self) -> int:
        """Number of times."""
        return len(self.time)

    @property
    def sha256(self) -> str:
        """Of times, values and flags: the same for the same readings, whatever the notes."""
        digest = hashlib.sha256(self.time.tobytes())
        for key, column in sorted(self.values.items()):
            digest.update(key.encode() + column.tobytes() + self.flags[key].tobytes())
        return digest.hexdigest()

    def usable(self, key: str) -> Bool[np.ndarray, " t"]:
        """Where a quantity may be used: finite, and neither failed nor missing.

        A suspect value is usable; it says what it is by its flag.
        """
        return np.isin(self.flags[key], _USABLE) & np.isfinite(self.values[key])

    def rows(self, some: np.ndarray | slice) -> "Record":
        """Some rows, by their numbers in order, by a mask or from one to another."""
        return replace(
            self,
            time=self.time[some],
            values={key: column[some] for key, column in self.values.items()},
            flags={key: column[some] for key, column in self.flags.items()},
        )

    def between(self, start: datetime, end: datetime) -> "Record":
        """The part with start <= time < end; both times say their zone."""
        return self.rows(slice(*np.searchsorted(self.time, [instant(start), instant(end)])))

    def samples(self) -> Iterator[Sample]:
        """The record as the stream of samples that it was, in order of time."""
        keys = tuple(self.values)
        values = zip(*(self.values[key].tolist() for key in keys), strict=True)
        flags = zip(*(self.flags[key].tolist() for key in keys), strict=True)
        for time, value, flag in zip(self.time.tolist(), values, flags, strict=True):
            yield Sample(
                stream=self.stream,
                t=time.replace(tzinfo=UTC),
                values=dict(zip(keys, value, strict=True)),
                flags={key: Flag(one) for key, one in zip(keys, flag, strict=True)},
            )
