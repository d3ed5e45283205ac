"""The current's frame, and slack water from the earth."""

import numpy as np

from seacage.conventions import towards
from seacage.surrogates import metocean_features
from seacage.surrogates._shape._frame import (
    moment_products,
    parted,
    seen_along,
    whole,
    whole_moments,
)


def weather(speed: np.ndarray, *, seed: int = 0) -> np.ndarray:
    random = np.random.default_rng(seed)
    rows = len(speed)
    return metocean_features(
        towards(speed, random.uniform(0.0, 360.0, rows)),
        hs=random.uniform(0.0, 3.0, rows),
        wave_direction=towards(np.ones(rows), random.uniform(0.0, 360.0, rows)),
        tp=np.full(rows, 8.0),
    )


def test_taking_apart_and_putting_together_is_exact_at_every_speed() -> None:
    x = weather(np.array([0.0, 1e-9, 0.02, 0.05, 0.1, 0.7]))
    moved = np.random.default_rng(1).standard_normal((6, 4, 3))
    np.testing.assert_allclose(whole(x, parted(x, moved)), moved, atol=1e-14)


def test_slack_water_is_seen_from_the_earth_and_a_stream_along_itself() -> None:
    x = weather(np.array([0.0, 0.5]))
    alone = np.zeros((2, 2, 2, 1, 3))
    alone[0, :, 0], alone[1, :, 1] = 1.0, 1.0
    earthly, along = (whole(x, parts) for parts in alone)
    np.testing.assert_array_equal(along[0], 0.0)
    np.testing.assert_array_equal(earthly[1], 0.0)
    np.testing.assert_array_equal(parted(x, np.ones((2, 1, 3)))[1, 0], 0.0)


def test_turning_sea_and_shape_changes_nothing_along_the_current() -> None:
    velocity, wave = np.array([[0.5, 0.0], [0.0, 0.5]]), np.array([[0.6, 0.8], [-0.8, 0.6]])
    x = metocean_features(velocity, hs=np.ones(2), wave_direction=wave)
    moved = np.array([[[1.0, 0.2, 0.3]], [[-0.2, 1.0, 0.3]]])
    along = parted(x, moved)[:, 1]
    np.testing.assert_allclose(along[1], along[0], atol=1e-14)
    np.testing.assert_allclose(seen_along(x)[1, 6:8], seen_along(x)[0, 6:8], atol=1e-14)


def test_nothing_jumps_where_the_water_turns() -> None:
    wave = {"hs": np.full(2, 2.0), "wave_direction": np.array([[0.6, 0.8]] * 2)}
    either_side = metocean_features(np.array([[1e-5, 0.0], [-1e-5, 0.0]]), **wave)
    parts = np.random.default_rng(0).standard_normal((1, 2, 3, 3)).repeat(2, axis=0)
    for seen in (seen_along(either_side), whole(either_side, parts).reshape(2, -1)):
        assert np.abs(seen[1] - seen[0]).max() < 1e-4


def test_the_current_alone_is_seen_as_it_is() -> None:
    x = metocean_features(np.array([[0.3, 0.4]]))
    np.testing.assert_array_equal(seen_along(x), x)


def test_variances_of_whole_shapes_are_those_of_drawn_ones() -> None:
    random = np.random.default_rng(2)
    x = weather(np.array([0.06]))
    direction = random.standard_normal((3, 2, 4, 3))
    spread = np.array([1.0, 0.5, 2.0])
    moments = np.tensordot((spread**2)[None], moment_products(direction), axes=1)
    told = whole_moments(x, moments)[0]
    each = whole(np.tile(x, (3, 1)), direction) * spread[:, None, None]
    expected = np.einsum("mni,mnj->ijn", each, each)
    found = [expected[0, 0], expected[1, 1], expected[2, 2], expected[0, 1]]
    np.testing.assert_allclose(told, found, rtol=1e-12, atol=1e-14)
