"""What the numbers of a study say, in sentences that follow from them."""

from collections.abc import Sequence

import numpy as np

from seacage.studies._level_one import LevelOneScore
from seacage.studies._sensor_scores import SensorScore

NOMINAL = 0.95


def number(value: float) -> str:
    """Three digits that matter, with a true minus."""
    written = f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:#.3g}".rstrip(".")
    return written.replace("-", "\N{MINUS SIGN}")


def percent(share: float, *, digits: int = 0) -> str:
    """A share in percent, which stays with its sign on one line."""
    return f"{100.0 * share:.{digits}f}\N{NARROW NO-BREAK SPACE}%"


def listed(names: Sequence[str]) -> str:
    """Names as a sentence lists them."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def findings(sensors: Sequence[SensorScore], level_one: LevelOneScore) -> list[str]:
    """The study's findings, one paragraph each."""
    return [
        _gain(sensors),
        _bias(sensors),
        _coverage(sensors),
        _emulation(sensors, level_one),
        _shape(level_one),
        _shortest(sensors),
    ]


def _gain(sensors: Sequence[SensorScore]) -> str:
    better = [score.sensor for score in sensors if score.means.better]
    worse = [score.sensor for score in sensors if score.means.worse]
    rest = [one.sensor for one in sensors if one.sensor not in {*better, *worse}]
    ranked = sorted(sensors, key=lambda score: score.means.ratio)
    first, last = ranked[0], ranked[-1]
    return (
        f"On days not trained on, multifidelity is better than low fidelity for {len(better)} of "
        f"{len(sensors)} sensors: the whole 95 % bootstrap interval of the gain lies above zero "
        "(10-minute means). "
        + (f"It is worse for {listed(worse)}: the interval lies below zero. " if worse else "")
        + (f"For {listed(rest)} the interval holds zero, so nothing is shown. " if rest else "")
        + "The multifidelity error is the smallest share of the low-fidelity error at "
        f"{first.sensor}, {number(first.means.ratio)}, and the largest at {last.sensor}, "
        f"{number(last.means.ratio)}."
    )


def _bias(sensors: Sequence[SensorScore]) -> str:
    # A depth that is too large is a displacement that is too small; so is a tension too low.
    under = [one.sensor for one in sensors if (one.raw.low_bias > 0.0) == (one.unit == "m")]
    over = [one.sensor for one in sensors if one.sensor not in under]
    if over:
        return (
            f"Low fidelity underestimates the response at {listed(under or ['no sensor'])} and "
            f"overestimates it at {listed(over)}, on average over the days that judge."
        )
    return (
        "Low fidelity underestimates the response at every sensor: on average the net is lifted "
        "less, and the bridles carry less, than in the virtual field. The virtual net is fouled "
        "and the simulated one is clean, which works in this direction."
    )


def _coverage(sensors: Sequence[SensorScore]) -> str:
    share = [score.raw.coverage for score in sensors]
    narrow = [score.sensor for score in sensors if score.raw.coverage < NOMINAL - 0.05]
    verdict = (
        f"They are too narrow for {listed(narrow)}. Two causes are likely and were not told "
        "apart: growth on the net since the days that taught, which level 2 does not see, and "
        "currents that those days did not have."
        if narrow
        else "None is too narrow by more than five points."
    )
    return (
        f"The multifidelity's {percent(NOMINAL)} intervals hold {percent(min(share))} to "
        f"{percent(max(share))} of single readings. {verdict}"
    )


def _emulation(sensors: Sequence[SensorScore], level_one: LevelOneScore) -> str:
    gap = float(np.mean([score.raw.low_mae for score in sensors if score.unit == "kN"]))
    emulation = float(np.mean(level_one.bridle_mae)) / 1000.0
    verdict = (
        "What level 2 corrects is the simulation, not its emulation."
        if gap > 10.0 * emulation
        else "So part of what level 2 corrects is the emulation; more simulations would help."
    )
    return (
        f"On {level_one.cases} held-out simulations the tensions of level 1 are off by "
        f"{number(1000.0 * emulation)} N on average; low fidelity misses the shackles by "
        f"{number(gap)} kN, {number(gap / emulation)} times as much. {verdict}"
    )


def _shape(level_one: LevelOneScore) -> str:
    ours, paper = level_one.shapes
    return (
        "For the whole shape, one Gaussian process with a kernel shared by all coordinates is "
        f"off by {number(float(np.mean(ours.axis_mae)))} m on average and by "
        f"{number(ours.worst)} m at the worst node of the worst case; three PCA modes with a "
        f"Gaussian process each, as in the paper, by {number(float(np.mean(paper.axis_mae)))} m "
        f"and {number(paper.worst)} m."
    )


def _shortest(sensors: Sequence[SensorScore]) -> str:
    shortest = min(sensors, key=lambda score: score.span_h)
    return (
        f"The shortest trial is that of {shortest.sensor}: {shortest.span_h:.0f} hours, about "
        f"{shortest.span_h / shortest.block_h:.0f} blocks for the bootstrap. That is few tides, "
        "so its interval says how sure the gain is in those hours, not in any others. All numbers "
        "are of one draw of current, noise and outages: another seed gives other hours, and a "
        "sensor that gains here may lose there."
    )
