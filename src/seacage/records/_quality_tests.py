"""The tests of quality: what one instrument's reading is worth, given its last good one."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from seacage.conventions import GRAVITY, Flag
from seacage.ocean import steepness_limit
from seacage.records._limits import GROUPS, Limits, Range, Steadiness

_SECOND = 1_000_000
_FLAT_SUSPECT_COUNT, _FLAT_FAIL_COUNT = 3, 5


class Anchor(NamedTuple):
    """The latest reading of a group that was in range, to compare the next with."""

    time: int  # [us]
    values: Mapping[str, float]
    since: int  # when the group last moved [us]
    readings: int  # since then, with this one


class Finding(NamedTuple):
    """A value that is not good, and why."""

    key: str
    flag: Flag
    why: str


def judged(
    group: str, anchor: Anchor | None, time: int, values: Mapping[str, float], limits: Limits
) -> tuple[Anchor | None, list[Finding]]:
    """Judge one reading of a group; only one in range, and not late, becomes the next anchor."""
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


def _range_finding(key: str, value: float, limits: Range) -> Finding | None:
    if math.isnan(value):
        return Finding(key, Flag.MISSING, "is missing")
    for flag, (low, high) in ((Flag.FAIL, limits.fail), (Flag.SUSPECT, limits.suspect)):
        if not low <= value <= high:
            return Finding(key, flag, f"is outside [{low:g}, {high:g}]")
    return None


def _steepness_findings(values: Mapping[str, float]) -> list[Finding]:
    hs, tp = values.get("hs_m", math.nan), values.get("tp_s", math.nan)
    if not (hs > 0.0 and 0.0 <= tp < math.inf):
        return []
    steepness = 2.0 * math.pi * hs / (GRAVITY * tp**2) if tp > 0.0 else math.inf
    limit = steepness_limit(tp)
    why = f"makes a sea of steepness {steepness:.2g}, above {limit:.3f} (DNV-RP-C205)"
    return [Finding(key, Flag.FAIL, why) for key in ("hs_m", "tp_s") if steepness > limit]


def _moved(
    anchor: Anchor | None, time: int, values: Mapping[str, float], limits: Steadiness
) -> Anchor:
    if anchor is None or time - anchor.time > limits.gap_s * _SECOND or values != anchor.values:
        return Anchor(time, values, time, 1)
    return Anchor(time, values, anchor.since, anchor.readings + 1)


def _steadiness_findings(
    group: str, before: Anchor | None, after: Anchor, limits: Steadiness
) -> list[Finding]:
    if before is None:
        return []
    elapsed = (after.time - before.time) / _SECOND
    keys = tuple(after.values)
    if elapsed > limits.gap_s:
        why = f"comes after {elapsed / 3600:.3g} h of silence (limit {limits.gap_s / 3600:g} h)"
        return [Finding(key, Flag.SUSPECT, why) for key in keys]
    change = _change(group, before.values, after.values)
    allowed = limits.jump + limits.rate * elapsed
    if change > allowed:
        why = f"changed by {change:.3g} in {elapsed:g} s (limit {allowed:.3g})"
        changed = keys if group != "waves" else ("hs_m",)
        return [Finding(key, Flag.SUSPECT, why) for key in changed]
    still = (after.time - after.since) / _SECOND
    if still >= limits.flat_fail_s and after.readings >= _FLAT_FAIL_COUNT:
        flag = Flag.FAIL
    elif still >= limits.flat_suspect_s and after.readings >= _FLAT_SUSPECT_COUNT:
        flag = Flag.SUSPECT
    else:
        return []
    why = f"has stood still for {still / 3600:.3g} h ({after.readings} readings)"
    return [Finding(key, flag, why) for key in keys]


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
