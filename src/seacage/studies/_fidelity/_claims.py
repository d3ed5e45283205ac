"""Claims of the fidelity study, and whether its own numbers support them."""

from collections.abc import Sequence

import numpy as np

from seacage.studies._fidelity._fouling import FoulingGap
from seacage.studies._fidelity._gap import SensorGap
from seacage.studies._fidelity._null_case import NullCase
from seacage.studies._fidelity._rescaling import LEAST_LEFT, Rescaling
from seacage.studies._interval import Interval
from seacage.studies._text import Claim, join_names, number, percent

THOUSANDTH = {"m": "mm", "kN": "N"}  # units that a null case's errors are read in


def claims(
    gaps: Sequence[SensorGap], rescalings: Sequence[Rescaling], null: NullCase, fouling: FoulingGap
) -> tuple[Claim, ...]:
    """The rules against an inverse crime, and what growth does."""
    return (
        _underestimation(gaps),
        _low_loads(gaps),
        _remainder(rescalings),
        _nothing_gained(null),
        _zero_covered(null),
        _widening(fouling),
    )


def ends(interval: Interval) -> str:
    """The interval's ends, as tables and sentences print them."""
    return f"{number(interval.low)} … {number(interval.high)}"


def _underestimation(gaps: Sequence[SensorGap]) -> Claim:
    depth = [gap for gap in gaps if gap.unit == "m"]
    found = [
        f"{gap.sensor} rises {number(gap.truth)} m in truth and {number(gap.low)} m in the low "
        f"fidelity, {number(gap.bias.mean)} m [{ends(gap.bias)}]"
        for gap in depth
    ]
    return Claim(
        claim=f"The low fidelity underestimates the displacement of {_all(len(depth))} on average.",
        holds=bool(depth) and all(gap.underestimates for gap in depth),
        finding=f"On average {join_names(found or ['no depth sensor was there'])}.",
    )


def _low_loads(gaps: Sequence[SensorGap]) -> Claim:
    loads = [gap for gap in gaps if gap.unit == "kN"]
    truth, low = (
        float(np.mean([getattr(gap, side) for gap in loads])) if loads else np.nan
        for side in ("truth", "low")
    )
    over = [gap.sensor for gap in loads if not gap.underestimates]
    finding = (
        f"Over all shackles and windows a bridle bears {number(truth)} kN in truth and "
        f"{number(low)} kN in the low fidelity, {number(low - truth)} kN."
        if loads
        else "No shackle was there."
    )
    if over:
        finding += f" It overestimates {join_names(over)} on average."
    return Claim(
        claim="The low fidelity underestimates the mean tension of the bridles with shackles.",
        holds=low < truth,
        finding=finding,
    )


def _all(count: int) -> str:
    return "all three depth sensors" if count == 3 else f"each of {count} depth sensors"


def _remainder(rescalings: Sequence[Rescaling]) -> Claim:
    ranked = sorted(rescalings, key=lambda one: one.left)
    short = [one.sensor for one in ranked if not one.enough]
    least, most = ranked[0], ranked[-1]
    finding = (
        f"On days not fitted to, {percent(least.left)} ({least.sensor}) to {percent(most.left)} "
        f"({most.sensor}) of the mean absolute error are left."
    )
    if short:
        finding += f" Less than {percent(LEAST_LEFT)} are left at {join_names(short)}."
    return Claim(
        claim="The best rescaling and rotation of the low fidelity leaves at least "
        f"{percent(LEAST_LEFT)} of its error at every sensor.",
        holds=not short,
        finding=finding,
    )


def _nothing_gained(null: NullCase) -> Claim:
    above = [one.sensor for one in null.null.sensors if one.gain.low > 0.0]
    together = null.null.together
    finding = (
        "For all sensors together the gain there is "
        f"{_shares(together)} of the low fidelity's error; in the field it is "
        f"{_shares(null.real.together)}."
    )
    if above:
        finding += f" It gains at {join_names(above)}, where there is nothing to gain."
    if null.unjudged:
        finding += f" {join_names(null.unjudged)} had too few readings to be evaluated."
    return Claim(
        claim="Where the truth is the low fidelity itself, multifidelity gains nothing: no "
        "interval of its gain lies above zero.",
        holds=bool(null.null.sensors) and together.low <= 0.0 and not above,
        finding=finding,
    )


def _zero_covered(null: NullCase) -> Claim:
    sensors, together = null.null.sensors, null.null.together
    off = [one for one in sensors if not one.gain.covers_zero]
    covered = len(sensors) - len(off)
    finding = f"{covered} of {len(sensors)} sensors' intervals cover zero"
    finding += ", and that of all together." if together.covers_zero else "."
    below = [one for one in off if one.gain.high < 0.0]
    if below:
        worst = min(below, key=lambda one: one.share.mean)
        unit = THOUSANDTH[worst.unit]
        real = {one.sensor: one.gain.mean for one in null.real.sensors}[worst.sensor]
        finding += (
            f" Below zero: {join_names([one.sensor for one in below])}. There level 2 learned from "
            f"noise, which costs: most at {worst.sensor}, {number(-1e3 * worst.gain.mean)} {unit}, "
            f"where the field's gain is {number(1e3 * real)} {unit}."
        )
    if together.high < 0.0:
        finding += " All together lie below zero: a loss beside an exact low fidelity, no gain."
    return Claim(
        claim="There the interval covers zero, at each sensor and in all.",
        holds=bool(sensors) and together.covers_zero and not off,
        finding=finding,
    )


def _shares(interval: Interval) -> str:
    mean, low, high = (
        percent(end, digits=1) for end in (interval.mean, interval.low, interval.high)
    )
    return f"{mean} [{low} … {high}]"


def _widening(fouling: FoulingGap) -> Claim:
    depth = [column for column, unit in enumerate(fouling.units) if unit == "m"]
    wider = fouling.widening[:, depth]
    middle = len(fouling.speed) // 2
    found = [
        f"{fouling.sensors[column]} from {number(fouling.gap[0, middle, column])} m to "
        f"{number(fouling.gap[-1, middle, column])} m"
        for column in depth
    ]
    return Claim(
        claim="The gap at the depth sensors widens as the net grows, at every settled current.",
        holds=bool(np.all(wider > 0.0)),
        finding=f"At {fouling.speed[middle]:g} m/s, from a net just cleaned to one grown out: "
        f"{join_names(found or ['no depth sensor'])}.",
    )
