"""Level 2 of a shackled line's loads in waves: level 1 times what its windows asked for."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.surrogates import LoadPrediction, LoadRatio, Loads, Prediction
from seacage.twin._metocean import Metocean

LEAST_HS = 0.05  # below which the logarithm of Hs counts as here [m]


@dataclass(frozen=True, slots=True, kw_only=True)
class LineCorrection:
    """Level 2 of one line, each part only where held-out windows show a gain."""

    every_s: float  # between the shackle's readings [s]
    # Readings per peak period in the training windows, at the median [-]. Of fewer than four
    # neither the largest load nor the damage-equivalent load has a factor of its own.
    peak_samples: float
    windows: int  # number of training windows of ten minutes
    mean: bool  # whether the mean is that of the shackle's level 2
    std: LoadRatio  # of the standard deviation to level 1's
    # Standard deviation of a window's log standard deviation about the prediction; None where too
    # few held-out windows show it [-]
    std_log_sd: float | None
    # Factors on level 1's peak factor, and on its damage-equivalent load over its standard
    # deviation; None where that load stays level 1's [-]
    peak: float | None
    damage: float | None
    # Standard deviation of the largest load's logarithm, above the mean, that is not the waves';
    # None as above [-]
    maximum_log_sd: float | None

    @property
    def rate(self) -> str:
        """How often the shackle is read, in words."""
        return f"a reading every {self.every_s:g} s, {self.peak_samples:.1f} per peak period"


def load_variables(
    water: Metocean, std: Float[np.ndarray, " case"]
) -> dict[str, Float[np.ndarray, " case"]]:
    """Variables that a line's ratio may depend on, by their names.

    ``std``: the line's standard deviation by level 1 [N]. Over Hs it says how slack the line is.
    """
    log_hs = np.log(np.maximum(water.hs, LEAST_HS))
    return {
        "speed": np.linalg.norm(water.current_velocity, axis=1),
        "log_hs": log_hs,
        "log_std_over_hs": np.log(np.maximum(std, 1.0)) - log_hs,
    }


def correct_lines(
    loads: Loads, corrections: Mapping[int, LineCorrection], water: Metocean, mean: Prediction
) -> Loads:
    """Loads with level 2 of the lines that have it.

    ``loads``: level 1 of all lines. ``corrections``: by the line's number. ``water``: of each row.
    ``mean``: of the bridles by their best level, which are the first lines [N].
    """
    low, std = loads.mean, loads.std.mean
    lines, own = low.mean.shape[1], list(corrections)
    log_ratio = np.zeros_like(low.mean)
    for line, one in corrections.items():
        log_ratio[:, line] = one.std.log(load_variables(water, std[:, line]), len(water))

    def of_lines(name: str) -> Float[np.ndarray, " line"]:
        values = np.full(lines, np.nan)
        values[own] = [getattr(one, name) for one in corrections.values()]
        return values

    def scale(load: LoadPrediction, factor: str | None, log_sd: str | None) -> LoadPrediction:
        ratio, sd = np.exp(log_ratio), load.log_std.copy()
        if factor is not None:
            ratio = np.where(np.isnan(of_lines(factor)), 1.0, ratio * of_lines(factor))
        if log_sd is not None:
            sd[:, own] = of_lines(log_sd)[own]
        above = ratio * np.maximum(load.size - load.offset, 0.0) + load.offset
        # The ratio is of means, which an interval of whatever width leaves where they are.
        return replace(load, size=above * np.exp(-0.5 * np.nan_to_num(sd) ** 2), log_std=sd)

    taken = [line for line, one in corrections.items() if one.mean]
    best = Prediction(mean=low.mean.copy(), std=low.std.copy())
    best.mean[:, taken], best.std[:, taken] = mean.mean[:, taken], mean.std[:, taken]
    best.mean[np.isnan(low.mean)] = best.std[np.isnan(low.mean)] = np.nan
    return Loads(
        mean=best,
        std=scale(loads.std, None, "std_log_sd"),
        maximum_3h=replace(
            scale(loads.maximum_3h, "peak", "maximum_log_sd"), base=best.mean.copy()
        ),
        damage_equivalent=scale(loads.damage_equivalent, "damage", None),
    )
