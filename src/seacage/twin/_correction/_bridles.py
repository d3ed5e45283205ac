"""Discrepancy of the simulated loads of bridles without a shackle, from those that have one.

Of the mean load by level 2 of the shackles; of loads in waves by their windows.
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from seacage.surrogates import LoadPrediction, Loads, Prediction, Predicts
from seacage.twin._correction._sensor import Correction

PerLine = Float[np.ndarray, "case line"]
Series = Float[np.ndarray, " window"]

LEAST_SHACKLES = 3  # with a calibrated level 2: of fewer, how much they differ is not known
LEAST_SCALE = 0.1  # least scale of a load over the mean of its line's [-]

# Of what a line's error is measured in, the share that is the mean load of all bridles and not its
# own: where one hangs slack in the simulation, another bears the more [-]
SHARED = 0.3
# Root mean square over the development truths (decision 74), which counts as so many shackles
EXPECTED, EXPECTED_WEIGHT = 0.95, 2.0
# Standard deviation over the root mean square, so that 1.96 of it hold 95 % of those cages' loads
CALIBRATION = 1.06

# In waves:
LEAST_WINDOWS = 6  # of a shackle: an hour
# Root mean square errors over the development truths, which count as so many shackles (decision 96)
EXPECTED_STD, EXPECTED_MAXIMUM, WINDOWS_WEIGHT = 0.43, 0.57, 5.0
# Standard deviation over the root mean square, so that 1.96 of it hold 95 % of those cages' loads:
# windows of half a day meet fewer seas than an interval has to hold
STD_CALIBRATION, MAXIMUM_CALIBRATION = 1.25, 1.05


def relative_discrepancy(
    corrections: Sequence[tuple[int, Correction]], bridles: Predicts
) -> float | None:
    """Root mean square of level 2 less level 1, over the scale of the loads [-].

    A cage's lines are longer, tighter and more heavily loaded than drawn, each in its own way. How
    large such errors are is alike for all lines of a cage, and differs between cages. None where
    fewer than ``LEAST_SHACKLES`` have a calibrated level 2.

    ``corrections``: level 2 of each shackle, with the number of its bridle.
    ``bridles``: level 1 of all bridles.
    """
    known = [one for one in corrections if one[1].spread.by != "none"]
    if len(known) < LEAST_SHACKLES:
        return None
    squares = [_mean_square(line, model, bridles) for line, model in known]
    return pool(squares, EXPECTED, EXPECTED_WEIGHT)


def pool(squares: Sequence[float], expected: float, weight: float) -> float:
    """Root of the mean of squares, and of an expected one that counts as so many."""
    return math.sqrt((weight * expected**2 + sum(squares)) / (weight + len(squares)))


def discrepancy_std(low: Prediction, relative: float) -> PerLine:
    """Standard deviation of the true loads about level 1, with that of the emulator [N]."""
    return np.hypot(low.std, CALIBRATION * relative * load_scale(low.mean))


def _mean_square(line: int, model: Correction, bridles: Predicts) -> float:
    """Of one shackle, over the water that trained it."""
    x = model.some_features
    low = bridles.predict(x)
    own = Prediction(mean=low.mean[:, line], std=low.std[:, line])
    latent = model.latent(x, own)
    error = np.hypot(latent.mean - own.mean, latent.std)
    return mean_square(error, low.mean, line)


def mean_square(error: Float[np.ndarray, " case"], low: PerLine, line: int) -> float:
    """Mean square of a bridle's errors over the scale of its loads [-]."""
    scale = load_scale(low)[:, line]
    # Where all lines hang slack in the simulation, a newton is not many times nothing.
    scale = np.maximum(scale, max(LEAST_SCALE * float(np.mean(scale)), 1.0))
    return float(np.mean((error / scale) ** 2))


def load_scale(low: PerLine) -> PerLine:
    """Scale of each bridle's error: mostly its own load, partly the mean of all [N]."""
    load = np.maximum(low, 0.0)
    return (1.0 - SHARED) * load + SHARED * load.mean(axis=1, keepdims=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class WindowErrors:
    """Root mean square errors of level 1 in a shackle's windows, over the loads' scale [-]."""

    std: float  # of the standard deviation
    maximum: float  # of the largest load, by mean and standard deviation and level 1's peak factor

    @classmethod
    def of_windows(
        cls, low: Loads, line: int, bridles: int, *, mean: Series, std: Series, share: float
    ) -> "WindowErrors | None":
        """Errors at one line; None where the windows are fewer than ``LEAST_WINDOWS``.

        A shackle that is too slow for peaks has one too, as its peaks are not read.

        ``low``: level 1 at each window, the bridles first. ``mean``, ``std``: measured [N].
        ``share``: length of a window over the three hours of a largest load [-].
        """
        if len(mean) < LEAST_WINDOWS:
            return None
        largest = low.maximum_3h.of_share(share).mean[:, :bridles]
        scatter, above = low.std.mean[:, :bridles], largest - low.mean.mean[:, :bridles]
        measured = mean + above[:, line] * std / np.maximum(scatter[:, line], 1.0)
        return cls(
            std=math.sqrt(mean_square(std - scatter[:, line], scatter, line)),
            maximum=math.sqrt(mean_square(measured - largest[:, line], largest, line)),
        )


def relative_in_waves(errors: Collection[WindowErrors]) -> WindowErrors | None:
    """Relative errors of the bridles without a shackle; None where too few have one."""
    if len(errors) < LEAST_SHACKLES:
        return None
    return WindowErrors(
        std=pool([one.std**2 for one in errors], EXPECTED_STD, WINDOWS_WEIGHT),
        maximum=pool([one.maximum**2 for one in errors], EXPECTED_MAXIMUM, WINDOWS_WEIGHT),
    )


def with_discrepancy(
    loads: Loads,
    low: Loads,
    relative: WindowErrors,
    *,
    bridles: int,
    own_mean: Sequence[int],
    rows: Bool[np.ndarray, " case"],
) -> Loads:
    """Loads with the standard deviation of the bridles' true ones about them.

    It counts where level 2 has no interval. ``low``: level 1 of all lines, the bridles first.
    ``bridles``: how many. ``own_mean``: those whose mean is of level 2, from which the largest
    load is off by less; nobody has measured how much. ``rows``: those in which it is known.
    """
    scatter, largest = STD_CALIBRATION * relative.std, MAXIMUM_CALIBRATION * relative.maximum
    every = np.arange(bridles)

    def about(name: str, factor: float, lines: np.ndarray) -> LoadPrediction:
        mean = getattr(low, name).mean
        std, some = np.full(mean.shape, np.nan), np.ix_(rows, lines)
        std[some] = factor * load_scale(mean[:, :bridles])[some]
        return replace(getattr(loads, name), discrepancy=std)

    return replace(
        loads,
        std=about("std", scatter, every),
        maximum_3h=about("maximum_3h", largest, np.setdiff1d(every, own_mean)),
        damage_equivalent=about("damage_equivalent", scatter, every),
    )
