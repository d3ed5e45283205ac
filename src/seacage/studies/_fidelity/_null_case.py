"""Gain of multifidelity on a field, and on a null case where there is nothing to gain."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from seacage.conventions import Progress
from seacage.records import FieldRecord
from seacage.studies._fidelity._windows import MEAN_S, Windows, window_means
from seacage.studies._interval import Interval, by_day
from seacage.studies._stages import count
from seacage.surrogates import Prediction
from seacage.twin import Correction, FixedPrediction, Pairs, spread_out

LEAST = 20  # least number of readings to train on, and to score on
_SHORT_S = 60.0  # means of this length where a sensor lives too shortly for 10-minute means [s]
_MOST = 6.0  # errors beyond so many times the usual one are faults and no noise [-]
_RESTARTS = 3  # of each search for hyperparameters, as a twin makes them
Series = Float[np.ndarray, " reading"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorTrial:
    """A sensor's readings beside the low fidelity's answers, to train on and to score on."""

    # Its name, and the unit of its responses, m or kN
    sensor: str
    unit: str
    mean_s: float  # length of the means that count as readings [s]
    # The window that each reading is of; the low fidelity's answer is the window's
    window: Int[np.ndarray, " reading"]
    time: Shaped[np.ndarray, " reading"]  # UTC, ascending
    # Responses: of the sensor, without its error, of the low fidelity
    reading: Series
    truth: Series
    low: Series
    # Training readings: those before the midnight that parts the days; the others are scored
    teach: Bool[np.ndarray, " reading"]

    @property
    def enough(self) -> bool:
        """There are enough readings to train on and to score on."""
        return bool(min(np.sum(self.teach), np.sum(~self.teach)) >= LEAST)


@dataclass(frozen=True, slots=True, kw_only=True)
class Gain:
    """What multifidelity gains on low fidelity at one sensor."""

    # Its name, and the unit of its responses
    sensor: str
    unit: str
    mean_s: float  # length of the means that count as readings [s]
    # How many readings
    teaching: int
    judging: int
    # Mean absolute errors against the readings that are scored
    low_mae: float
    multi_mae: float
    gain: Interval  # low-fidelity less multifidelity absolute error, paired, by blocks of a day

    @property
    def share(self) -> Interval:
        """The gain over the low fidelity's error [-]."""
        return Interval(
            mean=self.gain.mean / self.low_mae,
            low=self.gain.low / self.low_mae,
            high=self.gain.high / self.low_mae,
        )


# A sensor's gain in the mean and reading by reading, and the readings it was scored on
ScoredSensor = tuple[Gain, Float[np.ndarray, " _"], SensorTrial]


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """Of all sensors with enough readings."""

    sensors: tuple[Gain, ...]  # one each
    # Mean over the sensors of the gain as a share of the low fidelity's error [-]
    together: Interval


@dataclass(frozen=True, slots=True, kw_only=True)
class NullCase:
    """Multifidelity on the field as it is, and where the truth is the low fidelity itself."""

    # Gains where there is nothing to gain, and where there is
    null: Gains
    real: Gains
    unjudged: tuple[str, ...]  # sensors with too few readings


def null_case(
    windows: Windows,  # with the low fidelity's answers
    field: FieldRecord,  # whose sensors teach
    *,
    points: int,  # readings that each sensor teaches with, at most
    seed: int,  # of the choice of readings, the searches and the draws
    progress: Progress,
) -> NullCase:
    """Train and score twice alike: on the sensors' readings, and on a truth that is null.

    In the null case a sensor reads the low fidelity's own answer in the water that the
    buoy reports, and its own noise: its reading less the truth, less what lasts for days in that.
    Level 1 is the low fidelity itself, not a model of it, in both.
    """
    trials = [_trial(windows, field, column) for column in range(len(windows.sensors.names))]
    usable = [trial for trial in trials if trial.enough]
    real: list[ScoredSensor] = []
    null: list[ScoredSensor] = []
    for trial in count(usable, "null case", progress):
        real.append(_score(trial, trial.reading, windows, points, seed))
        null.append(_score(trial, trial.low + noise(trial), windows, points, seed))
    return NullCase(
        null=_together(null, windows, seed),
        real=_together(real, windows, seed),
        unjudged=tuple(trial.sensor for trial in trials if not trial.enough),
    )


def noise(trial: SensorTrial) -> Series:
    """What a sensor read beside the truth, without what lasts: its mean is 0 on each day.

    Offset, drift and the weather's air pressure last for days, and a gain forever; training
    cannot separate them from a difference of the cage. A spike, or a sensor that stood still, is
    no noise: what no check found of them is cut.
    """
    error = trial.reading - trial.truth
    error = error - np.median(error)
    most = _MOST * float(np.median(np.abs(error)))
    _, day = np.unique(trial.time.astype("datetime64[D]"), return_inverse=True)
    lasting = np.column_stack([np.eye(day.max() + 1)[day], trial.truth])
    sound = np.abs(error) <= most
    left = error - lasting @ np.linalg.lstsq(lasting[sound], error[sound])[0]
    return np.where(sound, left, 0.0)


def _trial(windows: Windows, field: FieldRecord, column: int) -> SensorTrial:
    """Ten-minute means of a sensor, or shorter ones where there are too few."""
    trial = _read(windows, field, column, MEAN_S)
    return trial if trial.enough else _read(windows, field, column, _SHORT_S)


def _read(windows: Windows, field: FieldRecord, column: int, mean_s: float) -> SensorTrial:
    sensors = windows.sensors
    name, unit = sensors.names[column], sensors.units[column]
    read = field.sensors.get(name)
    if read is None:
        time, mean = windows.end[:0], np.empty(0)
    else:
        time, mean = window_means(read, field, length=mean_s)
    window = np.minimum(np.searchsorted(windows.end, time), len(windows) - 1)
    before = (windows.end[window] - time) / np.timedelta64(1, "s")
    known = np.isfinite(mean) & (before >= 0.0) & (before < MEAN_S)
    time, window = time[known], window[known]
    days = np.unique(windows.day)
    return SensorTrial(
        sensor=name,
        unit=unit,
        mean_s=mean_s,
        window=window,
        time=time,
        reading=sensors.response(column, mean[known]),
        truth=windows.truth[window, column],
        low=windows.low[window, column],
        teach=windows.day[window] < days[len(days) // 2],
    )


def _score(
    trial: SensorTrial, reading: Series, windows: Windows, points: int, seed: int
) -> ScoredSensor:
    """Train level 2 of one sensor as a twin does, and score it; the gain of each reading too."""
    multi = _predict(trial, reading, windows, points, seed)
    held_out = ~trial.teach
    low = np.abs(trial.low - reading)[held_out]
    gain = low - np.abs(multi - reading[held_out])
    day = windows.day[trial.window[held_out]]
    score = Gain(
        sensor=trial.sensor,
        unit=trial.unit,
        mean_s=trial.mean_s,
        teaching=min(points, int(np.sum(trial.teach))),
        judging=len(gain),
        low_mae=float(low.mean()),
        multi_mae=float(low.mean() - gain.mean()),
        gain=by_day(gain, day, seed=seed),
    )
    return score, gain, trial


def _predict(
    trial: SensorTrial, reading: Series, windows: Windows, points: int, seed: int
) -> Float[np.ndarray, " held_out"]:
    inputs = ("current", "waves") if windows.waves else ("current",)
    water = windows.water.rows(trial.window)
    training = Pairs(time=trial.time, metocean=water, value=reading).rows(trial.teach)
    chosen = spread_out(training, points, seed=seed)
    rows = np.searchsorted(trial.time, chosen.time)
    model = Correction.fit(
        chosen,
        chosen.metocean.features(inputs),
        FixedPrediction(prediction=_exactly(trial.low[rows])),
        restarts=_RESTARTS,
        seed=seed,
    )
    if not model.beats_level_1(chosen, trial.low[rows]):  # a twin would stay at level 1
        return trial.low[~trial.teach]
    features = water.rows(~trial.teach).features(inputs)
    return model.latent(features, _exactly(trial.low[~trial.teach])).mean


def _exactly(answers: Series) -> Prediction:
    return Prediction(mean=answers, std=np.zeros(len(answers)))


def _together(parts: list[ScoredSensor], windows: Windows, seed: int) -> Gains:
    """All sensors at once: in each window the mean of those that have readings there."""
    total, count = np.zeros(len(windows)), np.zeros(len(windows))
    for score, gain, trial in parts:
        window = trial.window[~trial.teach]
        readings = np.bincount(window, minlength=len(windows))
        share = np.bincount(window, gain / score.low_mae, minlength=len(windows))
        total += share / np.maximum(readings, 1)
        count += readings > 0
    usable = count > 0
    together = by_day(total[usable] / count[usable], windows.day[usable], seed=seed)
    return Gains(sensors=tuple(score for score, _, _ in parts), together=together)
