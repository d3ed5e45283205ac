"""One reading of one stream."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime

from seacage.conventions import Flag, InputError
from seacage.records._keys import check_keys, is_direction

_STREAM = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """Values of one stream at one time, in house units.

    Raises InputError: an unknown key, a time without a zone, a stream's name that is no name.
    """

    stream: str  # such as ``buoy-1``, ``depth-3``, ``shackle-2``
    t: datetime  # when the source took it; any zone, kept as UTC
    # By door key; raw: a bad value stays as it came, and NaN stands for none
    values: Mapping[str, float]
    # By the same keys; all ``NOT_EVALUATED`` until checked
    flags: Mapping[str, Flag] = field(default_factory=dict[str, Flag])
    remarks: tuple[str, ...] = ()  # why a value is not good: one sentence each, from the check
    seq: int | None = None  # the source's own number of the sample, where it counts

    def __post_init__(self) -> None:
        check_stream(self.stream)
        check_keys(self.values, where=self.stream)
        if self.t.tzinfo is None:
            raise InputError(
                f"{self.stream}: the time {self.t.isoformat()} does not say its zone. "
                "Give it with an offset, in UTC."
            )
        # At a door 360 degrees is 0; anything beyond is left for the check to flag.
        values = {
            key: 0.0 if value == 360.0 and is_direction(key) else float(value)
            for key, value in self.values.items()
        }
        object.__setattr__(self, "t", self.t.astimezone(UTC))
        object.__setattr__(self, "values", values)
        object.__setattr__(
            self, "flags", {key: self.flags.get(key, Flag.NOT_EVALUATED) for key in values}
        )


def check_stream(name: str) -> None:
    """Refuse a stream's name that could not be a file's name or a topic's level.

    Raises InputError: empty, longer than 64, or with other characters than letters, digits and ``_
    . -``.
    """
    if _STREAM.fullmatch(name) is None:
        raise InputError(
            f"{name!r} is no stream's name: up to 64 letters, digits, '_', '.' or '-', "
            "the first a letter or a digit."
        )
