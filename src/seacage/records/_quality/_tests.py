"""Quality tests of one reading of an instrument, given its last good one."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from seacage.conventions import GRAVITY, Flag
from seacage.ocean import steepness_limit
from seacage.records._quality._limits import GROUPS, Limits, Range, Steadiness
from seacage.records._times import moment

SECOND = 1_000_000
FLAT_SUSPECT_COUNT, FLAT_FAIL_COUNT = 3, 5
BUCKETS = 64
ATTENUATED = "attenuated signal"
Point = tuple[float, ...]
"""Where a group is, so that distances are changes: a current in east and north, waves in hs."""


class Spread(NamedTuple):
    """Range of a group's readings, over a window kept as buckets and not as readings.

    A bucket leaves with the reading that opens a new one, so a window is at most one bucket
    too long, and exact where each bucket holds one reading.
    """

    began: int  # of the readings without a gap, the window's length ago at most [us]
    bucket: int
    low: Point  # of the open bucket
    high: Point
    closed: tuple[tuple[int, Point, Point], ...]  # time of the last reading, low, high
    closed_low: Point
    closed_high: Point


class Anchor(NamedTuple):
    """The latest reading of a group that was in range, to compare the next with."""

    time: int  # [us]
    values: Mapping[str, float]
    since: int  # when the group last moved [us]
    readings: int  # since then, with this one
    point: Point
    before: Point | None  # of the reading before, where no gap lies between
    spread: Spread


class Finding(NamedTuple):
    """A value that is not good, by which test, and why."""

    key: str
    flag: Flag
    why: str
    test: str


class Evaluation(NamedTuple):
    """Findings about one reading, and about the one before."""

    anchor: Anchor | None
    findings: list[Finding]
    of_the_last: Sequence[Finding] = ()  # of the reading that was the anchor


def evaluate(
    group: str, anchor: Anchor | None, time: int, values: Mapping[str, float], limits: Limits
) -> Evaluation:
    """Evaluate one reading of a group; only one in range, and not late, becomes the next anchor."""
    findings = evaluate_alone(group, time, values, limits)
    late = anchor is not None and time <= anchor.time
    if late or any(finding.flag >= Flag.FAIL for finding in findings):
        return Evaluation(anchor, findings)
    steadiness = limits.steadiness[group]
    moved = _next_anchor(group, anchor, time, values, steadiness)
    return Evaluation(
        moved,
        findings
        + _steadiness_findings(group, anchor, moved, steadiness)
        + _attenuation_findings(group, moved, steadiness),
        _spike_findings(group, anchor, moved, steadiness),
    )


def evaluate_alone(
    group: str, time: int, values: Mapping[str, float], limits: Limits
) -> list[Finding]:
    """Evaluate values by themselves, whatever came before."""
    findings = [
        finding
        for key, value in values.items()
        if (finding := _range_finding(key, value, limits.ranges[key], "gross range")) is not None
    ]
    if limits.climatology:
        findings += _climatology_findings(time, values, limits)
    if group == "waves":
        findings += _steepness_findings(values)
    return findings


def _range_finding(key: str, value: float, limits: Range, test: str) -> Finding | None:
    if math.isnan(value):
        return Finding(key, Flag.MISSING, "is missing", "missing value")
    for flag, (low, high) in ((Flag.FAIL, limits.fail), (Flag.SUSPECT, limits.suspect)):
        if not low <= value <= high:
            return Finding(key, flag, f"is outside [{low:g}, {high:g}]", test)
    return None


def _climatology_findings(time: int, values: Mapping[str, float], limits: Limits) -> list[Finding]:
    month = moment(time).month
    findings: list[Finding] = []
    for key, value in values.items():
        for season in limits.climatology.get(key, ()):
            if month in season.months and not math.isnan(value):
                found = _range_finding(key, value, season.range, "climatology")
                if found is not None:
                    why = f"{found.why}, usual in month {month}"
                    findings.append(found._replace(why=why))
    return findings


def _steepness_findings(values: Mapping[str, float]) -> list[Finding]:
    hs, tp = values.get("hs_m", math.nan), values.get("tp_s", math.nan)
    if not (hs > 0.0 and 0.0 <= tp < math.inf):
        return []
    square = tp * tp  # 0 or inf where tp is absurd, never an error
    steepness = 2.0 * math.pi * hs / (GRAVITY * square) if square > 0.0 else math.inf
    limit = steepness_limit(tp)
    why = f"makes a sea of steepness {steepness:.2g}, above {limit:.3f} (DNV-RP-C205)"
    if steepness <= limit:
        return []
    return [Finding(key, Flag.FAIL, why, "steepness") for key in ("hs_m", "tp_s")]


def _point(group: str, values: Mapping[str, float]) -> Point:
    key = GROUPS[group][0]
    if key not in values:
        return ()
    if group != "current" or "current_to_deg" not in values:
        return (values[key],)
    angle = math.radians(values["current_to_deg"])
    return (values[key] * math.sin(angle), values[key] * math.cos(angle))


def _next_anchor(
    group: str, anchor: Anchor | None, time: int, values: Mapping[str, float], limits: Steadiness
) -> Anchor:
    point = _point(group, values)
    gap = anchor is None or time - anchor.time > limits.gap_s * SECOND
    # A point of another kind (a current without its direction) is nothing to compare with.
    if anchor is None or gap or len(anchor.point) != len(point):
        spread = Spread(time, _bucket(time, limits), point, point, (), point, point)
        return Anchor(time, values, time, 1, point, None, spread)
    spread = _spread(anchor.spread, anchor.time, time, point, limits)
    if values != anchor.values:
        return Anchor(time, values, time, 1, point, anchor.point, spread)
    return Anchor(time, values, anchor.since, anchor.readings + 1, point, anchor.point, spread)


def _bucket(time: int, limits: Steadiness) -> int:
    width = limits.attenuated_s * SECOND / BUCKETS
    return 0 if math.isinf(width) else int(time // width)


def _spread(last: Spread, last_time: int, time: int, point: Point, limits: Steadiness) -> Spread:
    bucket = _bucket(time, limits)
    oldest = time - limits.attenuated_s * SECOND
    # No older than the window: so a late reading is forgotten when the window has passed it.
    began = last.began if math.isinf(oldest) else max(last.began, math.floor(oldest))
    if bucket == last.bucket:
        return last._replace(
            began=began,
            low=tuple(map(min, last.low, point)),
            high=tuple(map(max, last.high, point)),
        )
    closed = tuple(
        one for one in (*last.closed, (last_time, last.low, last.high)) if one[0] > oldest
    )
    return Spread(
        began,
        bucket,
        point,
        point,
        closed,
        tuple(map(min, *(low for _, low, _ in closed), point)) if closed else point,
        tuple(map(max, *(high for _, _, high in closed), point)) if closed else point,
    )


def _spike_findings(
    group: str, before: Anchor | None, after: Anchor, limits: Steadiness
) -> list[Finding]:
    """Of the reading between two others: how far it stands out from both, on one side."""
    if before is None or before.before is None or after.before is None:
        return []
    there = [b - a for a, b in zip(before.before, before.point, strict=True)]
    back = [c - b for b, c in zip(before.point, after.point, strict=True)]
    if sum(one * other for one, other in zip(there, back, strict=True)) >= 0.0:
        return []
    size = min(math.hypot(*there), math.hypot(*back))
    meanwhile = limits.rate * (after.time - before.time) / SECOND
    for flag, least in ((Flag.FAIL, limits.spike_fail), (Flag.SUSPECT, limits.spike_suspect)):
        limit = least + meanwhile
        if size > limit:
            why = f"stands out by {size:.3g} from its neighbours (limit {limit:.3g})"
            return [Finding(key, flag, why, "spike") for key in _of_change(group, before.values)]
    return []


def _attenuation_findings(group: str, after: Anchor, limits: Steadiness) -> list[Finding]:
    spread = after.spread
    full = after.time - spread.began >= limits.attenuated_s * SECOND
    if not full or len(spread.closed) + 1 < FLAT_FAIL_COUNT or not after.point:
        return []
    low = map(min, spread.low, spread.closed_low)
    high = map(max, spread.high, spread.closed_high)
    size = max(most - least for least, most in zip(low, high, strict=True))
    for flag, limit in (
        (Flag.FAIL, limits.attenuated_fail),
        (Flag.SUSPECT, limits.attenuated_suspect),
    ):
        if size < limit:
            hours = limits.attenuated_s / 3600.0
            why = f"stayed within {size:.2g} for {hours:g} h (limit {limit:g})"
            keys = _of_change(group, after.values)
            return [Finding(key, flag, why, ATTENUATED) for key in keys]
    return []


def _of_change(group: str, values: Mapping[str, float]) -> tuple[str, ...]:
    """The keys that a change speaks of: of waves the height alone."""
    return tuple(values) if group != "waves" else ("hs_m",)


def _steadiness_findings(
    group: str, before: Anchor | None, after: Anchor, limits: Steadiness
) -> list[Finding]:
    if before is None:
        return []
    elapsed = (after.time - before.time) / SECOND
    keys = tuple(after.values)
    if elapsed > limits.gap_s:
        why = f"comes after {elapsed / 3600:.3g} h of silence (limit {limits.gap_s / 3600:g} h)"
        return [Finding(key, Flag.SUSPECT, why, "gap") for key in keys]
    change = _change(before.point, after.point)
    allowed = limits.jump + limits.rate * elapsed
    if change > allowed:
        why = f"changed by {change:.3g} in {elapsed:g} s (limit {allowed:.3g})"
        changed = _of_change(group, after.values)
        return [Finding(key, Flag.SUSPECT, why, "rate of change") for key in changed]
    still = (after.time - after.since) / SECOND
    if still >= limits.flat_fail_s and after.readings >= FLAT_FAIL_COUNT:
        flag = Flag.FAIL
    elif still >= limits.flat_suspect_s and after.readings >= FLAT_SUSPECT_COUNT:
        flag = Flag.SUSPECT
    else:
        return []
    why = f"has stood still for {still / 3600:.3g} h ({after.readings} readings)"
    return [Finding(key, flag, why, "flat line") for key in keys]


def _change(before: Point, after: Point) -> float:
    """Of the current's vector, of hs, of the value; 0 where one side has none."""
    if not before or not after:
        return 0.0
    if len(before) != len(after):  # one side has no direction
        return abs(math.hypot(*after) - math.hypot(*before))
    return math.dist(before, after)
