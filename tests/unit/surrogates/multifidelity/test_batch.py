"""Levels that are asked together answer what each answers alone."""

import numpy as np
import pytest

from seacage.surrogates import (
    AR1,
    NARGP,
    BatchedLevels,
    FittedNARGP,
    GaussianProcess,
    ModelAverage,
    Prediction,
)
from seacage.surrogates._multifidelity import _batch as batch
from seacage.surrogates._multifidelity._nargp import AbstractMultifidelity

RANDOM = np.random.default_rng(11)
X1 = RANDOM.uniform(-1.0, 1.0, (50, 2))
NEW = RANDOM.uniform(-1.4, 1.4, (9, 2))


def low(x: np.ndarray) -> np.ndarray:
    return np.sin(4.0 * x[:, 0]) + x[:, 1] ** 2


@pytest.fixture(scope="module")
def models() -> tuple[FittedNARGP, ...]:
    base = GaussianProcess(restarts=0).fit(X1, low(X1))

    def fitted_level(model: AbstractMultifidelity, points: int, size: float) -> FittedNARGP:
        x = X1[:points]
        noise = 0.05 * np.random.default_rng(points).standard_normal(points)
        value = size * (1.3 * low(x) + 0.4 * low(x) ** 2 - x[:, 1] + noise)
        return model.fit([(x, value)], lower=base)

    return (
        fitted_level(NARGP(restarts=0, ensemble="never"), 45, 1.0),
        fitted_level(NARGP(restarts=0, ensemble="never", linear=False), 30, 2e4),
        fitted_level(AR1(restarts=0, ensemble="never"), 38, 5.0),
        fitted_level(NARGP(restarts=0, noise="by-input", ensemble="never"), 41, 0.1),
        fitted_level(NARGP(restarts=0, noise="per-output", ensemble="never"), 41, 0.1),
        fitted_level(NARGP(restarts=0, ensemble="always"), 12, 1.0),
        fitted_level(ModelAverage(restarts=0), 12, 3.0),
    )


def levels_of(models: tuple[FittedNARGP, ...]) -> BatchedLevels:
    return BatchedLevels.of([model.upper[0] for model in models])


def agree(models: tuple[FittedNARGP, ...], x: np.ndarray, below: Prediction) -> None:
    answer = levels_of(models).predict(x, below)
    for column, model in enumerate(models):
        own = Prediction(mean=below.mean[:, column], std=below.std[:, column])
        alone = model.predict(x, below=own)
        np.testing.assert_allclose(answer.mean[:, column], alone.mean, rtol=1e-9)
        np.testing.assert_allclose(answer.std[:, column], alone.std, rtol=1e-7)


def made_prediction(rows: int, models: int, spread: float) -> Prediction:
    random = np.random.default_rng(rows)
    std = spread * random.uniform(0.0, 1.0, (rows, models))
    return Prediction(mean=random.normal(0.0, 0.8, (rows, models)), std=std)


@pytest.mark.parametrize("which", range(7))
def test_one_level_answers_what_its_model_answers(
    which: int, models: tuple[FittedNARGP, ...]
) -> None:
    agree((models[which],), NEW, made_prediction(len(NEW), 1, 0.01))


@pytest.mark.parametrize("rows", [0, 1, 9])
@pytest.mark.parametrize("spread", [0.0, 0.01, 2.0])
def test_unlike_levels_answer_what_each_answers_alone(
    rows: int, spread: float, models: tuple[FittedNARGP, ...]
) -> None:
    # With the largest spread their rules differ, from row to row and from level to level.
    agree(models, NEW[:rows], made_prediction(rows, len(models), spread))


def test_rows_that_are_too_many_to_hold_at_once_are_answered_alike(
    monkeypatch: pytest.MonkeyPatch, models: tuple[FittedNARGP, ...]
) -> None:
    monkeypatch.setattr(batch, "CELLS", 2000)
    agree(models, NEW, made_prediction(len(NEW), len(models), 0.5))
