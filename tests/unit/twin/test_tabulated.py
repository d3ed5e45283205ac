from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.testing import stand_in_seas, stand_in_twin
from seacage.twin import Loads, Metocean, TabulatedTwin, Twin

TENSION, DEPTH = 1000.0, 0.2
COARSE = {
    "tolerance": 0.1,
    "std_tolerance": 0.2,
    "least_tension_std": TENSION,
    "least_depth_std": DEPTH,
}


@cache
def twin() -> Twin:
    """The stand-in twin with level 2 of two sensors, for the sake of time."""
    whole = stand_in_twin()
    upper = {name: whole.models.upper[name] for name in ("depth-2", "shackle-3")}
    return replace(whole, models=replace(whole.models, upper=upper))


@pytest.fixture(scope="module")
def tabulated() -> TabulatedTwin:
    return TabulatedTwin.of(twin(), **COARSE)


def test_it_says_what_the_twin_says_to_the_error_that_was_requested(tabulated):
    water = Metocean.of(stand_in_seas(400, seed=8, current_speed=0.95))
    quick, answer = tabulated.predict(water), twin().predict(water)
    assert answer.bridle_level.max() == 2
    floor = np.where(np.array(answer.sensor_units) == "N", TENSION, DEPTH)
    parts = (
        (quick.bridle_tension, answer.bridle_tension, TENSION),
        (quick.sensor, answer.sensor, floor),
        (quick.sensor_low, answer.sensor_low, floor),
    )
    for own, exact, least in parts:
        std = np.maximum(exact.std, least)
        # The error is the largest of thousands of draws, not a bound: a half more is allowed.
        assert np.max(np.abs(own.mean - exact.mean) / std) < 1.5 * COARSE["tolerance"]
        assert np.max(np.abs(own.std - exact.std) / std) < 1.5 * COARSE["std_tolerance"]
    std = np.maximum(answer.bridle_tension.std, TENSION)
    error = np.abs(quick.bridle_low - answer.bridle_low) / std
    assert error.max() < 1.5 * COARSE["tolerance"]


def test_a_rope_that_goes_slack_is_held_at_zero_as_the_twin_holds_it(tabulated):
    water = Metocean.of(stand_in_seas(400, seed=9, current_speed=0.95))
    smooth = tabulated.table.predict(water.features(("current",))).mean[:, :12]
    assert smooth.min() < 0.0
    loads = tabulated.predict(water)
    assert loads.bridle_tension.mean.min() >= 0.0
    assert loads.bridle_low.min() >= 0.0


def test_beyond_the_table_the_twin_itself_answers(tabulated):
    water = Metocean.of(stand_in_seas(30, seed=10, current_speed=1.6))
    loads, answer = tabulated.predict(water), twin().predict(water)
    assert loads.in_domain.tolist() == answer.in_domain.tolist()
    beyond = ~answer.in_domain
    assert 0 < beyond.sum() < 30
    for own, exact in (
        (loads.bridle_tension, answer.bridle_tension),
        (loads.sensor, answer.sensor),
        (loads.sensor_low, answer.sensor_low),
    ):
        # Rows in other company round otherwise.
        np.testing.assert_allclose(own.mean[beyond], exact.mean[beyond], rtol=1e-5, atol=1e-5)
    assert np.isfinite(loads.sensor.std[beyond]).all()


def test_a_row_without_a_current_has_no_number(tabulated):
    water = Metocean.of(stand_in_seas(3, seed=11))
    velocity = water.current_velocity.copy()
    velocity[1] = np.nan
    loads = tabulated.predict(replace(water, current_velocity=velocity))
    assert isinstance(loads, Loads)
    assert len(loads) == 3
    assert loads.valid.tolist() == [True, False, True]
    assert not loads.in_domain[1]
    for values in (loads.bridle_tension.mean, loads.bridle_low, loads.sensor.std):
        assert np.isfinite(values[[0, 2]]).all()
        assert np.isnan(values[1]).all()


def test_no_rows_are_answered_with_none(tabulated):
    loads = tabulated.predict(Metocean.from_columns({}, 0))
    assert loads.bridle_tension.mean.shape == (0, 12)
    assert loads.sensor.mean.shape == (0, 8)


def test_a_twin_that_asks_for_waves_is_refused():
    asking = replace(twin(), models=replace(twin().models, inputs=("current", "waves")))
    with pytest.raises(InputError, match="are current and waves; a table holds the current"):
        TabulatedTwin.of(asking)
