"""Gaussian process regression with one kernel for all outputs."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates._arrays import Arrays, Settings, array, setting
from seacage.surrogates._kernels import AbstractKernel, KernelName, kernel_named, saved_kernel
from seacage.surrogates._prediction import Prediction, checked_inputs, checked_outputs
from seacage.surrogates._regression import Posterior, learned
from seacage.surrogates._scaling import Scaling

MANY_OUTPUTS = 16
"""More outputs than this are condensed before they teach the kernel."""

CONDENSED = 1e-6
"""Share of the outputs' variance that condensing may leave out."""

SHARED_POINTS = 5.0
"""Weight of the shared variance against each output's own roughness, in points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianProcess:
    """Gaussian process regression, not yet fitted.

    All outputs share one kernel and one factorisation; each keeps its own mean and amplitude.
    Noise is Gaussian, the same share of every output's variance.

    Parameters
    ----------
    kernel
        ``"squared-exponential"`` for very smooth answers, ``"matern-5/2"`` for those with kinks.
    restarts
        Random starts of the hyperparameter search beside the deterministic one.

    References
    ----------
    Rasmussen & Williams (2006), chapters 2 and 5.
    """

    kernel: KernelName = "squared-exponential"
    restarts: int = 3

    def __post_init__(self) -> None:
        kernel_named(self.kernel)
        check_restarts(self.restarts)

    def fit(
        self, x: Float[np.ndarray, "n feature"], y: Float[np.ndarray, "n *output"], *, seed: int = 0
    ) -> "FittedGaussianProcess":
        """Learn from inputs and outputs.

        Parameters
        ----------
        x
            One row per case.
        y
            (n,) or (n, outputs).
        seed
            Of the subset of points and of the random starts.
        """
        what = "GaussianProcess.fit"
        x = checked_inputs(x, what=what)
        shape = "(rows,)" if np.ndim(y) == 1 else "(rows, outputs)"
        y = checked_outputs(y, what=what, rows=len(x), shape=shape)
        table = y.reshape(len(y), -1)
        fitted = fitted_process(
            kernel_named(self.kernel),
            x,
            table,
            taught_by=teachers(table),
            restarts=self.restarts,
            seed=seed,
        )
        return replace(fitted, single=y.ndim == 1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedGaussianProcess:
    """Gaussian process conditioned on its training cases.

    Parameters
    ----------
    posterior
        Of the outputs less their centre, at standardised inputs.
    inputs
        Centre and spread of each feature.
    centre, amplitude
        Of each output: its mean, and the standard deviation that the kernel's is a share of.
    single
        Whether the answer is (row,) rather than (row, output).
    """

    MODEL: ClassVar[str] = "gaussian-process"

    posterior: Posterior
    inputs: Scaling
    centre: Float[np.ndarray, " output"]
    amplitude: Float[np.ndarray, " output"]
    single: bool

    @property
    def noise(self) -> Float[np.ndarray, " output"]:
        """Variance of each output's noise, in its unit squared."""
        return self.posterior.noise * self.amplitude**2

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Answer at each row of features.

        Parameters
        ----------
        x
            One row per case, the features of the training.
        noisy
            Of a new observation rather than of what lies behind it: adds the noise.
        """
        x = checked_inputs(x, what="predict", width=len(self.inputs.centre))
        mean, variance = self.posterior.predict(self.inputs.standardised(x))
        return self._answer(mean + self.centre, variance + noisy * self.posterior.noise)

    def leave_one_out(self) -> Prediction:
        """Answer at each training case from all the others, as a new observation.

        In closed form; the hyperparameters stay those learned from all cases.

        References
        ----------
        Rasmussen & Williams (2006), eqs. (5.10)-(5.12).
        """
        residual, variance = self.posterior.leave_one_out()
        return self._answer(self.posterior.observed() + self.centre - residual, variance)

    def output(self, index: int) -> "FittedGaussianProcess":
        """One output as a model that answers (row,); it shares the factor."""
        outputs = len(self.centre)
        if not 0 <= index < outputs:
            raise InputError(f"output {index} does not exist; this model has {outputs}, from 0.")
        return self.combined(np.eye(outputs)[index])

    def combined(self, share: Float[np.ndarray, " output"]) -> "FittedGaussianProcess":
        """The sum of the outputs times their share, as a model that answers (row,)."""
        return replace(
            self,
            posterior=replace(self.posterior, weights=self.posterior.weights @ share[:, None]),
            centre=np.array([self.centre @ share]),
            amplitude=np.array([np.linalg.norm(self.amplitude * share)]),
            single=True,
        )

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        settings: Settings = {
            "model": self.MODEL,
            "kernel": self.posterior.kernel.name,
            "single": self.single,
        }
        return settings, {
            "log_parameters": self.posterior.log_parameters,
            "inputs": self.posterior.x,
            "weights": self.posterior.weights,
            "input_centre": self.inputs.centre,
            "input_spread": self.inputs.spread,
            "output_centre": self.centre,
            "output_amplitude": self.amplitude,
        }

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; it factorises its covariance again.

        Raises
        ------
        ModelError
            A setting or an array is missing, of another kind or shape, or not finite.
        """
        kernel = saved_kernel(setting(settings, "kernel", str))
        single = setting(settings, "single", bool)
        x = array(arrays, "inputs", None, None)
        rows, width = x.shape
        weights = array(arrays, "weights", rows, 1 if single else None)
        outputs = weights.shape[1]
        parameters = len(kernel.prior(width).mean) + 1
        posterior = Posterior.restored(
            kernel, array(arrays, "log_parameters", parameters), x, weights
        )
        inputs = Scaling(
            centre=array(arrays, "input_centre", width), spread=array(arrays, "input_spread", width)
        )
        return cls(
            posterior=posterior,
            inputs=inputs,
            centre=array(arrays, "output_centre", outputs),
            amplitude=array(arrays, "output_amplitude", outputs),
            single=single,
        )

    def _answer(
        self, mean: Float[np.ndarray, "row output"], variance: Float[np.ndarray, " row"]
    ) -> Prediction:
        std = np.sqrt(variance)[:, None] * self.amplitude
        if self.single:
            return Prediction(mean=mean[:, 0], std=std[:, 0])
        return Prediction(mean=mean, std=std)


def fitted_process(
    kernel: AbstractKernel,
    x: Float[np.ndarray, "n feature"],
    y: Float[np.ndarray, "n output"],
    *,
    taught_by: Float[np.ndarray, "n teacher"],
    restarts: int,
    seed: int,
) -> FittedGaussianProcess:
    """Learn the kernel from its teachers, then condition on the outputs.

    Parameters
    ----------
    kernel
        That all outputs share.
    x, y
        Inputs and outputs in their own units.
    taught_by
        What the hyperparameters are learned from, of unit variance all in all.
    restarts, seed
        Of the search.
    """
    inputs, outputs = Scaling.of(x), Scaling.of(y)
    standardised = inputs.standardised(x)
    log_parameters = learned(kernel, standardised, taught_by, restarts=restarts, seed=seed)
    posterior = Posterior.conditioned(kernel, log_parameters, standardised, y - outputs.centre)
    # Each output's own variance, held to the shared one by a few points' worth of belief:
    # the scale of the conjugate posterior, a scaled inverse chi-squared.
    own = np.einsum("no,no->o", y - outputs.centre, posterior.weights)
    variance = (SHARED_POINTS * outputs.spread**2 + own) / (SHARED_POINTS + len(y))
    return FittedGaussianProcess(
        posterior=posterior,
        inputs=inputs,
        centre=outputs.centre,
        amplitude=np.sqrt(variance),
        single=y.shape[1] == 1,
    )


def teachers(y: Float[np.ndarray, "n output"]) -> Float[np.ndarray, "n teacher"]:
    """Standardised outputs for the hyperparameters to be learned from, all alike important."""
    standardised = Scaling.of(y).standardised(y)
    return standardised if y.shape[1] <= MANY_OUTPUTS else condensed(standardised)


def condensed(y: Float[np.ndarray, "n output"]) -> Float[np.ndarray, "n teacher"]:
    """Fewer outputs that teach a kernel the same.

    The likelihood summed over outputs knows them only by their products between cases, Y Y',
    which the principal scores keep; an output counts as much as it varies.
    """
    left, size, _ = np.linalg.svd(y - y.mean(axis=0), full_matrices=False)
    left_out = 1.0 - np.cumsum(size**2) / max(float(np.sum(size**2)), np.finfo(float).tiny)
    kept = 1 + int(np.argmax(left_out < CONDENSED))
    scores = left[:, :kept] * size[:kept]
    return scores / (np.sqrt(np.mean(scores**2)) or 1.0)


def check_restarts(restarts: int) -> None:
    """Refuse a negative number of restarts."""
    if restarts < 0:
        raise InputError(f"restarts = {restarts} is negative. Give the number of extra starts.")
