"""What is left of the low fidelity's error after its best rescaling and rotation."""

from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Bool, Float

from seacage.campaigns import Plan
from seacage.conventions import Result
from seacage.studies._fidelity._windows import Sensors, Windows
from seacage.studies._interval import Interval, by_day
from seacage.studies._stages import Stages, count
from seacage.surrogates import FittedGaussianProcess, GaussianProcess, current_features

LEAST_LEFT = 0.10  # share of the low fidelity's error that no rescaling may remove
# Factors of the current's speed [-] and turns, clockwise [deg], that are tried first
_FACTORS = np.arange(0.2, 2.01, 0.1)
_TURNS = np.arange(-90.0, 91.0, 10.0)
_FINER = 5  # around the best, so many times finer steps are tried
# Settled currents that the change of an answer is learned from, up to this speed [m/s]
_CURRENTS = 400
_FASTEST = 1.8
_REWEIGHINGS = 30
Columns = Float[np.ndarray, "window sensor"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rescaling:
    """The best that rescaling and rotating the low fidelity does for one sensor."""

    # Its name, and the unit of its response
    sensor: str
    unit: str
    # Of the current's speed [-] and direction, clockwise [deg]
    factor: float
    turn: float
    # Of the answer [-] and [m] or [kN]
    gain: float
    offset: float
    # How many windows
    teaching: int
    judging: int
    # Mean absolute errors on the test days, before and after [m] or [kN]
    low_mae: float
    left_mae: float
    # What is left less a tenth of what there was: above 0 where more than a tenth is left
    above_least: Interval
    # Error of the interpolation between settled currents, each left out in turn [m] or [kN]
    emulation_mae: float

    @property
    def left(self) -> float:
        """Share of the low fidelity's error that is left [-]."""
        return self.left_mae / self.low_mae

    @property
    def enough(self) -> bool:
        """At least a tenth is left."""
        return self.left >= LEAST_LEFT


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Moving:
    """How the low fidelity's answers move when the current of each window is changed."""

    windows: Windows  # with the answers as they are; what waves add to them stays
    settled: FittedGaussianProcess  # answers of all sensors to currents alone

    def answers_at(self, factor: float, turn: float) -> Columns:
        """Answers to faster and turned currents, the turn clockwise [deg]."""
        velocity = self.windows.water.current_velocity
        angle = np.deg2rad(turn)
        rotation = np.array(
            [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        )  # of rows (east, north)
        change = self._at_current(factor * velocity @ rotation) - self._at_current(velocity)
        return self.windows.low + change

    def _at_current(self, velocity: Float[np.ndarray, "window 2"]) -> Columns:
        speed = np.linalg.norm(velocity, axis=1, keepdims=True)
        limited = velocity * np.minimum(1.0, _FASTEST / np.maximum(speed, _FASTEST))
        return self.settled.mean(current_features(limited))


def teaching_days(windows: Windows) -> Bool[np.ndarray, " window"]:
    """Every other day, from the first on: growth and weather are alike in training and test."""
    days, index = np.unique(windows.day, return_inverse=True)
    return index % 2 == 0 if len(days) > 1 else np.arange(len(windows)) < len(windows) // 2


def rescalings(windows: Windows, stages: Stages, *, seed: int) -> tuple[Rescaling, ...]:
    """Fit the best rescaling of each sensor on training days; score it on the others.

    The current's speed is multiplied, its direction turned, and the answer multiplied and
    shifted, with the least mean absolute error. It is fitted to the truth itself, without any
    sensor's noise, so that a rescaling has every advantage. How an answer changes with the current
    comes from settled currents; what waves add stays as simulated.
    """
    settled, errors = _fit_settled(windows.sensors, stages, seed)
    teach = teaching_days(windows)
    training, test = (
        Moving(windows=windows.rows(days), settled=settled) for days in (teach, ~teach)
    )
    coarse = list(product(_FACTORS.tolist(), _TURNS.tolist()))
    first = np.stack([training.answers_at(*change) for change in coarse])
    found: list[Rescaling] = []
    for column in count(range(len(errors)), "rescaling", stages.progress):
        change = coarse[_least(first[..., column], training.windows.truth[:, column])]
        change = _refine(training, column, change)
        found.append(_score(training, test, column, change, errors[column], seed))
    return tuple(found)


def _fit_settled(
    sensors: Sensors, stages: Stages, seed: int
) -> tuple[FittedGaussianProcess, Float[np.ndarray, " sensor"]]:
    """Answers to currents alone, and how far they are off at a current left out."""
    plan = Plan.sample(
        seed, _CURRENTS, current_speed=(0.0, _FASTEST), hs=(0.0, 0.0), name="currents"
    )
    record = stages.ensure_campaign("currents", sensors.cage, plan)
    known = record.result != Result.DIVERGED
    velocity = np.array([sea.current_velocity for sea in record.seas])[known]
    answers = sensors.responses_of(record.node_position[known], record.bridle_tension[known])
    settled = GaussianProcess(kernel="matern-5/2").fit(
        current_features(velocity), answers, seed=seed
    )
    return settled, np.abs(settled.leave_one_out().mean - answers).mean(axis=0)


def _refine(training: Moving, column: int, change: tuple[float, float]) -> tuple[float, float]:
    """The best change within a coarse step of a first one."""
    steps = np.linspace(-1.0, 1.0, 2 * _FINER + 1)
    factors = np.maximum(change[0] + (_FACTORS[1] - _FACTORS[0]) * steps, 0.0)
    turns = change[1] + (_TURNS[1] - _TURNS[0]) * steps
    tried = list(product(factors.tolist(), turns.tolist()))
    answers = np.stack([training.answers_at(*one)[:, column] for one in tried])
    return tried[_least(answers, training.windows.truth[:, column])]


def _least(answers: Float[np.ndarray, "change window"], truth: Float[np.ndarray, " window"]) -> int:
    """Which change leaves the least error, its best gain and offset given."""
    gain, offset = _fit_gain_and_offset(answers, truth).T
    error = np.abs(gain[:, None] * answers + offset[:, None] - truth).mean(axis=1)
    return int(np.argmin(error))


def _fit_gain_and_offset(
    answers: Float[np.ndarray, "change window"], truth: Float[np.ndarray, " window"]
) -> Float[np.ndarray, "change 2"]:
    """Gain and offset of least mean absolute error, for each row of answers.

    Source: Iteratively reweighted least squares: Schlossmacher (1973).
    """
    weight = np.ones_like(answers)
    smallest = 1e-4 * max(float(np.std(truth)), 1e-9)
    gain = offset = np.zeros(len(answers))
    for _ in range(_REWEIGHINGS):
        total = weight.sum(axis=1)
        centre = (weight * answers).sum(axis=1) / total
        level = (weight * truth).sum(axis=1) / total
        away = answers - centre[:, None]
        spread = (weight * away**2).sum(axis=1)
        gain = (weight * away * truth).sum(axis=1) / np.maximum(spread, 1e-12)
        offset = level - gain * centre
        left = np.abs(gain[:, None] * answers + offset[:, None] - truth)
        weight = 1.0 / np.maximum(left, smallest)
    return np.column_stack([gain, offset])


def _score(
    training: Moving,
    test: Moving,
    column: int,
    change: tuple[float, float],
    emulation_mae: float,
    seed: int,
) -> Rescaling:
    """Gain and offset from the training days; errors on the others."""
    train, windows = training.windows, test.windows
    answers = training.answers_at(*change)[:, column]
    gain, offset = _fit_gain_and_offset(answers[None], train.truth[:, column])[0].tolist()
    truth = windows.truth[:, column]
    low = np.abs(windows.low[:, column] - truth)
    left = np.abs(gain * test.answers_at(*change)[:, column] + offset - truth)
    factor, turn = change
    return Rescaling(
        sensor=windows.sensors.names[column],
        unit=windows.sensors.units[column],
        factor=factor,
        turn=turn,
        gain=gain,
        offset=offset,
        teaching=len(train),
        judging=len(windows),
        low_mae=float(low.mean()),
        left_mae=float(left.mean()),
        above_least=by_day(left - LEAST_LEFT * low, windows.day, seed=seed),
        emulation_mae=float(emulation_mae),
    )
