"""Link kernels side by side: the covariances of many levels with their own points, at once.

One formula holds them all: rho (curve (k_f - held k_f0 k_0f') + offset) + left delta + line f f'
+ constant, with rho, delta and k_f squared exponentials. What the level below does not enter is
made once for all its values. The kernels themselves say the same one at a time, and learn.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self, assert_never

import numpy as np
from jaxtyping import Float

from seacage.surrogates._autoregressive import AutoregressiveKernel, LinkKernel, StraightKernel
from seacage.surrogates._bend import RANGE
from seacage.surrogates._regression import Posterior

EachMember = Float[np.ndarray, "member 1 1"]
EachPoint = Float[np.ndarray, "member 1 1 n"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Links:
    """Link kernels with the points that each has learned from.

    A member that has fewer points than the most has some at 0 in the end.

    Parameters
    ----------
    local_length, link_length
        Over which rho and delta vary with the features, and k_f with the level below.
    curve, held, offset, left, line, constant
        Of the formula.
    local_point
        The points' features for rho and for delta, as ``_squared_distance`` takes them.
    link_point
        The level below at the points, in its length.
    held_point, line_point
        The factors of the formula's parts that the points make.
    """

    local_length: Float[np.ndarray, "2 member 1 feature"]
    link_length: EachMember
    curve: EachMember
    held: EachMember
    offset: EachMember
    left: EachMember
    line: EachMember
    constant: EachMember
    local_point: Float[np.ndarray, "2 member column n"]
    link_point: EachPoint
    held_point: EachPoint
    line_point: EachPoint

    @classmethod
    def of(cls, posteriors: Sequence[Posterior]) -> Self:
        """Of processes whose kernels are links over the same features."""
        terms = [_terms(one) for one in posteriors]
        each = {
            name: np.array([getattr(one, name) for one in terms]).reshape(-1, 1, 1)
            for name in ("link_length", "curve", "held", "offset", "left", "line", "constant")
        }
        lengths = [[one.rho_length for one in terms], [one.delta_length for one in terms]]
        local_length = np.array(lengths)[:, :, None]
        most = max(len(one.x) for one in posteriors)
        points = np.stack([np.pad(one.x, ((0, most - len(one.x)), (0, 0))) for one in posteriors])
        below = points[:, None, None, :, -1]
        link_point = below / each["link_length"][..., None]
        return cls(
            **each,
            local_length=local_length,
            local_point=_as_columns(points[..., :-1] / local_length),
            link_point=link_point,
            held_point=each["held"][..., None] * np.exp(-0.5 * link_point**2),
            line_point=each["line"][..., None] * below,
        )

    def covariance(
        self,
        x: Float[np.ndarray, "member row feature"],
        below: Float[np.ndarray, "member row node"],
    ) -> Float[np.ndarray, "member row node n"]:
        """With the points, where the level below has several values for each row of features."""
        rho, delta = np.exp(-0.5 * _squared_distance(x / self.local_length, self.local_point))
        link = (below / self.link_length)[..., None]
        covariance = np.exp(-0.5 * (link - self.link_point) ** 2)
        covariance -= np.exp(-0.5 * link**2) * self.held_point
        covariance *= self.curve[..., None]
        covariance += self.offset[..., None]
        covariance *= rho[:, :, None]
        covariance += (self.left * delta + self.constant)[:, :, None]
        covariance += below[..., None] * self.line_point
        return covariance

    def variance(
        self, below: Float[np.ndarray, "member row node"]
    ) -> Float[np.ndarray, "member row node"]:
        """Beforehand, where the level below has these values."""
        known = self.held * np.exp(-((below / self.link_length) ** 2))
        bent = self.curve * (1.0 - known) + self.offset
        return bent + self.left + self.constant + self.line * below**2


@dataclass(frozen=True, slots=True, kw_only=True)
class _Terms:
    """What the formula holds for one kernel."""

    rho_length: Sequence[float]
    delta_length: Sequence[float]
    link_length: float = np.inf
    curve: float = 0.0
    held: float = 0.0
    offset: float = 0.0
    left: float
    line: float
    constant: float = 0.0


def _terms(posterior: Posterior) -> _Terms:
    kernel, size = posterior.kernel, np.exp(posterior.log_parameters).tolist()
    assert isinstance(kernel, LinkKernel)
    features = posterior.x.shape[1] - 1
    match kernel:
        case AutoregressiveKernel(linear=linear):
            rho, link, left = size[0], size[features + 1], size[features + 2]
            line = size[-1] if linear else 0.0
            return _Terms(
                rho_length=size[1 : features + 1],
                delta_length=size[features + 3 : 2 * features + 3],
                link_length=link,
                curve=rho * link**2 if linear else rho,
                held=float(linear),
                offset=rho * RANGE**2 if linear else 0.0,
                left=left,
                line=line,
                constant=line,
            )
        case StraightKernel():
            line, left, *length = size
            return _Terms(rho_length=length, delta_length=length, left=left, line=line)
        case _:
            assert_never(kernel)


def _as_columns(point: Float[np.ndarray, "2 member n feature"]) -> np.ndarray:
    """Points that a product with rows (x, |x|^2, 1) makes squared distances of."""
    square = np.sum(point**2, axis=-1, keepdims=True)
    columns = np.concatenate([-2.0 * point, np.ones_like(square), square], axis=-1)
    return np.ascontiguousarray(np.swapaxes(columns, -1, -2))


def _squared_distance(
    x: Float[np.ndarray, "2 member row feature"], point: Float[np.ndarray, "2 member column n"]
) -> Float[np.ndarray, "2 member row n"]:
    square = np.sum(x**2, axis=-1, keepdims=True)
    squared = np.concatenate([x, square, np.ones_like(square)], axis=-1) @ point
    return np.maximum(squared, 0.0, out=squared)
