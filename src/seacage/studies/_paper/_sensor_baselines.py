"""A sceptic's baselines beside level 2 of each sensor, from the readings that it learns from."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.records import FieldRecord
from seacage.studies._interval import Interval, by_day
from seacage.studies._paper._boosted_trees import predict_by_trees
from seacage.studies._sensor_scores import MEAN_S, PEOPLE
from seacage.surrogates import AR1, GaussianProcess
from seacage.twin import Metocean, Training, Twin, align

TWIN = "twin"
SENSOR_BASELINES = ("sensor alone", "AR1", "linear", "boosted trees")


@dataclass(frozen=True, slots=True, kw_only=True)
class BaselineScore:
    """Mean absolute errors of one sensor's ten-minute means on days not trained on [unit]."""

    sensor: str
    unit: str
    origin: Origin
    mae: Mapping[str, float]  # of the twin and of each baseline
    gain: Mapping[str, Interval]  # error of each baseline less that of the twin


def score_sensor_baselines(
    twin: Twin, teaching: FieldRecord, held_out: FieldRecord, training: Training
) -> Iterator[BaselineScore]:
    """Score the twin and the baselines at each sensor that has level 2."""
    for name in twin.models.upper:
        after = align(held_out, name, mean_s=MEAN_S, travel_time=twin.travel_time)
        answer = twin.predict(after.metocean)
        column = answer.sensor_names.index(name)
        unit, factor = PEOPLE[answer.sensor_units[column]]
        found = {TWIN: answer.sensor.mean[:, column]}
        found |= predict_by_sensor_baselines(twin, teaching, name, after.metocean, training)
        error = {one: factor * np.abs(each - after.value) for one, each in found.items()}
        over = {one: error[one] - error[TWIN] for one in SENSOR_BASELINES}
        day, seed = after.time.astype("datetime64[D]"), training.seed
        yield BaselineScore(
            sensor=name,
            unit=unit,
            origin=held_out.origin,
            mae={one: float(each.mean()) for one, each in error.items()},
            gain={one: by_day(each, day, seed=seed) for one, each in over.items()},
        )


def predict_by_sensor_baselines(
    twin: Twin, teaching: FieldRecord, name: str, water: Metocean, training: Training
) -> dict[str, Float[np.ndarray, " row"]]:
    """Baselines' predictions of a sensor with level 2, by name [N] or [m].

    A Gaussian process of the water alone, AR1 on level 1, least squares on (level 1, u, u^2,
    harmonics), and boosted trees of the water.

    ``teaching``, ``training``: the record and the settings that the twin was trained with.
    """
    window = twin.provenance.training_windows[name]
    pairs = align(
        teaching,
        name,
        start=window.start,
        end=window.end,
        mean_s=training.mean_s,
        travel_time=twin.travel_time,
    )
    pairs = training.select(pairs)
    x, there = (one.features(twin.models.inputs) for one in (pairs.metocean, water))
    lower, restarts, value = twin.models.lower(name), training.restarts, pairs.value
    line, at_line = (_columns(lower.predict(one).mean, one) for one in (x, there))
    ar1 = AR1(restarts=restarts).fit([(x, value)], seed=training.seed, lower=lower)
    found = (
        GaussianProcess(restarts=restarts).fit(x, value, seed=training.seed).predict(there).mean,
        ar1.predict(there).mean,
        at_line @ np.linalg.lstsq(line, value, rcond=None)[0],
        predict_by_trees(x, value, there),
    )
    return dict(zip(SENSOR_BASELINES, found, strict=True))


def _columns(
    low: Float[np.ndarray, " row"], x: Float[np.ndarray, "row feature"]
) -> Float[np.ndarray, "row column"]:
    """One, level 1, and a quadratic of the current with its harmonics."""
    speed, east, north = x[:, :3].T
    squares = speed**2, east**2 - north**2, 2.0 * east * north
    return np.column_stack([np.ones(len(x)), low, speed, east, north, *squares])
