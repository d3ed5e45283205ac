"""Level 2 of the net, on a formula's cage that feels 1.15 times the buoy's current."""

from dataclasses import replace

import numpy as np
import pytest

from predicted_nets import NOW, erring_twin
from seacage.testing import stand_in_seas, stand_in_twin
from seacage.testing._stand_ins import _position
from seacage.twin import Metocean, PredictedNet, Twin
from seacage.twin._correction import volume_std

FELT = 1.15
SEAS = stand_in_seas(40, seed=5, current_speed=0.8)
WATER = Metocean.of(SEAS)


def twin_with(*sensors: str) -> Twin:
    twin = stand_in_twin()
    upper = {name: twin.models.upper[name] for name in sensors}
    return replace(twin, models=replace(twin.models, upper=upper))


@pytest.fixture(scope="module")
def true():
    return _position(stand_in_twin().cage, FELT * WATER.current_velocity)


def off(answer, true) -> float:
    return float(np.sqrt(np.mean((answer.node_position - true) ** 2)))


def test_depths_bring_the_whole_net_nearer_to_the_truth(true):
    twin = stand_in_twin()
    level_1, level_2 = twin_with().predict(SEAS), twin.predict(SEAS)
    assert (level_1.shape_level, level_2.shape_level) == (1, 2)
    assert off(level_2, true) < 0.6 * off(level_1, true)
    volume = twin.cage.volume(true) / twin.models.still_volume
    errors = [np.abs(one.volume_fraction - volume).mean() for one in (level_1, level_2)]
    assert errors[1] < 0.6 * errors[0]


def test_the_current_that_the_depths_agree_with_is_found():
    net = stand_in_twin().models.net
    assert net is not None
    fast = WATER.rows(np.linalg.norm(WATER.current_velocity, axis=1) > 0.4)
    depth = -_position(stand_in_twin().cage, FELT * fast.current_velocity)[:, list(net.nodes), 2]
    found = net.relative_current(fast, depth)
    # Between the depths', which weigh more where they have moved, and the one expected.
    assert (found > FELT - 0.05).all()
    assert np.median(found) < 1.3


def test_intervals_hold_the_true_net_and_its_volume(true):
    answer = stand_in_twin().predict(SEAS)
    held = np.abs(answer.node_position - true) <= 1.96 * answer.node_std
    assert held.mean() > 0.9
    lower, upper = answer.volume_interval()
    assert (lower <= answer.volume_fraction).all()
    assert (answer.volume_fraction <= upper).all()
    assert (lower >= 0.0).all()


@pytest.mark.parametrize("sensors", [(), ("depth-2",), ("shackle-1", "shackle-4", "depth-1")])
def test_fewer_than_two_depth_sensors_leave_level_1_without_an_interval(sensors):
    answer = twin_with(*sensors).predict(SEAS)
    assert answer.shape_level == 1
    assert np.isnan(answer.node_std).all()
    assert np.isnan(answer.volume_interval()).all()
    np.testing.assert_array_equal(answer.node_position, twin_with().predict(SEAS).node_position)


def test_depth_sensors_that_were_never_calibrated_do_not_correct_the_net():
    twin = stand_in_twin()
    upper = {
        name: replace(one, spread=replace(one.spread, by="none"))
        for name, one in twin.models.upper.items()
    }
    assert replace(twin.models, upper=upper).net is None


def test_water_without_a_current_keeps_the_net_at_rest():
    still = Metocean.without_waves(np.zeros((1, 2)))
    level_1, level_2 = twin_with().predict(still), stand_in_twin().predict(still)
    np.testing.assert_allclose(level_2.node_position, level_1.node_position, atol=1e-9)
    assert level_2.node_std.min() > 0.0


def test_water_outside_the_training_has_wider_intervals():
    answer = stand_in_twin().predict(Metocean.without_waves(np.array([[0.5, 0.0], [1.6, 0.0]])))
    assert answer.in_domain.tolist() == [True, False]
    inside, outside = answer.node_std.mean(axis=(1, 2))
    assert outside > inside
    assert np.isfinite(answer.node_position).all()


def test_a_volume_is_the_less_sure_the_more_of_it_is_lost():
    std = volume_std(np.array([1.02, 1.0, 0.8, 0.4]))
    assert (np.diff(std) >= 0.0).all()
    assert std[0] == std[1] > 0.0


def test_an_error_that_was_learned_of_level_1_is_added_to_level_1():
    twin = erring_twin()
    assert twin.discrepancy is not None
    old = replace(twin, discrepancy=replace(twin.discrepancy, level=1))
    water = Metocean.without_waves(np.array([[0.6, 0.1]]))
    nets = [PredictedNet.under(one, water, t=NOW) for one in (twin, old)]
    simulated = twin.models.level_1.answer(water, [""]).node_position[0]
    np.testing.assert_array_equal(nets[1].node_position, simulated)
    np.testing.assert_array_equal(nets[0].node_position, twin.predict(water).node_position[0])


def test_the_level_of_an_error_is_saved_with_it(tmp_path):
    twin = erring_twin()
    assert twin.discrepancy is not None
    assert twin.discrepancy.level == 2
    twin.write(tmp_path / "twin")
    read = Twin.read(tmp_path / "twin").discrepancy
    assert read is not None
    assert read.level == 2


def test_depths_that_no_simulation_has_widen_the_net():
    net = stand_in_twin().models.net
    assert net is not None
    water, nodes = WATER.rows(np.linalg.norm(WATER.current_velocity, axis=1) > 0.4), [*net.nodes]
    drawn = _position(stand_in_twin().cage, water.current_velocity)
    predicted = net.predict(water, -drawn[:, nodes, 2])
    agree = -predicted.mean[:, nodes, 2]
    uneven = agree + np.array([0.5, 0.0, -0.5]) * (agree + net.still[nodes, 2])
    narrow, wide = (net.std(water, predicted, depth) for depth in (agree, uneven))
    assert (wide >= narrow).all()
    moved = np.linalg.norm(predicted.mean - net.still, axis=2) > 2.0
    assert (wide[moved] > 1.1 * narrow[moved]).all(axis=1).mean() > 0.9
