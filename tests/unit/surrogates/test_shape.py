"""The whole shape from one shared kernel, compressed to a stated error."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import FittedShapeGP, PcaGP, ShapeGP, coverage, current_features


def net(rows: int, *, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A toy net of 24 nodes that sways and lifts with the square of the current."""
    random = np.random.default_rng(seed)
    speed, angle = random.uniform(0.0, 1.0, rows), random.uniform(0.0, 2.0 * np.pi, rows)
    velocity = speed[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    around = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    depth = np.repeat([0.0, 10.0, 20.0], 8)
    rest = np.column_stack([np.tile(20.0 * np.cos(around), 3), np.tile(20.0 * np.sin(around), 3)])
    sway = np.tanh(2.0 * speed**2)[:, None] * depth / 2.0
    heading = velocity / np.maximum(speed, 1e-12)[:, None]
    position = np.empty((rows, 24, 3))
    position[:, :, :2] = rest + sway[:, :, None] * heading[:, None]
    # The lift differs round the ring, so that more than a few modes are needed.
    lift = np.cos(np.tile(around, 3) - angle[:, None])
    position[:, :, 2] = sway**2 / 60.0 * (1.0 + 0.3 * lift) - depth
    return current_features(velocity), position


@pytest.fixture(scope="module")
def fitted() -> FittedShapeGP:
    return ShapeGP(restarts=0).fit(*net(150, seed=0))


def test_an_unseen_shape_is_predicted_to_centimetres(fitted: FittedShapeGP) -> None:
    x, shapes = net(60, seed=1)
    answer = fitted.predict(x)
    assert np.abs(answer.mean - shapes).mean() < 0.02
    assert 0.9 < coverage(shapes, answer.mean, answer.std) <= 1.0


def test_it_beats_three_modes(fitted: FittedShapeGP) -> None:
    x, shapes = net(60, seed=1)
    modes = PcaGP(modes=3, restarts=0).fit(*net(150, seed=0)).predict(x).mean
    assert np.abs(fitted.predict(x).mean - shapes).mean() < 0.2 * np.abs(modes - shapes).mean()


@pytest.mark.parametrize("tolerance", [1e-3, 0.1])
def test_compression_keeps_to_its_tolerance_with_the_fewest_modes(tolerance: float) -> None:
    x, shapes = net(80, seed=0)
    fitted = ShapeGP(tolerance=tolerance, restarts=0).fit(x, shapes)
    rows = shapes.reshape(80, -1)

    def worst_node(modes: int) -> float:
        centred = rows - rows.mean(axis=0)
        left, size, right = np.linalg.svd(centred, full_matrices=False)
        missed = centred - (left[:, :modes] * size[:modes]) @ right[:modes]
        return float(np.sqrt(np.mean(missed**2, axis=0).reshape(-1, 3).sum(axis=1).max()))

    assert fitted.compression_error_m == pytest.approx(worst_node(fitted.modes), abs=1e-9)
    assert fitted.compression_error_m <= tolerance < worst_node(fitted.modes - 1)


def test_one_coordinate_answers_as_within_the_whole_shape(fitted: FittedShapeGP) -> None:
    x, _ = net(20, seed=2)
    for noisy in (False, True):
        whole = fitted.predict(x, noisy=noisy)
        for node, axis in ((0, 0), (13, 1), (23, 2)):
            alone = fitted.coordinate(node, axis).predict(x, noisy=noisy)
            np.testing.assert_allclose(alone.mean, whole.mean[:, node, axis], atol=1e-9)
            np.testing.assert_allclose(alone.std, whole.std[:, node, axis], rtol=1e-6)


def test_a_coordinate_shares_the_factor_of_the_shape(fitted: FittedShapeGP) -> None:
    assert fitted.coordinate(3, 2).process.posterior.factor is fitted.scores.posterior.factor


@pytest.mark.parametrize(("node", "axis"), [(24, 0), (-1, 0), (0, 3), (0, -1)])
def test_a_coordinate_that_does_not_exist_is_refused(
    fitted: FittedShapeGP, node: int, axis: int
) -> None:
    with pytest.raises(InputError, match="this shape has 24 nodes"):
        fitted.coordinate(node, axis)


def test_a_tolerance_of_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="tolerance = 0 m is not above 0"):
        ShapeGP(tolerance=0.0)


def test_positions_without_three_coordinates_are_refused() -> None:
    with pytest.raises(InputError, match=r"expected \(rows, nodes, 3\)"):
        ShapeGP.fit.__wrapped__(ShapeGP(), np.zeros((4, 3)), np.zeros((4, 5, 2)))
