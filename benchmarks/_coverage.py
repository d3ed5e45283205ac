"""Whether a twin's intervals hold the noise-free truth, on days that did not teach."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int, Shaped

from seacage.conventions import InputError
from seacage.records import FieldRecord
from seacage.surrogates import (
    NARGP,
    AdaptiveConformal,
    Prediction,
    coverage,
    crps,
    mae,
)
from seacage.twin import Metocean, Training, Twin, align, spread_out

Series = Float[np.ndarray, " t"]

MOST_WORDS = 1500
"""Of the buoy, evenly over the unseen days; every reading and every truth under them counts."""

LEAST_LABELS = 100
"""Readings with which an online calibration is worth a score."""

_SI = {"tension_kn": 1000.0, "depth_m": 1.0}


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """How well one kind of interval held the truth.

    Parameters
    ----------
    count
        Truths.
    overall, thirds
        Share held by the 95 % interval [-]: of all, and of each third of the load or depth
        from low to high.
    crps
        Continuous ranked probability score [N] or [m].
    """

    count: int
    overall: float
    thirds: tuple[float, float, float]
    crps: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorCoverage:
    """One sensor of a virtual field against the truth behind it.

    Parameters
    ----------
    sensor
        Its name.
    calibrated
        On whose readings: "own", "carried" or "none".
    offline
        The twin's intervals as trained, on all unseen days.
    same_hours, online
        As trained, and as adapted to the readings before each, where there are readings; None
        where these are too few.
    plain, plain_noisy
        A NARGP alone on the same points, as it answers for what lies behind a reading, and with
        the noise that it found.
    published, published_noisy
        The same of a NARGP with the kernel as published.
    low_mae, multi_mae
        Mean absolute errors [N] or [m].
    """

    sensor: str
    calibrated: str
    offline: Held
    same_hours: Held | None
    online: Held | None
    plain: Held
    plain_noisy: Held
    published: Held
    published_noisy: Held
    low_mae: float
    multi_mae: float


def truth_coverage(
    twin: Twin, field: FieldRecord, truth: FieldRecord, *, training: Training, since_day: float
) -> tuple[SensorCoverage, ...]:
    """Hold a twin's intervals against the truth of a virtual field.

    The interval is that of what lies behind a reading, without the instrument's noise. Gain,
    bias and drift of an instrument are in every reading that taught, cannot be told from the
    cage, and count as the twin's error.

    Parameters
    ----------
    twin
        Trained on the field's first days.
    field
        Its readings are the labels of the online calibration.
    truth
        The same sensors without error and outages.
    training
        What the twin was trained with.
    since_day
        Of the field: judging begins there [d].
    """
    words, water = _judging_words(twin, field, since_day)
    answer = twin.predict(water)
    scores: list[SensorCoverage] = []
    for column, name in enumerate(twin.sensor_names):
        if name not in twin.models.upper:
            continue
        noise = twin.models.upper[name].spread.white
        predicted = Prediction(
            mean=answer.sensor.mean[:, column],
            std=np.sqrt(np.maximum(answer.sensor.std[:, column] ** 2 - noise, 0.0)),
        )
        time, true = _true(truth, name)
        word = _word_of(field, words, time)
        rows, kept = word[word >= 0], word >= 0
        scores.append(
            _scored(
                name,
                twin,
                predicted.mean[rows],
                predicted.std[rows],
                answer.sensor_low.mean[rows, column],
                true[kept],
                _alone(NARGP(restarts=training.restarts), twin, field, name, training, water, rows),
                _alone(
                    NARGP(linear=False, restarts=training.restarts),
                    twin,
                    field,
                    name,
                    training,
                    water,
                    rows,
                ),
                _read(field, name, time[kept]),
                noise,
            )
        )
    return tuple(scores)


def _scored(
    name: str,
    twin: Twin,
    mean: Series,
    std: Series,
    low: Series,
    true: Series,
    plain: tuple[Prediction, float],
    published: tuple[Prediction, float],
    reading: Series,
    noise: float,
) -> SensorCoverage:
    labelled = np.isfinite(reading)
    online = same = None
    if labelled.sum() >= LEAST_LABELS:
        score = np.abs(reading - mean)[labelled] / np.sqrt(std[labelled] ** 2 + noise)
        factor = AdaptiveConformal().followed(score)
        same = held(true[labelled], mean[labelled], std[labelled])
        online = held(true[labelled], mean[labelled], std[labelled] * factor)
    return SensorCoverage(
        sensor=name,
        calibrated=twin.provenance.training_windows[name].calibrated,
        offline=held(true, mean, std),
        same_hours=same,
        online=online,
        plain=_held_alone(true, plain, noisy=False),
        plain_noisy=_held_alone(true, plain, noisy=True),
        published=_held_alone(true, published, noisy=False),
        published_noisy=_held_alone(true, published, noisy=True),
        low_mae=mae(true, low),
        multi_mae=mae(true, mean),
    )


def held(truth: Series, mean: Series, std: Series) -> Held:
    """Score intervals, over all truths and in each third of them by size."""
    third = np.digitize(truth, np.quantile(truth, [1 / 3, 2 / 3]))
    shares = [
        coverage(truth[third == one], mean[third == one], std[third == one]) for one in range(3)
    ]
    return Held(
        count=len(truth),
        overall=coverage(truth, mean, std),
        thirds=(shares[0], shares[1], shares[2]),
        crps=crps(truth, mean, std),
    )


def _judging_words(
    twin: Twin, field: FieldRecord, since_day: float
) -> tuple[Int[np.ndarray, " word"], Metocean]:
    """Rows of the buoy that judge, and the water that they tell."""
    water = twin.travel_time.water_at(field.buoy, field.buoy.time)
    start = field.buoy.time[0].astype("datetime64[D]") + np.timedelta64(
        round(since_day * 86400), "s"
    )
    rows = np.flatnonzero((field.buoy.time >= start) & water.known(("current",)))
    if len(rows) < 2:
        raise InputError(
            f"coverage: {len(rows)} words of the buoy after day {since_day:g} are too few to "
            "judge by. Give a longer record."
        )
    rows = rows[:: max(1, len(rows) // MOST_WORDS)]
    return rows, water.rows(rows)


def _word_of(
    field: FieldRecord, words: Int[np.ndarray, " word"], time: Shaped[np.ndarray, " t"]
) -> Int[np.ndarray, " t"]:
    """Which of the judging words held at each time; -1 where another did."""
    row = np.searchsorted(field.buoy.time, time, side="right") - 1
    place = np.searchsorted(words, row)
    found = words[np.minimum(place, len(words) - 1)] == row
    return np.where(found, place, -1)


def _true(truth: FieldRecord, sensor: str) -> tuple[Shaped[np.ndarray, " t"], Series]:
    record = truth.sensors[sensor]
    (key,) = record.values
    return record.time, _SI[key] * record.values[key]


def _read(field: FieldRecord, sensor: str, time: Shaped[np.ndarray, " t"]) -> Series:
    """What the sensor read at some times; NaN where it read nothing sound."""
    pairs = align(field, sensor)
    place = np.minimum(np.searchsorted(pairs.time, time), len(pairs) - 1)
    return np.where(pairs.time[place] == time, pairs.value[place], np.nan)


def _held_alone(true: Series, alone: tuple[Prediction, float], *, noisy: bool) -> Held:
    outcome, noise = alone
    return held(true, outcome.mean, np.sqrt(outcome.std**2 + noisy * noise))


def _alone(
    model: NARGP,
    twin: Twin,
    field: FieldRecord,
    sensor: str,
    training: Training,
    water: Metocean,
    rows: Int[np.ndarray, " t"],
) -> tuple[Prediction, float]:
    """What a NARGP alone says, taught by the same points; and the noise that it found."""
    window, inputs = twin.provenance.training_windows[sensor], twin.models.inputs
    pairs = align(
        field,
        sensor,
        start=window.start,
        end=window.end,
        mean_s=training.mean_s,
        travel_time=twin.travel_time,
    )
    chosen = spread_out(pairs, training.high_fidelity_points, seed=training.seed)
    fitted = model.fit(
        [(chosen.metocean.features(inputs), chosen.value)],
        seed=training.seed,
        lower=twin.models.lower(sensor),
    )
    predicted = fitted.predict(water.features(inputs))
    return Prediction(mean=predicted.mean[rows], std=predicted.std[rows]), float(
        fitted.upper[-1].noise[0]
    )
