"""Discrepancy of bridles' simulated loads in waves, from the windows of those with a shackle."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from seacage.surrogates import LoadPrediction, Loads
from seacage.twin._correction._bridles import LEAST_SHACKLES, load_scale, mean_square, pool

Series = Float[np.ndarray, " window"]

LEAST_WINDOWS = 6  # of a shackle: an hour
# Root mean square errors over the development truths, which count as so many shackles (decision 96)
EXPECTED_STD, EXPECTED_MAXIMUM, EXPECTED_WEIGHT = 0.43, 0.57, 5.0
# Standard deviation over the root mean square, so that 1.96 of it hold 95 % of those cages' loads:
# windows of half a day meet fewer seas than an interval has to hold
STD_CALIBRATION, MAXIMUM_CALIBRATION = 1.25, 1.05


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
        std=pool([one.std**2 for one in errors], EXPECTED_STD, EXPECTED_WEIGHT),
        maximum=pool([one.maximum**2 for one in errors], EXPECTED_MAXIMUM, EXPECTED_WEIGHT),
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
