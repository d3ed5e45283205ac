"""Principal modes of the shape, and the paper's model on them."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import OverTime, PcaGP
from seacage.surrogates._shape._pca import all_modes


def swaying(rows: int = 40, nodes: int = 5, modes: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Shapes that sway in a few modes of falling weight about a mean far from the origin."""
    random = np.random.default_rng(0)
    x = random.uniform(-1.0, 1.0, (rows, 2))
    score = np.stack([np.sin(2.0 * x[:, 0]), x[:, 0] * x[:, 1], np.cos(3.0 * x[:, 1])], axis=1)
    weight = np.array([4.0, 1.0, 0.3])[:modes, None]
    direction = np.linalg.qr(random.standard_normal((3 * nodes, modes)))[0].T
    mean = 20.0 * random.standard_normal(3 * nodes)
    return x, (mean + score[:, :modes] @ (weight * direction)).reshape(rows, nodes, 3)


def test_modes_are_orthonormal_and_sorted() -> None:
    _, shapes = swaying()
    modes, share = all_modes(shapes.reshape(40, -1))
    np.testing.assert_allclose(modes.direction @ modes.direction.T, np.eye(15), atol=1e-12)
    variance = np.var(modes.encode(shapes.reshape(40, -1)), axis=0)
    assert (np.diff(variance) <= 1e-12).all()
    np.testing.assert_allclose(share, np.cumsum(variance) / variance.sum(), rtol=1e-12)


def test_modes_are_the_eigenvectors_that_the_paper_names() -> None:
    _, shapes = swaying()
    rows = shapes.reshape(40, -1)
    modes, _ = all_modes(rows, about=np.zeros(15))
    value, vector = np.linalg.eigh(rows.T @ rows)
    for mode in range(3):
        along = np.abs(modes.direction[mode] @ vector[:, -1 - mode])
        assert along == pytest.approx(1.0, abs=1e-9)
    size = np.sum(modes.encode(rows) ** 2, axis=0)
    np.testing.assert_allclose(size[:3], value[::-1][:3], rtol=1e-9)


@pytest.mark.parametrize("modes", [1, 2, 3])
def test_the_fewest_modes_that_explain_the_variance_are_kept(modes: int) -> None:
    x, shapes = swaying()
    _, share = all_modes(shapes.reshape(40, -1))
    for wanted in (share[modes - 1] - 1e-9, np.append(0.0, share)[modes - 1] + 1e-9):
        fitted = PcaGP(variance=wanted, restarts=0).fit(x, shapes)
        assert fitted.modes == modes
        assert fitted.explained_variance == pytest.approx(share[modes - 1])


def test_the_paper_keeps_93_percent() -> None:
    x, shapes = swaying()
    report, default = PcaGP(variance=0.93, restarts=0), PcaGP(restarts=0)
    assert default.fit(x, shapes).modes == report.fit(x, shapes).modes


def test_encoding_and_decoding_lose_only_what_the_modes_leave_out() -> None:
    x, shapes = swaying()
    every = PcaGP(modes=3, restarts=0).fit(x, shapes)
    np.testing.assert_allclose(every.decode(every.encode(shapes)), shapes, atol=1e-9)
    fewer = PcaGP(modes=2, restarts=0).fit(x, shapes)
    missed = fewer.decode(fewer.encode(shapes)) - shapes
    left_out = np.sqrt(np.mean(missed**2, axis=0)).ravel()
    np.testing.assert_allclose(fewer.basis.truncation, left_out, atol=1e-12)
    assert left_out.max() > 0.01


def test_the_variance_includes_what_the_modes_leave_out() -> None:
    x, shapes = swaying()
    fitted = PcaGP(modes=1, restarts=0).fit(x, shapes)
    answer = fitted.predict(x)
    left_out = fitted.basis.truncation.reshape(5, 3)
    # Variances are added, and the root of a sum with next to nothing may round down.
    assert (answer.std >= left_out * (1.0 - 1e-12)).all()
    inside = np.mean(np.abs(answer.mean - shapes) < 1.96 * answer.std)
    assert 0.88 < inside <= 1.0


def test_taking_out_the_mean_leaves_the_modes_to_the_motion() -> None:
    x, shapes = swaying()
    errors = [
        np.abs(PcaGP(modes=1, centred=centred, restarts=0).fit(x, shapes).predict(x).mean - shapes)
        for centred in (True, False)
    ]
    assert errors[0].mean() < 0.5 * errors[1].mean()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"modes": 3, "variance": 0.9}, "both modes and variance"),
        ({"modes": 0}, "modes = 0 keeps nothing"),
        ({"variance": 93.0}, "variance = 93 is not a share"),
        ({"variance": 0.0}, "variance = 0 is not a share"),
    ],
)
def test_impossible_options_are_refused(options: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PcaGP(**options)


def test_more_modes_than_cases_are_refused() -> None:
    x, shapes = swaying(rows=4)
    with pytest.raises(InputError, match="modes = 5, but these cases have only 4"):
        PcaGP(modes=5).fit(x, shapes)


def test_a_shape_of_other_nodes_is_refused() -> None:
    x, shapes = swaying()
    fitted = PcaGP(modes=1, restarts=0).fit(x, shapes)
    with pytest.raises(InputError, match="encode: x has 12 features per row, but 15 were learned"):
        fitted.encode(shapes[:, :4])


def test_a_shape_that_never_moves_has_one_mode_of_nothing() -> None:
    x, shapes = swaying()
    still = np.broadcast_to(shapes[0], shapes.shape).copy()
    answer = PcaGP(restarts=0).fit(x, still).predict(x)
    np.testing.assert_allclose(answer.mean, still, atol=1e-9)
    np.testing.assert_allclose(answer.std, 0.0, atol=1e-9)


def moving(rows: int = 30, steps: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Shapes that move about their means more, and in another direction, than the means vary."""
    random = np.random.default_rng(3)
    x, means = swaying(rows, modes=1)
    to_and_fro = random.standard_normal((rows, steps, 1, 1)) * random.standard_normal((5, 3))
    to_and_fro -= to_and_fro.mean(axis=1, keepdims=True)
    return x, means[:, None] + 3.0 * to_and_fro


@pytest.mark.parametrize("centred", [True, False])
def test_modes_over_time_are_those_of_all_snapshots_in_one_table(centred: bool) -> None:
    x, shapes = moving()
    means, table = shapes.mean(axis=1), shapes.reshape(-1, 15)
    over_time = OverTime.of_snapshots(shapes.reshape(-1, 5, 3))
    fitted = PcaGP(modes=2, centred=centred, restarts=0).fit(x, means, over_time=over_time)
    expected, share = all_modes(table, about=None if centred else np.zeros(15))
    along = np.abs(np.sum(fitted.basis.direction * expected.direction[:2], axis=1))
    np.testing.assert_allclose(along, 1.0, atol=1e-9)
    assert fitted.explained_variance == pytest.approx(share[1])
    # The mean of a case's scores is the score of its mean.
    scores = [fitted.encode(case).mean(axis=0) for case in shapes]
    np.testing.assert_allclose(fitted.encode(means), scores, atol=1e-9)


def test_modes_over_time_are_not_those_of_the_means() -> None:
    x, shapes = moving()
    over_time = OverTime.of_snapshots(shapes.reshape(-1, 5, 3))
    both = [
        PcaGP(modes=1, restarts=0).fit(x, shapes.mean(axis=1), over_time=one).basis.direction[0]
        for one in (over_time, None)
    ]
    assert abs(both[0] @ both[1]) < 0.8


def test_a_campaigns_second_moment_stands_for_its_snapshots() -> None:
    _, shapes = moving()
    rest = shapes[0, 0] + 0.5
    moved = (shapes - rest).reshape(-1, 15)
    kept = OverTime.of_moment(shapes.mean(axis=1), moved.T @ moved / len(moved), rest_position=rest)
    snapshots = OverTime.of_snapshots(shapes.reshape(-1, 5, 3))
    np.testing.assert_allclose(kept.mean, snapshots.mean, atol=1e-12)
    np.testing.assert_allclose(kept.scatter, snapshots.scatter, atol=1e-9)


def test_uncentred_modes_of_displacements_start_from_the_shape_at_rest() -> None:
    x, shapes = swaying()
    rest = shapes.mean(axis=0) + 0.3
    fitted = PcaGP(modes=2, centred=False, restarts=0).fit(x, shapes, rest_position=rest)
    np.testing.assert_array_equal(fitted.basis.centre, rest.ravel())
    expected, _ = all_modes((shapes - rest).reshape(40, -1), about=np.zeros(15))
    along = np.abs(np.sum(fitted.basis.direction * expected.direction[:2], axis=1))
    np.testing.assert_allclose(along, 1.0, atol=1e-9)


def test_shapes_of_another_net_are_refused() -> None:
    x, shapes = swaying()
    over_time = OverTime.of_snapshots(shapes[:, :4])
    with pytest.raises(InputError, match="over time have 4 nodes, those of the cases 5"):
        PcaGP().fit(x, shapes, over_time=over_time)
    with pytest.raises(InputError, match="shape at rest has 4 nodes, those of the cases 5"):
        PcaGP.fit.__wrapped__(PcaGP(centred=False), x, shapes, rest_position=shapes[0, :4])
    with pytest.raises(InputError, match="do not belong to 5 nodes"):
        OverTime.of_moment(shapes, np.eye(12), rest_position=shapes[0])
