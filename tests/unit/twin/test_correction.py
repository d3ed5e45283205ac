import numpy as np
import pytest

from seacage.surrogates import GaussianProcess, Prediction
from seacage.testing import stand_in_twin
from seacage.twin import Metocean, Pairs
from seacage.twin._correction._sensor import Correction, FixedPrediction, fit_gain

START = np.datetime64("2020-01-18T00:00", "us")


def minutes(count):
    return START + np.arange(count).astype("timedelta64[m]")


def test_a_gain_that_the_readings_show_plainly_is_found():
    low = np.sin(np.arange(600) / 100.0)
    noise = 0.01 * np.random.default_rng(0).standard_normal(600)
    assert fit_gain(low, 1.7 * low + 3.0 + noise, minutes(600)) == pytest.approx(1.7, abs=0.01)


def test_a_gain_that_the_readings_hardly_show_stays_near_one():
    random = np.random.default_rng(0)
    low = 0.01 * random.standard_normal(600)
    wild = fit_gain(low, -5.0 * low + random.standard_normal(600), minutes(600))
    assert abs(wild - 1.0) < 0.1


def test_a_level_one_that_never_moved_has_a_gain_of_one():
    assert fit_gain(np.ones(5), np.arange(5.0), minutes(5)) == 1.0


def test_more_hours_of_the_same_readings_are_trusted_more():
    random = np.random.default_rng(1)
    low = random.standard_normal(60)
    value = 2.0 * low + 3.0 * random.standard_normal(60)
    hour = fit_gain(low, value, minutes(60))
    days = fit_gain(low, value, START + np.arange(60).astype("timedelta64[h]"))
    assert 1.0 < hour < days


@pytest.mark.slow
def test_a_correction_carries_to_water_outside_its_training_window():
    x = np.linspace(0.0, 1.0, 60)[:, None]
    lower = GaussianProcess().fit(x, 10.0 * x[:, 0] ** 2)
    seen = x[:, 0] < 0.6
    pairs = Pairs(
        time=minutes(int(seen.sum())),
        metocean=Metocean.from_columns({}, int(seen.sum())),
        value=15.0 * x[seen, 0] ** 2 + 1.0,
    )
    model = Correction.fit(pairs, x[seen], lower, restarts=0, seed=0)
    top = model.latent(x[-1:], lower.predict(x[-1:]))
    assert top.mean == pytest.approx([16.0], abs=1.0)


def test_a_prediction_does_not_depend_on_who_evaluated_level_one():
    twin = stand_in_twin()
    model, lower = twin.models.upper["depth-2"], twin.models.lower("depth-2")
    x = np.array([[0.5, 0.3, 0.4], [0.0, 0.0, 0.0]])
    latent, rest = model.latent(x, lower.predict(x)), model.rest.predict(x)
    low = lower.predict(x).mean
    above = rest.mean + (model.gain - 1.0) * low
    np.testing.assert_allclose(latent.mean, low + model.weight * above)


def fitted(value, low, every):
    x = np.column_stack([low, np.cos(3.0 * low)])
    time = START + np.arange(len(low)) * every
    pairs = Pairs(time=time, metocean=Metocean.from_columns({}, len(low)), value=value)
    fixed = FixedPrediction(prediction=Prediction(mean=low, std=np.zeros(len(low))))
    return Correction.fit(pairs, x, fixed, restarts=0, seed=0), pairs


@pytest.mark.slow
def test_a_model_of_noise_alone_seldom_beats_level_one():
    random = np.random.default_rng(5)
    low = np.sin(np.arange(72) / 7.0)
    hour = np.timedelta64(20, "m")
    passed = 0
    for _ in range(20):
        model, pairs = fitted(low + 0.1 * random.standard_normal(72), low, hour)
        passed += model.beats_level_1(pairs, low)
    # 1 in 44 by the two standard errors, a little more as the search has seen the readings
    assert passed <= 3


def test_a_model_of_what_level_one_lacks_beats_it():
    low = np.sin(np.arange(72) / 7.0)
    noise = 0.1 * np.random.default_rng(6).standard_normal(72)
    model, pairs = fitted(1.5 * low + 0.3 + noise, low, np.timedelta64(20, "m"))
    assert model.beats_level_1(pairs, low)
