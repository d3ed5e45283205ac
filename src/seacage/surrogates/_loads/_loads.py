"""Statistics of lines' loads in waves, and predictions of them on the scale of their logarithm."""

import math
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
import scipy
from jaxtyping import Bool, Float, Int

from seacage.conventions import Rows
from seacage.surrogates._prediction import Prediction, interval_ends

CaseLine = Float[np.ndarray, "case line"]
EULER = 0.5772156649015329  # mean of a standard Gumbel variable
HALVINGS = 40  # of the bracket of a quantile
# Of the quadrature over a logarithm's normal distribution
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(9)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LoadCases(Rows):
    """Loads of a campaign's lines, one row per case."""

    # Of the tension [N]
    mean: CaseLine
    std: CaseLine
    # Most probable and expected largest tension of three hours; NaN where a line had too few
    # peaks, being slack nearly all the time [N]
    most_probable: CaseLine
    expected: CaseLine
    largest: CaseLine  # of the case itself, which counts where ``expected`` is NaN [N]
    # Range of cycles at 1 Hz that wear the line as much; NaN in all cases of a line without a T-N
    # curve [N]
    damage_equivalent: CaseLine

    @property
    def above_mean(self) -> CaseLine:
        """Expected largest tension of three hours above the mean [N]."""
        largest = np.where(np.isfinite(self.expected), self.expected, self.largest)
        return np.maximum(largest - self.mean, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LoadPrediction(Rows):
    """A load above a base, log-normal as far as it is not known, and Gumbel as far as waves vary.

    The load is base + size · exp(log_std · n) · (1 + gumbel · (g − 0.577)) − offset, with n
    standard normal and g standard Gumbel.
    """

    base: CaseLine  # what the load is above [N]
    size: CaseLine  # median of the rest, the offset included [N]
    # Standard deviation of the rest's logarithm; NaN where no honest interval is known [-]
    log_std: CaseLine
    # Scale of the largest value's scatter over the rest; 0 for what is no largest value [-]
    gumbel: CaseLine
    offset: float  # taken from the sum; no load is below its base [N]
    # Where ``log_std`` is NaN, standard deviation of a normal distribution about the mean; NaN or
    # None where that is not known either [N]
    discrepancy: CaseLine | None = None

    @property
    def mean(self) -> CaseLine:
        """Expected load [N]."""
        known = np.nan_to_num(self.log_std)
        return self._load(self.size * np.exp(0.5 * known**2))

    @property
    def std(self) -> CaseLine:
        """Standard deviation of the load [N]."""
        square = np.expm1(self.log_std**2)
        scatter = self.gumbel**2 * math.pi**2 / 6.0
        size = self.size * np.exp(0.5 * self.log_std**2)
        std = size * np.sqrt(square + scatter * (1.0 + square))
        return std if self.discrepancy is None else np.where(np.isnan(std), self.discrepancy, std)

    def interval(self, level: float) -> tuple[CaseLine, CaseLine]:
        """Bounds that hold a share of the loads, the same share beyond either [N]."""
        lower, upper = (self._quantile(end) for end in interval_ends(level))
        if self.discrepancy is None:
            return lower, upper
        ends = Prediction(mean=self.mean, std=self.discrepancy).interval(level)
        about, plain = np.maximum(ends, 0.0), np.isnan(self.log_std)
        return np.where(plain, about[0], lower), np.where(plain, about[1], upper)

    def lines(self, some: Int[np.ndarray, " line"]) -> Self:
        """The loads of some lines."""
        names = ("base", "size", "log_std", "gumbel", "discrepancy")
        known = {name: one for name in names if (one := getattr(self, name)) is not None}
        return replace(self, **{name: one[:, some] for name, one in known.items()})

    def of_share(self, share: float) -> Self:
        """Largest load of a share of the three hours, in each row: Gumbel with a lower mode."""
        scale = self.gumbel * self.size
        size = np.maximum(self.size + scale * math.log(share), 0.0)
        return replace(self, size=size, gumbel=scale / np.maximum(size, 1e-9))

    def pooled(self, share: float) -> Self:
        """Largest load of a time in which the cases follow one another, as one row.

        The largest of all is taken to be Gumbel distributed, with the mode and the decay that the
        product of the cases' distributions has there.

        ``share``: length of each case, over the three hours that its own largest is of [-].
        """
        scale = np.maximum(self.gumbel * self.size, 1e-6)
        mode = self.base + self.size - EULER * scale - self.offset
        crossing = np.empty((2, mode.shape[1]))
        for row, rate in enumerate((1.0, math.exp(-1.0))):
            least, most = (mode - 40.0 * scale).min(axis=0), (mode + 40.0 * scale).max(axis=0)
            for _ in range(2 * HALVINGS):
                middle = 0.5 * (least + most)
                exceeded = share * np.exp(np.minimum((mode - middle) / scale, 600.0)).sum(axis=0)
                beyond = exceeded > rate
                most, least = np.where(beyond, most, middle), np.where(beyond, middle, least)
            crossing[row] = most
        decay, base, about = crossing[1] - crossing[0], self.base.mean(axis=0), self.discrepancy
        size = np.maximum(crossing[0] + EULER * decay - base, 0.0) + self.offset
        return replace(
            self,
            base=base[None],
            size=size[None],
            log_std=self.log_std.mean(axis=0, keepdims=True),
            gumbel=(decay / np.maximum(size, 1e-9))[None],
            discrepancy=None if about is None else about.mean(axis=0, keepdims=True),
        )

    def widened(self, edge: Self, rows: Bool[np.ndarray, " case"]) -> Self:
        """The same, in some rows with the ratio to other loads added to the logarithm's spread."""
        sizes = (np.log(np.maximum(one.size, 1e-9)) for one in (self, edge))
        moved = np.where(rows[:, None], np.subtract(*sizes), 0.0)
        return replace(self, log_std=np.hypot(self.log_std, moved))

    def _load(self, above: CaseLine) -> CaseLine:
        return self.base + np.maximum(above - self.offset, 0.0)

    def _quantile(self, share: float) -> CaseLine:
        """By halving a bracket of the factor on ``size``, at all cases and lines at once."""
        widest = np.abs(NODES).max() * np.nan_to_num(self.log_std)
        most = np.exp(widest) * (1.0 + 40.0 * self.gumbel) + 1e-9
        least = np.zeros_like(most)
        for _ in range(HALVINGS):
            middle = 0.5 * (least + most)
            above = self._share_below(middle) > share
            least, most = np.where(above, least, middle), np.where(above, middle, most)
        factor = np.where(np.isfinite(self.log_std), 0.5 * (least + most), np.nan)
        return self._load(self.size * factor)

    def _share_below(self, factor: CaseLine) -> np.ndarray:
        with np.errstate(divide="ignore", over="ignore"):
            plain = scipy.special.ndtr(np.log(factor) / np.maximum(self.log_std, 1e-12))
            around = factor[..., None] * np.exp(-self.log_std[..., None] * NODES) - 1.0
            gumbel = np.maximum(self.gumbel[..., None], 1e-12)
            extreme = np.exp(-np.exp(-(around / gumbel + EULER))) @ (WEIGHTS / WEIGHTS.sum())
        return np.where(self.gumbel > 0.0, extreme, plain)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Loads(Rows):
    """Predicted loads of lines, one row per case."""

    # Of the tension over the time that was asked for [N]
    mean: Prediction
    std: LoadPrediction
    # Largest tension of three hours: its mean is the expected one, its interval holds the realised
    # one [N]
    maximum_3h: LoadPrediction
    # Range of cycles at 1 Hz that wear the line as much; NaN for a line without a T-N curve [N]
    damage_equivalent: LoadPrediction
    # Share of the life that a year of this sea uses up; NaN for a line without an intercept of its
    # curve, outside the training domain and where Tp is not known; None before lines' curves are
    # known [1/a]
    damage_per_year: CaseLine | None = None

    def known(self, rows: Bool[np.ndarray, " case"]) -> Self:
        """The same with NaN in all other rows."""
        return _where(rows, self)

    def widened(self, edge: Self, rows: Bool[np.ndarray, " case"]) -> Self:
        """The same, in some rows with how far the loads are from others added in quadrature."""
        mean, there = self.mean, edge.mean.mean
        moved = np.where(rows[:, None], mean.mean - there, 0.0)
        return replace(
            self,
            mean=replace(mean, std=np.hypot(mean.std, moved)),
            **{
                name: getattr(self, name).widened(getattr(edge, name), rows)
                for name in ("std", "maximum_3h", "damage_equivalent")
            },
        )


def _where(rows: Bool[np.ndarray, " case"], part: Any) -> Any:
    if isinstance(part, Rows):
        parts = {one.name: getattr(part, one.name) for one in fields(part)}
        return replace(part, **{name: _where(rows, one) for name, one in parts.items()})
    return np.where(rows[:, None], part, np.nan) if isinstance(part, np.ndarray) else part
