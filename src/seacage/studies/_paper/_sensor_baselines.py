"""Simple baselines beside level 2 of each sensor, from the readings that it learns from."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import Extension, InputError, Origin, call_extension, load_extension
from seacage.records import FieldRecord
from seacage.studies._interval import Interval, by_day
from seacage.studies._paper._boosted_trees import predict_by_trees
from seacage.studies._sensor_scores import MEAN_S, PEOPLE
from seacage.studies._split import unseen
from seacage.surrogates import AR1, GaussianProcess, Prediction
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
    twin: Twin,
    teaching: FieldRecord,
    held_out: FieldRecord,
    training: Training,
    learners: Sequence[Extension] = (),
) -> Iterator[BaselineScore]:
    """Score the twin, the baselines and other learners at each sensor that has level 2."""
    for name in (one for one in twin.models.upper if one in held_out.sensors):
        after = align(held_out, name, mean_s=MEAN_S, travel_time=twin.travel_time)
        after = after.rows(after.metocean.known(twin.models.inputs))
        answer = twin.predict(after.metocean)
        column = answer.sensor_names.index(name)
        unit, factor = PEOPLE[answer.sensor_units[column]]
        found = {TWIN: answer.sensor.mean[:, column]}
        given = twin, teaching, name, after.metocean, training
        others = predict_by_sensor_baselines(*given, learners=learners)
        found |= {one: each.mean for one, each in others.items()}
        error = {one: factor * np.abs(each - after.value) for one, each in found.items()}
        over = {one: error[one] - error[TWIN] for one in error if one != TWIN}
        day, seed = after.time.astype("datetime64[D]"), training.seed
        yield BaselineScore(
            sensor=name,
            unit=unit,
            origin=held_out.origin,
            mae={one: float(each.mean()) for one, each in error.items()},
            gain={one: by_day(each, day, seed=seed) for one, each in over.items()},
        )


def score_surrogate(twin: Twin, field: FieldRecord, surrogate: str) -> tuple[BaselineScore, ...]:
    """Score a surrogate of another package, and the baselines, beside a twin's level 2.

    It is fitted to the readings of the twin's training windows, and scored on later days.

    ``twin``: with level 2. ``field``: the record that it was trained on.
    ``surrogate``: name of the entry point.

    Raises InputError: no such surrogate, or no reading to fit it to or to score it on.
    """
    found = load_extension("surrogates", surrogate, Callable)
    windows = twin.provenance.training_windows
    training = Training(
        inputs=twin.models.inputs,
        high_fidelity_points=max((one.points for one in windows.values()), default=0),
        seed=twin.provenance.seed,
    )
    held_out = unseen(field, windows)
    scores = tuple(score_sensor_baselines(twin, field, held_out, training, [found]))
    if not scores:
        raise InputError(
            "score: the twin has level 2 of no sensor of the record, so nothing can be scored "
            "beside it. Train the twin on a record of sensors."
        )
    return scores


def predict_by_sensor_baselines(
    twin: Twin,
    teaching: FieldRecord,
    name: str,
    water: Metocean,
    training: Training,
    *,
    learners: Sequence[Extension] = (),
    trees: Callable[..., Float[np.ndarray, " row"]] | None = predict_by_trees,
) -> dict[str, Prediction]:
    """Baselines' predictions of a sensor's readings, by name [N] or [m]; NaN where no sd is known.

    A Gaussian process of the water alone, AR1 on level 1, least squares on (level 1, u, u^2,
    harmonics), and boosted trees of the water.

    ``teaching``, ``training``: the record and the settings that the twin was trained with.
    ``trees``: of features, values and other features; None leaves trees out.
    """
    window = twin.provenance.training_windows.get(name)
    pairs = align(
        teaching,
        name,
        start=window and window.start,
        end=window and window.end,
        mean_s=training.mean_s,
        travel_time=twin.travel_time,
    )
    pairs = training.select(pairs.rows(pairs.metocean.known(twin.models.inputs)))
    x, there = (one.features(twin.models.inputs) for one in (pairs.metocean, water))
    lower, restarts, value = twin.models.lower(name), training.restarts, pairs.value
    low, at_low = (lower.predict(one).mean for one in (x, there))
    line, at_line = _columns(low, x), _columns(at_low, there)
    ar1 = AR1(restarts=restarts).fit([(x, value)], seed=training.seed, lower=lower)
    alone = GaussianProcess(restarts=restarts).fit(x, value, seed=training.seed)
    found = [
        alone.predict(there, noisy=True),
        ar1.predict(there, noisy=True),
        _without_sd(at_line @ np.linalg.lstsq(line, value, rcond=None)[0]),
        *([_without_sd(trees(x, value, there))] if trees else []),
    ]
    given, at = (np.column_stack([x, low]), value, training.seed), np.column_stack([there, at_low])
    theirs = {one.title: call_extension(one.title, _predict_by, one, given, at) for one in learners}
    return {**dict(zip(SENSOR_BASELINES, found, strict=False)), **theirs}


def _without_sd(mean: Float[np.ndarray, " row"]) -> Prediction:
    return Prediction(mean=mean, std=np.full_like(mean, np.nan))


def _predict_by(
    learner: Extension,
    given: tuple[np.ndarray, np.ndarray, int],
    at: Float[np.ndarray, "row feature"],
) -> Prediction:
    """Prediction by a surrogate of another package, whose last feature is level 1."""
    found = learner.value(*given).predict(at, noisy=True)
    mean, std = (np.asarray_chkfinite(one).reshape(len(at)) for one in (found.mean, found.std))
    return Prediction(mean=mean, std=std)


def _columns(
    low: Float[np.ndarray, " row"], x: Float[np.ndarray, "row feature"]
) -> Float[np.ndarray, "row column"]:
    """One, level 1, and a quadratic of the current with its harmonics."""
    speed, east, north = x[:, :3].T
    squares = speed**2, east**2 - north**2, 2.0 * east * north
    return np.column_stack([np.ones(len(x)), low, speed, east, north, *squares])
