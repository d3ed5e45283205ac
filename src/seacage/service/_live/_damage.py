"""Damage of a cage's lines since their counters began, from the samples that are stored."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.service._live._clock import floor_time
from seacage.service._live._past import Past
from seacage.service._store._damage import Stretch
from seacage.service._store._store import StoreError
from seacage.twin import Action, AlarmEvent, damage_of_minutes

_MINUTE, _HOUR, _DAY = timedelta(minutes=1), timedelta(hours=1), timedelta(days=1)
_SEAS = 1000  # whose damage is remembered
_MOST = 1_000_000  # samples of a buoy in a day


@dataclass(frozen=True, slots=True, kw_only=True)
class LineDamage:
    """Damage of a line since its counter began."""

    damage: float = 0.0  # share of the line's life [-]
    damage_since: datetime
    # Time with an answer, and without, which is never filled [h]
    damage_valid_h: float = 0.0
    damage_missing_h: float = 0.0


class DamageCounter:
    """Counters of a cage's lines.

    They depend on the stored samples, the resets and the clock alone: whole hours are kept, an hour
    that late samples belong to is counted anew, and a service that was away counts what its buoy
    has sent since. So nothing counts twice, whatever is repeated. Each minute is counted by the
    twin that was in force then.
    """

    def __init__(self, past: Past) -> None:
        self._past, self._name, self._store = past, past.cage, past.store
        lines = past.twin.models.lines
        self.lines = tuple(
            line for line, load in zip(lines.names, lines.tn_load, strict=True) if load > 0.0
        )
        # By twin and sea
        self._known: defaultdict[str, dict[bytes, Float[np.ndarray, " line"]]] = defaultdict(dict)
        self._running: tuple[datetime, list[Stretch]] | None
        # An hour, when the lines' counts began, and their sums up to that hour
        self._summed: tuple[datetime, Mapping[str, datetime], Mapping[str, LineDamage]] | None
        self.load()

    def load(self) -> None:
        """Read what is kept."""
        rows, begins = self._store.line_damage(self._name) if self.lines else ([], [])
        self._rows, self._begins = {one.t: one for one in rows}, begins
        self._summed = self._running = None
        self._again = True

    def advance(self, now: datetime, arrived: Sequence[datetime] = ()) -> None:
        """Count to the last whole minute, of hours not counted yet a day's at most.

        ``arrived``: times of the buoy's samples that came or changed since the last call.
        """
        if not self.lines:
            return
        hour, minute = floor_time(now, _HOUR), floor_time(now, _MINUTE)
        if not self._begins:
            try:
                self._begin(self.lines, minute, ()).result()
            except StoreError:  # a disk that takes nothing: the count begins once it does
                self._begins = []
                return
        first = floor_time(self._begins[0][1], _HOUR)
        late = [t for t in arrived if t < hour]
        late += [hour - _DAY] * self._again  # what came just before a stop may not be counted
        self._again = False
        if late:
            self._count(max(floor_time(min(late), _HOUR), first), hour)
        last = max((t for t in self._rows if t < hour), default=first - _HOUR)
        start = floor_time(last, _HOUR) + _HOUR
        if start < hour:
            self._count(start, min(hour, start + _DAY))
        if arrived or self._running is None or self._running[0] != minute:
            self._running = minute, self._stretches(max(hour, first), minute)

    def rewind(self, now: datetime) -> None:
        """Forget what was counted ahead of a clock that has stepped back."""
        hour, minute = floor_time(now, _HOUR), floor_time(now, _MINUTE)
        ahead = {line for line, t in self._begins if t > minute}
        self._store.rewind_damage(self._name, hour, minute, sorted(ahead)).result()
        self.load()

    def at(self, t: datetime) -> Mapping[str, LineDamage]:
        """Return what the counters of the lines say at a time."""
        hour, minute = floor_time(t, _HOUR), floor_time(t, _MINUTE)
        running, begins = self._running, dict[str, datetime]()
        for line, begin in self._begins:
            if begin <= t:
                begins[line] = max(begin, begins.get(line, begin))
        if not begins:
            return {}
        whole = self._whole_hours(hour, begins)
        rows = running[1] if running and running[0] == minute else self._stretches(hour, minute)
        return {line: _add(whole[line], line, rows) for line in begins}

    def reset(self, line: str, *, who: str, why: str, now: datetime) -> "Future[None]":
        """Begin to count a line anew; the journal keeps what it had come to.

        Raises InputError: no damage of such a line is counted.
        """
        if line not in (before := self.at(now)):
            counted = ", ".join(self.lines) or "none: the twin has no loads in waves"
            raise InputError(f"No damage of a line {line!r} is counted. There are {counted}.")
        share = before[line].damage
        event = AlarmEvent(
            alarm=f"damage.{line}",
            action=Action.RESET,
            t=now,
            value=share,
            who=who,
            why=why,
            twin=self._past.id,
        )
        self._running = None
        return self._begin((line,), floor_time(now, _MINUTE), (event,))

    def _begin(
        self, lines: Iterable[str], t: datetime, journal: Sequence[AlarmEvent]
    ) -> "Future[None]":
        self._begins = [*self._begins, *((line, t) for line in lines)]
        return self._store.begin_damage(self._name, tuple(lines), t, journal)

    def _whole_hours(
        self, hour: datetime, begins: Mapping[str, datetime]
    ) -> Mapping[str, LineDamage]:
        """Sums up to an hour, which stay until another is asked for or counted: they grow long."""
        if self._summed is None or self._summed[:2] != (hour, begins):
            rows = [one for at, one in self._rows.items() if at < hour]
            sums = {
                line: _add(LineDamage(damage_since=begin), line, rows)
                for line, begin in begins.items()
            }
            self._summed = hour, begins, sums
        return self._summed[2]

    def _count(self, start: datetime, end: datetime) -> None:
        """Count whole hours anew, a day's at most at a time, and keep them."""
        for begin in _steps(start, end, _DAY):
            until = min(begin + _DAY, end)
            gone = {t for t in self._rows if begin <= t < until}
            if gone and self._store.is_retired(self._name, self._past.twin.buoy, begin, until):
                continue  # its samples are gone, and what was counted of them stays
            rows = self._stretches(begin, until)
            kept = {t: one for t, one in self._rows.items() if t not in gone}
            self._rows, self._summed = kept | {one.t: one for one in rows}, None
            self._store.keep_damage(self._name, (begin, until), rows)

    def _stretches(self, start: datetime, end: datetime) -> list[Stretch]:
        """Count anew between two whole minutes, cut at whole hours and where counters begin."""
        if start >= end:
            return []
        twin = self._past.twin
        stale, buoy = timedelta(seconds=twin.timeouts.stale_after_s), twin.buoy
        samples = self._store.samples(
            self._name, stream=buoy, start=start - stale, end=end, limit=_MOST, withdrawn=False
        )
        if sum(map(len, self._known.values())) > _SEAS:
            self._known.clear()
        rows = list[Stretch]()
        changes = {t for t in self._past.replacements() if start < t < end}
        for first, last in pairwise(sorted({start, end, *changes})):
            past, count = self._past.of(first), round((last - first) / _MINUTE)
            names, known = past.twin.models.lines.names, self._known[past.id]
            damage = damage_of_minutes(past.twin, samples, first, count, known=known)
            damage = damage[:, [names.index(line) for line in self.lines]]
            valid = np.asarray(np.isfinite(damage).all(axis=1))
            cuts = {first, last, *_steps(floor_time(first, _HOUR) + _HOUR, last, _HOUR)}
            cuts |= {t for _, t in self._begins if first < t < last}
            for begin, until in pairwise(sorted(cuts)):
                some = slice(round((begin - first) / _MINUTE), round((until - first) / _MINUTE))
                sums = damage[some][valid[some]].sum(axis=0).tolist()
                shares, minutes = dict(zip(self.lines, sums, strict=True)), int(valid[some].sum())
                missing = len(valid[some]) - minutes
                rows.append(Stretch(begin, shares, minutes, missing, past.id))
        return rows


def _add(before: LineDamage, line: str, rows: Sequence[Stretch]) -> LineDamage:
    since = [one for one in rows if one.t >= before.damage_since]
    return replace(
        before,
        damage=before.damage + sum(one.damage.get(line, 0.0) for one in since),
        damage_valid_h=before.damage_valid_h + sum(one.valid for one in since) / 60.0,
        damage_missing_h=before.damage_missing_h + sum(one.missing for one in since) / 60.0,
    )


def _steps(start: datetime, end: datetime, step: timedelta) -> list[datetime]:
    return [start + k * step for k in range(max(0, -((start - end) // step)))]
