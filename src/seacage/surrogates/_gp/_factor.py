"""A covariance with noise, factorised once for all that is asked of it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Self

import numpy as np
import scipy
from jaxtyping import Float

NN = Float[np.ndarray, "n n"]
RowN = Float[np.ndarray, "row n"]
PerN = Float[np.ndarray, " n"]
NOutput = Float[np.ndarray, "n output"]
# Shares of each variance added to the diagonal, the first that gives a factor in float64
JITTERS = (1e-9, 1e-8, 1e-7, 1e-6)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cholesky:
    """Of a covariance whose noise is the same for all outputs."""

    lower: NN  # triangular factor of the covariance with noise

    @classmethod
    def of(cls, covariance: NN, noise: PerN) -> Self:
        """Factorise the covariance plus the noise of each case.

        Raises LinAlgError: it is not positive definite, even with the largest jitter.
        """
        for jitter in JITTERS:
            diagonal = np.diag(covariance) * (1.0 + jitter) + noise
            try:
                return cls(lower=_lower(covariance, diagonal))
            except np.linalg.LinAlgError:
                continue
        raise np.linalg.LinAlgError("the covariance is not positive definite")

    def solve(self, y: NOutput) -> NOutput:
        """Inverse times outputs."""
        solved = scipy.linalg.cho_solve((self.lower, True), y, check_finite=False)
        # In C order, as they come back from a file: the same rounding in every prediction.
        return np.ascontiguousarray(solved)

    def observations(self, weights: NOutput) -> NOutput:
        """Outputs whose inverse is the weights."""
        return self.lower @ (self.lower.T @ weights)

    def variance_reduction(self, cross: RowN) -> Float[np.ndarray, "row 1"]:
        """Of each row's variance, by the cases that it varies with."""
        # Called bare: for one row, looking at the arguments first would cost as much again.
        right = cross.T.astype(self.lower.dtype, copy=False)
        half = _trtrs(self.lower.dtype.char)(self.lower, right, lower=True)[0]
        return np.einsum("nr,nr->r", half, half)[:, None]

    def inverse(self) -> NN:
        """Of the covariance with noise."""
        (potri,) = scipy.linalg.get_lapack_funcs(("potri",), (self.lower,))
        half = np.tril(potri(self.lower, lower=True)[0])
        return half + np.tril(half, -1).T

    def extended(
        self,
        # Covariance of the new cases with the old and with one another
        cross: Float[np.ndarray, "new n"],
        corner: Float[np.ndarray, "new new"],
        noise: Float[np.ndarray, " new"],  # of the new cases
    ) -> Self:
        """The factor with more cases, in O(n^2) for each.

        Raises LinAlgError: a new case repeats an old one more closely than its noise tells apart.
        """
        side = scipy.linalg.solve_triangular(self.lower, cross.T, lower=True, check_finite=False).T
        left = np.diag(corner) * (1.0 + JITTERS[0]) + noise - np.sum(side**2, axis=1)
        old, new = len(self.lower), len(corner)
        lower = np.zeros((old + new, old + new), order="F")
        lower[:old, :old], lower[old:, :old] = self.lower, side
        lower[old:, old:] = _lower(corner - side @ side.T, left)
        return replace(self, lower=lower)


class Later:
    """A factor of noise alike for all outputs, made when anything is first asked of it."""

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make = cache(make)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._make(), name)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spectrum:
    """Of a covariance under noise of another size for each output: one basis serves all."""

    # Eigenvectors (columns) and eigenvalues of the covariance
    basis: NN
    value: PerN
    noise: Float[np.ndarray, " output"]  # variance of each output's

    @classmethod
    def of(cls, covariance: NN, noise: Float[np.ndarray, " output"]) -> Self:
        """Decompose the covariance."""
        jitter = JITTERS[0] * float(np.diag(covariance).max())
        # Divide and conquer: the default driver fails where many eigenvalues are nearly the same.
        value, basis = scipy.linalg.eigh(covariance, driver="evd", check_finite=False)
        return cls(basis=basis, value=np.maximum(value, 0.0) + jitter, noise=noise)

    @property
    def inverse_value(self) -> NOutput:
        """Eigenvalues of the inverse, for each output."""
        return 1.0 / (self.value[:, None] + self.noise)

    def solve(self, y: NOutput) -> NOutput:
        """Inverse times outputs."""
        return self.basis @ ((self.basis.T @ y) * self.inverse_value)

    def observations(self, weights: NOutput) -> NOutput:
        """Outputs whose inverse is the weights."""
        return self.basis @ ((self.basis.T @ weights) / self.inverse_value)

    def variance_reduction(self, cross: RowN) -> Float[np.ndarray, "row output"]:
        """Of each row's variance, by the cases that it varies with."""
        return (cross @ self.basis) ** 2 @ self.inverse_value

    def precision(self) -> NOutput:
        """Diagonal of the inverse."""
        return self.basis**2 @ self.inverse_value


def _lower(covariance: NN, diagonal: PerN) -> NN:
    whole = covariance.copy()
    whole[np.diag_indices_from(whole)] = diagonal
    return scipy.linalg.cholesky(whole, lower=True, overwrite_a=True, check_finite=False)


@cache
def _trtrs(precision: str) -> Callable[..., tuple[np.ndarray, int]]:
    """LAPACK's solution of triangular systems, in double or single precision."""
    (trtrs,) = scipy.linalg.get_lapack_funcs(("trtrs",), dtype=precision)
    return trtrs
