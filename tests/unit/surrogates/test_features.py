"""Directions become vectors, and a model says where it guesses."""

import numpy as np
import pytest

from seacage.conventions import InputError, towards
from seacage.surrogates import Domain, current_features, metocean_features, wave_features
from seacage.surrogates._features import check_turnable

CAMPAIGN = np.array([[0.0, 5.0], [1.0, 5.0], [0.4, 7.0]])


def test_features_are_speed_east_and_north() -> None:
    velocity = np.array([[0.3, 0.4], [-0.6, 0.8], [0.0, 0.0]])
    expected = [[0.5, 0.3, 0.4], [1.0, -0.6, 0.8], [0.0, 0.0, 0.0]]
    np.testing.assert_allclose(current_features(velocity), expected, rtol=1e-14)


def test_north_has_no_seam() -> None:
    either_side = towards(np.array([0.5, 0.5]), np.array([359.999, 0.001]))
    one, other = current_features(either_side)
    assert np.abs(one - other).max() < 1e-4


def test_waves_are_their_height_and_its_vector() -> None:
    along = np.array([[0.6, 0.8], [0.0, -1.0]])
    features = wave_features(np.array([2.0, 0.5]), along)
    np.testing.assert_allclose(features, [[2.0, 1.2, 1.6], [0.5, 0.0, -0.5]], rtol=1e-14)


def test_with_a_period_waves_are_the_speed_of_the_surface_and_their_height() -> None:
    hs, tp = np.array([2.0, 0.0]), np.array([8.0, 0.0])
    features = wave_features(hs, np.array([[0.6, 0.8], [1.0, 0.0]]), tp=tp)
    speed = np.pi * 2.0 / 8.0
    expected = [[speed, 0.6 * speed, 0.8 * speed, 2.0], [0.0, 0.0, 0.0, 0.0]]
    np.testing.assert_allclose(features, expected, rtol=1e-14)


@pytest.mark.parametrize(("names", "columns"), [("", 3), ("hs wave", 6), ("hs wave tp", 7)])
def test_metocean_features_are_the_current_then_the_waves(names: str, columns: int) -> None:
    velocity, along = np.array([[0.3, -0.4]]), np.array([[0.0, 1.0]])
    every = {"hs": np.array([1.0]), "wave_direction": along, "tp": np.array([6.0])}
    body = {name: value for name, value in every.items() if name.split("_")[0] in names.split()}
    x = metocean_features(velocity, **body)
    assert x.shape == (1, columns)
    np.testing.assert_array_equal(x[:, :3], current_features(velocity))
    if columns > 3:
        np.testing.assert_array_equal(
            x[:, 3:], wave_features(every["hs"], along, tp=body.get("tp"))
        )
    check_turnable(x, what="test")


def test_waves_without_a_direction_are_refused() -> None:
    with pytest.raises(InputError, match="waves need both hs and wave_direction"):
        metocean_features(np.zeros((1, 2)), hs=np.ones(1))
    with pytest.raises(InputError, match="waves need both hs and wave_direction"):
        metocean_features(np.zeros((1, 2)), tp=np.ones(1))


def test_degrees_are_not_taken_for_a_vector() -> None:
    with pytest.raises(InputError, match=r"in row 1 feature 0 = 0\.5 is not the length of"):
        check_turnable(np.array([[0.0, 0.0, 0.0], [0.5, 90.0, 1.0]]), what="ShapeGP.fit")
    with pytest.raises(InputError, match="2 features per row"):
        check_turnable(np.zeros((1, 2)), what="ShapeGP.fit")


def test_every_training_case_is_inside() -> None:
    assert Domain.of(CAMPAIGN).contains(CAMPAIGN).all()


@pytest.mark.parametrize(
    ("row", "inside"),
    [
        ([0.5, 6.0], True),
        ([1.009, 6.0], True),
        ([1.02, 6.0], False),
        ([-0.02, 6.0], False),
        ([0.5, 7.5], False),
        ([0.5, 4.9], False),
    ],
)
def test_one_feature_beyond_its_range_is_outside(row: list[float], inside: bool) -> None:
    assert Domain.of(CAMPAIGN).contains(np.array([row])).tolist() == [inside]


def test_a_feature_that_never_varied_may_not_vary() -> None:
    domain = Domain.of(np.array([[0.0, 2.0], [1.0, 2.0]]))
    assert domain.contains(np.array([[0.5, 2.0], [0.5, 2.1]])).tolist() == [True, False]


def test_the_speed_closes_the_corners_of_the_currents_box() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 60)
    fastest = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    domain = Domain.of(current_features(np.concatenate([0.0 * fastest, fastest])))
    corner, along = current_features(np.array([[0.8, 0.8], [0.56, 0.56]]))
    assert not domain.contains(corner[None])[0]
    assert domain.contains(along[None])[0]


def test_features_of_another_width_are_refused() -> None:
    with pytest.raises(InputError, match="x has 3 features per row, but 2 were learned"):
        Domain.of(CAMPAIGN).contains(np.zeros((1, 3)))
