"""Fitted models become plain arrays and come back; the promises are in the contracts."""

import json
import subprocess
import sys
from functools import cache

import numpy as np
import pytest

from seacage.conventions import ModelError
from seacage.surrogates import (
    NARGP,
    FittedGaussianProcess,
    FittedNARGP,
    FittedPcaGP,
    FittedShapeGP,
    GaussianProcess,
    PcaGP,
    ShapeGP,
    decode,
    encode,
)

X = np.random.default_rng(0).uniform(-1.0, 1.0, (25, 2))
Y = np.sin(2.0 * X[:, 0]) + X[:, 1]
SHAPES = np.sin(X @ np.random.default_rng(1).standard_normal((2, 12))).reshape(25, 4, 3)


@cache
def process() -> FittedGaussianProcess:
    return GaussianProcess(restarts=0, ensemble="never").fit(X, Y)


@cache
def two_levels() -> FittedNARGP:
    return NARGP(restarts=0).fit([(X, Y), (X[::2], Y[::2] ** 2)])


@cache
def components() -> FittedPcaGP:
    return PcaGP(modes=2, restarts=0).fit(X, SHAPES)


@cache
def shapes() -> FittedShapeGP:
    return ShapeGP(restarts=0).fit(X, SHAPES)


@pytest.mark.parametrize("fit", [process, two_levels, components, shapes])
def test_decoding_finds_the_kind_of_what_was_encoded(fit) -> None:
    fitted = fit()
    settings, arrays = encode(fitted)
    back = decode(json.loads(json.dumps(settings)), arrays)
    assert type(back) is type(fitted)
    np.testing.assert_array_equal(back.predict(X).mean, fitted.predict(X).mean)


def test_what_a_fitted_model_says_of_itself_is_saved() -> None:
    pca = components()
    back = decode(*encode(pca))
    assert (back.modes, back.explained_variance) == (pca.modes, pca.explained_variance)
    shape = shapes()
    assert decode(*encode(shape)).compression_error_m == shape.compression_error_m


@pytest.mark.slow
def test_a_lent_level_1_is_not_saved_twice() -> None:
    base = GaussianProcess(restarts=0).fit(X, np.stack([Y, Y**2], axis=1)).output(0)
    fitted = NARGP(restarts=0).fit([(X[::2], Y[::2] ** 2)], lower=base)
    settings, arrays = encode(fitted)
    assert {name.split(".")[0] for name in arrays} == {"0"}
    assert arrays["0.inputs"].shape == (13, 3)
    back = decode(settings, arrays, lower=base)
    np.testing.assert_array_equal(back.predict(X).std, fitted.predict(X).std)


@pytest.mark.slow
def test_a_lent_level_1_has_to_be_given_back() -> None:
    lent = NARGP(restarts=0).fit([(X, Y**2)], lower=process())
    with pytest.raises(ModelError, match="needs its level 1 given"):
        decode(*encode(lent))
    with pytest.raises(ModelError, match="has its own level 1"):
        decode(*encode(two_levels()), lower=process())


@pytest.mark.parametrize("model", ["oracle", 3, None])
def test_a_model_of_an_unknown_kind_is_refused(model: object) -> None:
    settings, arrays = encode(process())
    with pytest.raises(ModelError):
        decode(settings | {"model": model}, arrays)


def test_a_model_that_says_no_kind_is_refused() -> None:
    with pytest.raises(ModelError, match="setting 'model' is None"):
        decode({}, {})


def test_arrays_of_another_precision_are_refused() -> None:
    settings, arrays = encode(process())
    arrays["weights"] = arrays["weights"].astype(np.float32)
    with pytest.raises(
        ModelError, match=r"'weights' is float32 \(1, 25, 1\); expected finite float64"
    ):
        decode(settings, arrays)


def test_arrays_that_do_not_fit_one_another_are_refused() -> None:
    settings, arrays = encode(process())
    with pytest.raises(ModelError, match=r"'weights' .* expected finite float64 \(1, 24, 1\)"):
        decode(settings, arrays | {"inputs": arrays["inputs"][:24]})


@pytest.mark.parametrize("size", [-800.0, 800.0])
def test_a_covariance_that_no_model_has_is_refused(size: float) -> None:
    settings, arrays = encode(process())
    wild = {"log_parameters": np.array([[size, 0.0, 0.0]]), "log_noise": np.array([[-800.0]])}
    with pytest.raises(ModelError, match="covariance is not positive definite"):
        decode(settings, arrays | wild)


def test_levels_that_do_not_stand_on_one_another_are_refused() -> None:
    settings, arrays = encode(two_levels())
    parts = settings["levels"]
    upside_down = {f"{1 - int(name[0])}{name[1:]}": values for name, values in arrays.items()}
    with pytest.raises(ModelError, match="levels do not fit together"):
        decode(settings | {"levels": parts[::-1]}, upside_down)
    with pytest.raises(ModelError, match="levels do not fit together"):
        decode(settings | {"levels": []}, {})


def test_a_setting_of_another_kind_is_refused() -> None:
    settings, arrays = encode(process())
    with pytest.raises(ModelError, match="setting 'single' is 'yes', not of kind bool"):
        decode(settings | {"single": "yes"}, arrays)


def test_loading_the_room_leaves_scipy_for_when_it_is_needed() -> None:
    # The command line loads this room to print its help.
    script = "import sys, seacage.surrogates; print('scipy.linalg' in sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    )
    assert result.stdout.strip() == "False"
