"""Where a table answers: boxes and discs as unit cubes."""

import json

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import current_features
from seacage.surrogates._tables._region import Box, Disc, restore_region

REGIONS = [
    Box(lower=(-1.0, 10.0), upper=(1.0, 30.0)),
    Box(lower=(0.0, 0.0, -2.0), upper=(1.0, 360.0, 5.0), closed=(1,)),
    Disc(radius=1.2),
    Disc(radius=0.7, length_first=False),
]


@pytest.mark.parametrize("region", REGIONS, ids=str)
def test_an_input_is_found_at_its_place(region) -> None:
    place = np.random.default_rng(0).uniform(0.01, 0.99, (50, len(region.periodic)))
    x = region.inputs(place)
    assert x.shape == (50, region.width)
    assert region.contains(x).all()
    np.testing.assert_allclose(region.check_places(x, what="test"), place, atol=1e-12)


@pytest.mark.parametrize("region", REGIONS, ids=str)
def test_a_region_is_saved_and_comes_back(region) -> None:
    assert restore_region(json.loads(json.dumps(region.to_settings()))) == region


def test_the_rim_is_inside_and_a_little_beyond_is_not() -> None:
    disc = Disc(radius=1.0)
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    assert disc.contains(current_features(rim)).all()
    assert not disc.contains(current_features(1.0001 * rim)).any()
    box = Box(lower=(0.0,), upper=(1.0,))
    x = np.array([[-1e-6], [0.0], [1.0], [1.0 + 1e-6]])
    assert box.contains(x).tolist() == [False, True, True, False]


def test_a_closed_feature_is_brought_back_from_any_turn() -> None:
    box = Box(lower=(0.0,), upper=(360.0,), closed=(0,))
    place = box.check_places(np.array([[-90.0], [270.0], [630.0], [360.0]]), what="test")
    np.testing.assert_allclose(place[:, 0], [0.75, 0.75, 0.75, 0.0])


def test_an_input_outside_is_refused_with_its_row_and_the_limits() -> None:
    x = current_features(np.array([[0.1, 0.0], [0.9, 0.9]]))
    with pytest.raises(
        InputError, match=r"1 of 2 rows lie outside .*up to 1 long.*row 1, x = 1.27"
    ):
        Disc(radius=1.0).check_places(x, what="Table.predict")
    with pytest.raises(InputError, match=r"the table \(0 to 1, 2 to 3\)"):
        Box(lower=(0.0, 2.0), upper=(1.0, 3.0)).check_places(np.zeros((1, 2)), what="test")


def test_a_length_that_is_not_the_vectors_is_refused() -> None:
    with pytest.raises(InputError, match=r"row 0 says its length is 0.5, but its vector is 0.3"):
        Disc(radius=1.0).contains(np.array([[0.5, 0.3, 0.0]]))


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: Box(lower=(0.0,), upper=(1.0, 2.0)), "1 lower and 2 upper limits"),
        (lambda: Box(lower=(0.0,) * 4, upper=(1.0,) * 4), "one to three features"),
        (lambda: Box(lower=(1.0,), upper=(1.0,)), "every lower limit has to lie below"),
        (lambda: Box(lower=(0.0,), upper=(np.inf,)), "both to be finite"),
        (lambda: Box(lower=(0.0,), upper=(1.0,), closed=(1,)), "names a feature that is not there"),
        (lambda: Disc(radius=0.0), "radius = 0 is not above 0"),
        (lambda: Disc(radius=np.nan), "radius = nan is not above 0"),
    ],
)
def test_a_region_that_cannot_be_is_refused(make, why: str) -> None:
    with pytest.raises(InputError, match=why):
        make()


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"kind": "sphere"},
        {"kind": "disc", "radius": -1.0, "length_first": True},
        {"kind": "disc", "radius": "1", "length_first": True},
        {"kind": "box", "lower": [0.0], "upper": [1.0]},
        {"kind": "box", "lower": [2.0], "upper": [1.0], "closed": []},
    ],
)
def test_a_damaged_region_is_refused(settings) -> None:
    with pytest.raises(ModelError):
        restore_region(settings)
