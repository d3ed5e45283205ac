"""Findings of a study, in sentences that follow from its numbers."""

from collections.abc import Sequence

import numpy as np

from seacage.studies._paper._level_one import LevelOneScore
from seacage.studies._paper._shape_models import PCA_PAPER, PCA_WAVES, SHAPE_CURRENT
from seacage.studies._paper._shape_study import ShapeStudy
from seacage.studies._paper._ways import HEARING, ScoredWays, WayScore
from seacage.studies._sensor_scores import SensorScore
from seacage.studies._text import join_names, number, percent

NOMINAL = 0.95


def findings(scored: ScoredWays, level_one: LevelOneScore, shapes: ShapeStudy) -> list[str]:
    """The study's findings, one paragraph each."""
    sensors = scored.sensors
    return [
        _gain(sensors),
        _bias(sensors),
        *(_wave_gain(scored, way) for way in scored.ways if way.name == HEARING),
        _coverage(sensors),
        _emulation(sensors, level_one),
        _shape(shapes),
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
        + (f"It is worse for {join_names(worse)}: the interval lies below zero. " if worse else "")
        + (f"For {join_names(rest)} the interval holds zero, so nothing is shown. " if rest else "")
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
            f"Low fidelity underestimates the response at {join_names(under or ['no sensor'])} and "
            f"overestimates it at {join_names(over)}, on average over the validation days."
        )
    return (
        "Low fidelity underestimates the response at every sensor: on average the net is lifted "
        "less, and the bridles carry less, than in the virtual field. The virtual net is fouled "
        "and the simulated one is clean, which works in this direction."
    )


def _coverage(sensors: Sequence[SensorScore]) -> str:
    share = [score.minutes.coverage for score in sensors]
    narrow = [score.sensor for score in sensors if score.minutes.coverage < NOMINAL - 0.05]
    verdict = (
        f"They are too narrow for {join_names(narrow)}. Two causes are likely and were not "
        "separated: growth on the net since the training days, which level 2 does not see, and "
        "currents that those days did not have."
        if narrow
        else "None is too narrow by more than five points."
    )
    return (
        f"The multifidelity's {percent(NOMINAL)} intervals hold {percent(min(share))} to "
        f"{percent(max(share))} of means over a minute, as in training. {verdict}"
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


def _wave_gain(scored: ScoredWays, way: WayScore) -> str:
    """What it brings to hear the waves, sensor by sensor on the same readings."""
    current = {one.sensor: one for one in scored.sensors}
    pairs = [(one, current[one.sensor]) for one in way.sensors]
    better = [one.sensor for one, other in pairs if one.means.multi_mae < other.means.multi_mae]
    low = [one.sensor for one, other in pairs if one.means.low_mae < other.means.low_mae]
    change = float(np.median([a.means.multi_mae / b.means.multi_mae - 1.0 for a, b in pairs]))
    return (
        "A twin with waves as inputs has a smaller multifidelity error at "
        f"{join_names(better or ['no sensor'])} and a larger one at the others; the median change "
        f"is {percent(change)}. Low fidelity gains by it at {join_names(low or ['no sensor'])}."
    )


def _shape(shapes: ShapeStudy) -> str:
    ours, paper = shapes.best, shapes.scores[PCA_PAPER]
    text = (
        f"For the whole shape, one Gaussian process with a kernel shared by all coordinates is "
        f"off by {number(ours.mae)} m on average and by {number(ours.worst)} m at the worst node "
        f"of the worst case; three PCA modes with a Gaussian process each, as in the paper, by "
        f"{number(paper.mae)} m and {number(paper.worst)} m: {number(paper.mae / ours.mae)} times "
        "the average error."
    )
    deaf, modes = shapes.scores.get(SHAPE_CURRENT), shapes.scores.get(PCA_WAVES)
    if deaf is None or modes is None:
        return text
    return text + (
        f" Both the waves and the modes count: without waves the shared kernel is at "
        f"{number(deaf.mae)} m, three modes with waves at {number(modes.mae)} m."
    )


def _shortest(sensors: Sequence[SensorScore]) -> str:
    shortest = min(sensors, key=lambda score: score.told_h)
    return (
        f"The shortest trial is that of {shortest.sensor}: {shortest.told_h:.0f} hours, "
        f"{shortest.blocks} blocks for the bootstrap. That is few tides, "
        "so its interval says how sure the gain is in those hours, not in any others. All numbers "
        "are of one draw of current, noise and outages: another seed gives other hours, and a "
        "sensor that gains here may lose there."
    )
