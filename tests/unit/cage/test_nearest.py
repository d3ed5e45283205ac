import numpy as np
import pytest

from brute import brute_distance
from seacage.cage import Cage
from seacage.cage._nearest import nearest_on_net

CAGE = Cage.named("ace")
SQUARE = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]])
PANEL = np.array([[0, 1, 2, 3]])
"""A panel that looks up: its corners run counter-clockwise seen from above."""


def bent_net(seed: int) -> np.ndarray:
    """Return the cage's net, sheared and crumpled."""
    shape = CAGE.design_position.copy()
    shape[:, 0] += -0.3 * shape[:, 2]
    return shape + 0.2 * np.random.default_rng(seed).standard_normal(shape.shape)


def densely(shape: np.ndarray, panels: np.ndarray, points_per_edge: int) -> np.ndarray:
    """Return points spread over all triangles of a net."""
    u, v = np.meshgrid(*[np.linspace(0.0, 1.0, points_per_edge)] * 2)
    u, v = u[u + v <= 1.0], v[u + v <= 1.0]
    share = np.stack([1.0 - u - v, u, v], axis=1)
    cut = np.concatenate([panels[:, [0, 1, 2]], panels[:, [0, 2, 3]]])
    return np.einsum("wk,tkj->twj", share, shape[cut]).reshape(-1, 3)


@pytest.mark.parametrize(
    ("point", "foot", "normal"),
    [
        ([1.0, 0.5, 3.0], [1.0, 0.5, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.5, -3.0], [1.0, 0.5, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, -2.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([5.0, 6.0, 0.0], [2.0, 2.0, 0.0], [0.0, 0.0, 1.0]),
    ],
    ids=["above", "below", "beside an edge", "beyond a corner"],
)
def test_the_nearest_point_of_a_square_is_where_one_expects_it(point, foot, normal):
    near = nearest_on_net(np.array([point]), SQUARE, PANEL)
    np.testing.assert_allclose(near.position[0], foot, atol=1e-12)
    np.testing.assert_allclose(near.normal[0], normal, atol=1e-12)
    np.testing.assert_allclose(near.distance[0], np.linalg.norm(np.subtract(point, foot)))
    assert near.inside[0] == (point[2] < 0.0)


def test_no_point_of_the_net_is_nearer_and_a_dense_cloud_of_them_hardly_farther():
    shape = bent_net(0)
    point = np.random.default_rng(1).uniform([-60, -60, -45], [60, 60, 0], (60, 3))
    cloud = densely(shape, CAGE.panels, 17)
    nearest = np.array([np.linalg.norm(cloud - one, axis=1).min() for one in point])
    distance = CAGE.nearest(point, shape).distance
    assert (distance <= nearest + 1e-9).all()
    # The cloud's points lie a third of a metre apart.
    assert (nearest - distance).max() < 0.2
    assert np.median(nearest - distance) < 1e-2


def test_the_weights_give_the_nearest_point_and_the_normal_leads_back_to_the_point():
    shape = bent_net(2)
    point = np.random.default_rng(3).uniform([-40, -40, -30], [40, 40, 0], (500, 3))
    near = CAGE.nearest(point, shape)
    again = np.einsum("pk,pkj->pj", near.weight, shape[near.node])
    np.testing.assert_allclose(again, near.position, atol=1e-9)
    np.testing.assert_allclose(near.weight.sum(axis=1), 1.0)
    assert (near.weight >= 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(near.normal, axis=1), 1.0)
    away = np.einsum("pj,pj->p", point - near.position, near.normal)
    assert ((away < 0.0) == near.inside).all()


def test_the_middle_of_the_cage_is_inside_and_the_sea_around_it_is_not():
    shape = CAGE.design_position
    around = np.array([[0.0, 0.0, -5.0], [10.0, 0.0, -8.0], [40.0, 0.0, -5.0], [0.0, 0.0, -60.0]])
    assert CAGE.nearest(around, shape).inside.tolist() == [True, True, False, False]


def test_a_point_on_the_net_is_at_distance_nought_and_many_points_answer_as_one():
    shape = bent_net(4)
    point = np.concatenate([shape, np.random.default_rng(5).uniform(-30.0, 0.0, (1500, 3))])
    near = CAGE.nearest(point, shape)
    np.testing.assert_allclose(near.distance[: len(shape)], 0.0, atol=1e-6)
    alone = [CAGE.nearest(one[None], shape).distance[0] for one in point[-20:]]
    np.testing.assert_allclose(alone, near.distance[-20:], rtol=1e-12)
    assert len(CAGE.nearest(point[:0], shape).distance) == 0


@pytest.mark.slow
def test_ten_thousand_distances_are_those_to_every_triangle_in_turn():
    shape = bent_net(6)
    random = np.random.default_rng(7)
    far = random.uniform([-60.0, -60.0, -45.0], [60.0, 60.0, 0.0], (5000, 3))
    # Half of them at the net itself, where an ROV is.
    close = shape[random.integers(len(shape), size=5000)] + random.normal(size=(5000, 3))
    point = np.concatenate([far, close])
    slow = brute_distance(point, shape, CAGE.panels)
    # Two ways of rounding; a millimetre is what people ask for.
    np.testing.assert_allclose(CAGE.nearest(point, shape).distance, slow, atol=1e-6)
