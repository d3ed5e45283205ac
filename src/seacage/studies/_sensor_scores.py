"""How well a twin says what a sensor reads."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import InputError, Origin, Rows
from seacage.records import FieldRecord, Record
from seacage.surrogates import block_bootstrap, block_means, coverage, crps, mae
from seacage.twin import Answer, TravelTime, Twin, align

MEAN_S = 600.0  # scores are given raw and on means of this length [s]
# Readings teach as means of this length, and the twin's intervals are of such means [s]
MINUTE_S = 60.0

_DRAWS = 1000
_LEAST_READINGS = 100
_LEAST_BLOCKS = 8
_HOUR, _MINUTE = np.timedelta64(1, "h"), np.timedelta64(1, "m")
_BLOCK = 512  # rows answered at once; the shapes of more would crowd the memory
# A sensor's unit inside, and the one that people read with what it is multiplied by
PEOPLE = {"m": ("m", 1.0), "N": ("kN", 1e-3)}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Readings(Rows):
    """Readings of one sensor and the twin's predictions of them, in the unit that people read."""

    # Its name, the unit of all values (m or kN), and how the readings were made
    sensor: str
    unit: str
    origin: Origin
    # That answers; at level 1 the standard deviation is the emulator's own, and no interval
    level: int
    time: Shaped[np.ndarray, " t"]  # UTC
    # The sensor, the low-fidelity mean, the multifidelity mean and the standard deviation that it
    # gives for a reading [unit]
    reading: Float[np.ndarray, " t"]
    low: Float[np.ndarray, " t"]
    multi: Float[np.ndarray, " t"]
    multi_std: Float[np.ndarray, " t"]

    def averaged(self, length: float) -> Self:
        """Means over windows that begin at whole multiples of a length [s] since 1970.

        The standard deviation is averaged too: the error of a held input does not average out.
        """
        second = self.time.astype("datetime64[s]").astype(np.int64)
        names = ("reading", "low", "multi", "multi_std")
        columns = (getattr(self, name) for name in names)
        window, means = block_means(second // int(length), *columns)
        time = (window * int(length)).astype("datetime64[s]")
        return replace(self, time=time, **dict(zip(names, means, strict=True)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Errors:
    """Errors of both fidelities on the same readings [m] or [kN]."""

    readings: int
    # Mean absolute errors
    low_mae: float
    multi_mae: float
    # Mean of prediction less reading
    low_bias: float
    multi_bias: float
    # Low-fidelity less multifidelity absolute error: its mean, and the 95 % interval by a paired
    # block bootstrap. An interval above 0 says that multifidelity is better.
    gain: float
    gain_low: float
    gain_high: float
    coverage: float  # share of readings inside the multifidelity's 95 % interval [-]
    # Continuous ranked probability score of multifidelity; for a forecast without spread, as the
    # low fidelity is, it would be the mean absolute error
    crps: float

    @property
    def ratio(self) -> float:
        """Multifidelity over low-fidelity mean absolute error [-]."""
        return self.multi_mae / self.low_mae

    @property
    def better(self) -> bool:
        """Multifidelity is better, and not by chance: the gain's whole interval says so."""
        return self.gain_low > 0.0

    @property
    def worse(self) -> bool:
        """Multifidelity is worse, and not by chance: the gain's whole interval is below 0."""
        return self.gain_high < 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorScore:
    """Scores of one sensor on validation days."""

    # Its name, the unit of all errors, and how its readings were made
    sensor: str
    unit: str
    origin: Origin
    # From the first reading to the last, and hours of it that have readings [h]
    span_h: float
    told_h: float
    blocks: int  # of the bootstrap: the days that have readings, eight at least
    # Errors on single readings, on means over a minute as in training, and on 10-minute means.
    # Coverage and CRPS are those of minutes: the twin's interval is of such means.
    raw: Errors
    minutes: Errors
    means: Errors
    # Slope [-] and intercept [unit] of the best fit of the prediction on the reading
    low_line: tuple[float, float]
    multi_line: tuple[float, float]
    # Mean absolute errors against the noise-free truth that only a virtual field has
    low_truth_mae: float | None
    multi_truth_mae: float | None

    @property
    def underestimates(self) -> bool:
        """Low fidelity predicts too small a response: too deep a net, or too low a tension."""
        return (self.raw.low_bias > 0.0) == (self.unit == "m")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answers:
    """A twin's answers to a buoy's record, each in force until the next."""

    time: Shaped[np.ndarray, " t"]  # UTC
    answer: Answer  # without the nodes

    @classmethod
    def of(cls, twin: Twin, buoy: Record) -> Self:
        """Answer to each reading, and each minute where the current takes time to the cage."""
        rows = _each_minute(buoy, twin.travel_time) if twin.travel_time.history_s else buoy
        blocks = [rows.rows(slice(one, one + _BLOCK)) for one in range(0, len(rows), _BLOCK)]
        answers = (twin.predict_record(one, among=buoy).without_nodes() for one in blocks or [rows])
        return cls(time=rows.time, answer=Answer.join(*answers))


def compare(answers: Answers, field: FieldRecord) -> dict[str, Readings]:
    """Every sound reading of a field record beside a twin's prediction of it.

    The buoy's last sample holds until the next; where it was unsound or too old there is no
    number, and the reading is not scored. Sensors that the twin does not know are left out.

    ``answers``: to the field record's buoy.
    """
    known = [name for name in answers.answer.sensor_names if name in field.sensors]
    return {name: _compare(answers, field, name) for name in known}


def score_sensor(readings: Readings, *, seed: int, truth: Readings | None = None) -> SensorScore:
    """Score one sensor: raw, and on means over one and over ten minutes.

    The bootstrap's blocks hold as much as a day has on average, for errors resemble themselves
    from tide to tide, or an eighth of the readings where there are fewer days than eight.

    ``readings``: in order of time.
    ``seed``: of the bootstrap.
    ``truth``: predictions beside the noise-free truth, at the readings' times and perhaps at
    others.
    """
    if truth is not None:
        truth = truth.rows(np.isin(truth.time, readings.time))
    blocks = max(_LEAST_BLOCKS, len(np.unique(readings.time.astype("datetime64[D]"))))
    raw, minutes, means = (
        _errors(some, blocks=blocks, seed=seed)
        for some in (readings, readings.averaged(MINUTE_S), readings.averaged(MEAN_S))
    )
    return SensorScore(
        sensor=readings.sensor,
        unit=readings.unit,
        origin=readings.origin,
        span_h=float((readings.time[-1] - readings.time[0]) / _HOUR),
        told_h=float(len(readings.time) * np.median(np.diff(readings.time)) / _HOUR),
        blocks=blocks,
        raw=raw,
        minutes=minutes,
        means=means,
        low_line=_best_fit(readings.reading, readings.low),
        multi_line=_best_fit(readings.reading, readings.multi),
        low_truth_mae=None if truth is None else mae(truth.reading, truth.low),
        multi_truth_mae=None if truth is None else mae(truth.reading, truth.multi),
    )


def _each_minute(buoy: Record, travel: TravelTime) -> Record:
    """Readings held from minute to minute, until the current of the last has arrived."""
    last = buoy.time[-1] + np.timedelta64(math.ceil(travel.longest_s), "s")
    minutes = np.arange(buoy.time[0].astype("datetime64[m]"), last + _MINUTE, _MINUTE)
    time = np.union1d(buoy.time, minutes[minutes > buoy.time[0]])
    held = np.searchsorted(buoy.time, time, side="right") - 1
    values, flags = (
        {key: column[held] for key, column in one.items()} for one in (buoy.values, buoy.flags)
    )
    return replace(buoy, time=time, values=values, flags=flags)


def _compare(answers: Answers, field: FieldRecord, sensor: str) -> Readings:
    answer = answers.answer
    column = answer.sensor_names.index(sensor)
    unit, scale = PEOPLE[answer.sensor_units[column]]
    pairs = align(field, sensor)
    word = np.searchsorted(answers.time, pairs.time, side="right") - 1
    valid = answer.valid[word]
    if np.sum(valid) < _LEAST_READINGS:
        raise InputError(
            f"{sensor}: {np.sum(valid)} sound readings at times at which the twin has an answer; "
            f"a score needs {_LEAST_READINGS}. Leave the sensor out, or give a longer record."
        )
    row = word[valid]
    return Readings(
        sensor=sensor,
        unit=unit,
        origin=field.origin,
        level=int(answer.sensor_level[column]),
        time=pairs.time[valid],
        reading=scale * pairs.value[valid],
        low=scale * answer.sensor_low.mean[row, column],
        multi=scale * answer.sensor.mean[row, column],
        multi_std=scale * answer.sensor.std[row, column],
    )


def _errors(readings: Readings, *, blocks: int, seed: int) -> Errors:
    low_error, multi_error = readings.low - readings.reading, readings.multi - readings.reading
    low, multi = np.abs(low_error), np.abs(multi_error)
    block = max(1, round(len(low) / blocks))
    gain, gain_low, gain_high = block_bootstrap(low - multi, block=block, seed=seed, draws=_DRAWS)
    return Errors(
        readings=len(low),
        low_mae=float(low.mean()),
        multi_mae=float(multi.mean()),
        low_bias=float(low_error.mean()),
        multi_bias=float(multi_error.mean()),
        gain=gain,
        gain_low=gain_low,
        gain_high=gain_high,
        coverage=coverage(readings.reading, readings.multi, readings.multi_std),
        crps=crps(readings.reading, readings.multi, readings.multi_std),
    )


def _best_fit(
    reading: Float[np.ndarray, " t"], predicted: Float[np.ndarray, " t"]
) -> tuple[float, float]:
    slope, intercept = np.polyfit(reading, predicted, 1)
    return float(slope), float(intercept)
