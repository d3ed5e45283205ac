"""Level 2 of one sensor: a line through level 1, and a NARGP of what the line leaves."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, Self

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import InputError
from seacage.surrogates import (
    NARGP,
    BatchedLevels,
    Domain,
    FittedNARGP,
    Folds,
    ModelAverage,
    ModelName,
    Prediction,
    Predicts,
    is_gain,
    log_density,
    pseudo_bma,
)
from seacage.twin._correction._window_edge import WindowEdge
from seacage.twin._metocean import Metocean
from seacage.twin._pairs import Pairs

CaseSensor = Float[np.ndarray, "case *sensor"]
PerPair = Float[np.ndarray, " pair"]

GAIN_SD = 0.5  # how far from 1 a gain is expected: the simulations may be half wrong, seldom more
HOUR = 3_600_000_000  # [us]

# Least share of the fitted noise variance that is the cage's and not the instrument's. Where errors
# are as small as the instrument's noise, they cannot be told apart; too wide is better.
LEAST_SHARE = 0.5

# Models of what a gain leaves, which are averaged (decision 76)
REST_MODELS: tuple[ModelName, ...] = ("nargp", "ar1", "regression")
# Blocks of readings that are held out to weigh them [s]: days where there are four, else two hours
# without the half hour on either side
DAY, TWO_HOURS = 86400.0, (7200.0, 1800.0)
LEAST_DAYS, LEAST_BLOCKS = 4, 2
HALF_TIDE = 22357.0  # [s] whose readings are worth a single independent one
# Of a window's speeds, beyond which readings are held out to see how far level 2 carries; and how
# many there have to be
SLOWER_SHARE, LEAST_FASTER = 0.75, 10
MOST_ROWS = 100  # of the training water, where level 2 is compared with level 1

Features = Float[np.ndarray, "case feature"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FixedPrediction:
    """A level's prediction made before, so that many sensors share it."""

    prediction: Prediction

    def predict(self, _: Features, /) -> Prediction:
        """Return the prediction."""
        return self.prediction


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """Calibration of level 2's standard deviations, by held-out readings."""

    scale: float = 1.0  # calibration factor of the model's own standard deviation [-]
    # Standard deviation of each component of the current at the cage that the buoy does not measure
    # [m/s]: eddies on the way, and the time it takes. It counts where level 1 is steep.
    water_sd: float = 0.0
    # Variance of the instrument's own noise [N2] or [m2], which the truth does not have
    white: float = 0.0
    # "own" readings, "carried" from sensors with longer windows, or "none"
    by: Literal["own", "carried", "none"] = "none"

    def __post_init__(self) -> None:
        if not all(0.0 <= one < math.inf for one in (self.scale, self.water_sd, self.white)):
            raise InputError(
                f"Spread: scale = {self.scale:g}, water_sd = {self.water_sd:g} m/s and white = "
                f"{self.white:g} are no spreads. Give numbers of at least 0."
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class Correction:
    """Level 2 of a sensor: its reading, from the water and the prediction of level 1.

    A NARGP alone returns to the mean of its training data in water unlike that of the window. A
    shackle's is half a day, so that its correction extrapolates: the gain does, and an average of
    NARGP, AR1 and a linear regression is fitted to the rest. That is averaged with level 1. Weights
    follow how probable each finds held-out blocks of readings; minutes have none, and NARGP alone.
    """

    gain: float  # change of the reading per change of level 1 [-]
    weight: float = 1.0  # of this against level 1 as it is [-]
    rest: FittedNARGP  # of the reading less gain times level 1 [N] or [m]; its own level 1 is lent
    spread: Spread = Spread()  # calibration of the standard deviation
    # Of the training window, and how it goes on beyond it
    edge: WindowEdge = field(default_factory=WindowEdge)

    @classmethod
    def fit(cls, pairs: Pairs, x: Features, lower: Predicts, *, restarts: int, seed: int) -> Self:
        """Fit to readings and the features of the water at their times."""
        low = lower.predict(x).mean
        gain = fit_gain(low, pairs.value, pairs.time)
        above = pairs.value - gain * low
        folds = time_folds(pairs.time)
        if len(folds.each()) < LEAST_BLOCKS:
            rest = NARGP(restarts=restarts).fit([(x, above)], seed=seed, lower=lower)
            return cls(gain=gain, rest=rest)
        average = ModelAverage(models=REST_MODELS, restarts=restarts)
        rest = average.fit([(x, above)], seed=seed, lower=lower, folds=folds)
        error = np.concatenate([(pairs.value - low)[out] for out, _ in folds.each()])
        alone = log_density(error, np.zeros_like(error), np.full_like(error, np.mean(error**2)))
        density = np.stack([rest.fold_density(above, folds), alone])
        level_2, level_1 = pseudo_bma(density, folds.independent).tolist()
        # Beforehand level 1 counts as much as each model of the average.
        return cls(gain=gain, weight=level_2 / (level_2 + level_1 / len(REST_MODELS)), rest=rest)

    def beats_level_1(self, pairs: Pairs, low: PerPair) -> bool:
        """Whether it predicts its training readings better than level 1, and not by chance.

        Each reading is left out in turn. Readings within an hour share their error and count
        as one. A model fitted to noise alone seldom passes, and would only add noise.

        ``pairs``: the training readings. ``low``: level 1 at them [N] or [m].
        """
        (rest,) = self.rest.upper
        above = (self.gain - 1.0) * low + np.ravel(rest.leave_one_out().mean)
        left_out = low + self.weight * above
        better = np.abs(pairs.value - low) - np.abs(pairs.value - left_out)
        hours = _hours(pairs.time)
        if len(np.unique(hours)) < 2:
            return True  # no second hour to compare; the caller wants a minimum of readings
        return is_gain(better, hours)

    def updated(self, pairs: Pairs, x: Features) -> Self:
        """Condition on more readings; gain, hyperparameters, spread and level 1 stay."""
        below = self.rest.lower.predict(x).mean
        rest = self.rest.updated(x, pairs.value - self.gain * below)
        return replace(self, rest=rest, edge=self.edge.reaching(pairs.metocean))

    def with_edge(self, pairs: Pairs, features: Callable[[Metocean], Features]) -> Self:
        """Weigh both ways beyond the window on the fastest quarter of its readings, held out.

        Hyperparameters, gain and weight stay those of the whole window.

        ``pairs``: the training readings, in this model's order. ``features``: of their water.
        """
        speed = np.linalg.norm(pairs.metocean.current_velocity, axis=1)
        slower = float(np.quantile(speed, SLOWER_SHARE))
        out, (whole,) = speed > slower, self.rest.upper
        if out.sum() < LEAST_FASTER:
            return replace(self, edge=WindowEdge(speed=float(speed.max())))
        reduced = replace(self, rest=replace(self.rest, own=(whole.kept(~out),)))
        fast = pairs.rows(out)
        at_edge = fast.metocean.limited(current_speed=slower, hs=math.inf)
        low, low_edge = (self.rest.lower.predict(features(w)) for w in (fast.metocean, at_edge))
        own = reduced.latent(features(fast.metocean), low).mean
        following = reduced.latent(features(at_edge), low_edge).mean + low.mean - low_edge.mean
        errors = (float(np.mean((fast.value - one) ** 2)) for one in (own, following))
        return replace(self, edge=WindowEdge.weighed(float(speed.max()), *errors))

    @cached_property
    def domain(self) -> Domain:
        """Of the features of the water that trained it."""
        return Domain.of(self.rest.upper[-1].cases()[:, :-1])

    @property
    def some_features(self) -> Features:
        """Every so many-th of the features of that water, ``MOST_ROWS`` at most."""
        x = self.rest.upper[-1].cases()[:, :-1]
        return x[:: -(-len(x) // MOST_ROWS)]

    @cached_property
    def alone(self) -> "Corrections":
        """The same, as one of several."""
        return Corrections.of([self])

    @cached_property
    def own(self) -> float:
        """Variance of the cage's response that the water does not explain [N2] or [m2].

        This is the fitted noise less the instrument's share, which is at most half of it.
        """
        found = float(self.rest.upper[-1].noise[0])
        return max(found - self.spread.white, LEAST_SHARE * found)

    def latent(self, x: Features, low: Prediction) -> Prediction:
        """Predict a reading without the instrument's noise, given level 1.

        The current that the buoy does not measure is left out of the standard deviation.

        ``x``: features of the water. ``low``: level 1 there.
        """
        column = Prediction(mean=low.mean[:, None], std=low.std[:, None])
        latent = self.alone.latent(x, column, np.zeros_like(column.mean))
        return Prediction(mean=latent.mean[:, 0], std=latent.std[:, 0])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Corrections:
    """Level 2 of several sensors, predicted at once."""

    rest: BatchedLevels  # of each, beside the gain
    # Of each ``Correction`` and its ``Spread``
    gain: Float[np.ndarray, " sensor"]
    weight: Float[np.ndarray, " sensor"]
    own: Float[np.ndarray, " sensor"]
    scale: Float[np.ndarray, " sensor"]
    water_sd: Float[np.ndarray, " sensor"]
    noise: Float[np.ndarray, " sensor"]
    # Of each ``WindowEdge``
    edge_speed: Float[np.ndarray, " sensor"]
    edge_weight: Float[np.ndarray, " sensor"]

    @classmethod
    def of(cls, models: Sequence[Correction]) -> Self:
        """Put together."""
        return cls(
            rest=BatchedLevels.of([level for model in models for level in model.rest.upper]),
            gain=np.array([model.gain for model in models]),
            weight=np.array([model.weight for model in models]),
            own=np.array([model.own for model in models]),
            scale=np.array([model.spread.scale for model in models]),
            water_sd=np.array([model.spread.water_sd for model in models]),
            noise=np.array([model.spread.white for model in models]),
            edge_speed=np.array([model.edge.speed for model in models]),
            edge_weight=np.array([model.edge.weight for model in models]),
        )

    def latent(
        self,
        x: Features,  # features of the water
        low: Prediction,  # level 1 there, (case, sensor)
        # Of level 1: length of its gradient over the current [N s/m] or [s]
        steepness: Float[np.ndarray, "case sensor"],
    ) -> Prediction:
        """Predict each sensor's reading without the instrument's noise, given level 1.

        The scatter that the water does not explain is not left out, as it is the cage's own.
        The line's and the NARGP's shares of level 1's small variance are taken as independent.
        """
        mean, own = self.raw_moments(self.rest.predict(x, low), low)
        variance = self.scale**2 * own + (self.gain * steepness * self.water_sd) ** 2
        return Prediction(mean=mean, std=np.sqrt(variance))

    def raw_moments(self, rest: Prediction, low: Prediction) -> tuple[CaseSensor, CaseSensor]:
        """Mean and variance of readings without the instrument's noise, before calibration.

        ``rest``: what level 1 and the gain leave, (case, sensor).
        ``low``: level 1 there.
        """
        above = rest.mean + (self.gain - 1.0) * low.mean
        own = rest.std**2 + (self.gain * low.std) ** 2 + self.own
        # Of a mixture with level 1 as it is, which is taken to scatter as much.
        between = self.weight * (1.0 - self.weight) * above**2
        return low.mean + self.weight * above, own + between


def time_folds(time: Shaped[np.ndarray, " pair"]) -> Folds:
    """Whole days, held out in turn, or blocks of two hours where there are not four days."""
    second = time.astype("datetime64[us]").astype(np.int64) / 1e6
    length, gap = (DAY, 0.0) if np.ptp(second) >= LEAST_DAYS * DAY else TWO_HOURS
    return Folds.of_time(second, length=length, gap=gap, memory=HALF_TIDE)


def fit_gain(low: PerPair, value: PerPair, time: Shaped[np.ndarray, " pair"]) -> float:
    """Slope of readings over level 1, drawn towards 1 where the readings say little of it.

    Readings within an hour share their error, and weigh as one against the expectation.

    Source: Bayesian linear regression with a Gaussian prior, Rasmussen & Williams (2006), eq.
    (2.8).
    """
    variance = float(np.var(low))
    if variance == 0.0:
        return 1.0
    above = value - low
    slope = float(np.mean((low - np.mean(low)) * above)) / variance
    left = float(np.var(above - slope * low))
    hours = len(np.unique(_hours(time)))
    return 1.0 + slope * variance / (variance + left / (hours * GAIN_SD**2))


def _hours(time: Shaped[np.ndarray, " pair"]) -> Shaped[np.ndarray, " pair"]:
    return time.astype("datetime64[us]").astype(np.int64) // HOUR
