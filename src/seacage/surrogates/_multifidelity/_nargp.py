"""Nonlinear autoregressive Gaussian processes: each fidelity corrects the one below."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Literal, Self

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError, ModelError
from seacage.surrogates import _gp
from seacage.surrogates._arrays import Arrays, Settings, setting
from seacage.surrogates._multifidelity._folds import LEAST_CASES, Folds, log_density, pseudo_bma
from seacage.surrogates._multifidelity._kernel import (
    MANY,
    LinkKernel,
    alone,
    autoregressive,
    line_and_bend,
    regression,
    straight,
)
from seacage.surrogates._multifidelity._quadrature import (
    ProcessLevel,
    propagate_moments,
    propagate_slope,
)
from seacage.surrogates._prediction import (
    Moments,
    Prediction,
    Predicts,
    check_inputs,
    check_outputs,
)
from seacage.surrogates._scaling import Scaling

NFeature = Float[np.ndarray, "n feature"]
PerN = Float[np.ndarray, " n"]
PerRow = Float[np.ndarray, " row"]
RowFeature = Float[np.ndarray, "row feature"]
ModelName = Literal["nargp", "nargp-published", "ar1", "regression", "alone"]
"""Name of the kernel of an upper level."""
# Step of central differences, in spreads of a feature; their error falls with its square
DIFFERENCE = 1e-4
SAME = 1e-9  # distance of inputs that are the same, in spreads of a feature
# Two levels are taken for the same quantity where their difference has less than this share of the
# upper one's spread
ALIKE = 0.5

# Covariances of a level over its inputs and the level below, from the log lengths of the lowest
# level in spreads of this level's inputs, empty where a lent one has none, whether the level below
# explains most of this one as it is, and whether this one has many cases
MODELS: Mapping[ModelName, Callable[[tuple[float, ...], bool, bool], LinkKernel]] = {
    "nargp": lambda lengths, alike, _: line_and_bend(lengths=lengths, alike=alike),
    "nargp-published": lambda lengths, _, many: autoregressive(lengths=lengths, broad=many),
    "ar1": lambda *_: straight(),
    "regression": lambda *_: regression(),
    "alone": lambda _, __, many: alone(broad=many),
}

# Inputs (n, features) and outputs (n,) of one fidelity
Cases = tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]]


@dataclass(frozen=True, slots=True, kw_only=True)
class AbstractMultifidelity(ABC):
    """Levels of fidelity learned one after the other, each on the one below; not yet fitted."""

    noise: _gp.NoiseName = "white"
    ensemble: _gp.Ensemble = "auto"
    restarts: int = 3

    def __post_init__(self) -> None:
        _gp.check_options(noise=self.noise, ensemble=self.ensemble, restarts=self.restarts)

    @abstractmethod
    def kernel_names(self) -> Sequence[ModelName]:
        """Kernels of each upper level, whose processes are averaged."""

    def fit(
        self,
        # Inputs (n, features) and outputs (n,) of each level, from low to high fidelity
        levels: Sequence[Cases],
        *,
        seed: int = 0,  # of the subsets of points and of the random starts
        # Demand that the inputs of each level are among those of the level below, and use the
        # outputs observed there instead of the posterior mean
        nested: bool = False,
        # A fitted model that serves as level 1; ``levels`` then begins at level 2. It has to answer
        # with one number per row.
        lower: Predicts | None = None,
        # Cases of the highest level that are held out together to weigh its models, where it has
        # several; None for ten folds at random
        folds: Folds | None = None,
        # Of the cases of the highest level [s], where their noise is correlated in time
        time: PerN | None = None,
    ) -> "FittedNARGP":
        """Learn each level from its own cases.

        Raises InputError: no level, tables that do not fit, or inputs that are not nested though
        they should be.
        """
        what = f"{type(self).__name__}.fit"
        cases = _check_cases(levels, first=1 if lower is None else 2, what=what)
        if nested and lower is not None:
            raise InputError(
                f"{what}: nested=True needs the cases of level 1, but `lower` has none to give. "
                "Pass `nested=False` to use its mean."
            )
        seeds = np.random.SeedSequence(seed).generate_state(len(cases)).tolist()
        fitted = FittedNARGP(own=(), lent=lower, nested=nested)
        for index, (x, y) in enumerate(cases):
            last = index == len(cases) - 1
            kernels: Sequence[_gp.AbstractKernel] = [_gp.StationaryKernel("squared-exponential")]
            inputs, slope = x, np.zeros(x.shape[1])
            if fitted.levels:
                if nested:
                    below = _observations_below(x, cases[index - 1], level=index + 1, what=what)
                else:
                    below = _one_per_row(fitted.predict(x).mean, what=what)
                alike = bool(np.std(y - below) < ALIKE * np.std(y))
                lengths, many = _lengths_below(fitted, x), len(x) >= MANY
                kernels = links = [MODELS[one](lengths, alike, many) for one in self.kernel_names()]
                inputs, slope = np.column_stack([x, below]), np.append(slope, links[0].ratio)
            added = [
                _gp.fit_process(
                    kernel,
                    inputs,
                    y[:, None],
                    noise=self.noise,
                    ensemble=self.ensemble,
                    slope=slope,
                    restarts=self.restarts,
                    seed=seeds[index],
                    time=time if last else None,
                )
                for kernel in kernels
            ]
            models = [replace(fitted, own=(*fitted.own, one)) for one in added]
            fitted = models[0]
            if len(models) > 1:
                out = folds if folds and last else Folds.random(len(y), seed=seeds[index])
                density = np.stack([model.fold_density(y, out) for model in models])
                together = _gp.average(added, pseudo_bma(density, out.independent))
                fitted = fitted._replaced(fitted.levels, together)  # noqa: SLF001
        return fitted


@dataclass(frozen=True, slots=True, kw_only=True)
class NARGP(AbstractMultifidelity):
    """Nonlinear autoregressive multifidelity regression, not yet fitted; any number of levels.

    Level 1 is a Gaussian process of the inputs. Each level above is one of the inputs and of
    the level below, f_t(x) = g_t(x, f_{t-1}(x)), trained at the posterior mean of the level
    below, so that its inputs need not be among those below.

    ``linear``: expect a line in the level below, the same everywhere, which carries a plain ratio
    of the two to where nothing was observed, and about it a curve that is held to an offset at the
    mean of the level below. Where the level below explains most of this one as it is, the ratio is
    expected to be near 1. False is the kernel as published; a level of twenty cases
    and more then has broad priors.
    ``noise``, ``ensemble``: of every level, as for ``GaussianProcess``; a level has one output.
    ``restarts``: of each level, as for ``GaussianProcess``.

    Source: Perdikaris et al. (2017), "Nonlinear information fusion algorithms for data-efficient
    multi-fidelity modelling", Proc. R. Soc. A 473:20160751.
    """

    linear: bool = True

    def kernel_names(self) -> Sequence[ModelName]:
        return ["nargp" if self.linear else "nargp-published"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AR1(AbstractMultifidelity):
    """Linear autoregressive multifidelity regression, not yet fitted; any number of levels.

    f_t(x) = rho_t f_{t-1}(x) + delta_t(x), with a constant rho_t of its own for each level: a
    baseline to compare ``NARGP`` with. Levels are learned one after the other at the mean of
    the level below, and rho_t is integrated out. The fitted model is that of ``NARGP``.

    ``noise``, ``ensemble``, ``restarts``: as for ``NARGP``.

    Sources: Kennedy & O'Hagan (2000), "Predicting the output from a complex computer code when fast
    approximations are available", Biometrika 87:1-13; Le Gratiet & Garnier (2014), Int. J.
    Uncertainty Quantification 4:365-386, for the recursion.
    """

    def kernel_names(self) -> Sequence[ModelName]:
        return ["ar1"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelAverage(AbstractMultifidelity):
    """Average of several multifidelity regressions, not yet fitted; any number of levels.

    Each level is one of ``MODELS``, or a mixture of them by pseudo-BMA: in proportion to the
    density that each gives to cases which are held out, at this level and at all below. No single
    one is best everywhere, and where little is known the weights are nearly equal. The fitted
    model is that of ``NARGP``, with several kernels in a level.

    ``models``: by name.
    ``noise``, ``ensemble``, ``restarts``: as for ``NARGP``.

    Source: Yao et al. (2018), "Using stacking to average Bayesian predictive distributions",
    Bayesian Analysis 13:917-1007.
    """

    models: tuple[ModelName, ...] = ("nargp", "nargp-published", "ar1", "alone")

    def __post_init__(self) -> None:
        AbstractMultifidelity.__post_init__(self)
        if not self.models or not set(self.models) <= set(MODELS):
            raise InputError(
                f"ModelAverage: models = {self.models!r} must name at least one of "
                f"{', '.join(MODELS)}, and no other."
            )

    def kernel_names(self) -> Sequence[ModelName]:
        return self.models


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedNARGP:
    """Levels of fidelity, each answering from the one below."""

    MODEL: ClassVar[str] = "nargp"

    # The levels learned here: from level 1, or from level 2 where level 1 is lent
    own: tuple[_gp.FittedGaussianProcess, ...]
    # Level 1 where another model serves as it; it is not saved with this one
    lent: Predicts | None = None
    # Whether each level was fitted at the observations of the level below, not at its mean
    nested: bool = False

    @property
    def levels(self) -> int:
        """The number of fidelities."""
        return len(self.own) + (self.lent is not None)

    @property
    def lower(self) -> Predicts:
        """Level 1."""
        return self.own[0] if self.lent is None else self.lent

    @property
    def upper(self) -> tuple[_gp.FittedGaussianProcess, ...]:
        """Level 2 and above, each a process of the inputs and of the level below."""
        return self.own[1:] if self.lent is None else self.own

    def predict(
        self,
        x: RowFeature,
        *,
        level: int | None = None,
        noisy: bool = False,
        below: Prediction | None = None,
    ) -> Prediction:
        """Answer at each row of features.

        Parameters
        ----------
        x
            One row per case.
        level
            From 1, the lowest, to ``levels``, which None means.
        noisy
            Of a new observation at this level: adds its noise.
        below
            Of level 1 at these rows, where it is known already; None predicts it.
        """
        level = self._level(level, lowest=1 if below is None else 2, what="predict")
        if level == 1:
            if self.lent is None:
                return self.own[0].predict(x, noisy=noisy)
            if noisy:
                raise InputError(
                    "predict: level 1 is lent, and its noise is not known here. "
                    "Ask the model that lent it."
                )
            return self.lent.predict(x)
        x = check_inputs(x, what="predict", width=self._width)
        if below is None:
            below = self.lower.predict(x)
        elif below.mean.shape != (len(x),):
            raise InputError(
                f"predict: level 1 is given for {below.mean.shape}, but there are {len(x)} rows. "
                "Give one mean and one standard deviation per row."
            )
        mean, variance = propagate_moments(self._steps(level), x, below.mean, below.std**2)
        if noisy:
            # Where the noise changes with the level below, it is that at its mean.
            at = below if level == 2 else self.predict(x, level=level - 1, below=below)
            variance += self.upper[level - 2].noise_at(np.column_stack([x, at.mean]))
        return Prediction(mean=mean, std=np.sqrt(variance))

    def jacobian(self, x: RowFeature, *, level: int | None = None) -> RowFeature:
        """Change of the mean per change of each feature, at each row, through all levels.

        A lent level 1 that is no Gaussian process is differentiated by central differences.

        ``x``: one row per case, the features of the training.
        ``level``: as for ``predict``.
        """
        level = self._level(level, lowest=1, what="jacobian")
        x = check_inputs(x, what="jacobian", width=self._width)
        if isinstance(self.lower, _gp.FittedGaussianProcess):
            below = self.lower.moments(x)
        else:
            step = DIFFERENCE * self.upper[0].inputs.unit[:-1]
            below = _central_differences(self.lower, x, step=step)
        return propagate_slope(self._steps(level), x, below) if level > 1 else below.mean_slope

    def updated(
        self, x: RowFeature, y: PerRow, *, level: int | None = None, time: PerRow | None = None
    ) -> Self:
        """Conditioned on more cases of a level above the first, without learning anew.

        Levels below stay the same objects. Levels above were fitted at the mean of this one, so
        they are conditioned again on their own cases at its new mean, unless fitted nested.

        ``x``, ``y``: new cases; the level below is asked for its mean there.
        ``level``: from 2 to ``levels``, which None means.
        ``time``: of the new cases [s], where the level was fitted with times.
        """
        level = self._level(level, lowest=2, what="updated")
        x = check_inputs(x, what="updated", width=self._width)
        y = check_outputs(y, what="updated", rows=len(x), shape="(rows,)", least=1)
        below = self.predict(x, level=level - 1).mean
        process = self.upper[level - 2].updated(np.column_stack([x, below]), y, time=time)
        fitted = self._replaced(level, process)
        if not self.nested:
            for above in range(level + 1, self.levels + 1):
                upper_process = fitted.upper[above - 2]
                x = upper_process.cases()[:, :-1]
                below = fitted.predict(x, level=above - 1).mean
                fitted = fitted._replaced(above, upper_process.moved(np.column_stack([x, below])))  # noqa: SLF001
        return fitted

    def fold_density(self, y: PerN, folds: Folds) -> PerRow:
        """Log density of the highest level's cases, those of each fold held out at all levels.

        The hyperparameters, and the level below at the cases that are kept, stay those learned
        from all. A lent level 1 stays as it is.

        ``y``: their outputs.
        """
        below, top = replace(self, own=self.own[:-1]), self.own[-1]
        x, parts = top.cases()[:, :-1], [np.zeros(0)]
        lent = None if below.own else below.lower.predict(x)
        for out, kept in folds.each():
            lower = lent.rows(out) if lent else below._without(x[out]).predict(x[out])  # noqa: SLF001
            reduced = top.kept(kept)
            mean, variance = propagate_moments(
                [ProcessLevel(reduced)], x[out], lower.mean, lower.std**2
            )
            variance += reduced.noise_at(np.column_stack([x[out], lower.mean]))
            parts.append(log_density(y[out], mean, variance))
        return np.concatenate(parts)

    def _without(self, x: RowFeature) -> Self:
        """Without the cases that any level learned here has at some inputs."""
        own: list[_gp.FittedGaussianProcess] = []
        for process in self.own:
            cases, unit = process.cases()[:, : x.shape[1]], process.inputs.unit[: x.shape[1]]
            distance = np.max(np.abs(cases[:, None] - x) / unit, axis=2)
            kept = np.min(distance, axis=1) > SAME
            whole = kept.all() or kept.sum() < LEAST_CASES
            own.append(process if whole else process.kept(kept))
        return replace(self, own=tuple(own))

    def _replaced(self, level: int, process: _gp.FittedGaussianProcess) -> Self:
        own = list(self.own)
        own[level - 1 - (self.lent is not None)] = process
        return replace(self, own=tuple(own))

    @property
    def _width(self) -> int | None:
        """Features of a row, where a level of this model has them."""
        if self.upper:
            return len(self.upper[0].inputs.centre) - 1
        return len(self.own[0].inputs.centre) if self.own else None

    def _level(self, level: int | None, *, lowest: int, what: str) -> int:
        level = self.levels if level is None else level
        if not lowest <= level <= self.levels:
            raise InputError(
                f"{what}: level = {level} does not exist; this model has levels {lowest} to "
                f"{self.levels}."
            )
        return level

    def _steps(self, level: int) -> list[ProcessLevel]:
        return [ProcessLevel(process) for process in self.upper[: level - 1]]

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs; a lent level 1 is left out."""
        levels, arrays = _gp.processes_to_arrays(self.own)
        settings: Settings = {
            "model": self.MODEL,
            "lent": self.lent is not None,
            "nested": self.nested,
            "levels": levels,
        }
        return settings, arrays

    @classmethod
    def from_arrays(
        cls,
        settings: Mapping[str, object],
        arrays: Mapping[str, np.ndarray],
        *,
        lower: Predicts | None = None,
    ) -> Self:
        """The model that ``to_arrays`` described.

        Raises ModelError: a part is missing or damaged, or ``lower`` is given or left out against
        the settings.

        ``lower``: level 1, where another model had lent it.
        """
        lent = setting(settings, "lent", bool)
        if lent != (lower is not None):
            need = "needs its level 1 given" if lent else "has its own level 1"
            raise ModelError(f"The saved NARGP {need}. Check what is passed as `lower`.")
        own = _gp.processes_from_arrays(settings, "levels", arrays)
        fitted = cls(own=own, lent=lower, nested=setting(settings, "nested", bool))
        widths = {len(process.inputs.centre) - 1 for process in fitted.upper}
        if own and not lent:
            widths.add(len(own[0].inputs.centre))
        links = all(isinstance(process.posterior.kernel, LinkKernel) for process in fitted.upper)
        if not own or len(widths) > 1 or not links or not all(process.single for process in own):
            raise ModelError("The saved NARGP's levels do not fit together. Train the model again.")
        return fitted


def _check_cases(
    levels: Sequence[tuple[ArrayLike, ArrayLike]], *, first: int, what: str
) -> list[Cases]:
    if len(levels) == 0:
        raise InputError(f"{what}: there is no level to learn. Give (x, y) of each, low to high.")
    cases: list[Cases] = []
    for level, (x, y) in enumerate(levels, start=first):
        who = f"{what}, level {level}"
        rows = check_inputs(x, what=who, width=cases[0][0].shape[1] if cases else None)
        cases.append((rows, check_outputs(y, what=who, rows=len(rows), shape="(rows,)")))
    return cases


def _observations_below(x: NFeature, below: Cases, *, level: int, what: str) -> PerN:
    """What the level below observed at the same inputs."""
    found = {row.tobytes(): value for row, value in zip(*below, strict=True)}
    values = [found.get(row.tobytes(), np.nan) for row in x]
    missing = np.flatnonzero(np.isnan(values))
    if len(missing):
        raise InputError(
            f"{what}: {len(missing)} inputs of level {level} are not in level {level - 1} "
            f"(first: case {missing[0]}). Pass `nested=False` to use the level-{level - 1} mean "
            "there."
        )
    return np.array(values)


def _lengths_below(fitted: FittedNARGP, x: NFeature) -> tuple[float, ...]:
    """Log lengths of the lowest level in spreads of these inputs, where it was learned here."""
    if fitted.lent is not None:
        return ()
    ratio = fitted.own[0].inputs.unit / Scaling.of(x).unit
    return tuple((fitted.own[0].posterior.log_parameters[1:] + np.log(ratio)).tolist())


def _one_per_row(mean: Float[np.ndarray, "n *rest"], *, what: str) -> PerN:
    if mean.ndim != 1:
        raise InputError(
            f"{what}: `lower` answers with shape {mean.shape}; expected one number per row. "
            "Lend one output of it, e.g. `fitted.output(0)` or `fitted.coordinate(node, axis)`."
        )
    return mean


def _central_differences(
    lower: Predicts, x: RowFeature, *, step: Float[np.ndarray, " feature"]
) -> Moments:
    """Mean and variance of a lent level, and their gradients by central differences."""
    here = lower.predict(x)
    mean_slope, variance_slope = np.empty_like(x), np.empty_like(x)
    for feature, size in enumerate(step):
        aside = np.zeros(x.shape[1])
        aside[feature] = size
        up, down = lower.predict(x + aside), lower.predict(x - aside)
        mean_slope[:, feature] = (up.mean - down.mean) / (2.0 * size)
        variance_slope[:, feature] = (up.std**2 - down.std**2) / (2.0 * size)
    return Moments(
        mean=here.mean, variance=here.std**2, mean_slope=mean_slope, variance_slope=variance_slope
    )
