"""Windows of ten minutes of a sensor: mean, standard deviation, largest value and wear."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Rows
from seacage.dynamics import damage_equivalent_load
from seacage.surrogates import block_means
from seacage.twin._metocean import Metocean
from seacage.twin._pairs import Pairs

WINDOW_S = 600.0
LEAST_SHARE = 0.8  # of a window's readings that have to be sound [-]

# Readings per peak period from which waves are smooth enough for their third differences to show
# the instrument's noise [-]
NOISE_SAMPLES = 8.0

LEAST_SIGNAL = 1.0  # least variance of a window, its noise taken off, over that noise [-]
MOST_ALIKE = 10  # equal readings in a row; more are of a sensor that is stuck

# Readings per peak period below which peaks and cycles are lost between them [-]
PEAK_SAMPLES = 4.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Windows(Rows):
    """Statistics of one sensor's readings over windows, which begin at whole multiples since 1970.

    The instrument's noise is taken off the standard deviations. The largest value is that of a
    parabola through each three readings; it and the damage are NaN of a sensor too slow for the
    waves, and the damage without a T-N slope.
    """

    number: Int[np.ndarray, " window"]  # of windows since 1970
    metocean: Metocean  # mean over the window
    # Of the readings [N] or [m]
    mean: Float[np.ndarray, " window"]
    std: Float[np.ndarray, " window"]
    maximum: Float[np.ndarray, " window"]
    damage: Float[np.ndarray, " window"]  # damage-equivalent load [N]
    every_s: float  # between readings [s]
    noise_sd: float  # standard deviation of the instrument's noise [N] or [m]

    def __len__(self) -> int:
        return len(self.number)

    @property
    def peak_samples(self) -> Float[np.ndarray, " window"]:
        """Readings per peak period [-]."""
        return self.metocean.tp / self.every_s


def sensor_windows(
    pairs: Pairs, *, noise_sd: float | None = None, tn_slope: float = math.nan
) -> Windows | None:
    """Windows of single readings; None where there is no whole one in known waves.

    Windows that lack a fifth of their readings, that are hardly more than noise, and in which Hs
    or Tp is not known are left out.

    ``pairs``: sound readings, not averaged.
    ``noise_sd``: standard deviation of the instrument's noise; None estimates it [N] or [m].
    ``tn_slope``: of the line's T-N curve [-].
    """
    pairs = pairs.rows(~_stuck(pairs.value))
    if len(pairs) < 2:
        return None
    microsecond = pairs.time.astype("datetime64[us]").astype(np.int64)
    step = np.diff(microsecond) / 1e6
    every = float(np.median(step))
    label = microsecond // round(WINDOW_S * 1e6)
    steady = np.concatenate([[False], np.abs(step - every) < 0.1 * every])
    shift = float(pairs.value.mean())
    columns = (*pairs.metocean.whole.T, pairs.value - shift, (pairs.value - shift) ** 2)
    number, (*water, mean, square) = block_means(label, *columns)
    metocean = Metocean.from_table(np.column_stack(water))
    variance = np.maximum(square - mean**2, 0.0)
    first = np.searchsorted(label, number)
    count = np.diff(first, append=len(label))
    samples = metocean.tp / every
    whole = count >= LEAST_SHARE * WINDOW_S / every
    if noise_sd is None:
        smooth = number[whole & (samples >= NOISE_SAMPLES)]
        noise = _noise_variance(pairs.value, steady, label, smooth)
    else:
        noise = noise_sd**2
    # A few long waves would say of the peaks and cycles of all what is lost between readings.
    fast = (samples >= PEAK_SAMPLES) & (np.median(samples) >= PEAK_SAMPLES)
    own = variance - noise
    whole &= (own > LEAST_SIGNAL * noise) & (own > 0.0)
    whole &= np.isfinite(metocean.table).all(axis=1) & (metocean.hs > 0.0)
    if not whole.any():
        return None
    largest = np.maximum.reduceat(_parabolic(pairs.value, steady), first)
    damage = np.full(len(number), np.nan)
    if math.isfinite(tn_slope):
        for row in np.flatnonzero(whole & fast):
            values = pairs.value[first[row] : first[row] + count[row], None]
            damage[row] = damage_equivalent_load([values], np.array([tn_slope]), every=every)[0]
    return Windows(
        number=number,
        metocean=metocean,
        mean=mean + shift,
        std=np.sqrt(np.maximum(own, 0.0)),
        maximum=np.where(fast, largest, np.nan),
        damage=damage,
        every_s=every,
        noise_sd=math.sqrt(noise),
    ).rows(whole)


def _stuck(value: Float[np.ndarray, " reading"]) -> Bool[np.ndarray, " reading"]:
    """Readings that repeat the one before them, ten and more in a row."""
    changed = np.flatnonzero(np.concatenate([[True], np.diff(value) != 0.0, [True]]))
    return np.repeat(np.diff(changed) > MOST_ALIKE, np.diff(changed))


def _noise_variance(
    value: Float[np.ndarray, " reading"],
    steady: Bool[np.ndarray, " reading"],
    label: Int[np.ndarray, " reading"],
    smooth: Int[np.ndarray, " window"],  # whole windows in waves that are slow for the sensor
) -> float:
    """Least variance of third differences of any window, as the waves only add to it.

    0 of a sensor that is too slow to tell its noise from waves. The third differences of white
    noise have 20 times its variance.
    """
    third = np.diff(value, 3)
    even = steady[1:-2] & steady[2:-1] & steady[3:] & (label[3:] == label[:-3])
    even &= np.isin(label[3:], smooth)
    if not even.any():
        return 0.0
    (square,) = block_means(label[3:][even], third[even] ** 2 / 20.0)[1]
    return float(square.min())


def _parabolic(
    value: Float[np.ndarray, " reading"], steady: Bool[np.ndarray, " reading"]
) -> Float[np.ndarray, " reading"]:
    """Readings, those that are peaks raised to the top of the parabola through three of them."""
    before, here, after = value[:-2], value[1:-1], value[2:]
    bend = 2.0 * here - before - after
    peak = (here >= before) & (here >= after) & (bend > 0.0) & steady[1:-1] & steady[2:]
    raised = value.copy()
    raised[1:-1][peak] += (after - before)[peak] ** 2 / (8.0 * bend[peak])
    return raised
