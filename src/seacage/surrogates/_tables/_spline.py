"""Tensor-product cubic splines on even grids, evaluated at millions of places."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Self

import numpy as np
import scipy
from jaxtyping import Float, Int

from seacage.surrogates._gp import chunks

FEWEST = 4  # nodes of an axis: four fix a cubic
PerRow = Float[np.ndarray, " row"]
CHUNK = 2**13  # rows weighed at once: their weights stay in a core's own cache


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spline:
    """Cubic spline through values on an even grid over the unit cube; any number of fields.

    Twice continuously differentiable. At the ends of an axis the first two pieces are one
    polynomial (not-a-knot), so that the error is of fourth order up to the edge; a periodic
    axis has no ends.

    Source: de Boor (1978), "A Practical Guide to Splines", chapters IV, IX and XVII.
    """

    # Nodes of each axis; the last node of a periodic axis lies one cell before its end
    shape: tuple[int, ...]
    periodic: tuple[bool, ...]  # whether each axis closes on itself
    # Of the B-splines, one row for each, the last axis running fastest, one column per field
    coefficients: Float[np.ndarray, "coefficient field"]

    @classmethod
    def through(
        cls,
        values: Float[np.ndarray, "node field"],
        *,
        shape: tuple[int, ...],
        periodic: tuple[bool, ...],
    ) -> Self:
        """Interpolate values at the nodes that ``nodes`` lists, in its order."""
        fields = values.shape[1]
        table = values.reshape(*shape, fields)
        for axis, closed in enumerate(periodic):
            lines = np.moveaxis(table, axis, 0)
            solved = (_close if closed else _open)(lines.reshape(len(lines), -1))
            table = np.moveaxis(solved.reshape(-1, *lines.shape[1:]), 0, axis)
        coefficients = np.ascontiguousarray(table).reshape(-1, fields)
        return cls(shape=shape, periodic=periodic, coefficients=coefficients)

    def at(self, place: Float[np.ndarray, "row axis"]) -> Float[np.ndarray, "row field"]:
        """Value of each field at places of the unit cube."""
        answer = np.empty((len(place), self.coefficients.shape[1]))
        for rows in chunks(len(place), CHUNK):
            answer[rows] = self._weights(place[rows]) @ self.coefficients
        return answer

    def _weights(self, place: Float[np.ndarray, "row axis"]) -> "scipy.sparse.csr_array":
        """Row of B-spline weights for each place: the product with the coefficients is one loop."""
        # Whole columns at a time: the inner loops run over the rows, not over four weights.
        weights, first = [np.ones(len(place))], np.zeros(len(place), dtype=np.int32)
        offset = np.zeros(1, dtype=np.int32)
        sizes = coefficient_counts(self.shape, self.periodic)
        for axis, count, closed, size in zip(
            place.T, self.shape, self.periodic, sizes, strict=True
        ):
            along, cell = _pieces(axis, count if closed else count - 1)
            weights = [one * other for one in weights for other in along]
            first = first * np.int32(size) + cell
            offset = (offset[:, None] * size + np.arange(4, dtype=np.int32)).ravel()
        weight = np.stack(weights, axis=1).ravel()
        index = (first[:, None] + offset.astype(np.int32)).ravel()
        start = np.arange(0, len(weight) + 1, len(weights), dtype=np.int32)
        shape = (len(place), prod(sizes))
        return scipy.sparse.csr_array((weight, index, start), shape=shape, copy=False)


def nodes(shape: Sequence[int], periodic: Sequence[bool]) -> Float[np.ndarray, "node axis"]:
    """Places of a grid's nodes in the unit cube, the last axis running fastest."""
    lines = [
        np.linspace(0.0, 1.0, count, endpoint=not closed)
        for count, closed in zip(shape, periodic, strict=True)
    ]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(lines))


def coefficient_counts(shape: Sequence[int], periodic: Sequence[bool]) -> list[int]:
    """Along each axis; a closed one repeats its first three, so that no index has to wrap."""
    return [count + 2 + closed for count, closed in zip(shape, periodic, strict=True)]


def _pieces(place: PerRow, cells: int) -> tuple[list[PerRow], Int[np.ndarray, " row"]]:
    """Weights of the four B-splines that reach each place, and the first one's index."""
    across = place * cells
    cell = np.minimum(across.astype(np.int32), np.int32(cells - 1))
    u = across - cell
    v = 1.0 - u
    u2, v2 = u * u, v * v
    return [
        v2 * v / 6.0,
        2.0 / 3.0 - 0.5 * u2 * (2.0 - u),
        2.0 / 3.0 - 0.5 * v2 * (2.0 - v),
        u2 * u / 6.0,
    ], cell


def _open(values: Float[np.ndarray, "node line"]) -> Float[np.ndarray, "coefficient line"]:
    """B-spline coefficients of lines with two ends."""
    count = len(values)
    # By diagonals: row i of the system holds the values' condition (1, 4, 1)/6 in its columns
    # i-1..i+1, and the first and the last row that the third derivative does not jump.
    band = np.zeros((9, count + 2))
    for offset, weight in ((-1, 1.0 / 6.0), (0, 4.0 / 6.0), (1, 1.0 / 6.0)):
        band[4 - offset, 1 + offset : count + 1 + offset] = weight
    for offset, weight in enumerate((1.0, -4.0, 6.0, -4.0, 1.0)):
        band[4 - offset, offset] = weight
        band[4 + offset, count + 1 - offset] = weight
    target = np.zeros((count + 2, values.shape[1]))
    target[1:-1] = values
    return scipy.linalg.solve_banded((4, 4), band, target, check_finite=False)


def _close(values: Float[np.ndarray, "node line"]) -> Float[np.ndarray, "coefficient line"]:
    """B-spline coefficients of lines that close on themselves, the first three repeated."""
    count = len(values)
    wave = 2.0 * np.pi * np.arange(count // 2 + 1) / count
    response = (4.0 + 2.0 * np.cos(wave)) / 6.0
    around = np.fft.irfft(np.fft.rfft(values, axis=0) / response[:, None], n=count, axis=0)
    return around[np.arange(-1, count + 2) % count]
