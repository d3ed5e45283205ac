"""A covariance of points and all their images under a group, factorised in blocks."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates._gp._factor import Cholesky

NOutput = Float[np.ndarray, "n output"]
DISTINCT = 1e-6  # eigenvalues of different subspaces, at least
# Noise over the variance of a point from which factors in single precision give variances. Rounding
# leaves an error of some 1e-6 of the variance there
SINGLE_NOISE = 5e-5
Part = tuple[Float[np.ndarray, "image _"], Cholesky]  # basis and factor
Quotient = Int[np.ndarray, "image image"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Orbits:
    """Of a covariance that a group of images leaves as it is, with the same noise at all points.

    Rows are image by image, in each the same points. In a basis of the group's irreducible
    subspaces no two of them covary: the eight images of 480 points under a square's group have four
    blocks of 480 rows and two of 960 for 3840 rows. Nothing is left out: but for the jitter,
    answers are those of the whole.
    """

    # Number of the image that the second of a pair is as the first one sees it
    quotient: Quotient
    parts: tuple[Part, ...]
    of_variance: tuple[Part, ...]  # the same, perhaps in single precision: its time goes by memory

    @classmethod
    def of(
        cls,
        covariance: Float[np.ndarray, "point n"],  # of the points of the first image with all
        noise: float,
        quotient: Quotient,
    ) -> Self:
        """Factorise; raises LinAlgError where a block is not positive definite."""
        images = covariance.reshape(len(covariance), len(quotient), -1)
        product = np.argsort(quotient, axis=1)
        parts = []
        for basis in irreducible_bases(quotient):
            share = np.einsum("ga,gkb->kab", basis, basis[product])
            block = np.einsum("ikj,kab->aibj", images, share, optimize=True)
            rows = len(block) * len(covariance)
            factor = Cholesky.of(block.reshape(rows, rows), np.full(rows, noise))
            parts.append((basis, factor))
        single = noise > SINGLE_NOISE * float(np.diag(covariance).max())
        return cls(
            quotient=quotient,
            parts=tuple(parts),
            of_variance=tuple(
                (basis, replace(one, lower=one.lower.astype(np.float32)) if single else one)
                for basis, one in parts
            ),
        )

    def solve(self, y: NOutput) -> NOutput:
        """Inverse times outputs."""
        return self._by_parts(Cholesky.solve, y)

    def observations(self, weights: NOutput) -> NOutput:
        """Outputs whose inverse is the weights."""
        return self._by_parts(Cholesky.observations, weights)

    def _by_parts(self, work: Callable[[Cholesky, np.ndarray], np.ndarray], y: NOutput) -> NOutput:
        images = y.reshape(len(self.quotient), -1)
        total = np.zeros_like(images)
        for basis, factor in self.parts:
            part = work(factor, (basis.T @ images).reshape(-1, y.shape[1]))
            total += basis @ part.reshape(basis.shape[1], -1)
        return total.reshape(y.shape)

    def variance_reduction(self, cross: Float[np.ndarray, "row n"]) -> Float[np.ndarray, "row 1"]:
        """Of each row's variance, by the cases that it varies with."""
        images = cross.reshape(len(cross), len(self.quotient), -1)
        total = np.zeros((len(cross), 1))
        for basis, factor in self.of_variance:
            total += factor.variance_reduction((basis.T @ images).reshape(len(cross), -1))
        return total

    def inverse(self) -> Float[np.ndarray, "n n"]:
        """Of the covariance with noise."""
        images, basis, factor = len(self.quotient), *self.parts[0]
        points = len(factor.lower) // basis.shape[1]
        first = self.solve(np.eye(images * points, points)).reshape(images, points, points)
        return first[self.quotient].transpose(0, 3, 1, 2).reshape(images * points, -1)


def irreducible_bases(quotient: Quotient) -> list[Float[np.ndarray, "image _"]]:
    """Orthonormal bases of the irreducible subspaces of a group.

    They are the eigenspaces of a random symmetric matrix that commutes with the group: Murota,
    Kanno, Kojima & Kojima (2010), Japan J. Indust. Appl. Math. 27, 125-160.
    """
    product, undone = np.argsort(quotient, axis=1), quotient[:, 0]
    commuting = np.random.default_rng(0).standard_normal(len(quotient))[product[:, undone].T]
    value, vector = np.linalg.eigh(commuting + commuting.T)
    return np.split(vector, np.flatnonzero(np.diff(value) > DISTINCT) + 1, axis=1)
