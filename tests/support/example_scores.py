"""Scores made up for tests of the sentences about them."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np

from seacage.conventions import Origin
from seacage.studies._paper._shape_models import GCN_PAPER, PCA_PAPER, SHAPE
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._shape_study import ShapeStudy
from seacage.studies._paper._study import LevelOneScore
from seacage.studies._paper._trainings import SPREAD, ScoredWays, WayScore
from seacage.studies._sensor_scores import Errors, SensorScore
from seacage.twin import Twin

ERRORS = Errors(
    readings=1440,
    low_mae=4.0,
    multi_mae=1.0,
    low_bias=-3.9,
    multi_bias=-0.1,
    gain=3.0,
    gain_low=2.0,
    gain_high=4.0,
    coverage=0.94,
    crps=0.7,
)


def sensor(name: str, *, unit: str = "kN", slope: float = 1.0, **changes: float) -> SensorScore:
    errors = replace(ERRORS, **changes)
    return SensorScore(
        sensor=name,
        unit=unit,
        origin=Origin.VIRTUAL_FIELD,
        span_h=24.0,
        told_h=24.0,
        blocks=8,
        raw=errors,
        minutes=errors,
        means=errors,
        low_line=(0.5, 0.0),
        multi_line=(slope, 0.0),
        low_truth_mae=4.0,
        multi_truth_mae=1.0,
    )


def way(*sensors: SensorScore, name: str = SPREAD) -> WayScore:
    return WayScore(name=name, trained=tuple(one.sensor for one in sensors), sensors=sensors)


def scored(*sensors: SensorScore, more: tuple[WayScore, ...] = ()) -> ScoredWays:
    return ScoredWays(twin=Mock(spec=Twin), readings={}, ways=(way(*sensors), *more))


def level_one(bridle_mae: float = 10.0) -> LevelOneScore:
    return LevelOneScore(
        cases=1,
        bridle_names=("bridle-1",),
        bridle_mae=np.array([bridle_mae]),
        bridle_mean=np.array([10e3]),
    )


def shape(model: str, error: float, *, worst: float = 3.0) -> ShapeScore:
    """Errors that grow with the case, so with the speed that ``shapes`` gives it."""
    case = error * np.linspace(0.5, 1.5, 10)
    return ShapeScore(
        model=model,
        inputs="current",
        modes=3,
        axis_mae=(error, error, error),
        p99=3.0 * error,
        worst=worst,
        mae_without_drift=0.9 * error,
        p99_without_drift=2.7 * error,
        worst_without_drift=0.9 * worst,
        coverage=0.95,
        crps=0.7 * error,
        fit_cpu_s=1.0,
        predict_ms=0.1,
        case_axis_mae=np.repeat(case[:, None], 3, axis=1),
        case_worst=worst * np.linspace(0.1, 1.0, 10),
    )


def shapes(*, pca: float = 0.3, network: float | None = 0.5, variance: float = 0.99) -> ShapeStudy:
    scores = {PCA_PAPER: shape(PCA_PAPER, pca), SHAPE: shape(SHAPE, 0.01, worst=0.1)}
    if network is not None:
        scores[GCN_PAPER] = shape(GCN_PAPER, network)
    return ShapeStudy(
        training_cases=90,
        test_cases=10,
        current_speed=np.linspace(0.0, 1.0, 10),
        scores=scores,
        cases=(),
        variance={"means of the cases, centred": variance, "means of the cases, not centred": 0.99},
        left_out=() if network is not None else ("There is no network here.",),
    )
