"""Quality control in the store: each stream is checked in the order of its times, once.

Samples get their flags in the transaction that stores them. One that comes late takes its place
in time, and what follows it is checked again, as far as it makes a difference. So the flags are
those of the samples that are stored, whatever came when and however often the service stopped.

What the checks remember is kept as checkpoints, each in the transaction of its sample: the
memory after any sample is that of the checkpoint before it, and of a few samples more.
"""

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from math import isfinite

from pydantic import TypeAdapter

from seacage.conventions import Flag
from seacage.records import (
    AHEAD,
    DEFAULT_LIMITS,
    Amendment,
    Limits,
    QualityState,
    Sample,
    check_sample,
    groups_of,
    is_withdrawn,
    withdrawn,
)
from seacage.service._store._database._checksum import checksum
from seacage.service._store._database._rows import (
    DAY_US,
    SAMPLES,
    Own,
    SampleRow,
    microseconds,
    own_flags,
    readable,
    readings_text,
    remarks_text,
)
from seacage.service._store._database._session import AbstractSession, DamageError

# Samples between two checkpoints: a start, or a late sample, checks about so many again
EVERY = 256
_AT_ONCE = 1000
_HELD = 4 * _AT_ONCE  # entries of a long walk that wait to be written
_LONGEST_S = 7 * 86_400.0
_SECOND = 1_000_000
_SAMPLES = f"{SAMPLES} AND stream = ?"
_FROM = f"{_SAMPLES} AND (t > ? OR (t = ? AND seq > ?)) ORDER BY t, seq LIMIT ?"
_AT = f"{_SAMPLES} AND t = ? ORDER BY seq"
_LAST = f"{_SAMPLES} AND t <= ? ORDER BY t DESC, seq DESC LIMIT ?"
_AHEAD = f"{_SAMPLES} AND t > ? AND remarks NOT LIKE ? ORDER BY t DESC, seq DESC LIMIT ?"
_GONE = f"{_SAMPLES} AND t <= ? AND remarks LIKE ? ORDER BY t, seq LIMIT ?"
# What nobody has verified does not become so by an amendment.
_AMEND = """
UPDATE sample SET readings = ?, remarks = ?, crc = CASE WHEN crc < 0 THEN crc ELSE ? END
WHERE cage = ? AND stream = ? AND t = ? AND seq = ?"""
_MEMORY = "SELECT t, seq, memory, crc FROM quality WHERE cage = ? AND stream = ?"
_BEFORE = f"{_MEMORY} AND (t < ? OR (t = ? AND seq < ?)) ORDER BY t DESC, seq DESC LIMIT ?"
_BEHIND = f"{_MEMORY} AND (t > ? OR (t = ? AND seq > ?)) ORDER BY t, seq LIMIT ?"
_KEEP = """
INSERT INTO quality VALUES (?, ?, ?, ?, ?, ?)
ON CONFLICT (cage, stream, t, seq) DO UPDATE SET memory = excluded.memory, crc = excluded.crc"""
_CUT = "DELETE FROM quality WHERE cage = ? AND stream = ? AND t > ?"
_RETIRE = """
DELETE FROM quality WHERE cage = ? AND stream = ? AND t < (
    SELECT max(t) FROM quality WHERE cage = ? AND stream = ? AND t < ?)"""
_SEALED = "SELECT t, crc FROM sealed WHERE cage = ? AND stream = ? AND t >= ? AND t <= ?"
Key = tuple[int, int]  # time [us] and number: what a sample is known by in its stream
Of = tuple[str, str]  # cage and stream
_KEPT = TypeAdapter(tuple[QualityState, dict[str, Key]])  # a memory, as it is written
_FIRST: Key = (-(2**62), -1)
_END: Key = (2**62, 2**62)


@dataclass(frozen=True, slots=True)
class Memory:
    """What the checks remember after a stream's samples up to one of them."""

    quality: QualityState = field(default_factory=QualityState)  # of the tests that look back
    # The last sample that carried each quantity, by door key
    newest: Mapping[str, Key] = field(default_factory=dict[str, Key])
    at: Key = _FIRST  # the last sample of all
    since: int = 0  # samples since the last checkpoint

    def same(self, other: "Memory") -> bool:
        """Whether whatever comes next is checked the same."""
        return self.quality == other.quality and self.newest == other.newest

    def after(
        self, key: Key, sample: Sample, limits: Limits
    ) -> tuple["Memory", Sample, tuple[Amendment, ...]]:
        """Check the next sample: what is then remembered, its flags, and those that it amends."""
        quality, own = check_sample(self.quality, sample, limits)
        memory = Memory(
            quality=replace(quality, amended=()),
            newest={**self.newest, **dict.fromkeys(sample.values, key)},
            at=key,
            since=self.since + 1,
        )
        return memory, own, quality.amended

    @property
    def open(self) -> set[int]:
        """Times of the samples that the next one may still amend [us]."""
        return {anchor.time for anchor in self.quality.anchors.values()}


@dataclass(slots=True)
class Checked:
    """What one transaction does to a stream."""

    # The samples that were not known, by key, with their flags
    fresh: dict[Key, Sample] = field(default_factory=dict[Key, Sample])
    # Of these, where a later one has amended a flag already
    amended: dict[Key, dict[str, Own]] = field(default_factory=dict[Key, dict[str, Own]])
    # Those among them whose row is there: they had been withdrawn
    again: set[Key] = field(default_factory=set[Key])
    # Flags of stored samples that change
    amendments: list[Amendment] = field(default_factory=list[Amendment])
    walked: bool = False  # whether stored samples were checked again


class QualityControl:
    """Checks the samples that a store takes, and remembers what the next are compared with.

    It belongs to the one writer, which calls ``forget`` where a transaction has failed: what is
    remembered is then read again.
    """

    def __init__(self) -> None:
        self._memory: dict[Of, Memory] = {}
        self._beyond: set[Of] = set()  # where withdrawn samples lie after the memory

    def forget(self, of: Of | None = None) -> None:
        """Forget a stream, or everything; the store has it."""
        if of is None:
            self._memory.clear()
        else:
            self._memory.pop(of, None)

    def check(
        self, session: AbstractSession, of: Of, samples: Mapping[Key, Sample], limits: Limits
    ) -> Checked:
        """Check samples of one stream, each in its place, and write what they amend.

        Those that come back as ``fresh`` are the caller's to write.
        """
        stream = _Stream(session, of, limits)
        end = self._memory_of(stream)
        doubtful = [key for key in samples if key <= end.at or of in self._beyond]
        known = stream.find(doubtful)
        again = {key for key, (_, one) in known.items() if is_withdrawn(one)}
        fresh = deque(sorted(key for key in samples if key not in known or key in again))
        checked = Checked(again=again)
        for key in stream.of_sealed_days(fresh):
            # Its neighbours have left the store.
            _, checked.fresh[key] = check_sample(QualityState(), samples[key], limits)
            fresh.remove(key)
        if fresh:
            walk = _Walk(stream, end, checked)
            if fresh[0] <= end.at:
                checked.walked = True
                walk.memory = stream.root(fresh[0])
                _check_again(walk, end, fresh, samples)
            while fresh:
                key = fresh.popleft()
                walk.take(key, samples[key])
            walk.finish()
            self._memory[of] = walk.memory
        return checked

    def withdraw(self, session: AbstractSession, of: Of, *, clock: datetime, after: int) -> Checked:
        """Withdraw samples of a stream after a time [us], some at a time, the newest first."""
        checked, stream = Checked(), _Stream(session, of)
        rows = stream.rows(_AHEAD, after, f"%{AHEAD}%", limit=_AT_ONCE)
        if not rows:
            return checked
        session.rows(_CUT, (*of, after))
        gone = [
            _Entry(withdrawn(sample, clock=clock), _key(row), row) for row, sample in readable(rows)
        ]
        stream.write(gone, checked)
        # What they had shown of the samples before them is taken back.
        walk = _Walk(stream, stream.recall(until=after), checked)
        walk.open_again()
        walk.finish()
        self._memory.pop(of, None)
        return checked

    def _memory_of(self, stream: "_Stream") -> Memory:
        of = stream.of
        if of not in self._memory:
            memory = stream.recall()
            if memory.since >= EVERY:
                memory = stream.keep(memory)
            self._memory[of] = memory
            last = readable(stream.rows(_LAST, _END[0], limit=1))
            beyond = any(is_withdrawn(sample) for _, sample in last)
            (self._beyond.add if beyond else self._beyond.discard)(of)
        return self._memory[of]


def newest_keys(session: AbstractSession, of: Of, at: int) -> set[Key]:
    """Find the last samples of a stream until a time [us] that carried each quantity."""
    stream = _Stream(session, of)
    root = stream.checkpoint(_BEFORE, (at, _END[1]))
    if root is None:
        rows = reversed(stream.rows(_LAST, at, limit=4 * EVERY))
        found = ((row, sample) for row, sample in readable(rows) if not is_withdrawn(sample))
    else:
        found = stream.read(root.at, until=(at, _END[1]))
    newest = dict[str, Key]() if root is None else dict(root.newest)
    for row, sample in found:
        newest |= dict.fromkeys(sample.values, _key(row))
    return set(newest.values())


def withdrawn_samples(
    session: AbstractSession, of: Of, *, clock: datetime, until: int
) -> dict[Key, Sample]:
    """Find samples until a time [us] that were withdrawn by a clock, the first of them."""
    which = f"%{AHEAD} at {clock.isoformat()}%"
    rows = _Stream(session, of).rows(_GONE, until, which, limit=_AT_ONCE)
    return {_key(row): sample for row, sample in readable(rows)}


def retire_memory(session: AbstractSession, of: Of, before: int) -> None:
    """Delete the checkpoints before a time [us] but for the last."""
    session.rows(_RETIRE, (*of, *of, before))


@dataclass(slots=True)
class _Entry:
    """A sample that was checked: as its own check found it, and what later ones showed of it."""

    own: Sample
    key: Key
    row: SampleRow | None = None  # as it is stored
    later: dict[str, tuple[Flag, int, str]] = field(
        default_factory=dict[str, tuple[Flag, int, str]]
    )

    @property
    def sample(self) -> Sample:
        """With the flags that it has now."""
        if not self.later:
            return self.own
        flags = {key: flag for key, (flag, _, _) in self.later.items()}
        remarks = (remark for _, _, remark in self.later.values())
        return replace(
            self.own, flags={**self.own.flags, **flags}, remarks=(*self.own.remarks, *remarks)
        )

    @property
    def amended(self) -> dict[str, Own]:
        return {key: (int(self.own.flags[key]), t) for key, (_, t, _) in self.later.items()}


@dataclass(frozen=True, slots=True)
class _Stream:
    """The samples of one stream and its checkpoints, in one transaction."""

    session: AbstractSession
    of: Of
    limits: Limits = DEFAULT_LIMITS  # to check with

    def root(self, key: Key) -> Memory:
        """What was remembered a little before a sample."""
        return self.checkpoint(_BEFORE, key) or self._first_memory(key[0])

    def recall(self, *, until: int = _END[0]) -> Memory:
        """What is remembered after the last sample until a time [us]."""
        end = (until, _END[1])
        memory = self.root(end)
        for row, sample in self.read(memory.at, until=end):
            memory, _, _ = memory.after(_key(row), sample, self.limits)
        return memory

    def checkpoint(self, which: str, key: Key) -> Memory | None:
        """Read the checkpoint before or behind a sample."""
        rows = self.session.intact("quality", which, (*self.of, key[0], *key), head=2, limit=1)
        if not rows:
            return None
        ((t, seq, text),) = rows
        quality, newest = _KEPT.validate_json(text)
        return Memory(quality=quality, newest=newest, at=(t, seq))

    def keep(self, memory: Memory) -> Memory:
        """Make a checkpoint."""
        text = _KEPT.dump_json((memory.quality, dict(memory.newest))).decode()
        self.session.keep("quality", _KEEP, (*self.of, *memory.at, text))
        return replace(memory, since=0)

    def rows(self, sql: str, *values: object, limit: int | None = None) -> list[SampleRow]:
        """Select samples as they are stored."""
        return self.session.intact("sample", sql, (*self.of, *values), limit=limit)

    def read(self, after: Key, *, until: Key) -> Iterator[tuple[SampleRow, Sample]]:
        """Read the samples in order, but for those that are withdrawn."""
        while rows := self.rows(_FROM, after[0], *after, limit=_AT_ONCE):
            for row, sample in readable(rows):
                if _key(row) > until:
                    return
                if not is_withdrawn(sample):
                    yield row, sample
            if _key(rows[-1]) <= after:
                raise DamageError(
                    f"{self.of[0]}: samples of {self.of[1]} lie in disorder on the disk."
                )
            after = _key(rows[-1])

    def find(self, keys: Sequence[Key]) -> dict[Key, tuple[SampleRow, Sample]]:
        """Find which of some samples are stored."""
        found = dict[Key, tuple[SampleRow, Sample]]()
        times = sorted({t for t, _ in keys})
        for first in range(0, len(times), _AT_ONCE):
            some = times[first : first + _AT_ONCE]
            places = ", ".join("?" * len(some))
            rows = self.rows(f"{_SAMPLES} AND t IN ({places})", *some)
            found |= {_key(row): (row, sample) for row, sample in readable(rows)}
        return {key: found[key] for key in keys if key in found}

    def of_sealed_days(self, keys: Sequence[Key]) -> list[Key]:
        """Which of some samples, in order of time, are of days that have left the store."""
        if not keys:
            return []
        first, last = keys[0][0], keys[-1][0]
        span = (*self.of, first - first % DAY_US, last)
        sealed = {t for (t,) in self.session.intact("sealed", _SEALED, span, head=2)}
        return [key for key in keys if key[0] - key[0] % DAY_US in sealed]

    def write(self, entries: Sequence[_Entry], checked: Checked) -> None:
        """Write the entries that differ from what is stored; those not stored are fresh."""
        changes = list[tuple[object, ...]]()
        for entry in entries:
            sample = entry.sample
            if entry.row is None:
                checked.fresh[entry.key] = sample
                checked.amended[entry.key] = entry.amended
                continue
            texts = readings_text(sample, entry.amended), remarks_text(sample)
            if texts != entry.row[3:5]:
                crc = checksum("sample", (*self.of, *entry.key, *texts, entry.row[5]))
                changes.append((*texts, crc, *self.of, *entry.key))
                checked.amendments += _amendments(entry.row, sample)
        self.session.each(_AMEND, changes)

    def _first_memory(self, t: int) -> Memory:
        """Where to begin without a checkpoint: as far back as the tests look.

        Only stores of 0.1.0 have more samples before their first checkpoint than are looked at
        here.
        """
        last = [sample for _, sample in readable(self.rows(_LAST, t, limit=4 * EVERY))]
        if not last:
            return Memory()
        seen = {key for one in last for key in one.values}
        groups = {group.partition(" ")[0] for group, _ in groups_of(seen)}
        steady = [self.limits.steadiness[group] for group in groups]
        times = (t for one in steady for t in (one.attenuated_s, one.flat_fail_s, one.gap_s))
        reach_s = max([0.0, *filter(isfinite, times)])
        reach = 2 * round(min(reach_s, _LONGEST_S) * _SECOND)
        return Memory(at=(min(microseconds(last[-1].t), microseconds(last[0].t) - reach), -2))


class _Walk:
    """The checks on their way along a stream, and what changes by them."""

    def __init__(self, stream: _Stream, memory: Memory, checked: Checked) -> None:
        self.stream, self.memory, self._checked = stream, memory, checked
        self._entries: dict[Key, _Entry] = {}

    def take(
        self, key: Key, sample: Sample, row: SampleRow | None = None, *, again: bool = False
    ) -> None:
        """Check a sample in its place; ``row`` is what is stored of it.

        Where samples are checked again the checkpoints that there are serve, as long as they lie
        near enough.
        """
        self.memory, own, amendments = self.memory.after(key, sample, self.stream.limits)
        for one in amendments:
            self._amend(one, key[0])
        self._entries[key] = _Entry(own, key, row)
        if self.memory.since >= EVERY * (2 if again else 1):
            self.memory = self.stream.keep(self.memory)
        if len(self._entries) > _HELD:
            self._write(lambda entry: entry.key[0] not in self.memory.open)

    def open_again(self) -> None:
        """Take up the samples that the next may amend, without what was found of them later."""
        for t in self.memory.open:
            self._load(t)

    def finish(self, until: Key = _END) -> None:
        """Write what has changed until a sample, and leave what follows as it is stored."""
        self._write(lambda entry: entry.key <= until)
        self._entries.clear()

    def _amend(self, one: Amendment, by: int) -> None:
        t = microseconds(one.t)
        if not (meant := self._at(t)):
            self._load(t)
            meant = self._at(t)
        for entry in meant:
            if one.flag > entry.own.flags.get(one.key, one.flag):
                entry.later[one.key] = (one.flag, by, one.remark)

    def _at(self, t: int) -> list[_Entry]:
        return [entry for key, entry in self._entries.items() if key[0] == t]

    def _load(self, t: int) -> None:
        for row, sample in readable(self.stream.rows(_AT, t)):
            if not is_withdrawn(sample) and _key(row) not in self._entries:
                flags = own_flags(row[3])
                later = sum(flag != sample.flags[key] for key, flag in flags.items())
                remarks = sample.remarks[: len(sample.remarks) - later]
                own = replace(sample, flags=flags, remarks=remarks)
                self._entries[_key(row)] = _Entry(own, _key(row), row)

    def _write(self, which: Callable[[_Entry], bool]) -> None:
        done = [entry for entry in self._entries.values() if which(entry)]
        for entry in done:
            del self._entries[entry.key]
        self.stream.write(done, self._checked)


def _check_again(
    walk: _Walk, end: Memory, fresh: deque[Key], samples: Mapping[Key, Sample]
) -> None:
    """Check late samples and what follows them, until it makes no difference any more."""
    kept = walk.stream.checkpoint(_BEHIND, fresh[0])
    same_from: Key | None = None
    began = False
    for row, sample in walk.stream.read(walk.memory.at, until=end.at):
        key = _key(row)
        while fresh and fresh[0] < key:
            if not began:
                began = True
                walk.open_again()
            late = fresh.popleft()
            walk.take(late, samples[late], again=True)
            same_from = None
        if not began:
            walk.memory, _, _ = walk.memory.after(key, sample, walk.stream.limits)
            continue
        walk.take(key, sample, row, again=True)
        if kept is not None and key == kept.at:
            same_from = key if same_from is None and walk.memory.same(kept) else same_from
            walk.memory = walk.stream.keep(walk.memory)
            kept = walk.stream.checkpoint(_BEHIND, key)
        more = fresh and fresh[0] <= end.at
        if same_from and not more and min(walk.memory.open, default=key[0]) > same_from[0]:
            walk.finish(same_from)
            walk.memory = end
            return
    if not began:
        walk.open_again()


def _amendments(row: SampleRow, sample: Sample) -> Iterator[Amendment]:
    ((_, before),) = readable([row])
    for key, flag in sample.flags.items():
        if flag != (was := before.flags[key]):
            why = [remark for remark in sample.remarks if f" {key} " in remark]
            remark = why[-1] if why else f"{sample.stream}: {key} is good after all."
            yield Amendment(
                stream=sample.stream, t=sample.t, key=key, flag=flag, was=was, remark=remark
            )


def _key(row: SampleRow) -> Key:
    return row[1], row[2]
