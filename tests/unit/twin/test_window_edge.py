"""Beyond the fastest water of its window a sensor goes on by its own errors in the window."""

import math
from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import Prediction
from seacage.testing import stand_in_seas, stand_in_twin
from seacage.twin import Metocean, Pairs
from seacage.twin._correction._sensor import Correction, FixedPrediction
from seacage.twin._correction._window_edge import WindowEdge, follow_level_1

START = np.datetime64("2020-01-18T00:00", "us")


class SquareOfSpeed:
    """A level 1 that is ten times the squared speed."""

    def predict(self, x):
        return Prediction(mean=10.0 * x[:, 0] ** 2, std=np.zeros(len(x)))


def features(water):
    return np.linalg.norm(water.current_velocity, axis=1)[:, None]


def edge_of(law):
    """Edge of a sensor that reads a law of the speed, in currents up to 0.6 m/s."""
    speed = 0.6 * np.random.default_rng(0).permutation(np.arange(1, 61)) / 60.0
    water = Metocean.without_waves(np.column_stack([speed, np.zeros(60)]))
    time = START + (20 * np.arange(60)).astype("timedelta64[m]")
    pairs = Pairs(time=time, metocean=water, value=law(speed))
    model = Correction.fit(pairs, features(water), SquareOfSpeed(), restarts=0, seed=0)
    return model.with_edge(pairs, features).edge


def test_a_sensor_whose_difference_stops_growing_follows_level_1():
    edge = edge_of(lambda speed: 10.0 * speed**2 + 5.0 * np.minimum(speed, 0.42))
    assert edge.speed == pytest.approx(0.6)
    assert edge.weight > 0.9


def test_a_sensor_that_is_in_proportion_to_level_1_goes_on_by_its_gain():
    edge = edge_of(lambda speed: 15.0 * speed**2 + 1.0)
    assert edge.weight < 0.1


def test_few_readings_in_faster_water_weigh_nothing():
    low = np.sin(np.arange(8.0))
    time = START + np.arange(8).astype("timedelta64[h]")
    water = Metocean.without_waves(np.arange(8)[:, None] / 8.0 * np.ones((1, 2)))
    pairs = Pairs(time=time, metocean=water, value=low + np.cos(3.0 * np.arange(8.0)))
    fixed = FixedPrediction(prediction=Prediction(mean=low, std=0.0 * low))
    model = Correction.fit(pairs, features(water), fixed, restarts=0, seed=0)
    edge = model.with_edge(pairs, features).edge
    assert edge.speed == pytest.approx(7.0 / 8.0 * math.sqrt(2.0))
    assert edge.weight == 0.0


def test_a_mixture_is_as_wide_as_its_parts_lie_apart():
    own, at = (Prediction(mean=np.array([[m]]), std=np.array([[1.0]])) for m in (10.0, 4.0))
    found = follow_level_1(own, at, np.array([[2.0]]), np.array([0.5]))
    assert found.mean.item() == 8.0
    assert found.std.item() == pytest.approx(math.sqrt(1.0 + 0.25 * 4.0**2))
    alone = follow_level_1(own, at, np.array([[2.0]]), np.array([0.0]))
    assert (alone.mean.item(), alone.std.item()) == (10.0, 1.0)


def with_edge(edge):
    twin = stand_in_twin()
    model = replace(twin.models.upper["shackle-1"], edge=edge)
    return replace(twin, models=twin.models.with_level_2("shackle-1", model))


def test_a_twin_follows_level_1_beyond_the_edge_and_has_no_step_there():
    speed = np.array([0.2, 0.3 - 1e-9, 0.3 + 1e-9, 0.5])
    water = Metocean.without_waves(np.column_stack([-speed, 0.1 * speed]))
    edge = float(np.linalg.norm([0.3, 0.03]))
    whole = with_edge(WindowEdge(speed=edge, weight=1.0)).predict(water)
    plain = with_edge(WindowEdge(speed=edge)).predict(water)
    column = whole.sensor_names.index("shackle-1")
    mean, low = whole.sensor.mean[:, column], whole.sensor_low.mean[:, column]
    np.testing.assert_array_equal(mean[:2], plain.sensor.mean[:2, column])
    np.testing.assert_allclose(mean[2], mean[1], rtol=1e-6)
    np.testing.assert_allclose(mean[3] - mean[1], low[3] - low[1], rtol=1e-5)
    others = np.arange(len(whole.sensor_names)) != column
    np.testing.assert_array_equal(whole.sensor.mean[:, others], plain.sensor.mean[:, others])


def test_sensors_with_other_edges_each_answer_as_they_do_alone():
    water = Metocean.without_waves(np.array([[0.1, 0.0], [0.35, 0.1], [-0.6, 0.3]]))
    edges = {
        "shackle-1": WindowEdge(speed=0.3, weight=0.7),
        "depth-1": WindowEdge(speed=0.5, weight=0.4),
    }
    twin = stand_in_twin()
    plain = {name: replace(one, edge=WindowEdge()) for name, one in twin.models.upper.items()}

    def answer(some):
        upper = {name: replace(one, edge=some.get(name, one.edge)) for name, one in plain.items()}
        return replace(twin, models=replace(twin.models, upper=upper)).predict(water).sensor

    both, none = answer(edges), answer({})
    for column, name in enumerate(twin.sensor_names):
        alone = answer({name: edges[name]}) if name in edges else none
        np.testing.assert_allclose(both.mean[:, column], alone.mean[:, column], rtol=1e-9)
        np.testing.assert_allclose(both.std[:, column], alone.std[:, column], rtol=1e-9)
        moved = np.abs(both.mean[:, column] - none.mean[:, column]) > 1e-9
        beyond = np.array([0.1, 0.36, 0.67]) > edges[name].speed if name in edges else [False] * 3
        np.testing.assert_array_equal(moved, beyond)


def test_more_readings_move_the_edge_outwards_alone():
    edge = WindowEdge(speed=0.5, weight=0.3)
    calm, fast = (Metocean.of(stand_in_seas(3, current_speed=one)) for one in (0.1, 2.0))
    assert edge.reaching(calm) == edge
    assert edge.reaching(fast).speed > 0.5
    assert edge.reaching(fast).weight == 0.3


@pytest.mark.parametrize("wrong", [{"speed": -0.1}, {"weight": 1.2}, {"speed": math.nan}])
def test_numbers_that_are_no_edge_are_refused(wrong):
    with pytest.raises(InputError, match="are no edge"):
        WindowEdge(**wrong)
