"""Nonlinear autoregressive Gaussian processes: each fidelity corrects the one below."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import (
    Arrays,
    Settings,
    joined,
    setting,
    sub_settings,
    within,
)
from seacage.surrogates._gaussian_process import (
    FittedGaussianProcess,
    check_restarts,
    fitted_process,
    teachers,
)
from seacage.surrogates._kernels import AutoregressiveKernel, kernel_named
from seacage.surrogates._prediction import Prediction, Predicts, checked_inputs, checked_outputs
from seacage.surrogates._quadrature import carried

WHAT = "NARGP.fit"

Cases = tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]]
"""Inputs (n, features) and outputs (n,) of one fidelity."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NARGP:
    """Nonlinear autoregressive multifidelity regression, not yet fitted; any number of levels.

    Level 1 is a Gaussian process of the inputs. Each level above is one of the inputs and of
    the level below, f_t(x) = g_t(x, f_{t-1}(x)), trained at the posterior mean of the level
    below, so that its inputs need not be among those below.

    Parameters
    ----------
    linear
        Add a linear term in the level below to the kernel, which extrapolates a plain ratio of
        the two; False is the kernel as published.
    restarts
        Random starts of each level's hyperparameter search beside the deterministic one.

    References
    ----------
    Perdikaris et al. (2017), "Nonlinear information fusion algorithms for data-efficient
    multi-fidelity modelling", Proc. R. Soc. A 473:20160751.
    """

    linear: bool = True
    restarts: int = 3

    def __post_init__(self) -> None:
        check_restarts(self.restarts)

    def fit(
        self,
        levels: Sequence[Cases],
        *,
        seed: int = 0,
        nested: bool = False,
        lower: Predicts | None = None,
    ) -> "FittedNARGP":
        """Learn each level from its own cases.

        Parameters
        ----------
        levels
            Inputs (n, features) and outputs (n,) of each level, from low to high fidelity.
        seed
            Of the subsets of points and of the random starts.
        nested
            Demand that the inputs of each level are among those of the level below, and use the
            outputs observed there instead of the posterior mean.
        lower
            A fitted model that serves as level 1; ``levels`` then begins at level 2. It has to
            answer with one number per row.

        Raises
        ------
        InputError
            No level, tables that do not fit, or inputs that are not nested though they should be.
        """
        cases = _checked_cases(levels, first=1 if lower is None else 2)
        if nested and lower is not None:
            raise InputError(
                f"{WHAT}: nested=True needs the cases of level 1, but `lower` has none to give. "
                "Pass `nested=False` to use its mean."
            )
        seeds = np.random.SeedSequence(seed).generate_state(len(cases)).tolist()
        if lower is None:
            first, fitted = 1, FittedNARGP(own=(self._base(*cases[0], seed=seeds[0]),))
        else:
            first, fitted = 0, FittedNARGP(own=(), lent=lower)
        for index in range(first, len(cases)):
            x, y = cases[index]
            if nested:
                below = _observed_below(x, cases[index - 1], level=index + 1)
            else:
                below = _one_per_row(fitted.predict(x).mean)
            added = self._added(x, below, y, seed=seeds[index])
            fitted = replace(fitted, own=(*fitted.own, added))
        return fitted

    def _base(
        self, x: Float[np.ndarray, "n feature"], y: Float[np.ndarray, " n"], *, seed: int
    ) -> FittedGaussianProcess:
        return fitted_process(
            kernel_named("squared-exponential"),
            x,
            y[:, None],
            taught_by=teachers(y[:, None]),
            restarts=self.restarts,
            seed=seed,
        )

    def _added(
        self,
        x: Float[np.ndarray, "n feature"],
        below: Float[np.ndarray, " n"],
        y: Float[np.ndarray, " n"],
        *,
        seed: int,
    ) -> FittedGaussianProcess:
        return fitted_process(
            AutoregressiveKernel(linear=self.linear),
            np.column_stack([x, below]),
            y[:, None],
            taught_by=teachers(y[:, None]),
            restarts=self.restarts,
            seed=seed,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedNARGP:
    """Levels of fidelity, each answering from the one below.

    Parameters
    ----------
    own
        The levels learned here: from level 1, or from level 2 where level 1 is lent.
    lent
        Level 1 where another model serves as it; it is not saved with this one.
    """

    MODEL: ClassVar[str] = "nargp"

    own: tuple[FittedGaussianProcess, ...]
    lent: Predicts | None = None

    @property
    def levels(self) -> int:
        """The number of fidelities."""
        return len(self.own) + (self.lent is not None)

    @property
    def lower(self) -> Predicts:
        """Level 1."""
        return self.own[0] if self.lent is None else self.lent

    @property
    def upper(self) -> tuple[FittedGaussianProcess, ...]:
        """Level 2 and above, each a process of the inputs and of the level below."""
        return self.own[1:] if self.lent is None else self.own

    def predict(
        self,
        x: Float[np.ndarray, "row feature"],
        *,
        level: int | None = None,
        noisy: bool = False,
    ) -> Prediction:
        """Answer at each row of features.

        Parameters
        ----------
        x
            One row per case, the features of the training.
        level
            From 1, the lowest, to ``levels``, which None means.
        noisy
            Of a new observation at this level: adds its noise.
        """
        level = self.levels if level is None else level
        if not 1 <= level <= self.levels:
            raise InputError(
                f"predict: level = {level} does not exist; this model has levels 1 to "
                f"{self.levels}."
            )
        if level == 1:
            return self._lowest(x, noisy=noisy)
        upper = self.upper[: level - 1]
        x = checked_inputs(x, what="predict", width=len(upper[0].inputs.centre) - 1)
        below = self.lower.predict(x)
        steps = [_Step(process) for process in upper]
        mean, variance = carried(steps, x, below.mean, below.std**2)
        return Prediction(mean=mean, std=np.sqrt(variance + noisy * upper[-1].noise))

    def _lowest(self, x: Float[np.ndarray, "row feature"], *, noisy: bool) -> Prediction:
        if self.lent is None:
            return self.own[0].predict(x, noisy=noisy)
        if noisy:
            raise InputError(
                "predict: level 1 is lent, and its noise is not known here. "
                "Ask the model that lent it."
            )
        return self.lent.predict(x)

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs; a lent level 1 is left out."""
        saved = [process.to_arrays() for process in self.own]
        settings: Settings = {
            "model": self.MODEL,
            "lent": self.lent is not None,
            "levels": [settings for settings, _ in saved],
        }
        return settings, joined([arrays for _, arrays in saved])

    @classmethod
    def from_arrays(
        cls,
        settings: Mapping[str, object],
        arrays: Mapping[str, np.ndarray],
        *,
        lower: Predicts | None = None,
    ) -> Self:
        """The model that ``to_arrays`` described.

        Parameters
        ----------
        settings, arrays
            As ``to_arrays`` gave them.
        lower
            Level 1, where another model had lent it.

        Raises
        ------
        ModelError
            A part is missing or damaged, or ``lower`` is given or left out against the settings.
        """
        lent = setting(settings, "lent", bool)
        if lent != (lower is not None):
            need = "needs its level 1 given" if lent else "has its own level 1"
            raise ModelError(f"The saved NARGP {need}. Check what is passed as `lower`.")
        own = tuple(
            FittedGaussianProcess.from_arrays(part, within(index, arrays))
            for index, part in enumerate(sub_settings(settings, "levels"))
        )
        fitted = cls(own=own, lent=lower)
        _check_chain(fitted)
        return fitted


@dataclass(frozen=True, slots=True)
class _Step:
    """An upper level, as the quadrature sees it."""

    process: FittedGaussianProcess

    @property
    def bend(self) -> float:
        kernel = self.process.posterior.kernel
        assert isinstance(kernel, AutoregressiveKernel)
        length = kernel.link_length(self.process.posterior.log_parameters[:-1])
        return length * (float(self.process.inputs.spread[-1]) or 1.0)

    def moments(
        self, x: Float[np.ndarray, "row feature"], below: Float[np.ndarray, " row"]
    ) -> tuple[Float[np.ndarray, " row"], Float[np.ndarray, " row"]]:
        answer = self.process.predict(np.column_stack([x, below]))
        return answer.mean, answer.std**2


def _checked_cases(levels: Sequence[Cases], *, first: int) -> list[Cases]:
    if len(levels) == 0:
        raise InputError(f"{WHAT}: there is no level to learn. Give (x, y) of each, low to high.")
    cases: list[Cases] = []
    for level, (x, y) in enumerate(levels, start=first):
        what = f"{WHAT}, level {level}"
        rows = checked_inputs(x, what=what, width=cases[0][0].shape[1] if cases else None)
        cases.append((rows, checked_outputs(y, what=what, rows=len(rows), shape="(rows,)")))
    return cases


def _observed_below(
    x: Float[np.ndarray, "n feature"], below: Cases, *, level: int
) -> Float[np.ndarray, " n"]:
    """What the level below observed at the same inputs."""
    found = {row.tobytes(): value for row, value in zip(*below, strict=True)}
    values = [found.get(row.tobytes(), np.nan) for row in x]
    missing = np.flatnonzero(np.isnan(values))
    if len(missing):
        raise InputError(
            f"{WHAT}: {len(missing)} inputs of level {level} are not in level {level - 1} "
            f"(first: case {missing[0]}). Pass `nested=False` to use the level-{level - 1} mean "
            "there."
        )
    return np.array(values)


def _one_per_row(mean: Float[np.ndarray, "n *rest"]) -> Float[np.ndarray, " n"]:
    if mean.ndim != 1:
        raise InputError(
            f"{WHAT}: `lower` answers with shape {mean.shape}; expected one number per row. "
            "Lend one output of it, e.g. `fitted.output(0)` or `fitted.coordinate(node, axis)`."
        )
    return mean


def _check_chain(fitted: FittedNARGP) -> None:
    """Refuse a saved chain whose levels do not fit on one another."""
    widths = {len(process.inputs.centre) - 1 for process in fitted.upper}
    if fitted.lent is None and fitted.own:
        widths.add(len(fitted.own[0].inputs.centre))
    steps = all(
        process.single and isinstance(process.posterior.kernel, AutoregressiveKernel)
        for process in fitted.upper
    )
    if not fitted.own or len(widths) > 1 or not steps or not fitted.own[0].single:
        raise ModelError("The saved NARGP's levels do not fit together. Train the model again.")
