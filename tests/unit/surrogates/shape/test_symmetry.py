"""Turns and mirrorings that bring a net onto itself."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, ModelError
from seacage.surrogates import Symmetry, metocean_features


def ring(nodes: int = 8, *, heading: float = 0.0) -> np.ndarray:
    """Two rings of nodes, one below the other, about a point that is not the origin."""
    angle = 2.0 * np.pi * np.arange(nodes) / nodes + np.deg2rad(heading)
    level = np.stack([3.0 + 5.0 * np.cos(angle), -1.0 + 5.0 * np.sin(angle)], axis=1)
    return np.vstack([np.column_stack([level, np.full(nodes, z)]) for z in (0.0, -4.0)])


def weather(rows: int, *, seed: int = 0) -> np.ndarray:
    random = np.random.default_rng(seed)
    velocity, wave = random.standard_normal((2, rows, 2))
    direction = wave / np.linalg.norm(wave, axis=1, keepdims=True)
    return metocean_features(velocity, hs=random.uniform(0.0, 3.0, rows), wave_direction=direction)


@pytest.mark.parametrize(
    ("fold", "mirror", "images"), [(1, 0.0, 2), (4, None, 4), (4, 0.0, 8), (8, 22.5, 16)]
)
def test_every_image_of_the_net_at_rest_is_the_net_at_rest(
    fold: int, mirror: float | None, images: int
) -> None:
    net = ring()
    symmetry = Symmetry.of(net, fold=fold, mirror=mirror)
    assert len(symmetry) == images
    for image in range(images):
        np.testing.assert_allclose(symmetry.moved(net[None], image)[0], net, atol=1e-12)


def test_the_reference_cage_has_a_fold_of_four_with_mirrors_whatever_its_heading() -> None:
    for heading in (0.0, 30.0):
        cage = Cage.named("ace").rotated(heading)
        assert len(Symmetry.of(cage.design_position, fold=4, mirror=-heading)) == 8


@pytest.mark.parametrize(("fold", "mirror"), [(4, None), (4, 0.0), (2, 45.0), (1, 0.0)])
def test_moving_there_and_back_is_exact(fold: int, mirror: float | None) -> None:
    symmetry = Symmetry.of(ring(), fold=fold, mirror=mirror)
    shapes = np.random.default_rng(0).standard_normal((3, 16, 3))
    x = weather(5)
    for image in range(len(symmetry)):
        back = symmetry.back(image)
        np.testing.assert_allclose(
            symmetry.moved(symmetry.moved(shapes, image), back), shapes, atol=1e-13
        )
        there = symmetry.turned(symmetry.turned(x, image), back)
        np.testing.assert_allclose(there, x, atol=1e-14)


def test_a_quarter_turn_carries_shape_and_weather_the_same_way_round() -> None:
    symmetry = Symmetry.of(ring(4), fold=4)
    shape = ring(4)[None].copy()
    shape[0, 0, 0] += 1.0  # the eastern node goes east
    moved = symmetry.moved(shape, 1)[0]
    np.testing.assert_allclose(moved[1] - ring(4)[1], [0.0, 1.0, 0.0], atol=1e-12)
    eastward = metocean_features(np.array([[1.0, 0.0]]))
    np.testing.assert_allclose(symmetry.turned(eastward, 1), [[1.0, 0.0, 1.0]], atol=1e-12)


def test_home_is_in_the_sector() -> None:
    symmetry = Symmetry.of(ring(), fold=4, mirror=0.0)
    x = weather(200)
    for row, image in zip(x, symmetry.home(x).tolist(), strict=True):
        home = symmetry.turned(row[None], image)[0]
        assert -1e-9 <= np.arctan2(home[2], home[1]) <= np.pi / 4 + 1e-9


def test_images_share_their_say_without_a_jump() -> None:
    symmetry = Symmetry.of(ring(), fold=4, mirror=0.0)
    angle = np.linspace(0.0, 2.0 * np.pi, 20_001)
    for speed in (0.5, 0.01):
        x = metocean_features(speed * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        shares = symmetry.shares(x)
        np.testing.assert_allclose(shares.sum(axis=1), 1.0, rtol=1e-12)
        # The steepest share rises by 1.5 over the band of 6 degrees, which is 333 steps.
        assert np.abs(np.diff(shares, axis=0)).max() < 1.6 / 333
    out = np.linspace(0.0, 0.03, 301)[:, None] * np.array([np.cos(0.3), np.sin(0.3)])
    shares = symmetry.shares(metocean_features(out))
    np.testing.assert_allclose(shares[0], 1.0 / 8.0)
    assert np.abs(np.diff(shares, axis=0)).max() < 0.01
    assert shares[-1].max() == pytest.approx(1.0, rel=1e-12)  # shares of a sum


def test_a_net_that_does_not_fall_on_itself_is_refused() -> None:
    with pytest.raises(InputError, match=r"turned by 120 deg, the net does not fall on itself"):
        Symmetry.of(ring(), fold=3)
    with pytest.raises(InputError, match="mirrored, the net does not fall on itself: node"):
        Symmetry.of(ring(), fold=4, mirror=10.0)
    bent = ring()
    bent[5, 2] += 0.1
    with pytest.raises(InputError, match=r"is 0\.1 m from the nearest"):
        Symmetry.of(bent, fold=4)


@pytest.mark.parametrize(("fold", "mirror"), [(0, None), (4, np.nan)])
def test_an_impossible_fold_or_mirror_is_refused(fold: int, mirror: float | None) -> None:
    with pytest.raises(InputError, match="fold is a whole number from 1"):
        Symmetry.of(ring(), fold=fold, mirror=mirror)


def test_a_saved_symmetry_comes_back_the_same() -> None:
    symmetry = Symmetry.of(ring(), fold=4, mirror=0.0)
    arrays = symmetry.to_arrays()
    back = Symmetry.from_arrays(arrays, nodes=16)
    x = weather(20)
    np.testing.assert_array_equal(back.shares(x), symmetry.shares(x))
    np.testing.assert_array_equal(back.source, symmetry.source)
    lost = {**arrays, "symmetry_source": np.zeros((8, 16))}
    with pytest.raises(ModelError, match="does not lead every node to one"):
        Symmetry.from_arrays(lost, nodes=16)
