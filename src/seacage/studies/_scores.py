"""How well a twin says what a sensor read, and what a simulation computed."""

from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.cage import Cage
from seacage.conventions import InputError, Origin
from seacage.records import CampaignRecord, FieldRecord
from seacage.surrogates import PcaGP, block_bootstrap, coverage, crps, current_features, mae
from seacage.twin import Answer, Twin, align

MEAN_S = 600.0
"""Scores are given raw and on means of this length [s]."""

_DRAWS = 1000
_UNITS = {"m": ("m", 1.0), "N": ("kN", 1e-3)}
"""A sensor's unit inside, and the one people read with what it is multiplied by."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Readings:
    """What one sensor read, and what the twin had said, in the unit that people read.

    Parameters
    ----------
    time
        UTC.
    reading, low, multi, multi_std
        The sensor, the low-fidelity mean, the multifidelity mean and the standard deviation
        that it gives for a reading [m] or [kN].
    """

    time: Shaped[np.ndarray, " t"]
    reading: Float[np.ndarray, " t"]
    low: Float[np.ndarray, " t"]
    multi: Float[np.ndarray, " t"]
    multi_std: Float[np.ndarray, " t"]

    def at(self, rows: Bool[np.ndarray, " t"]) -> Self:
        """Some of the readings."""
        return type(self)(**{part.name: getattr(self, part.name)[rows] for part in fields(self)})

    def averaged(self, length: float) -> Self:
        """Means over windows that begin at whole multiples of a length [s] since 1970.

        The standard deviation is averaged too: errors of a held input do not average out.
        """
        second = self.time.astype("datetime64[s]").astype(np.int64)
        window, group = np.unique(second // int(length), return_inverse=True)
        count = np.bincount(group)

        def mean(column: Float[np.ndarray, " t"]) -> Float[np.ndarray, " window"]:
            return np.bincount(group, weights=column) / count

        return type(self)(
            time=(window * int(length)).astype("datetime64[s]"),
            reading=mean(self.reading),
            low=mean(self.low),
            multi=mean(self.multi),
            multi_std=mean(self.multi_std),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Errors:
    """Errors of both fidelities on the same readings [m] or [kN].

    Parameters
    ----------
    readings
        How many.
    low_mae, multi_mae
        Mean absolute errors.
    low_bias, multi_bias
        Mean of prediction less reading.
    gain, gain_low, gain_high
        Low-fidelity less multifidelity absolute error: its mean, and the 95 % interval by a
        paired block bootstrap. An interval above 0 says that multifidelity is better.
    coverage
        Share of readings inside the multifidelity's 95 % interval [-].
    crps
        Continuous ranked probability score of multifidelity; for a forecast without spread,
        as the low fidelity is, it would be the mean absolute error.
    """

    readings: int
    low_mae: float
    multi_mae: float
    low_bias: float
    multi_bias: float
    gain: float
    gain_low: float
    gain_high: float
    coverage: float
    crps: float

    @property
    def ratio(self) -> float:
        """Multifidelity over low-fidelity mean absolute error [-]."""
        return self.multi_mae / self.low_mae

    @property
    def better(self) -> bool:
        """Multifidelity is better, and not by chance: the gain's whole interval says so."""
        return self.gain_low > 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorScore:
    """One sensor on the days that it did not teach.

    Parameters
    ----------
    sensor, unit, origin
        Its name, the unit of all errors, and how its readings were made.
    span_h, block_h
        From the first reading to the last, and length of the bootstrap's blocks [h].
    raw, means
        Errors on single readings and on 10-minute means.
    low_line, multi_line
        Slope [-] and intercept [unit] of the best fit of the prediction on the reading.
    low_truth_mae, multi_truth_mae
        Mean absolute errors against the noise-free truth that only a virtual field has.
    """

    sensor: str
    unit: str
    origin: Origin
    span_h: float
    block_h: float
    raw: Errors
    means: Errors
    low_line: tuple[float, float]
    multi_line: tuple[float, float]
    low_truth_mae: float | None
    multi_truth_mae: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeScore:
    """One model of the whole shape against held-out simulations.

    Parameters
    ----------
    model
        Its name.
    axis_mae
        Mean absolute error along x, y and z [m].
    p99, worst
        Of the distance between the predicted and the computed node [m].
    case_mae
        Mean absolute error of each case, over nodes and axes [m].
    """

    model: str
    axis_mae: tuple[float, float, float]
    p99: float
    worst: float
    case_mae: Float[np.ndarray, " case"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LevelOneScore:
    """Level 1 against simulations that it has not seen.

    Parameters
    ----------
    cases
        How many.
    current_speed
        Of each [m/s].
    bridle_names, bridle_mae, bridle_mean
        Mean absolute error and mean tension of each bridle [N].
    shapes
        The twin's model and the paper's three modes.
    """

    cases: int
    current_speed: Float[np.ndarray, " case"]
    bridle_names: tuple[str, ...]
    bridle_mae: Float[np.ndarray, " line"]
    bridle_mean: Float[np.ndarray, " line"]
    shapes: tuple[ShapeScore, ...]


def compared(answer: Answer, field: FieldRecord) -> dict[str, Readings]:
    """Every sound reading of a field record beside what a twin says about it.

    The buoy's last word holds until the next; where it was unsound or too old there is no
    number, and the reading is not scored.

    Parameters
    ----------
    answer
        Of the twin, one row for each row of the field record's buoy.
    field
        Sensors and buoy.
    """
    return {name: _compared(answer, field, name) for name in field.sensors}


def score_sensor(
    sensor: str,
    readings: Readings,
    *,
    unit: str,
    origin: Origin,
    block_h: float,
    seed: int,
    truth: Readings | None = None,
) -> SensorScore:
    """Score one sensor, raw and on 10-minute means.

    Parameters
    ----------
    block_h
        Length of the bootstrap's blocks [h]: longer than errors resemble themselves, short
        enough that the readings hold several.
    truth
        Predictions beside the noise-free truth, at the readings' times and perhaps at others.
    """
    if truth is not None:
        truth = truth.at(np.isin(truth.time, readings.time))
    means = readings.averaged(MEAN_S)
    step_s = float(np.median(np.diff(readings.time)) / np.timedelta64(1, "s"))
    return SensorScore(
        sensor=sensor,
        unit=unit,
        origin=origin,
        span_h=float((readings.time[-1] - readings.time[0]) / np.timedelta64(1, "h")),
        block_h=block_h,
        raw=_errors(readings, block=round(3600.0 * block_h / step_s), seed=seed),
        means=_errors(means, block=round(3600.0 * block_h / MEAN_S), seed=seed),
        low_line=_best_fit(readings.reading, readings.low),
        multi_line=_best_fit(readings.reading, readings.multi),
        low_truth_mae=None if truth is None else mae(truth.reading, truth.low),
        multi_truth_mae=None if truth is None else mae(truth.reading, truth.multi),
    )


def score_level_one(
    twin: Twin, cage: Cage, campaign: CampaignRecord, held_out: CampaignRecord, *, seed: int
) -> LevelOneScore:
    """Score tensions and shapes of level 1 on simulations that it has not seen.

    Beside the twin's own shape model stands the paper's: three PCA modes, each with a GP,
    fitted to the same campaign.
    """
    seas = [sea for sea, good in zip(held_out.seas, held_out.converged, strict=True) if good]
    tension = held_out.bridle_tension[held_out.converged]
    position = held_out.node_position[held_out.converged]
    answer = twin.predict(seas)
    three_modes = PcaGP(modes=3).fit(
        _features(campaign)[campaign.converged],
        campaign.node_position[campaign.converged],
        seed=seed,
    )
    paper = three_modes.predict(_features(held_out)[held_out.converged]).mean
    return LevelOneScore(
        cases=len(seas),
        current_speed=np.array([sea.current_speed for sea in seas]),
        bridle_names=cage.bridle_names,
        bridle_mae=np.mean(np.abs(answer.bridle_low - tension), axis=0),
        bridle_mean=np.mean(tension, axis=0),
        shapes=(
            shape_score("ShapeGP (the twin's)", answer.node_position, position),
            shape_score("PCA, 3 modes + GP", paper, position),
        ),
    )


def _compared(answer: Answer, field: FieldRecord, sensor: str) -> Readings:
    column = answer.sensor_names.index(sensor)
    _, scale = people_unit(answer, sensor)
    pairs = align(field, sensor)
    word = np.searchsorted(field.buoy.time, pairs.time, side="right") - 1
    valid = answer.valid[word]
    if not np.any(valid):
        raise InputError(f"{sensor}: the twin has no answer at any of its readings' times.")
    row = word[valid]
    return Readings(
        time=pairs.time[valid],
        reading=scale * pairs.value[valid],
        low=scale * answer.sensor_low.mean[row, column],
        multi=scale * answer.sensor.mean[row, column],
        multi_std=scale * answer.sensor.std[row, column],
    )


def people_unit(answer: Answer, sensor: str) -> tuple[str, float]:
    """The unit that people read a sensor in, and what SI is multiplied by to get there."""
    return _UNITS[answer.sensor_units[answer.sensor_names.index(sensor)]]


def _errors(readings: Readings, *, block: int, seed: int) -> Errors:
    low_error, multi_error = readings.low - readings.reading, readings.multi - readings.reading
    low, multi = np.abs(low_error), np.abs(multi_error)
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


def _features(campaign: CampaignRecord) -> Float[np.ndarray, "case 3"]:
    return current_features(np.array([sea.current_velocity for sea in campaign.seas]))


def shape_score(
    model: str,
    predicted: Float[np.ndarray, "case node 3"],
    computed: Float[np.ndarray, "case node 3"],
) -> ShapeScore:
    error = np.abs(predicted - computed)
    distance = np.linalg.norm(predicted - computed, axis=-1)
    x, y, z = error.mean(axis=(0, 1))
    return ShapeScore(
        model=model,
        axis_mae=(float(x), float(y), float(z)),
        p99=float(np.quantile(distance, 0.99)),
        worst=float(distance.max()),
        case_mae=error.mean(axis=(1, 2)),
    )
