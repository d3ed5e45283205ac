"""Quality control: one path for live samples and for archives."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime

import numpy as np
from jaxtyping import Int

from seacage.conventions import Flag
from seacage.records._quality._limits import DEFAULT_LIMITS, GROUPS, Limits, groups_of
from seacage.records._quality._prefilter import Columns, candidate_rows
from seacage.records._quality._tests import ATTENUATED, Anchor, Finding, evaluate
from seacage.records._record import Record
from seacage.records._sample import Sample
from seacage.records._times import microseconds, moment


@dataclass(frozen=True, slots=True, kw_only=True)
class Amendment:
    """A flag of a sample that changed after the sample was checked.

    The next sample may show that one was a spike, and a late sample that it was none.
    """

    # Of the sample that is meant; t in UTC
    stream: str
    t: datetime
    key: str  # of the value
    # The flag from now on; of a spike, to be taken where it is worse than the value's own
    flag: Flag
    remark: str  # why: one sentence
    # The flag before; None where only the next sample is known, and not the one meant
    was: Flag | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class QualityState:
    """State of the checks of one stream; the first state is ``QualityState()``."""

    # By group: the latest readings in range, to compare the next with
    anchors: Mapping[str, Anchor] = field(default_factory=dict[str, Anchor])
    # What the last sample showed of an earlier one: that it was a spike
    amended: tuple[Amendment, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Verdict:
    """Findings of one test in one quantity of a record."""

    # The quantity, the test's name, and the flag that it gave
    key: str
    test: str
    flag: Flag
    rows: Int[np.ndarray, " row"]  # where, ascending
    example: str  # why, of the first row: one sentence


def check_sample(
    state: QualityState, sample: Sample, limits: Limits = DEFAULT_LIMITS
) -> tuple[QualityState, Sample]:
    """Flag the values of one sample, given the samples of its stream before.

    Presence, range and climatology are evaluated for each value alone; a sea too steep to stand
    fails its height and its period. Gap, rate of change, flat line and attenuated signal compare
    with the readings of the same instrument before, those that were in range. That a reading was
    a spike is known when the next has come: ``state.amended`` says it then. A late sample, older
    than the latest reading, is evaluated alone and leaves the state as it was.

    ``state``: after the stream's previous sample.
    ``sample``: flags that it already carries are replaced.
    ``limits``: what to compare with.

    Returns the state to check the stream's next sample with, and the sample with its flags, and
    with a remark for each value that is not good.

    Source: QARTOD manuals of IOOS: in-situ currents, surface waves, water level.
    """
    time = microseconds(sample.t)
    anchors = dict(state.anchors)
    findings: list[Finding] = []
    amendments: list[Amendment] = []
    for group, keys in groups_of(sample.values):
        kind, plain = _plain(group, keys)
        values = {plain[key]: sample.values[key] for key in keys}
        before = anchors.get(group)
        evaluation = evaluate(kind, before, time, values, limits)
        findings += _by_key(evaluation.findings, plain)
        if before is not None:
            own = {key: before.values[name] for key, name in plain.items() if name in before.values}
            of_the_last = _by_key(evaluation.of_the_last, plain)
            amendments += _amendments(sample.stream, before.time, own, of_the_last)
        if evaluation.anchor is not None:
            anchors[group] = evaluation.anchor
    flags = dict.fromkeys(sample.values, Flag.GOOD)
    for finding in findings:
        flags[finding.key] = max(flags[finding.key], finding.flag)
    remarks = tuple(_sentence(sample.stream, sample.values, finding) for finding in findings)
    state = QualityState(anchors=anchors, amended=tuple(amendments))
    return state, replace(sample, flags=flags, remarks=remarks)


def amended(sample: Sample, amendments: Iterable[Amendment]) -> Sample:
    """Return a sample with those of the amendments that are about it."""
    for one in amendments:
        meant = (one.stream, one.t) == (sample.stream, sample.t)
        if meant and one.flag > sample.flags.get(one.key, one.flag):
            flags = {**sample.flags, one.key: one.flag}
            sample = replace(sample, flags=flags, remarks=(*sample.remarks, one.remark))
    return sample


AHEAD = "ahead of the clock"
"""Text in the remark of a withdrawn sample, and in no other remark."""


def withdrawn(sample: Sample, *, clock: datetime) -> Sample:
    """Return a sample that counts no more: its time is ahead of a clock that has stepped back.

    ``sample``: of which every value is flagged FAIL; the raw values are kept. ``clock``: the time
    that it was set to.
    """
    by_s = (sample.t - clock).total_seconds()
    remark = (
        f"{sample.stream}: its time is {by_s:.0f} s {AHEAD} at {clock.isoformat()}. Flagged 4 "
        "(fail) until it is sent again; the raw values are kept."
    )
    return replace(sample, flags=dict.fromkeys(sample.values, Flag.FAIL), remarks=(remark,))


def is_withdrawn(sample: Sample) -> bool:
    """Whether ``withdrawn`` made the sample: then it is as if it had never come."""
    return any(AHEAD in remark for remark in sample.remarks)


def is_evaluated(sample: Sample) -> bool:
    """Whether a sample has passed the checks, with whatever flags."""
    return Flag.NOT_EVALUATED not in sample.flags.values()


def check_record(record: Record, limits: Limits = DEFAULT_LIMITS) -> Record:
    """Flag every value of a record, as ``check_sample`` would one by one, amendments made.

    Its notes then say for each quantity, test and flag how many, and the first.
    """
    flags = {key: np.full(len(record), Flag.GOOD, dtype=np.uint8) for key in record.values}
    verdicts = verdicts_on(record, limits)
    for one in verdicts:
        flags[one.key][one.rows] = np.maximum(flags[one.key][one.rows], one.flag)
    notes = tuple(_note(record, same) for same in alike(verdicts))
    return replace(record, flags=flags, notes=tuple(dict.fromkeys(record.notes + notes)))


def verdicts_on(record: Record, limits: Limits = DEFAULT_LIMITS) -> tuple[Verdict, ...]:
    """Return what each test finds in a record, in the order of first finds."""
    time = record.time.astype(np.int64)
    found: dict[tuple[str, str, Flag], tuple[list[int], str]] = {}
    for group, keys in groups_of(record.values):
        kind, plain = _plain(group, keys)
        columns = {plain[key]: record.values[key] for key in keys}
        for row, one, values in _findings(kind, time, columns, limits):
            (finding,) = _by_key([one], plain)
            name = (finding.key, finding.test, finding.flag)
            if name not in found:
                own = {key: values[short] for key, short in plain.items() if short in values}
                found[name] = ([], _sentence(record.stream, own, finding))
            found[name][0].append(row)
    return tuple(
        Verdict(key=key, test=test, flag=flag, rows=np.unique(rows), example=example)
        for (key, test, flag), (rows, example) in found.items()
    )


def alike(verdicts: Sequence[Verdict]) -> tuple[tuple[Verdict, ...], ...]:
    """Group what one test found in the same readings, as of a current's speed and direction."""
    groups: dict[tuple[str, Flag, bytes], list[Verdict]] = {}
    for one in verdicts:
        groups.setdefault((one.test, one.flag, one.rows.tobytes()), []).append(one)
    return tuple(map(tuple, groups.values()))


def _note(record: Record, same: Sequence[Verdict]) -> str:
    first = same[0]
    others = " and ".join(one.key for one in same[1:])
    return (
        f"{first.example} The first of {len(first.rows)} such among {len(record)}, "
        f"at {record.time[first.rows[0]].astype('datetime64[s]')}Z"
        f"{f', with {others}' if others else ''}."
    )


def _findings(
    group: str, time: Int[np.ndarray, " t"], columns: Columns, limits: Limits
) -> Iterator[tuple[int, Finding, Mapping[str, float]]]:
    if not columns:
        return
    candidates = candidate_rows(group, time, columns, limits)
    for rows in candidates.stretches:
        times = time[rows].tolist()
        numbers = {key: column[rows].tolist() for key, column in columns.items()}
        for row, finding, values in _stretch_findings(group, times, numbers, limits):
            if finding.test != ATTENUATED or candidates.faint[rows.start + row]:
                yield rows.start + row, finding, values


def _stretch_findings(
    group: str, times: list[int], columns: Mapping[str, list[float]], limits: Limits
) -> Iterator[tuple[int, Finding, Mapping[str, float]]]:
    anchor: Anchor | None = None
    last = 0  # the row of the anchor
    for row, numbers in enumerate(zip(*columns.values(), strict=True)):
        values = dict(zip(columns, numbers, strict=True))
        before = anchor
        anchor, findings, of_the_last = evaluate(group, before, times[row], values, limits)
        for finding in findings:
            yield row, finding, values
        if before is not None:
            for finding in of_the_last:
                yield last, finding, before.values
        if anchor is not before:
            last = row


def _plain(group: str, keys: Sequence[str]) -> tuple[str, dict[str, str]]:
    """Group whose limits count, and plain names of keys: those of a current at a depth."""
    if group in GROUPS:
        return group, {key: key for key in GROUPS[group]}
    return "current", dict(zip(keys, GROUPS["current"], strict=True))


def _by_key(findings: Sequence[Finding], plain: Mapping[str, str]) -> list[Finding]:
    """Findings about plain names, by the keys that these stand for."""
    keys = {name: key for key, name in plain.items()}
    return [one._replace(key=keys[one.key]) for one in findings]


def _amendments(
    stream: str, time: int, values: Mapping[str, float], found: Sequence[Finding]
) -> Iterator[Amendment]:
    t = moment(time)
    for one in found:
        remark = _sentence(stream, values, one)
        yield Amendment(stream=stream, t=t, key=one.key, flag=one.flag, remark=remark)


def _sentence(stream: str, values: Mapping[str, float], finding: Finding) -> str:
    key, flag, why, _ = finding
    flagged = f"Flagged {flag} ({flag.name.lower()})"
    if flag == Flag.MISSING:
        return f"{stream}: {key} {why}. {flagged}."
    return f"{stream}: {key} = {values[key]:g} {why}. {flagged}; the raw value is kept."
