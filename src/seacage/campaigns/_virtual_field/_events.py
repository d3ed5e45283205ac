"""Events: faults at a chosen time, so that alarms can be tried."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self, cast

import numpy as np

from seacage.cage import Cage
from seacage.campaigns._virtual_field._spells import Spells
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.conventions import InputError, parse_toml, read_text
from seacage.dynamics import Damage
from seacage.records import Record, instant

# Of the kinds that have one: its key, with the unit, and what it is when left out
_USUAL_SIZE = {"net-hole": ("panels", 2.0), "drift": ("m_per_day", 0.1)}

_ENDING = ("stuck", "silent")
_KINDS = ("bridle-cut", *_USUAL_SIZE, *_ENDING)
_CORNER = re.compile(r"ring-(\d+)/spoke-(\d+)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """One thing that goes wrong, and when.

    ==========  ==============  ========================================================
    kind        target          what happens
    ==========  ==============  ========================================================
    bridle-cut  bridle-8        it parts
    net-hole    ring-3/spoke-8  the netting from there on is gone, ``size`` panels wide
                                and high; ring 0 is the collar, spoke 0 points east
    drift       depth-2         the depth sensor drifts by ``size`` metres a day
    stuck       shackle-1       the sensor, or the buoy, repeats its last reading
    silent      buoy-1          the buoy, or the sensor, says nothing
    ==========  ==============  ========================================================

    Raises InputError: an unknown kind, a time without its zone, a size or an end that it cannot
    have.
    """

    kind: str
    target: str
    at: datetime  # when it begins; any zone, kept as UTC
    # Of a hole [panels; None for 2], of a drift [m/day; None for 0.1]; others have none
    size: float | None = None
    until: datetime | None = None  # when what is stuck or silent speaks again; None for never

    def __post_init__(self) -> None:
        if self.kind not in _KINDS:
            raise InputError(
                f"Event: {self.kind!r} is no kind of event. There are: {', '.join(_KINDS)}."
            )
        for name in ("at", "until"):
            if (time := getattr(self, name)) is not None:
                instant(time)  # which refuses a time without its zone
                object.__setattr__(self, name, time.astimezone(UTC))
        if self.size is None and self.kind in _USUAL_SIZE:
            object.__setattr__(self, "size", _USUAL_SIZE[self.kind][1])
        self._check_size()
        if self.until is not None and not (self.kind in _ENDING and self.until > self.at):
            raise InputError(
                f"Event: {self.kind} at {_text(self.at)} cannot end at {_text(self.until)}. "
                "Only what is stuck or silent ends, and after it began."
            )

    def _check_size(self) -> None:
        whole = self.kind == "net-hole"
        if self.kind not in _USUAL_SIZE:
            right = self.size is None
        else:
            size = cast("float", self.size)
            right = math.isfinite(size) and (size >= 1 and size % 1 == 0 if whole else size != 0)
        if not right:
            raise InputError(
                f"Event: {self.kind} has no size {self.size:g}. "
                "A net-hole has whole panels, 1 or more, a drift m/day, others nothing."
            )

    def __str__(self) -> str:
        """As ``parse`` reads it."""
        words = [self.kind, self.target, _text(self.at)]
        if self.size is not None:
            words.append(f"{_USUAL_SIZE[self.kind][0]}={self.size:g}")
        if self.until is not None:
            words.append(f"until={_text(self.until)}")
        return " ".join(words)

    @classmethod
    def parse(cls, text: str) -> Self:
        """An event from words: kind, target, time, then what else it has as key=value.

        ``bridle-cut bridle-8 2020-02-01T12:00Z``,
        ``net-hole ring-3/spoke-8 2020-02-01T12:00Z panels=3``,
        ``drift depth-2 2020-02-01T12:00Z m_per_day=0.2``,
        ``silent buoy-1 2020-02-01T12:00Z until=2020-02-02T00:00Z``.

        Raises InputError: other words, or what ``Event`` refuses.
        """
        words = text.split()
        if len(words) < 3 or not all("=" in word for word in words[3:]):
            raise InputError(
                f"Event {text!r}: give kind, target, time and no more than key=value after "
                'them, such as "bridle-cut bridle-8 2020-02-01T12:00Z".'
            )
        table = dict(zip(("kind", "target", "at"), words, strict=False))
        return cls(**_arguments(table | dict(word.split("=", 1) for word in words[3:]), text))

    def damage(self, cage: Cage) -> Damage | None:
        """Damage to the cage; None for an event of a sensor or of the buoy.

        Raises InputError: a bridle or a place that the cage has not.
        """
        if self.kind == "bridle-cut":
            _check_target(self, cage.bridle_names)
            return Damage(bridle=cage.bridle_names.index(self.target))
        return Damage(hole=_hole(self, cage)) if self.kind == "net-hole" else None

    def apply_to(self, record: Record) -> Record:
        """Apply the event to a stream's record; the record of another stream stays as it is.

        What a sensor says of damage to the cage comes from the simulation, so that changes no
        stream here.
        """
        if record.stream != self.target or self.kind not in ("drift", *_ENDING):
            return record
        first = int(np.searchsorted(record.time, instant(self.at)))
        last = len(record)
        if self.until is not None:
            last = int(np.searchsorted(record.time, instant(self.until)))
        if first == last:
            return record
        if self.kind == "silent":
            return record.rows(np.delete(np.arange(len(record)), slice(first, last)))
        values = {key: column.copy() for key, column in record.values.items()}
        for column in values.values():
            if self.kind == "stuck":
                column[first:last] = column[first]
            else:
                days = (record.time[first:] - instant(self.at)) / np.timedelta64(1, "D")
                column[first:] += cast("float", self.size) * days
        return replace(record, values=values)


def check_events(
    events: Sequence[Event], cage: Cage, buoy: Record, hidden: TruthParameters
) -> None:
    """Refuse an event that would meet nothing: no part, no stream, no time.

    Raises InputError: at the first one.
    """
    sensors = {
        "drift": tuple(sensor.name for sensor in cage.depth_sensors),
        **dict.fromkeys(_ENDING, (*cage.sensor_names, buoy.stream)),
    }
    shackles = {shackle.name for shackle in cage.shackles}
    for event in events:
        event.damage(cage)
        if event.kind in sensors:
            _check_target(event, sensors[event.kind])
        if not buoy.time[0] <= instant(event.at) < buoy.time[-1]:
            first, last = buoy.time[[0, -1]].astype("datetime64[m]")
            raise InputError(
                f"Event {event}: it is not within the record, {first}Z to {last}Z. "
                "Choose a time that is."
            )
        if event.target in shackles:
            _check_awake(event, Spells.at_shares(buoy.time, hidden.shackle.windows))


def read_events(path: str | Path) -> tuple[Event, ...]:
    """Events from a TOML file, sorted by time.

    The file looks like this::

        [[event]]
        kind = "bridle-cut"
        target = "bridle-8"
        at = 2020-02-01T12:00:00Z

        [[event]]
        kind = "drift"
        target = "depth-2"
        at = 2020-02-03T00:00:00Z
        m_per_day = 0.2

    Raises InputError: no TOML, a key that is missing or unknown, a value that ``Event`` refuses.
    """
    table = parse_toml(read_text(path), str(path))
    entries = table.get("event")
    tables = isinstance(entries, list) and all(isinstance(entry, dict) for entry in entries)
    if len(table) != 1 or not tables:
        raise InputError(f"{path}: write each event as a table [[event]], and nothing else.")
    events = [
        Event(**_arguments(entry, f"{path}, [[event]] {number}"))
        for number, entry in enumerate(table["event"], start=1)
    ]
    return tuple(sorted(events, key=lambda event: event.at))


def _arguments(table: Mapping[str, object], where: str) -> dict[str, Any]:
    """Arguments of ``Event``, from the keys that a file or a shell has for it."""
    kind = str(table.get("kind"))
    size_key, _ = _USUAL_SIZE.get(kind, ("size", 0.0))
    known = ("kind", "target", "at", size_key, "until")
    missing = [key for key in known[:3] if key not in table]
    unknown = [key for key in table if key not in known]
    if missing or unknown:
        raise InputError(
            f"{where}: the key {(missing + unknown)[0]!r} is {'missing' if missing else 'unknown'}."
            f" An event has {', '.join(known)}."
        )
    arguments: dict[str, Any] = {"kind": kind, "target": str(table["target"])}
    arguments |= {key: _time(table[key], where) for key in ("at", "until") if key in table}
    return arguments | ({"size": _number(table[size_key], where)} if size_key in table else {})


def _time(value: object, where: str) -> datetime:
    try:
        return value if isinstance(value, datetime) else datetime.fromisoformat(str(value))
    except ValueError as error:
        raise InputError(
            f"{where}: {value!r} is no time. Write it like 2020-02-01T12:00Z."
        ) from error


def _number(value: object, where: str) -> float:
    try:
        return float(str(value))
    except ValueError as error:
        raise InputError(f"{where}: {value!r} is no number.") from error


def _text(time: datetime) -> str:
    return time.replace(tzinfo=None).isoformat(timespec="auto" if time.second else "minutes") + "Z"


def _check_target(event: Event, known: Sequence[str]) -> None:
    if event.target not in known:
        raise InputError(
            f"Event {event}: there is no {event.target!r} for it. It is one of {', '.join(known)}."
        )


def _check_awake(event: Event, awake: Spells) -> None:
    until = np.datetime64("9999") if event.until is None else instant(event.until)
    if not np.any((instant(event.at) < awake.end) & (until > awake.start)):
        spells = np.column_stack([awake.start, awake.end]).astype("datetime64[m]")
        windows = " and ".join(f"{start}Z to {end}Z" for start, end in spells)
        raise InputError(f"Event {event}: it would not be seen. Shackles live from {windows}.")


def _hole(event: Event, cage: Cage) -> tuple[int, int, int]:
    corner, size = _CORNER.fullmatch(event.target), int(cast("float", event.size))
    ring, spoke = (int(number) for number in corner.groups()) if corner else (-1, -1)
    if not (0 <= ring < cage.rings - size and 0 <= spoke < cage.spokes and size < cage.spokes):
        raise InputError(
            f"Event {event}: cage {cage.name} has no netting there for a hole of {size} by {size} "
            f"panels. Name its upper corner, ring-0/spoke-0 to ring-{cage.rings - 1 - size}/"
            f"spoke-{cage.spokes - 1}."
        )
    return ring, spoke, size
