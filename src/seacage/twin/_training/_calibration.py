"""Calibration of level-2 intervals: by a sensor's held-out readings, or by those of others."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from seacage.surrogates import Prediction, conformal_factor, variance_components
from seacage.twin._correction import DAY, LEAST_SHARE, Correction, Spread
from seacage.twin._pairs import Pairs
from seacage.twin._training._data import CageTraining
from seacage.twin._training._held_out import (
    HeldOut,
    cross_validate,
    independent_count,
    outside,
    span_s,
    stretch_rows,
    thin,
    white_noise,
)

SHORT = 2.0 * DAY  # a training window shorter than this is calibrated by other sensors [s]
LEAST_REFERENCE_PAIRS = 20  # readings of another sensor within a short training window


def calibrate(model: Correction, training: CageTraining, sensor: str) -> Correction:
    """Calibrate the intervals of a sensor's level 2."""
    pairs = training.sensors[sensor].pairs
    model = _with_white_noise(model, training, pairs)
    references = _references(training, pairs) if span_s(pairs) < SHORT else []
    if references:
        others = [_reference_errors(training, name, pairs) for name in references]
        days = sum(_days_outside(training.sensors[name].pairs, pairs) for name in references)
        return replace(model, spread=spread_by_others(model, others, days))
    count = independent_count(pairs)
    if count < 2:
        return model
    held_out = thin(pairs)
    x, selected = training.features(held_out), training.sensors[sensor].selected
    mean, variance = cross_validate(model, selected, held_out, x)
    column = training.models.cage.sensor_names.index(sensor)
    errors = HeldOut(
        error=held_out.value - mean,
        variance=variance,
        steepness=model.gain * training.models.steepness(held_out.metocean)[:, column],
        white=model.spread.white,
    )
    return replace(model, spread=own_spread(model, errors, count))


def own_spread(model: Correction, errors: HeldOut, independent: int) -> Spread:
    """Calibrate by a sensor's own readings, each predicted without its part of the window.

    Two variances are fitted to the squared errors, each as large as it has to be: the model's
    own, scaled, and that of the current which the buoy did not measure. Both are then scaled so
    that the intervals have their coverage, and a little more where the readings are few.

    ``model``: fitted to the whole window.
    ``errors``: of held-out readings.
    ``independent``: number of independent readings among them.
    """
    terms = np.column_stack([errors.variance, errors.steepness**2])
    # Some are below 0, as the noise is known on average alone.
    square = errors.error**2 - errors.white
    scale2, water2 = variance_components(terms, square).tolist()
    # A twin that is as good as its sensors can be is still not perfect.
    least = LEAST_SHARE * float(np.mean(errors.error**2)) / float(np.mean(errors.variance))
    scale2 = max(scale2, least) if water2 == 0.0 else scale2
    fitted = replace(model.spread, scale=math.sqrt(scale2), water_sd=math.sqrt(water2), by="own")
    factor = conformal_factor(errors.scores(fitted), independent=max(independent, 2))
    return replace(fitted, scale=fitted.scale * factor, water_sd=fitted.water_sd * factor)


def spread_by_others(model: Correction, others: Sequence[HeldOut], days: float) -> Spread:
    """Calibrate a short training window by the held-out errors of other sensors.

    Each of the others is fitted within the short window, and predicts its readings on its other
    days. Its calibration factor is taken to be alike for all sensors of a cage, because it comes
    from what the window lacks: other currents, and a net that gets fouled.

    ``model``: fitted to the short window.
    ``others``: held-out readings of each of the others.
    ``days``: of these readings, all sensors together.
    """
    plain = Spread()
    independent = max(days, 2.0)
    factors = [conformal_factor(one.scores(plain), independent=independent) for one in others]
    return replace(model.spread, scale=float(np.mean(factors)), by="carried")


def _with_white_noise(model: Correction, training: CageTraining, pairs: Pairs) -> Correction:
    """Return a model with the variance of its instrument's noise."""
    rows = pairs.rows(stretch_rows(len(pairs)))
    x = training.features(rows)
    error = rows.value - model.latent(x, model.rest.lower.predict(x)).mean
    return replace(model, spread=replace(model.spread, white=white_noise(error, rows.time)))


def _reference_errors(training: CageTraining, sensor: str, short: Pairs) -> HeldOut:
    """Return held-out readings of a sensor, by a model fitted within a short window."""
    first, last = (
        round(one.astype("datetime64[s]").astype(int) / 3600) for one in short.time[[0, -1]]
    )
    key = sensor, first, last
    if key not in training.held_out:
        pairs = training.sensors[sensor].pairs
        within = _within(pairs, short)
        model = training.fit(sensor, training.training.select(within))
        model = _with_white_noise(model, training, within)
        held_out = thin(outside(pairs, short))
        low = model.rest.lower.predict(training.features(held_out))
        column = Prediction(mean=low.mean[:, None], std=low.std[:, None])
        latent = training.models.with_level_2(sensor, model).level_2(
            held_out.metocean, column, np.zeros_like(column.mean)
        )
        training.held_out[key] = HeldOut(
            error=held_out.value - latent.mean[:, 0],
            variance=latent.std[:, 0] ** 2,
            steepness=np.zeros(len(held_out)),
            white=model.spread.white,
        )
    return training.held_out[key]


def _references(training: CageTraining, short: Pairs) -> list[str]:
    """Name the sensors with readings in a short training window, and on a day at least beside."""
    return [
        name
        for name, one in training.sensors.items()
        if one.calibrates
        and span_s(one.pairs) >= SHORT
        and len(_within(one.pairs, short)) >= LEAST_REFERENCE_PAIRS
        and _days_outside(one.pairs, short) >= 1.0
    ]


def _within(pairs: Pairs, short: Pairs) -> Pairs:
    return pairs.rows((pairs.time >= short.time[0]) & (pairs.time <= short.time[-1]))


def _days_outside(pairs: Pairs, short: Pairs) -> float:
    """Days of a sensor's readings that are outside a short training window."""
    left = outside(pairs, short)
    return 0.0 if len(left) == 0 else (span_s(pairs) - span_s(short)) / DAY - 1.0
