"""What every surrogate promises, whoever wrote it."""

import json
from collections.abc import Callable, Mapping
from typing import Protocol, Self, runtime_checkable

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates import Arrays, Prediction, Settings

CASES, UNSEEN = 50, 20
Inputs = Float[np.ndarray, "_ feature"]
Outputs = Float[np.ndarray, "_ *output"]


@runtime_checkable
class FittedSurrogate(Protocol):
    """What the suite needs of a fitted model."""

    def predict(self, x: Inputs, *, noisy: bool = False) -> Prediction:
        """Answer at each row of features."""
        ...


@runtime_checkable
class SavedSurrogate(FittedSurrogate, Protocol):
    """What the suite needs of one that can be saved."""

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Describe the model by plain values and float64 arrays."""
        ...

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """Make the model again."""
        ...


# Fits a surrogate to inputs (row, 2) and outputs (row, *output), from a seed
MakeFitted = Callable[[Inputs, Outputs, int], FittedSurrogate]


def check_surrogate(
    make_fitted: MakeFitted,
    *,
    output_shape: tuple[int, ...] = (),
    extrapolates: bool = True,
    saves: bool = True,
    training_error: float = 1e-2,
    unseen_error: float = 0.05,
) -> None:
    """Hold a surrogate to what the twin relies on; an assertion names the first broken promise.

    The problem is smooth, without noise, and of three modes, so that a model of the whole
    shape may compress it.

    Parameters
    ----------
    make_fitted
        Fits the surrogate to x (row, 2) and y, one row each, from a seed.
    output_shape
        Of one case: () for a number, (5,) for five, (nodes, 3) for a shape.
    extrapolates
        Whether it answers far from its cases too, less surely; False demands that it refuses.
        Its cases lie between -1 and 1.
    saves
        Whether it can be saved; one that ``seacage score`` compares with a twin need not.
    training_error, unseen_error
        Largest miss of a case it was given, and root mean square miss of unseen ones, as
        shares of the spread. A network, which holds cases back and stops early, may need
        more; say how much.
    """
    x, y = _problem(CASES, output_shape, seed=1)
    unseen, truth = _problem(UNSEEN, output_shape, seed=2)
    fitted = make_fitted(x, y, 0)
    _check_answers(fitted, unseen, output_shape)
    _check_rows_are_independent(fitted, unseen)
    _check_it_learns(fitted, (x, y), (unseen, truth), training_error, unseen_error)
    _check_far(fitted, x, extrapolates=extrapolates)
    _check_noise(fitted, unseen)
    _check_seed(make_fitted, x, y, unseen)
    if saves:
        assert isinstance(fitted, SavedSurrogate), "it has no to_arrays and from_arrays"
        _check_saving(fitted, unseen)
    _check_refusals(fitted, make_fitted, x, y)


def _problem(rows: int, output_shape: tuple[int, ...], *, seed: int) -> tuple[Inputs, Outputs]:
    x = np.random.default_rng(seed).uniform(-1.0, 1.0, (rows, 2))
    modes = np.stack([np.sin(2.0 * x[:, 0]), x[:, 0] * x[:, 1], np.cos(2.0 * x[:, 1])], axis=1)
    mixing = np.random.default_rng(0).standard_normal((3, *output_shape))
    return x, 4.0 + np.tensordot(modes, mixing, axes=1)


def _check_answers(fitted: FittedSurrogate, unseen: Inputs, output_shape: tuple[int, ...]) -> None:
    answer = fitted.predict(unseen)
    for name, values in (("mean", answer.mean), ("std", answer.std)):
        expected = (len(unseen), *output_shape)
        assert values.shape == expected, f"{name} has shape {values.shape}, not {expected}"
        assert values.dtype == np.float64, f"{name} is {values.dtype}, not float64"
        assert np.isfinite(values).all(), f"{name} is not finite everywhere"
    assert (answer.std >= 0.0).all(), "a standard deviation is negative"
    assert fitted.predict(unseen[:0]).mean.shape == (0, *output_shape), "no rows, no answer"


def _check_rows_are_independent(fitted: FittedSurrogate, unseen: Inputs) -> None:
    together = fitted.predict(unseen)
    alone = [fitted.predict(row[None]) for row in unseen]
    for name in ("mean", "std"):
        one_by_one = np.concatenate([getattr(answer, name) for answer in alone])
        # Matrix products of other sizes round otherwise.
        np.testing.assert_allclose(
            one_by_one, getattr(together, name), rtol=1e-6, atol=1e-8, err_msg=f"{name} by row"
        )


def _check_it_learns(
    fitted: FittedSurrogate,
    given: tuple[Inputs, Outputs],
    kept: tuple[Inputs, Outputs],
    training_error: float,
    unseen_error: float,
) -> None:
    (x, y), (unseen, truth) = given, kept
    spread = y.std()
    missed = np.max(np.abs(fitted.predict(x).mean - y)) / spread
    assert missed < training_error, (
        f"it misses noise-free training cases by {missed:.2g} of their spread"
    )
    error = np.sqrt(np.mean((fitted.predict(unseen).mean - truth) ** 2)) / spread
    assert error < unseen_error, f"it misses unseen cases by {error:.2g} of the spread"


def _check_far(fitted: FittedSurrogate, x: Inputs, *, extrapolates: bool) -> None:
    if not extrapolates:
        check_refused(lambda: fitted.predict(x + 20.0), error=InputError, about="far cases")
        return
    near, far = fitted.predict(x).std.mean(), fitted.predict(x + 20.0).std.mean()
    assert far > 3.0 * near, "it is as sure far from its cases as among them"


def _check_noise(fitted: FittedSurrogate, unseen: Inputs) -> None:
    quiet, noisy = fitted.predict(unseen), fitted.predict(unseen, noisy=True)
    np.testing.assert_array_equal(noisy.mean, quiet.mean, err_msg="noise moves the mean")
    assert (noisy.std >= quiet.std).all(), "noise narrows the answer"
    assert (noisy.std > quiet.std).any(), "noise adds nothing anywhere"


def _check_seed(make_fitted: MakeFitted, x: Inputs, y: Outputs, unseen: Inputs) -> None:
    first, again = (make_fitted(x, y, 7).predict(unseen) for _ in range(2))
    np.testing.assert_array_equal(again.mean, first.mean, err_msg="the seed does not fix the mean")
    np.testing.assert_array_equal(again.std, first.std, err_msg="the seed does not fix the std")


def _check_saving(fitted: SavedSurrogate, unseen: Inputs) -> None:
    settings, arrays = fitted.to_arrays()
    for name, values in arrays.items():
        assert values.dtype == np.float64, f"array {name} is {values.dtype}, not float64"
        assert values.flags.c_contiguous, f"array {name} is not in C order"
    settings = json.loads(json.dumps(settings, allow_nan=False))
    read = {
        name: np.frombuffer(values.tobytes()).reshape(values.shape)
        for name, values in arrays.items()
    }
    back = type(fitted).from_arrays(settings, read)
    for noisy in (False, True):
        before, after = fitted.predict(unseen, noisy=noisy), back.predict(unseen, noisy=noisy)
        np.testing.assert_array_equal(after.mean, before.mean, err_msg="saving moves the mean")
        np.testing.assert_array_equal(after.std, before.std, err_msg="saving moves the std")
    for name, values in read.items():
        lost = {other: kept for other, kept in read.items() if other != name}
        unfinished = np.full_like(values, np.nan)
        for damaged in (lost, lost | {name: values[None]}, lost | {name: unfinished}):
            check_refused(
                lambda damaged=damaged: type(fitted).from_arrays(settings, damaged),
                error=ModelError,
                about=f"a damaged array {name}",
            )


def _check_refusals(
    fitted: FittedSurrogate, make_fitted: MakeFitted, x: Inputs, y: Outputs
) -> None:
    missing = x.copy()
    missing[3, 1] = np.nan
    wide = np.column_stack([x, x])
    check_refused(lambda: fitted.predict(missing), error=InputError, about="NaN in x")
    check_refused(lambda: fitted.predict(wide), error=InputError, about="too many features")
    check_refused(lambda: make_fitted(missing, y, 0), error=InputError, about="NaN in x")
    gap = y.copy()
    gap[5] = np.inf
    check_refused(lambda: make_fitted(x, gap, 0), error=InputError, about="infinity in y")


def check_refused(call: Callable[[], object], *, error: type[Exception], about: str) -> None:
    try:
        call()
    except error as refusal:
        message = str(refusal)
        assert "\n" not in message, f"refusing {about}, it says more than one line"
        assert message.endswith("."), f"refusing {about}, it makes no sentence"
        return
    raise AssertionError(f"it accepts {about}")
