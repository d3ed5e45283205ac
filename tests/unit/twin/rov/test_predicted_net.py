from dataclasses import replace

import numpy as np
import pytest

from brute import brute_distance
from predicted_nets import (
    CAGE,
    NOW,
    answered,
    currents,
    drifting,
    erring_twin,
    level_1_twin,
    net_in,
)
from seacage.conventions import InputError
from seacage.ocean import SeaState
from seacage.twin import Answered, PredictedNet, StaleError
from seacage.twin._rov._clearance import sample_path


def near_net(net: PredictedNet, random: np.random.Generator, count: int) -> np.ndarray:
    node = random.integers(CAGE.node_count, size=count)
    return net.node_position[node] + 3.0 * random.normal(size=(count, 3))


def test_the_distance_is_to_the_predicted_net_on_either_side():
    net = net_in(erring_twin(), 0.4, 0.2)
    point = near_net(net, np.random.default_rng(1), 200)
    found = net.clearance(point)
    slow = brute_distance(point, net.node_position, CAGE.panels)
    np.testing.assert_allclose(found.distance, slow, atol=1e-6)
    assert net.clearance(np.array([[0.0, 0.0, -5.0]])).inside.all()
    np.testing.assert_allclose(
        np.linalg.norm(point - found.position, axis=1), found.distance, atol=1e-6
    )


def test_what_is_expected_is_the_net_less_its_known_drift():
    net = net_in(erring_twin(), 0.0, 0.0)
    # All nets drift a metre east, so the eastern wall leaves a point within, the western comes.
    east, west = [[15.0, 0.0, -5.0]], [[-15.0, 0.0, -5.0]]
    away, towards = (net.clearance(np.array(point)) for point in (east, west))
    # The mean of some sixty of 1.5 m is known to 0.2 m, and the panels lie a little askew.
    assert away.expected[0] - away.distance[0] == pytest.approx(0.9, abs=0.5)
    assert towards.expected[0] - towards.distance[0] == pytest.approx(-0.9, abs=0.5)
    # Case by case 1.5 m along, and the crumpling and the surrogate besides.
    assert 1.1 < away.sigma[0] < 2.0


@pytest.mark.slow
def test_of_a_hundred_foretellings_so_many_come_true():
    random = np.random.default_rng(5)
    foretold, happened = [], []
    for velocity in currents(60, random):
        net = net_in(erring_twin(), *velocity.tolist())
        point = near_net(net, random, 100)
        (true,) = drifting(net.node_position[None], random)
        foretold.append(net.clearance(point).p_below)
        happened.append(CAGE.nearest(point, true).distance < 1.0)
    p, was = np.concatenate(foretold), np.concatenate(happened)
    for low in (0.0, 0.2, 0.4, 0.6):
        rows = (p >= low) & (p < low + 0.2)
        # 10 points are what is promised; the fewest rows here are some 100.
        assert rows.sum() > 90
        assert was[rows].mean() == pytest.approx(p[rows].mean(), abs=0.1)


def test_without_a_known_error_the_surrogates_spread_is_all_there_is():
    net = net_in(level_1_twin(), 0.4, 0.2)
    found = net.clearance(near_net(net, np.random.default_rng(1), 50))
    np.testing.assert_allclose(found.expected, found.distance, atol=1e-9)
    assert (found.sigma <= net.node_sigma.max() + 1e-9).all()
    far = found.distance > 1.0 + 6.0 * found.sigma
    assert far.any()
    np.testing.assert_allclose(found.p_below[far], 0.0, atol=1e-6)


def test_a_point_on_the_expected_net_may_be_on_either_side_of_the_true_one():
    net = net_in(erring_twin(), 0.0, 0.0)
    wall = net.expected_position[CAGE.node(4, 0)][None]
    assert net.clearance(wall).p_through[0] == pytest.approx(0.5, abs=0.1)
    assert net.clearance(np.array([[0.0, 0.0, -5.0]])).p_through[0] < 1e-3


def test_asking_for_more_room_is_never_less_likely_to_be_denied():
    net = net_in(erring_twin(), 0.3, 0.0)
    point = near_net(net, np.random.default_rng(2), 60)
    p = np.array(
        [net.clearance(point, below=below).p_below for below in (0.0, 0.5, 1.0, 3.0, 90.0)]
    )
    assert (np.diff(p, axis=0) >= -1e-12).all()
    np.testing.assert_allclose(p[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(p[-1], 1.0, atol=1e-6)


def test_many_points_answer_as_one_does():
    net = net_in(erring_twin(), 0.3, 0.1)
    point = near_net(net, np.random.default_rng(3), 2500)
    many, one = net.clearance(point), net.clearance(point[-3:])
    for key in ("distance", "expected", "sigma", "p_below", "p_through"):
        np.testing.assert_allclose(getattr(many, key)[-3:], getattr(one, key), atol=1e-9)


def test_a_path_is_looked_at_all_along_and_at_its_corners():
    path = np.array([[0.0, 0.0, -2.0], [3.1, 0.0, -2.0], [3.1, 4.0, -2.0], [3.1, 4.0, -2.0]])
    point, along = sample_path(path)
    assert np.linalg.norm(np.diff(point, axis=0), axis=1).max() <= 0.25 + 1e-12
    assert along[-1] == pytest.approx(7.1)
    for corner in path:
        assert np.linalg.norm(point - corner, axis=1).min() < 1e-12
    np.testing.assert_allclose(sample_path(path[:1])[0], path[:1])


def test_a_paths_closest_approach_is_where_its_points_are_nearest_and_its_bounds_hold():
    net = net_in(erring_twin(), 0.4, 0.0)
    path = np.array([[0.0, 0.0, -5.0], [15.0, 0.0, -8.0], [15.0, 12.0, -8.0]])
    found = net.along(path)
    assert found.clearance.distance[found.closest] == found.clearance.distance.min()
    # Where one point decides, bound and probability are the same sum added in two orders.
    rounding = 1 + 1e-12
    assert found.clearance.p_below.max() <= found.p_least * rounding
    assert found.p_least <= found.p_below * rounding <= found.p_most * rounding**2
    assert found.p_most <= 1.0
    through = net.along(np.array([[0.0, 0.0, -5.0], [60.0, 0.0, -5.0]]))
    assert through.p_below > 0.99


def test_a_path_of_one_point_is_that_point():
    net, point = net_in(erring_twin(), 0.4, 0.0), np.array([[20.0, 3.0, -6.0]])
    assert net.along(point).p_below == pytest.approx(net.clearance(point).p_below[0])


def test_an_old_reading_is_refused_unless_it_is_allowed():
    fresh = answered(erring_twin(), 0.4, 0.2)
    unknown = erring_twin().models.answer(fresh.metocean, ["The last reading is too old."])
    stale = replace(fresh, answer=unknown, input_age_s=20000.0)
    with pytest.raises(StaleError, match="too old"):
        PredictedNet.of(erring_twin(), stale)
    net = PredictedNet.of(erring_twin(), stale, allow_stale=True)
    assert net.age_s == 20000.0
    np.testing.assert_array_equal(net.node_position, fresh.answer.node_position[0])
    with pytest.raises(StaleError, match="60 s ago; 30 s is the limit"):
        PredictedNet.of(erring_twin(), fresh, most_age_s=30.0)


def test_without_a_sound_reading_there_is_nothing_to_allow():
    unknown = erring_twin().models.answer(
        answered(erring_twin(), 0.4, 0.2).metocean, ["buoy-1 has not spoken."]
    )
    nothing = Answered(t=NOW, answer=unknown, metocean=None, input_age_s=None)
    with pytest.raises(StaleError, match="has not spoken"):
        PredictedNet.of(erring_twin(), nothing, allow_stale=True)


@pytest.mark.parametrize(
    ("point", "below"), [([[np.nan, 0.0, 0.0]], 1.0), ([], 1.0), ([[0.0, 0.0, 0.0]], -1.0)]
)
def test_what_is_no_point_or_no_distance_is_refused(point, below):
    with pytest.raises(InputError):
        net_in(erring_twin(), 0.4, 0.0).clearance(
            np.array(point, dtype=float).reshape(-1, 3), below=below
        )


def test_a_path_in_millimetres_is_refused():
    with pytest.raises(InputError, match="metres"):
        net_in(erring_twin(), 0.4, 0.0).along(np.array([[0.0, 0.0, 0.0], [25000.0, 0.0, 0.0]]))


def test_a_net_may_be_requested_in_water_that_is_only_imagined():
    sea = SeaState(current_speed=0.5, current_to=90.0)
    imagined, read = PredictedNet.under(erring_twin(), sea, t=NOW), net_in(erring_twin(), 0.5, 0.0)
    np.testing.assert_allclose(imagined.node_position, read.node_position, atol=1e-9)
    np.testing.assert_allclose(imagined.expected_position, read.expected_position, atol=1e-9)
    assert imagined.age_s == 0.0
