"""Covariance functions that add and multiply, with their gradients."""

import math
import operator
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import ModelError

BatchNFeature = Float[np.ndarray, "*batch n feature"]
BatchParameter = Float[np.ndarray, "*batch parameter"]
BatchRowN = Float[np.ndarray, "*batch row n"]
NFeature = Float[np.ndarray, "n feature"]
PerParameter = Float[np.ndarray, " parameter"]
RowFeature = Float[np.ndarray, "row feature"]
KernelName = Literal["squared-exponential", "matern-5/2", "matern-3/2"]
Normal = tuple[float, float]  # mean and standard deviation of a log hyperparameter
VARIANCE_PRIOR: Normal = (0.0, 2.0)  # of a log variance: the outputs have unit variance
# Of a log length in spreads of a feature, which is about 3.5 across. The median grows with the root
# of the number of features, as distances do: without that a prior over many inputs would make every
# case independent of the next.
LENGTH_PRIOR: Normal = (math.log(3.0), 1.5)
# Of the variance that rows of a case have in common, as of noise
CASE_PRIOR: Normal = (math.log(1e-3), 2.5)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prior:
    """Independent log-normal priors, so normal in the logarithms."""

    mean: PerParameter
    sd: PerParameter

    @classmethod
    def of(cls, *parameters: Normal) -> "Prior":
        """From the mean and sd of each log hyperparameter."""
        mean, sd = np.array(parameters).T
        return cls(mean=mean, sd=sd)

    def __add__(self, other: "Prior") -> "Prior":
        """Of these hyperparameters and then the others."""
        return Prior(mean=np.append(self.mean, other.mean), sd=np.append(self.sd, other.sd))


def _no_pullback(_: np.ndarray) -> np.ndarray:
    raise NotImplementedError("Hyperparameters are fitted to covariances, not to variances alone.")


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """Covariances of pairs of inputs, with what their gradients need; they add and multiply."""

    # Of each row of x with each row of z, or of each row of x with itself
    value: Float[np.ndarray, "*pair"]
    # From a share of each covariance to the gradient in each row of x of their sum by shares; one
    # row of shares stands for all
    slope: Callable[[np.ndarray], np.ndarray]
    # From a loss's gradient in each covariance to its gradient in each log hyperparameter, where z
    # is x and the gradient symmetric
    pull: Callable[[np.ndarray], np.ndarray] = _no_pullback

    def __add__(self, other: "Evaluation") -> "Evaluation":
        return Evaluation(
            self.value + other.value,
            lambda share: self.slope(share) + other.slope(share),
            lambda adjoint: np.append(self.pull(adjoint), other.pull(adjoint)),
        )

    def __mul__(self, other: "Evaluation") -> "Evaluation":
        one, two = self.value, other.value
        return Evaluation(
            one * two,
            lambda share: self.slope(share * two) + other.slope(share * one),
            lambda adjoint: np.append(self.pull(adjoint * two), other.pull(adjoint * one)),
        )


# Function of inputs: their covariances with some points
Covariances = Callable[[np.ndarray], Evaluation]
Leaf = Callable[..., Any]  # function of inputs whose results add and multiply


class AbstractKernel(ABC):
    """A positive definite function of two inputs, and the prior of its hyperparameters."""

    @property
    def name(self) -> str:
        """Under which a saved model finds it again; without one of its own that of its class."""
        return type(self).__name__

    @abstractmethod
    def prior(self, width: int) -> Prior:
        """Of its log hyperparameters, for inputs with so many features."""

    @abstractmethod
    def size(self, width: int) -> int:
        """Number of its hyperparameters, for inputs with so many features."""

    @abstractmethod
    def at(self, log_parameters: BatchParameter, z: BatchNFeature) -> Covariances:
        """Covariance with points: a function of the other inputs.

        What depends on the points alone is evaluated once. Only values are for batches; gradients
        are for one set of hyperparameters.
        """

    @abstractmethod
    def diagonal(
        self, log_parameters: BatchParameter, x: Float[np.ndarray, "*batch row feature"]
    ) -> Evaluation:
        """Variance of each row."""

    def quotient(self, x: NFeature) -> Int[np.ndarray, "image image"] | None:  # noqa: ARG002
        """The group that the rows are images under, as for ``Orbits``; None where there is none."""
        return None

    def evaluate(self, log_parameters: PerParameter, x: RowFeature, z: NFeature) -> Evaluation:
        """Covariance between the rows of two sets of inputs."""
        return self.at(log_parameters, z)(x)

    def covariance(
        self, log_parameters: PerParameter, x: RowFeature, z: NFeature
    ) -> Float[np.ndarray, "row n"]:
        """The value of ``evaluate`` alone, which keeps nothing for gradients."""
        return self.values_at(log_parameters, z)(x)

    def values_at(self, log_parameters: PerParameter, z: NFeature) -> Leaf:
        """The values of ``at`` alone, which keep nothing for gradients."""

        def value(leaf: AbstractKernel, own: np.ndarray) -> Leaf:
            covariances = leaf.at(own, z)
            return lambda x: covariances(x).value

        return self.combine(log_parameters, z.shape[-1], value)

    def combine(
        self,
        log_parameters: np.ndarray,
        width: int,  # noqa: ARG002
        leaf: Callable[["AbstractKernel", np.ndarray], Leaf],
    ) -> Leaf:
        """Function that adds and multiplies what its leaves give, as the kernel does.

        ``log_parameters`` and ``width``: of the kernel, and the number of features. ``leaf``:
        called with each kernel that is no composition and its own hyperparameters.
        """
        return leaf(self, log_parameters)

    def __add__(self, other: "AbstractKernel") -> "Sum":
        return Sum(self, other)

    def __mul__(self, other: "AbstractKernel") -> "Product":
        return Product(self, other)


@dataclass(frozen=True, slots=True)
class StationaryKernel(AbstractKernel):
    """Variance times a correlation that falls with distance, one length per feature (ARD).

    Hyperparameters: log variance, then one log length per feature.
    """

    shape: KernelName  # of the correlation
    # Priors; that of the length is for a single feature. No variance is one of 1, known.
    variance: Normal | None = VARIANCE_PRIOR
    length: Normal = LENGTH_PRIOR
    # Prior of each feature's length, where the general one is not meant
    lengths: tuple[Normal, ...] = ()
    # Which of the lengths each feature has, from 0; each its own where this is empty. The
    # components of a vector have one, so that a turn changes no distance
    alike: tuple[int, ...] = ()

    @property
    def name(self) -> str:
        return self.shape

    def prior(self, width: int) -> Prior:
        variance = [self.variance] if self.variance else []
        general = (self.length[0] + 0.5 * math.log(width), self.length[1])
        lengths = self.lengths or [general] * (self.size(width) - len(variance))
        return Prior.of(*variance, *lengths)

    def size(self, width: int) -> int:
        return (max(self.alike) + 1 if self.alike else width) + (self.variance is not None)

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> Covariances:
        sized = self.variance is not None
        variance = np.exp(log_parameters[..., :1, None]) if sized else None
        length = np.exp(log_parameters[..., None, sized:])
        if self.alike:
            length = length[..., list(self.alike)]
        scaled_z = z / length
        distance_squared = _distance_squared(scaled_z)

        def evaluate(x: np.ndarray) -> Evaluation:
            scaled_x = x / length
            value, fall = _covariance(self.shape, distance_squared(scaled_x), variance)

            def slope(share: np.ndarray) -> np.ndarray:
                weight = share * fall
                return (weight @ scaled_z - weight.sum(axis=1)[:, None] * scaled_x) / length

            def pull(adjoint: np.ndarray) -> np.ndarray:
                # Sum of w_ab (z_a - z_b)^2 over the pairs, without n x n differences per feature.
                weight = adjoint * fall
                crossed = np.sum(scaled_z * (weight @ scaled_z), axis=0)
                by_length = 2.0 * (weight.sum(axis=1) @ scaled_z**2 - crossed)
                if self.alike:
                    by_length = np.bincount(self.alike, by_length)
                return np.append(np.sum(adjoint * value), by_length) if sized else by_length

            return Evaluation(value, slope, pull)

        return evaluate

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> Evaluation:
        value = np.ones(x.shape[:-1])
        if self.variance is not None:
            value *= np.exp(log_parameters[..., :1])
        return Evaluation(value, lambda _: np.zeros_like(x))


@dataclass(frozen=True, slots=True)
class SameCase(AbstractKernel):
    """Variance that rows of one number have in common, and no others: what is a case's own."""

    def prior(self, width: int) -> Prior:  # noqa: ARG002
        return Prior.of(CASE_PRIOR)

    def size(self, width: int) -> int:  # noqa: ARG002
        return 1

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> Covariances:
        variance = np.exp(log_parameters[..., :1, None])
        number = np.swapaxes(z, -1, -2)

        def evaluate(x: np.ndarray) -> Evaluation:
            value = variance * (x == number)
            slope = np.zeros_like(x)
            return Evaluation(value, lambda _: slope, lambda adjoint: np.sum(adjoint * value))

        return evaluate

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> Evaluation:
        value = np.exp(log_parameters[..., :1]) * np.ones(x.shape[:-1])
        return Evaluation(value, lambda _: np.zeros_like(x))


@dataclass(frozen=True, slots=True)
class Columns(AbstractKernel):
    """A kernel of some of the features."""

    part: AbstractKernel
    columns: slice

    def prior(self, width: int) -> Prior:
        return self.part.prior(self._width(width))

    def size(self, width: int) -> int:
        return self.part.size(self._width(width))

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> Covariances:
        part = self.part.at(log_parameters, z[..., self.columns])
        return lambda x: self._widen(x, part(x[..., self.columns]))

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> Evaluation:
        return self._widen(x, self.part.diagonal(log_parameters, x[..., self.columns]))

    def _widen(self, x: np.ndarray, part: Evaluation) -> Evaluation:
        def slope(share: np.ndarray) -> np.ndarray:
            gradient = np.zeros_like(x)
            gradient[..., self.columns] = part.slope(share)
            return gradient

        return Evaluation(part.value, slope, part.pull)

    def _width(self, width: int) -> int:
        return len(range(width)[self.columns])


@dataclass(frozen=True, slots=True)
class AbstractComposition(AbstractKernel):
    """Two kernels in one; the hyperparameters of the first come first."""

    one: AbstractKernel
    other: AbstractKernel

    # Of the evaluations of both parts, and of their values
    join: ClassVar[Callable[[Any, Any], Any]]
    join_values: ClassVar[np.ufunc]

    def prior(self, width: int) -> Prior:
        return self.one.prior(width) + self.other.prior(width)

    def size(self, width: int) -> int:
        return self.one.size(width) + self.other.size(width)

    def at(self, log_parameters: np.ndarray, z: np.ndarray) -> Covariances:
        return self.combine(log_parameters, z.shape[-1], lambda leaf, own: leaf.at(own, z))

    def diagonal(self, log_parameters: np.ndarray, x: np.ndarray) -> Evaluation:
        def variance(leaf: AbstractKernel, own: np.ndarray) -> Leaf:
            return lambda x: leaf.diagonal(own, x)

        return self.combine(log_parameters, x.shape[-1], variance)(x)

    def combine(
        self,
        log_parameters: np.ndarray,
        width: int,
        leaf: Callable[[AbstractKernel, np.ndarray], Leaf],
    ) -> Leaf:
        size = self.one.size(width)
        one = self.one.combine(log_parameters[..., :size], width, leaf)
        other = self.other.combine(log_parameters[..., size:], width, leaf)
        return lambda *at: self._join(one(*at), other(*at))

    def _join(self, one: Any, other: Any) -> Any:
        if isinstance(one, Evaluation):
            return type(self).join(one, other)
        # In the place of the larger one, as large arrays cost more than what is done with them.
        return self.join_values(one, other, out=one if one.size >= other.size else other)


@dataclass(frozen=True, slots=True)
class Sum(AbstractComposition):
    """The sum of two kernels: of independent processes that add."""

    label: str = ""  # its name, where it has one of its own

    join, join_values = operator.add, np.add

    @property
    def name(self) -> str:
        return self.label or type(self).__name__


@dataclass(frozen=True, slots=True)
class Product(AbstractComposition):
    """The product of two kernels: of a process whose size changes as another one does."""

    join, join_values = operator.mul, np.multiply


# By the name under which a saved model finds its kernel again
_SAVED: dict[str, AbstractKernel] = {name: StationaryKernel(name) for name in get_args(KernelName)}


def register_kernels(*kernels: AbstractKernel) -> None:
    """Let saved models name kernels beyond those that a user chooses from."""
    _SAVED.update({kernel.name: kernel for kernel in kernels})


def restore_kernel(name: str) -> AbstractKernel:
    """Kernel of a saved model: one with a public name, or a registered one."""
    if name not in _SAVED:
        raise ModelError(f"The saved model has kernel {name!r}, which this version does not know.")
    return _SAVED[name]


def _covariance(
    name: KernelName, squared: BatchRowN, variance: Float[np.ndarray, "*batch 1 1"] | None
) -> tuple[BatchRowN, BatchRowN]:
    """At a squared distance, which is overwritten, and minus twice its derivative there."""
    if name == "squared-exponential":
        squared *= -0.5
        value = np.exp(squared, out=squared)
        if variance is not None:
            value *= variance
        return value, value
    far = np.sqrt((3.0 if name == "matern-3/2" else 5.0) * squared)
    decay = np.exp(-far)
    if variance is not None:
        decay *= variance
    if name == "matern-3/2":
        return (1.0 + far) * decay, 3.0 * decay
    return (1.0 + far + 5.0 / 3.0 * squared) * decay, 5.0 / 3.0 * (1.0 + far) * decay


def _distance_squared(z: BatchNFeature) -> Callable[[np.ndarray], np.ndarray]:
    """From points to a function of other inputs: (row, n)."""
    columns = np.swapaxes(z, -1, -2)
    if z.shape[-1] == 1:
        return lambda x: np.square(x - columns)
    twice, square = -2.0 * columns, np.einsum("...f,...f->...", z, z)[..., None, :]

    def evaluate(x: np.ndarray) -> np.ndarray:
        squared = x @ twice
        squared += np.einsum("...f,...f->...", x, x)[..., None]
        squared += square
        return np.maximum(squared, 0.0, out=squared)

    return evaluate
