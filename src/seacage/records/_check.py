"""Quality control: one path for live samples and for archives."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from seacage.conventions import GRAVITY, Flag
from seacage.ocean import steepness_limit
from seacage.records._limits import DEFAULT_LIMITS, GROUPS, Limits, Range, Steadiness
from seacage.records._record import Record
from seacage.records._sample import Sample
from seacage.records._times import microseconds

_SECOND = 1_000_000
_FLAT_SUSPECT_COUNT, _FLAT_FAIL_COUNT = 3, 5


class _Anchor(NamedTuple):
    """The latest reading of a group that may be compared with."""

    time: int  # [us]
    values: Mapping[str, float]
    since: int  # when the group last moved [us]
    readings: int  # since then, with this one


@dataclass(frozen=True, slots=True, kw_only=True)
class QualityState:
    """What the checks remember of one stream; the first state is ``QualityState()``."""

    anchors: Mapping[str, _Anchor] = field(default_factory=dict[str, _Anchor])


class _Finding(NamedTuple):
    """A value that is not good, and why."""

    key: str
    flag: Flag
    why: str


def check_sample(
    state: QualityState, sample: Sample, limits: Limits = DEFAULT_LIMITS
) -> tuple[QualityState, Sample]:
    """Flag the values of one sample, given what its stream said before.

    Range and presence are judged for each value alone; a sea too steep to stand fails its
    height and its period. Rate of change and flat line compare with the latest reading of the
    same instrument that was in range. A late sample, older than that reading, is judged alone
    and leaves the state as it was.

    Parameters
    ----------
    state
        After the stream's previous sample.
    sample
        Flags that it already carries are replaced.
    limits
        What to compare with.

    Returns
    -------
    state
        To check the stream's next sample with.
    sample
        With its flags, and with a remark for each value that is not good.

    References
    ----------
    QARTOD manuals of IOOS: in-situ currents, surface waves, water level.
    """
    time = microseconds(sample.t)
    anchors = dict(state.anchors)
    findings: list[_Finding] = []
    for group, keys in GROUPS.items():
        values = {key: sample.values[key] for key in keys if key in sample.values}
        if values:
            anchor, found = _checked(group, anchors.get(group), time, values, limits)
            findings += found
            if anchor is not None:
                anchors[group] = anchor
    flags = dict.fromkeys(sample.values, Flag.GOOD)
    for finding in findings:
        flags[finding.key] = max(flags[finding.key], finding.flag)
    remarks = tuple(_sentence(sample.stream, sample.values, finding) for finding in findings)
    return QualityState(anchors=anchors), replace(sample, flags=flags, remarks=remarks)


def check_record(record: Record, limits: Limits = DEFAULT_LIMITS) -> Record:
    """Flag every value of a record, as ``check_sample`` would one by one.

    Returns
    -------
    record
        With flags, and with a note per quantity and flag: how many, and the first of them.
    """
    times = record.time.astype(np.int64).tolist()
    flags = {key: np.full(len(times), Flag.GOOD, dtype=np.uint8) for key in record.values}
    tally: dict[tuple[str, Flag], tuple[int, int, str]] = {}
    for group, keys in GROUPS.items():
        columns = {key: record.values[key].tolist() for key in keys if key in record.values}
        for row, finding, values in _findings(group, times, columns, limits):
            flags[finding.key][row] = max(flags[finding.key][row], finding.flag)
            sentence = _sentence(record.stream, values, finding)
            count, first, example = tally.get((finding.key, finding.flag), (0, row, sentence))
            tally[finding.key, finding.flag] = (count + 1, first, example)
    notes = tuple(
        f"{example} The first of {count} such among {len(times)}, "
        f"at {record.time[first].astype('datetime64[s]')}Z."
        for count, first, example in tally.values()
    )
    return replace(record, flags=flags, notes=tuple(dict.fromkeys(record.notes + notes)))


def _findings(
    group: str, times: list[int], columns: Mapping[str, list[float]], limits: Limits
) -> Iterator[tuple[int, _Finding, Mapping[str, float]]]:
    anchor: _Anchor | None = None
    for row, numbers in enumerate(zip(*columns.values(), strict=True)):
        values = dict(zip(columns, numbers, strict=True))
        anchor, findings = _checked(group, anchor, times[row], values, limits)
        for finding in findings:
            yield row, finding, values


def _checked(
    group: str, anchor: _Anchor | None, time: int, values: Mapping[str, float], limits: Limits
) -> tuple[_Anchor | None, list[_Finding]]:
    findings = [
        finding
        for key, value in values.items()
        if (finding := _range_finding(key, value, limits.ranges[key])) is not None
    ]
    if group == "waves":
        findings += _steepness_findings(values)
    late = anchor is not None and time <= anchor.time
    if late or any(finding.flag >= Flag.FAIL for finding in findings):
        return anchor, findings
    steadiness = limits.steadiness[group]
    moved = _moved(anchor, time, values, steadiness)
    return moved, findings + _steadiness_findings(group, anchor, moved, steadiness)


def _range_finding(key: str, value: float, limits: Range) -> _Finding | None:
    if math.isnan(value):
        return _Finding(key, Flag.MISSING, "is missing")
    for flag, (low, high) in ((Flag.FAIL, limits.fail), (Flag.SUSPECT, limits.suspect)):
        if not low <= value <= high:
            return _Finding(key, flag, f"is outside [{low:g}, {high:g}]")
    return None


def _steepness_findings(values: Mapping[str, float]) -> list[_Finding]:
    hs, tp = values.get("hs_m", math.nan), values.get("tp_s", math.nan)
    if not (hs > 0.0 and 0.0 <= tp < math.inf):
        return []
    steepness = 2.0 * math.pi * hs / (GRAVITY * tp**2) if tp > 0.0 else math.inf
    limit = steepness_limit(tp)
    why = f"makes a sea of steepness {steepness:.2g}, above {limit:.3f} (DNV-RP-C205)"
    return [_Finding(key, Flag.FAIL, why) for key in ("hs_m", "tp_s") if steepness > limit]


def _moved(
    anchor: _Anchor | None, time: int, values: Mapping[str, float], limits: Steadiness
) -> _Anchor:
    still = (
        anchor is not None
        and anchor.values == values
        and time - anchor.time <= limits.gap_s * _SECOND
    )
    if anchor is not None and still:
        return _Anchor(time, values, anchor.since, anchor.readings + 1)
    return _Anchor(time, values, time, 1)


def _steadiness_findings(
    group: str, before: _Anchor | None, after: _Anchor, limits: Steadiness
) -> list[_Finding]:
    if before is None:
        return []
    elapsed = (after.time - before.time) / _SECOND
    still = (after.time - after.since) / _SECOND
    keys = tuple(after.values)
    if elapsed > limits.gap_s:
        why = f"comes after {elapsed / 3600:.3g} h of silence (limit {limits.gap_s / 3600:g} h)"
        return [_Finding(key, Flag.SUSPECT, why) for key in keys]
    change, allowed = (
        _change(group, before.values, after.values),
        limits.jump + limits.rate * elapsed,
    )
    if change > allowed:
        why = f"changed by {change:.3g} in {elapsed:g} s (limit {allowed:.3g})"
        return [
            _Finding(key, Flag.SUSPECT, why) for key in keys if group != "waves" or key == "hs_m"
        ]
    if still >= limits.flat_fail_s and after.readings >= _FLAT_FAIL_COUNT:
        flag = Flag.FAIL
    elif still >= limits.flat_suspect_s and after.readings >= _FLAT_SUSPECT_COUNT:
        flag = Flag.SUSPECT
    else:
        return []
    why = f"has stood still for {still / 3600:.3g} h ({after.readings} readings)"
    return [_Finding(key, flag, why) for key in keys]


def _change(group: str, before: Mapping[str, float], after: Mapping[str, float]) -> float:
    """Of the current's vector, of hs, of the value; 0 where one side has none."""
    key = GROUPS[group][0]
    if key not in before or key not in after:
        return 0.0
    if group != "current":
        return abs(after[key] - before[key])
    a, b = before[key], after[key]
    to = "current_to_deg"
    turn = math.radians(after[to] - before[to]) if to in before and to in after else 0.0
    # The cosine rule; max, because rounding may leave a hair below zero.
    return math.sqrt(max(a * a + b * b - 2.0 * a * b * math.cos(turn), 0.0))


def _sentence(stream: str, values: Mapping[str, float], finding: _Finding) -> str:
    key, flag, why = finding
    if flag == Flag.MISSING:
        return f"{stream}: {key} {why}. Flagged {flag} ({_word(flag)})."
    return (
        f"{stream}: {key} = {values[key]:g} {why}. "
        f"Flagged {flag} ({_word(flag)}); the raw value is kept."
    )


def _word(flag: Flag) -> str:
    return flag.name.lower().replace("_", " ")
