"""The whole shape from one shared kernel, compressed to a stated error."""

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import (
    FittedShapeGP,
    PcaGP,
    ShapeGP,
    Symmetry,
    coverage,
    current_features,
    decode,
    encode,
    metocean_features,
)

AROUND = np.tile(np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False), 3)
REST = np.column_stack(
    [20.0 * np.cos(AROUND), 20.0 * np.sin(AROUND), -np.repeat([0.0, 10.0, 20.0], 8)]
)
SYMMETRY = Symmetry.of(REST, fold=4, mirror=0.0)


def net(rows: int, *, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A toy net of 24 nodes that sways and lifts with the square of the current."""
    random = np.random.default_rng(seed)
    speed, angle = random.uniform(0.0, 1.0, rows), random.uniform(0.0, 2.0 * np.pi, rows)
    velocity = speed[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return current_features(velocity), shaped(speed, angle, velocity)


def shaped(speed: np.ndarray, angle: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    rest, depth = REST[:, :2], -REST[:, 2]
    sway = np.tanh(2.0 * speed**2)[:, None] * depth / 2.0
    heading = velocity / np.maximum(speed, 1e-12)[:, None]
    position = np.empty((len(speed), 24, 3))
    position[:, :, :2] = rest + sway[:, :, None] * heading[:, None]
    # The lift differs round the ring, so that more than a few modes are needed.
    lift = np.cos(AROUND - angle[:, None])
    position[:, :, 2] = sway**2 / 60.0 * (1.0 + 0.3 * lift) - depth
    return position


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


def test_a_coordinate_shares_the_shape(fitted: FittedShapeGP) -> None:
    assert fitted.coordinate(3, 2).shape is fitted


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


def in_waves(rows: int, *, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The toy net, drifting along with the waves besides."""
    random = np.random.default_rng(seed)
    x, position = net(rows, seed=seed + 1000)
    hs, angle = random.uniform(0.0, 2.0, rows), random.uniform(0.0, 2.0 * np.pi, rows)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    position[:, :, :2] += 0.3 * (hs[:, None] * along)[:, None]
    return metocean_features(x[:, 1:], hs=hs, wave_direction=along), position


MODES = ("centre", "direction", "truncation")

OPTIONS = [
    {"symmetry": SYMMETRY},
    {"symmetry": Symmetry.of(REST, fold=8)},
]


@pytest.fixture(scope="module", params=range(len(OPTIONS)))
def turnable(request: pytest.FixtureRequest) -> FittedShapeGP:
    return ShapeGP(restarts=0, asymmetry=0.1, **OPTIONS[request.param]).fit(*in_waves(150, seed=0))


def test_a_symmetry_predicts_unseen_shapes(turnable: FittedShapeGP) -> None:
    x, shapes = in_waves(60, seed=1)
    answer = turnable.predict(x, noisy=True)
    assert np.abs(answer.mean - shapes).mean() < 0.03
    assert 0.85 < coverage(shapes, answer.mean, answer.std) <= 1.0


def test_a_symmetry_makes_the_most_of_few_cases() -> None:
    x, shapes = in_waves(60, seed=1)
    few = in_waves(60, seed=2)
    error = [
        np.abs(ShapeGP(restarts=0, asymmetry=0.2, symmetry=one).fit(*few).predict(x).mean - shapes)
        for one in (SYMMETRY, None)
    ]
    assert error[0].mean() < 0.7 * error[1].mean()


def test_turning_the_sea_turns_the_answer() -> None:
    fitted = ShapeGP(restarts=0, asymmetry=0.1, symmetry=SYMMETRY).fit(*in_waves(150, seed=0))
    x, _ = in_waves(20, seed=3)
    answer = fitted.predict(x)
    for image in range(len(SYMMETRY)):
        turned = fitted.predict(SYMMETRY.turned(x, image))
        # Where two sectors meet both have a say, in another order after the turn.
        np.testing.assert_allclose(
            turned.mean, SYMMETRY.moved(answer.mean, image), atol=1e-8, rtol=0.0
        )


def test_nothing_jumps_between_sectors_nor_in_slack_water(turnable: FittedShapeGP) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 721)
    wave = {"hs": np.ones(721), "wave_direction": np.tile([0.6, 0.8], (721, 1))}
    round_about = 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    through_slack = np.linspace(-0.05, 0.05, 721)[:, None] * np.array([[0.8, 0.6]])
    for velocity in (round_about, through_slack):
        answer = turnable.predict(metocean_features(velocity, **wave))
        for values in (answer.mean, answer.std):
            step = np.abs(np.diff(values, axis=0)).max()
            # Of 720 steps none may be more than a few times the usual one; a jump would be 50.
            assert step < 12.0 * np.abs(np.diff(values, axis=0)).max(axis=(1, 2)).mean()


def test_one_coordinate_of_a_turned_shape_answers_as_the_whole(turnable: FittedShapeGP) -> None:
    x, _ = in_waves(20, seed=2)
    whole = turnable.predict(x, noisy=True)
    alone = turnable.coordinate(13, 1).predict(x, noisy=True)
    np.testing.assert_allclose(alone.mean, whole.mean[:, 13, 1], atol=1e-9)
    np.testing.assert_allclose(alone.std, whole.std[:, 13, 1], rtol=1e-6)


def test_the_mean_of_some_nodes_is_that_of_the_whole_shape(
    fitted: FittedShapeGP, turnable: FittedShapeGP
) -> None:
    nodes = np.array([13, 2])
    for shape, x in ((fitted, net(7, seed=4)[0]), (turnable, in_waves(7, seed=4)[0])):
        whole = shape.predict(x).mean[:, nodes]
        np.testing.assert_allclose(shape.mean_of_nodes(x, nodes), whole, atol=1e-9)


def test_a_turned_shape_is_saved_exactly(turnable: FittedShapeGP) -> None:
    x, _ = in_waves(20, seed=2)
    settings, arrays = encode(turnable)
    back = decode(settings, arrays)
    np.testing.assert_array_equal(back.predict(x).mean, turnable.predict(x).mean)
    np.testing.assert_array_equal(back.predict(x).std, turnable.predict(x).std)
    with pytest.raises(ModelError, match="frame 'moon', which this version does not know"):
        decode({**settings, "frame": "moon"}, arrays)
    with pytest.raises(ModelError, match="modes of 69 coordinates, but 24 nodes"):
        decode(settings, arrays | {name: arrays[name][..., :69] for name in MODES})


def test_intervals_are_calibrated_on_cases_left_out(fitted: FittedShapeGP) -> None:
    _, shapes = net(150, seed=0)
    left_out = fitted.scores.leave_one_out()
    missed = np.abs(shapes - fitted.render(left_out.mean))
    moments = fitted.variance(left_out.std, slice(None))
    inside = missed <= 1.96 * np.sqrt(np.swapaxes(moments[:, :3], 1, 2))
    # 144 of 150 at each coordinate; the upper ring hardly moves, and one case more may be inside.
    np.testing.assert_allclose(inside[:, 8:].mean(axis=0), 0.96, atol=1e-9)


def test_a_cage_without_the_symmetry_is_refused() -> None:
    x, shapes = in_waves(150, seed=0)
    shapes[:, 3, 2] -= 1.0
    with pytest.raises(InputError, match=r"m from symmetric, above the tolerance of 0\.05 m"):
        ShapeGP(symmetry=SYMMETRY).fit(x, shapes)


@pytest.mark.parametrize("options", OPTIONS)
def test_features_that_cannot_be_turned_are_refused(options: dict) -> None:
    x, shapes = in_waves(30, seed=0)
    with pytest.raises(InputError, match="turns the 3, 6 or 7 of metocean_features"):
        ShapeGP(**options).fit(x[:, :5], shapes)
    degrees = x.copy()
    degrees[:, 1] = 90.0
    with pytest.raises(InputError, match="Directions in degrees cannot be turned"):
        ShapeGP(**options).fit(degrees, shapes)


def test_scores_of_unlike_std_are_summed_one_by_one(turnable: FittedShapeGP) -> None:
    prior = turnable.scores.amplitude
    alike = turnable.variance(np.tile(0.3 * prior, (4, 1)), slice(None))
    # A hair of difference takes the other way, and must not change the sum.
    unlike = np.tile(0.3 * prior * (1.0 + 1e-7 * np.arange(len(prior))), (4, 1))
    np.testing.assert_allclose(turnable.variance(unlike, slice(None)), alike, rtol=1e-3, atol=1e-7)
