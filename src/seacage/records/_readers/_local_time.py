"""Local times as UTC: fixed offsets, named zones, and clocks that changed without saying so."""

import re
from collections.abc import Callable, Sequence
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from difflib import get_close_matches
from typing import NamedTuple
from zoneinfo import ZoneInfo, available_timezones

import numpy as np
from jaxtyping import Int, Shaped

from seacage.conventions import RecordError
from seacage.records._times import microseconds

_HOUR = 3_600_000_000  # in microseconds, as are all times below
_NO_STEP = "the clock is not seen to step back in it"
# Zones whose changes of the clock an unnamed one is compared with, in order of longitude
_WIDELY_USED = (
    *("Europe/Oslo", "Europe/London", "Europe/Helsinki", "America/New_York", "America/Santiago"),
    *("Australia/Hobart", "Pacific/Auckland"),
)


def parse_zone(text: str, *, where: str) -> tzinfo | None:
    """A zone: ``UTC``, a fixed offset, or a name of the time zone database; None for ``stated``.

    Raises RecordError: any other text. So are names without a place: CET and Etc/GMT+1 are not
    the zones that they are taken for.
    """
    if text == "stated":
        return None
    if text == "UTC":
        return UTC
    if match := re.fullmatch(r"([+-])(0\d|1[0-4]):([0-5]\d)", text):
        offset = timedelta(hours=int(match[2]), minutes=int(match[3]))
        return timezone(offset if match[1] == "+" else -offset)
    names = [name for name in available_timezones() if re.match(r"(?!Etc/|SystemV/)\w+/", name)]
    if text in names:
        return ZoneInfo(text)
    advice = (
        'Declare "UTC", an offset such as "+01:00", a place such as "Europe/Oslo" where the clock '
        'follows daylight saving, or "stated" where each time says its own.'
    )
    if not names:
        advice = "There is no time zone database here; install one: pip install tzdata."
    elif close := get_close_matches(text, names, n=1):
        advice = f"Did you mean {close[0]!r}?"
    raise RecordError(f"{where}: the time zone {text!r} cannot be read. {advice}")


class _Rows(NamedTuple):
    """Times of rows in microseconds since 1970, in the order of the file."""

    clock: Int[np.ndarray, " row"]  # as a clock shows them
    early: Int[np.ndarray, " row"]  # in UTC, the first of two where the zone has a time twice
    late: Int[np.ndarray, " row"]  # the second
    usual: float  # the median of the clock's steps, where it goes forward

    @property
    def near(self) -> float:
        """How far a step may be from the usual one."""
        return min(1.5 * self.usual, _HOUR / 4)

    def nights(self) -> list[Int[np.ndarray, " part"]]:
        """The rows of each hour that there is twice."""
        twice = np.flatnonzero(self.late > self.early)
        other = np.flatnonzero(np.abs(np.diff(self.early[twice])) > 24 * _HOUR)
        return np.split(twice, other + 1) if twice.size else []

    def second_pass(self, night: Int[np.ndarray, " part"]) -> tuple[Int[np.ndarray, " later"], str]:
        """The rows of such an hour that are standard time, and why nothing tells, or nothing.

        A step back counts that leaves about the usual step, or at least takes back half of the
        hour: rows that are merely out of order step back by less. Without one, it must be that
        only one of the two leaves the usual step before, between and after the rows.
        """
        first, last = night[0], night[-1]
        shown, shift = self.clock[night], self.late[first] - self.early[first]
        around = self.clock[max(0, first - 1) : last + 2]
        steps = np.diff(shown)
        change = (steps <= 0) & (steps + shift <= np.fmax(1.5 * self.usual, shift / 2))
        apart = last - first >= night.size or around[0] > shown[0] or around[-1] < shown[-1]
        if apart or change.sum() > 1 or np.any((steps < 0) & ~change):
            return night[:0], "its rows are out of order"
        if change.any():
            return night[int(np.argmax(change)) + 1 :], ""
        if first > 0 and last + 1 < self.clock.size:  # steps of hours may pass the clock's
            for utc, second in ((self.early, night[night.size :]), (self.late, night)):
                steps = np.diff([self.early[first - 1], *utc[night], self.early[last + 1]])
                if np.all(np.abs(steps - self.usual) <= self.near):
                    return second, ""
        return night[:0], _NO_STEP


def utc_times(
    times: Sequence[datetime],  # as the cells have them, with or without a zone
    zone: tzinfo | None,  # of those without one
    *,
    may_change: bool,  # refuse changed clocks where the offset is fixed
    row: Callable[[int], str],  # name of a row in messages, by its index
) -> Shaped[np.ndarray, " t"]:
    """Times of a file's rows, in the order of the file, as UTC.

    In the hour that a named zone has twice, rows before a step back of the clock are summer time
    and those after it standard time.

    Raises RecordError: a time that the zone does not have, or has twice where the order of rows
    does not tell which; and where a fixed offset is declared, a step of an hour in the night in
    which a widely used zone changes its clocks.
    """
    rows = _rows(times, zone)
    if not isinstance(zone, ZoneInfo):
        if may_change and not any(time.tzinfo for time in times):
            _check_unchanged(times, rows, row)
        return rows.early.view("datetime64[us]")
    if np.any(gone := rows.late < rows.early):
        raise RecordError(
            f"{row(int(np.argmax(gone)))} does not exist in {zone}, whose clocks were put forward "
            "past it, so the logger's clock did not follow daylight saving. Declare the offset "
            'that it kept: zone = "UTC", or one such as "+01:00".'
        )
    for night in rows.nights():
        second, trouble = rows.second_pass(night)
        if trouble:
            raise RecordError(
                f"{row(int(night[0]))} is in the hour that {zone} has twice, and {trouble}, so "
                f"nothing tells summer time from standard time in {night.size} rows. Leave them "
                "out, or give their times with an offset."
            )
        rows.early[second] = rows.late[second]
    return rows.early.view("datetime64[us]")


def _rows(times: Sequence[datetime], zone: tzinfo | None) -> _Rows:
    """Count times; those without a zone are in the one that is given."""
    shown = [time.replace(tzinfo=UTC) for time in times]
    utc = ([t if t.tzinfo else t.replace(tzinfo=zone, fold=fold) for t in times] for fold in (0, 1))
    clock, early, late = (np.array([*map(microseconds, one)]) for one in (shown, *utc))
    ahead = np.diff(clock)[np.diff(clock) > 0]
    return _Rows(clock, early, late, float(np.median(ahead)) if ahead.size else np.nan)


def _check_unchanged(times: Sequence[datetime], rows: _Rows, row: Callable[[int], str]) -> None:
    """Refuse times that step by an hour as the clocks of a widely used zone do."""
    steps = np.diff(rows.clock)
    _, hour, count = np.unique(rows.clock // _HOUR, return_inverse=True, return_counts=True)
    # An export sorted by its times has no step back, but one hour with twice as many rows
    crowded = (count > 1.75 * _HOUR / rows.usual)[hour]
    jumps = np.abs(np.abs(steps - rows.usual) - _HOUR) <= rows.near
    zones = available_timezones() if crowded.any() or jumps.any() else ()
    for zone in (ZoneInfo(name) for name in _WIDELY_USED if name in zones):
        local = _rows(times, zone)
        passes = [local.second_pass(night) for night in local.nights()]
        doubled = crowded.any() and bool(np.all(local.late[crowded] > local.early[crowded]))
        same = any(trouble == _NO_STEP for _, trouble in passes)
        if np.any(local.late < local.early) or (same and not doubled):
            continue  # the zone's clocks changed, and the file's did not
        for second, _ in passes:
            local.early[second] = local.late[second]
        passed = np.diff(local.early)
        seen = (passed != steps) & (np.abs(passed - rows.usual) <= rows.near)
        at = np.flatnonzero(np.append(False, seen) | (crowded & doubled))
        if at.size:
            raise RecordError(
                f"{row(int(at[0]))} is where the clock steps by an hour, in the night in which "
                f"{zone} begins or ends daylight saving, so the file seems to be in a local time "
                f'and not in one of fixed offset. Name its zone, such as zone = "{zone}", or '
                "confirm the offset by daylight_saving = false under [time] of a map."
            )
