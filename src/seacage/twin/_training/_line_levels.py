"""Training of level 2 in waves, of lines' loads and of depths, from their sensors' windows."""

import math
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates import LoadPrediction, LoadRatio, conformal_factor, is_gain
from seacage.twin._correction import Correction, WindowErrors
from seacage.twin._lines._line_correction import LineCorrection, load_variables
from seacage.twin._lines._line_loads import LineLoads
from seacage.twin._pairs import Pairs
from seacage.twin._training._held_out import cross_validate
from seacage.twin._training._windows import WINDOW_S, Windows

BLOCK_WINDOWS = 6  # windows of an hour, which share their error, as readings of the mean do
LEAST_WINDOWS = 6  # of a block, for its largest value to count
LEAST_BLOCKS = 4  # held-out blocks, for there to be an interval
THREE_HOURS = 10800.0  # [s]
Series = Float[np.ndarray, " window"]
Blocks = Int[np.ndarray, " window"]


def train_line_level_2(
    loads: LineLoads,
    line: int,
    windows: Windows,
    *,
    model: Correction | None,
    selected: Pairs,
    x: Float[np.ndarray, "window feature"],
) -> LineCorrection | None:
    """Train level 2 of a line; None where no held-out window shows a gain.

    ``loads``, ``line``: level 1, and the number of the line. ``windows``: of its shackle, in the
    training window. ``model``, ``selected``, ``x``: level 2 of the shackle's mean, if it has one,
    the readings that it was fitted to, and its features at the windows.
    """
    low, inside, _ = loads.predict(windows.metocean, spread=False)
    std = low.std.mean[:, line]
    usable = inside & (std > 0.0)
    low, windows, std = low.rows(usable), windows.rows(usable), std[usable]
    if len(windows) < 2:
        return None
    block = windows.number // BLOCK_WINDOWS
    mean = low.mean.mean[:, line]
    takes_mean = False
    if model is not None:
        pairs = Pairs(
            time=(windows.number * round(WINDOW_S * 1e6)).astype("datetime64[us]"),
            metocean=windows.metocean,
            value=windows.mean,
        )
        left_out, _ = cross_validate(model, selected, pairs, x[usable])
        error = np.abs(windows.mean - mean) - np.abs(windows.mean - left_out)
        takes_mean = is_gain(error, block)
        mean = left_out if takes_mean else mean
    variables = load_variables(windows.metocean, std)
    ratio, error = LoadRatio.fit(np.log(windows.std / std), block, variables)
    of_std = np.log(windows.std / std) - error  # held-out log ratio of each window
    largest = low.maximum_3h.lines(np.array([line]))
    above = largest.of_share(WINDOW_S / THREE_HOURS).size[:, 0] - largest.offset
    peak, of_peak = _follow(windows.maximum - windows.mean, above, of_std, block)
    damage, _ = _follow(windows.damage, low.damage_equivalent.mean[:, line], of_std, block)
    if not takes_mean and ratio == LoadRatio() and peak is None and damage is None:
        return None
    return LineCorrection(
        every_s=windows.every_s,
        peak_samples=float(np.median(windows.peak_samples)),
        windows=len(windows),
        mean=takes_mean,
        std=ratio,
        std_log_sd=_spread(error, block),
        peak=peak,
        damage=damage,
        maximum_log_sd=_maximum_spread(windows, largest, mean, np.exp(of_peak), error),
    )


def window_errors(loads: LineLoads, line: int, windows: Windows) -> WindowErrors | None:
    """Errors of a line's level 1 in its shackle's windows; None where these are too few."""
    low, inside, _ = loads.predict(windows.metocean, spread=False)
    usable = inside & (low.std.mean[:, line] > 0.0)
    low, windows = low.rows(usable), windows.rows(usable)
    bridles, share = loads.kinds.count("bridle"), WINDOW_S / THREE_HOURS
    measured = {"mean": windows.mean, "std": windows.std}
    return WindowErrors.of_windows(low, line, bridles, share=share, **measured)


def train_depth_ratio(low: Series, windows: Windows) -> LoadRatio | None:
    """Ratio of the standard deviation of a sensor's depth to level 1's, ``low`` [m].

    None where no held-out window shows a gain.
    """
    usable = low > 0.0
    low, windows = low[usable], windows.rows(usable)
    block = windows.number // BLOCK_WINDOWS
    variables = load_variables(windows.metocean, low)
    ratio, _ = LoadRatio.fit(np.log(windows.std / low), block, variables)
    return None if ratio == LoadRatio() else ratio


def _follow(
    measured: Series, low: Series, of_std: Series, block: Blocks
) -> tuple[float | None, Series]:
    """Factor on a load that follows the standard deviation, and the held-out log ratio to level 1.

    None and 0 where following it, with the factor or without, is no better than level 1.
    """
    known = np.isfinite(measured) & np.isfinite(low)
    known[known] = (measured[known] > 0.0) & (low[known] > 0.0)
    level_1 = np.log(measured[known] / low[known])
    ratio, error = LoadRatio.fit(level_1 - of_std[known], block[known], {})
    if not known.any() or not is_gain(np.abs(level_1) - np.abs(error), block[known]):
        return None, np.zeros_like(of_std)
    return math.exp(ratio.constant), of_std + ratio.constant


def _spread(error: Series, block: Blocks) -> float | None:
    """Standard deviation of a window's log standard deviation, by held-out windows."""
    blocks, scale = len(np.unique(block)), float(np.sqrt(np.mean(error**2)))
    if blocks < LEAST_BLOCKS or scale == 0.0:
        return None
    return scale * conformal_factor(np.abs(error) / scale, independent=blocks)


def _maximum_spread(
    windows: Windows, largest: LoadPrediction, mean: Series, scale: Series, error: Series
) -> float | None:
    """Standard deviation of the largest load's logarithm by held-out blocks of two hours.

    What the waves explain is left out.

    It is at least that of the blocks' mean log standard deviations, as waves hide small errors of
    the largest value of two hours.

    ``mean``, ``scale``: held-out mean, and factor on level 1's largest load above the mean.
    ``error``: held-out errors of the log standard deviation.
    """
    above = scale[:, None] * (largest.size - largest.offset) + largest.offset
    expected = replace(largest, base=mean[:, None], size=above)
    block = windows.number // (2 * BLOCK_WINDOWS)
    left, waves, slow = list[float](), list[float](), list[float]()
    for one in np.unique(block):
        rows = (block == one) & np.isfinite(windows.maximum)
        if rows.sum() < LEAST_WINDOWS:
            continue
        whole = expected.rows(rows).pooled(WINDOW_S / THREE_HOURS)
        height = float(windows.maximum[rows].max() - whole.base[0, 0])
        left.append(math.log(max(height, 1.0) / float(whole.size[0, 0] - whole.offset)))
        waves.append(float(whole.gumbel[0, 0]) ** 2 * math.pi**2 / 6.0)
        slow.append(float(error[rows].mean()))
    if len(left) < LEAST_BLOCKS:
        return None
    wide = float(np.mean(waves))
    own = max(float(np.mean(np.square(left))) - wide, float(np.mean(np.square(slow))))
    scores = np.abs(left) / math.sqrt(own + wide)
    return math.sqrt(own) * max(conformal_factor(scores, independent=len(left)), 1.0)
