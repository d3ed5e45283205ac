"""Principal modes of the shape, and the paper's model on them."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import PcaGP
from seacage.surrogates._pca import all_modes


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
    modes, _ = all_modes(rows, centred=False)
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
    told, default = PcaGP(variance=0.93, restarts=0), PcaGP(restarts=0)
    assert default.fit(x, shapes).modes == told.fit(x, shapes).modes


def test_encoding_and_decoding_lose_only_what_the_modes_leave_out() -> None:
    x, shapes = swaying()
    every = PcaGP(modes=3, restarts=0).fit(x, shapes)
    np.testing.assert_allclose(every.decode(every.encode(shapes)), shapes, atol=1e-9)
    fewer = PcaGP(modes=2, restarts=0).fit(x, shapes)
    missed = fewer.decode(fewer.encode(shapes)) - shapes
    left_out = np.sqrt(np.mean(missed**2, axis=0)).ravel()
    np.testing.assert_allclose(fewer.basis.truncation, left_out, atol=1e-12)
    assert left_out.max() > 0.01


def test_the_doubt_includes_what_the_modes_leave_out() -> None:
    x, shapes = swaying()
    fitted = PcaGP(modes=1, restarts=0).fit(x, shapes)
    answer = fitted.predict(x)
    left_out = fitted.basis.truncation.reshape(5, 3)
    assert (answer.std >= left_out).all()
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
