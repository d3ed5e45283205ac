"""A model says where it guesses."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import Domain, current_features

CAMPAIGN = np.array([[0.0, 5.0], [1.0, 5.0], [0.4, 7.0]])


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
