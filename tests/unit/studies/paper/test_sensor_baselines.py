"""Baselines beside level 2, on the stand-in cage."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Extension, InputError, Origin
from seacage.studies._paper._sensor_baselines import (
    SENSOR_BASELINES,
    TWIN,
    predict_by_sensor_baselines,
    score_sensor_baselines,
)
from seacage.studies._split import split
from seacage.surrogates import Prediction
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import Metocean, Training


class Line:
    """A line in the last feature, which is level 1, or what a broken learner answers."""

    def __init__(self, x, y, _seed):
        self.slope, self.shift = np.polyfit(x[:, -1], y, 1)

    def predict(self, x, **_):
        mean = self.slope * x[:, -1] + self.shift
        return Prediction(mean=mean, std=np.zeros_like(mean))


def learner(value):
    return Extension(source="lab 1.0", title="surrogate 'line' of lab 1.0", value=value)


class Unknowing(Line):
    def predict(self, x, **_):
        return Prediction(mean=np.full(len(x), np.nan), std=np.zeros(len(x)))


class Short(Line):
    def predict(self, x, **_):
        return super().predict(x[1:], noisy=noisy)


TRAINING = Training(high_fidelity_points=60, days=2.0, restarts=0)


@pytest.fixture(scope="module")
def field():
    return stand_in_field(Cage.named("ace").altered(mesh={"spokes": 8}))


@pytest.mark.slow
def test_each_sensor_with_level_2_is_scored_beside_four_baselines(field):
    twin = stand_in_twin()
    days = split(field, teaching_days=1)
    scores = list(score_sensor_baselines(twin, *days, TRAINING))
    assert [one.sensor for one in scores] == list(twin.models.upper)
    for one in scores:
        assert one.origin is Origin.VIRTUAL_FIELD
        assert one.unit == ("m" if one.sensor.startswith("depth") else "kN")
        assert set(one.mae) == {TWIN, *SENSOR_BASELINES}
        assert set(one.gain) == set(SENSOR_BASELINES)
        for name, gain in one.gain.items():
            assert gain.low <= gain.mean <= gain.high
            assert gain.mean == pytest.approx(one.mae[name] - one.mae[TWIN], rel=1e-6, abs=1e-9)


@pytest.mark.slow
def test_a_line_through_level_1_is_found_by_the_baselines_that_have_it(field):
    twin = stand_in_twin()
    name = next(iter(twin.models.upper))
    lower = twin.models.lower(name)
    record = field.sensors[name]
    (key,) = record.values
    water = Metocean.of_record(field.buoy)
    held = np.searchsorted(field.buoy.time, record.time, side="right") - 1
    low = lower.predict(water.rows(np.maximum(held, 0)).features(("current",))).mean
    made = replace(record, values={key: 2.0 * low + 1.0})
    new = replace(field, sensors={**field.sensors, name: made})
    some = water.rows(np.arange(len(field.buoy.time))[::40])
    given = twin, new, name, some, TRAINING
    found = predict_by_sensor_baselines(*given, learners=[learner(Line)])
    true = 2.0 * lower.predict(some.features(("current",))).mean + 1.0
    spread = float(np.std(true))
    for method in ("AR1", "linear", "surrogate 'line' of lab 1.0"):
        assert np.sqrt(np.mean((found[method].mean - true) ** 2)) < 0.1 * spread
    assert all(np.isfinite(each.mean).all() for each in found.values())
    for broken in (Unknowing, Short, lambda *_: None):
        with pytest.raises(InputError, match=r"surrogate 'line' of lab 1\.0 fails \("):
            predict_by_sensor_baselines(*given, learners=[learner(broken)])
