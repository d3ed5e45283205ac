"""Quality control: one path for live samples and for archives."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from seacage.conventions import Flag
from seacage.records._limits import DEFAULT_LIMITS, GROUPS, Limits
from seacage.records._quality_tests import Anchor, Finding, judged
from seacage.records._record import Record
from seacage.records._sample import Sample
from seacage.records._times import microseconds


@dataclass(frozen=True, slots=True, kw_only=True)
class QualityState:
    """What the checks remember of one stream; the first state is ``QualityState()``."""

    anchors: Mapping[str, Anchor] = field(default_factory=dict[str, Anchor])


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
    findings: list[Finding] = []
    for group, keys in GROUPS.items():
        values = {key: sample.values[key] for key in keys if key in sample.values}
        if values:
            anchor, found = judged(group, anchors.get(group), time, values, limits)
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
) -> Iterator[tuple[int, Finding, Mapping[str, float]]]:
    anchor: Anchor | None = None
    for row, numbers in enumerate(zip(*columns.values(), strict=True)):
        values = dict(zip(columns, numbers, strict=True))
        anchor, findings = judged(group, anchor, times[row], values, limits)
        for finding in findings:
            yield row, finding, values


def _sentence(stream: str, values: Mapping[str, float], finding: Finding) -> str:
    key, flag, why = finding
    if flag == Flag.MISSING:
        return f"{stream}: {key} {why}. Flagged {flag} ({_word(flag)})."
    return (
        f"{stream}: {key} = {values[key]:g} {why}. "
        f"Flagged {flag} ({_word(flag)}); the raw value is kept."
    )


def _word(flag: Flag) -> str:
    return flag.name.lower().replace("_", " ")
