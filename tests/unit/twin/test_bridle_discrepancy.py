"""Intervals of bridles without a shackle: as wide as simulations are off at those that have one."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.surrogates import Prediction
from seacage.testing import stand_in_campaign, stand_in_seas, stand_in_twin
from seacage.twin import Metocean, Twin, interval_reason
from seacage.twin._correction._bridles import SHARED, discrepancy_std, relative_discrepancy

SEAS = stand_in_seas(40, seed=5, current_speed=0.5)


def with_shackles(count: int) -> Twin:
    """A twin with level 2 of so many shackles, and of all depth sensors."""
    twin = stand_in_twin()
    gone = [one.name for one in twin.cage.shackles][count:]
    upper = {name: one for name, one in twin.models.upper.items() if name not in gone}
    return replace(twin, models=replace(twin.models, upper=upper))


def test_a_bridle_without_a_shackle_has_an_interval_that_holds_its_true_tension():
    """The stand-in cage is softer than simulated: its loads are 1.2 times those at 1.15 speeds."""
    twin = stand_in_twin()
    answer, cage = twin.predict(SEAS), twin.cage
    faster = [replace(sea, current_speed=1.15 * sea.current_speed) for sea in SEAS]
    truth = 1.2 * stand_in_campaign(cage, faster).bridle_tension
    (lower, upper), alone = answer.bridle_interval(), answer.bridle_level == 1
    held = (lower <= truth) & (truth <= upper)
    assert alone.sum() == 7
    assert np.mean(held[:, alone]) > 0.9
    emulator = twin.models.bridles.predict(Metocean.of(SEAS).features(("current",)))
    by_emulator = np.abs(truth - emulator.mean) <= 1.96 * emulator.std
    assert np.mean(by_emulator[:, alone]) < 0.5
    np.testing.assert_allclose(answer.bridle_tension.mean[:, alone], answer.bridle_low[:, alone])


@pytest.mark.parametrize("shackles", [0, 1, 2])
def test_of_fewer_than_three_shackles_there_is_no_interval(shackles: int):
    answer = with_shackles(shackles).predict(SEAS)
    lower, upper = answer.bridle_interval()
    alone = answer.bridle_level == 1
    assert alone.sum() == 12 - shackles
    assert answer.bridle_calibrated.tolist() == (~alone).tolist()
    for end in (lower, upper):
        assert np.isnan(end[:, alone]).all()
        assert np.isfinite(end[:, ~alone]).all()
    assert np.isfinite(answer.bridle_tension.std).all()


def test_shackles_whose_own_interval_is_not_calibrated_do_not_count():
    twin = stand_in_twin()
    upper = {
        name: replace(one, spread=replace(one.spread, by="none"))
        for name, one in twin.models.upper.items()
    }
    assert replace(twin.models, upper=upper).relative_discrepancy is None


def test_the_wider_simulations_are_off_at_the_shackles_the_wider_is_the_interval():
    models = stand_in_twin().models
    upper = {
        name: replace(one, gain=2.0 * one.gain) if name.startswith("shackle") else one
        for name, one in models.upper.items()
    }
    off, before = replace(models, upper=upper).relative_discrepancy, models.relative_discrepancy
    assert off is not None
    assert before is not None
    assert off > 2.0 * before > 0.0


class Still:
    """Level 1 of lines that bear nothing in half of the water."""

    def predict(self, x: np.ndarray, /) -> Prediction:
        load = np.where(x[:, :1] > np.median(x[:, 0]), 2e4 * x[:, :1], 0.0)
        return Prediction(mean=np.tile(load, (1, 12)), std=np.ones((len(x), 12)))


def test_lines_that_all_hang_slack_in_the_simulation_do_not_blow_the_intervals_up():
    models = stand_in_twin().models
    shackles = [(one.bridle, models.upper[one.name]) for one in models.cage.shackles]
    found = relative_discrepancy(shackles, Still())
    assert found is not None
    assert found < 10.0


def test_a_slack_line_may_bear_a_share_of_what_the_others_do():
    low = Prediction(mean=np.array([[0.0, 100.0, 200.0]]), std=np.zeros((1, 3)))
    std = discrepancy_std(low, 1.0)[0]
    share = SHARED * 100.0
    np.testing.assert_allclose(std / std[0], np.array([0.0, 70.0, 140.0]) / share + 1.0)


def test_a_saved_twin_has_the_same_interval(tmp_path):
    stand_in_twin().write(tmp_path / "twin")
    kept, twin = Twin.read(tmp_path / "twin").predict(SEAS), stand_in_twin().predict(SEAS)
    np.testing.assert_array_equal(kept.bridle_interval(), twin.bridle_interval())


def test_only_what_is_not_known_has_a_reason():
    assert "No sensor has trained level 2" in str(interval_reason(known=False))
    assert interval_reason(known=True) is None
