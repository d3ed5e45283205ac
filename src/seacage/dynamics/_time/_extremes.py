"""The largest tension of three hours, from the peaks of shorter simulations."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

Series = Float[np.ndarray, "t line"]  # tension of each line in a simulation [N]
TAIL = 0.8  # share of the peaks below the fifth that a Weibull line is drawn through [-]
LEAST_TIME = 600.0  # simulated time below which there is no estimate [s]
LEAST_PEAKS = 50  # peaks below which there is no estimate
BLOCK = 300.0  # length of the blocks that the bootstrap draws [s]
DRAWS = 50  # of the bootstrap
_SHARES = (np.arange(200) + 0.5) / 200  # of the distribution of the largest peak, for its mean


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extremes:
    """Largest tensions of a time of ``hours``; NaN where there are too few peaks."""

    # Most probable maximum: the tension that one peak of that time exceeds on average [N]
    mpm: Float[np.ndarray, "*case line"]
    expected: Float[np.ndarray, "*case line"]  # mean of the largest peak [N]
    # Their standard deviations, by a bootstrap over blocks of five minutes [N]
    mpm_std: Float[np.ndarray, "*case line"]
    expected_std: Float[np.ndarray, "*case line"]


def extremes(
    tension: Sequence[Series], *, every: float, hours: float = 3.0, has_waves: bool = True
) -> Extremes:
    """Extremes of a stationary sea from simulations of it.

    A peak is the largest value between two successive up-crossings of the mean. A Weibull
    distribution of a peak's height over the mean is fitted to the upper fifth of the peaks of
    all simulations, a straight line on Weibull paper. With N peaks in ``hours``, the most
    probable maximum has N (1 − F) = 1. Left out: that the sea itself is known only within the
    scatter of the simulations where they are few, and peaks that depend on one another.

    Parameters
    ----------
    tension
        Of each simulation, which differ in their seeds alone [N].
    every
        Between samples [s].
    hours
        In which the largest is asked for [h].
    has_waves
        Without waves the largest tension is the mean.

    Source: Naess and Moan (2013), Stochastic Dynamics of Marine Structures, on fitted peaks;
    plotting positions after Benard and Bos-Levenbach (1953).
    """
    if not has_waves:
        mean = np.asarray(np.mean(np.concatenate(tension), axis=0, dtype=np.float64))
        sure = np.zeros_like(mean)
        return Extremes(mpm=mean, expected=mean, mpm_std=sure, expected_std=sure)
    duration, lines = every * sum(map(len, tension)), tension[0].shape[1]
    each = np.full((lines, 4), np.nan)
    if duration >= LEAST_TIME:
        blocks, draws = _draw_blocks([len(one) for one in tension], max(1, round(BLOCK / every)))
        for line in range(lines):
            series = [one[:, line] for one in tension]
            each[line] = _line_extremes(series, blocks, draws, 3600.0 * hours / duration)
    return Extremes(**dict(zip(Extremes.__slots__, each.T, strict=True)))


def _draw_blocks(
    lengths: list[int], per_block: int
) -> tuple[list[Int[np.ndarray, " t"]], Int[np.ndarray, "draw block"]]:
    """Block of each sample, and how often each is drawn: in the first row once, as it is."""
    counts = [-(-length // per_block) for length in lengths]
    begin, count = np.cumsum([0, *counts]), sum(counts)
    drawn = np.random.default_rng(0).multinomial(count, np.full(count, 1 / count), DRAWS)
    blocks = [b + np.arange(n) // per_block for b, n in zip(begin[:-1], lengths, strict=True)]
    return blocks, np.vstack([np.ones((1, count), dtype=np.int64), drawn])


def _line_extremes(
    series: list[Float[np.ndarray, " t"]],
    blocks: list[Int[np.ndarray, " t"]],
    draws: Int[np.ndarray, "draw block"],
    longer: float,
) -> tuple[float, ...]:
    """Of one line, in the order of the attributes of ``Extremes``."""
    mean = float(np.mean(np.concatenate(series), dtype=np.float64))
    found = [upcrossing_peaks(one, mean) for one in series]
    height = np.concatenate([peaks for peaks, _ in found]) - mean
    if len(height) < LEAST_PEAKS:
        return (np.nan,) * 4
    block = np.concatenate([of[at] for of, (_, at) in zip(blocks, found, strict=True)])
    mpm, expected = mean + _tail_maxima(height, draws[:, block], longer)
    return mpm[0], expected[0], float(mpm[1:].std()), float(expected[1:].std())


def upcrossing_peaks(
    series: Float[np.ndarray, " t"], level: float
) -> tuple[Float[np.ndarray, " peak"], Int[np.ndarray, " peak"]]:
    """Largest values between successive up-crossings of a level, and where each stretch begins."""
    above = series > level
    crossing = np.flatnonzero(~above[:-1] & above[1:]) + 1
    if len(crossing) < 2:
        return np.zeros(0), np.zeros(0, dtype=np.int64)
    return np.maximum.reduceat(series, crossing)[:-1].astype(np.float64), crossing[:-1]


def _tail_maxima(
    height: Float[np.ndarray, " peak"], times: Int[np.ndarray, "draw peak"], longer: float
) -> Float[np.ndarray, "2 draw"]:
    """Most probable and expected largest height, each peak counted so many times in each draw.

    NaN of a draw that has no two peaks in its tail, as where blocks without peaks are drawn.
    """
    order = np.argsort(height)
    top = max(int(TAIL * len(order)) - len(order) // 5, 0)  # a draw's upper fifth may reach lower
    weight = times[:, order]
    count = weight.sum(axis=1, keepdims=True)
    rank = np.cumsum(weight, axis=1) - 0.5 * (weight - 1.0)
    share = ((rank - 0.3) / (count + 0.4))[:, top:]
    weight = (weight[:, top:] * (share > TAIL)).astype(np.float64)
    known = np.count_nonzero(weight, axis=1) > 1
    weight, share, count = weight[known], share[known], count[known]
    x = np.log(-np.log1p(-np.clip(share, 0.0, 1.0 - 1e-9)))
    y = np.log(height[order][top:])
    # a draw of calm blocks alone may have no peak in the tail
    total = np.where((total := weight.sum(axis=1, keepdims=True)) > 0.0, total, np.nan)
    x_mean, y_mean = (np.sum(weight * v, axis=1, keepdims=True) / total for v in (x, y))
    slope = np.sum(weight * (x - x_mean) * (y - y_mean), axis=1) / np.sum(
        weight * (x - x_mean) ** 2, axis=1
    )
    scale = np.exp(y_mean[:, 0] - slope * x_mean[:, 0])
    number = count[:, 0] * longer
    mpm = scale * np.log(number) ** slope
    largest = -np.log(-np.expm1(np.log(_SHARES) / number[:, None]))
    expected = scale * np.mean(largest ** slope[:, None], axis=1)
    found = np.full((2, len(times)), np.nan)
    found[:, known] = mpm, expected
    return found
