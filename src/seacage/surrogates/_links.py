"""Link kernels side by side: the covariances of many levels with their own points, at once.

One formula holds them all: k_rho (curve (k_f - held k_f0 k_0f') + offset) + left k_delta
+ line f f' + level. What the level below does not enter is made once for all its values.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self, assert_never

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from seacage.surrogates._autoregressive import AutoregressiveKernel, LinkKernel, StraightKernel
from seacage.surrogates._bend import RANGE
from seacage.surrogates._kernels import squared_distance
from seacage.surrogates._regression import Posterior


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Links:
    """Link kernels with the points that each has learned from.

    Parameters
    ----------
    rho_length, delta_length, link_length
        Over which each varies with the features and with the level below.
    curve, held, offset, left, line, level
        What the parts of the formula are multiplied by.
    rho_point, delta_point
        Features of the points, in these lengths; a level that has fewer points than the most
        has some at 0 in the end.
    below_point
        The level below at the points.
    """

    rho_length: Float[np.ndarray, "voice feature"]
    delta_length: Float[np.ndarray, "voice feature"]
    link_length: Float[np.ndarray, " voice"]
    curve: Float[np.ndarray, " voice"]
    held: Float[np.ndarray, " voice"]
    offset: Float[np.ndarray, " voice"]
    left: Float[np.ndarray, " voice"]
    line: Float[np.ndarray, " voice"]
    level: Float[np.ndarray, " voice"]
    rho_point: Float[np.ndarray, "voice n feature"]
    delta_point: Float[np.ndarray, "voice n feature"]
    below_point: Float[np.ndarray, "voice n"]

    @classmethod
    def of(cls, posteriors: Sequence[Posterior]) -> Self:
        """Of processes whose kernels are links over the same features."""
        parts = [_terms(_link(one), one.log_parameters) for one in posteriors]
        terms = {name: np.array([part[name] for part in parts]) for name in parts[0]}
        most = max(len(one.x) for one in posteriors)
        points = np.stack([np.pad(one.x, ((0, most - len(one.x)), (0, 0))) for one in posteriors])
        local = points[..., :-1]
        return cls(
            **terms,
            rho_point=local / terms["rho_length"][:, None],
            delta_point=local / terms["delta_length"][:, None],
            below_point=points[..., -1],
        )

    def covariance(
        self, x: Float[np.ndarray, "voice row feature"], below: Float[np.ndarray, "voice row node"]
    ) -> Float[np.ndarray, "voice row node n"]:
        """With the points, where the level below has several values for each row of inputs."""
        rho = _bell(x / self.rho_length[:, None], self.rho_point)
        delta = _bell(x / self.delta_length[:, None], self.delta_point)
        plain = self.left[:, None, None] * delta + self.level[:, None, None]

        length, point = _beside(self.link_length, 3), self.below_point[:, None, None]
        below = below[..., None]
        covariance = np.exp(-0.5 * (below / length - point / length) ** 2)
        to_mean = _beside(self.held, 3) * np.exp(-0.5 * (below / length) ** 2)
        covariance -= to_mean * np.exp(-0.5 * (point / length) ** 2)
        covariance *= _beside(self.curve, 3)
        covariance += _beside(self.offset, 3)
        covariance *= rho[:, :, None]
        covariance += plain[:, :, None]
        covariance += (_beside(self.line, 3) * below) * point
        return covariance

    def variance(self, below: Float[np.ndarray, "voice row node"]) -> Float[np.ndarray, "_ _ _"]:
        """Beforehand, where the level below has these values."""
        to_mean = np.exp(-((below / _beside(self.link_length, 2)) ** 2))
        bent = _beside(self.curve, 2) * (1.0 - _beside(self.held, 2) * to_mean)
        flat = self.offset + self.left + self.level
        return bent + _beside(flat, 2) + _beside(self.line, 2) * below**2


def _bell(
    x: Float[np.ndarray, "voice row feature"], point: Float[np.ndarray, "voice n feature"]
) -> Float[np.ndarray, "voice row n"]:
    return np.exp(-0.5 * squared_distance(x, point))


def _beside(values: Float[np.ndarray, " voice"], axes: int) -> np.ndarray:
    """With so many axes of length 1 behind."""
    return values.reshape(-1, *[1] * axes)


def _link(posterior: Posterior) -> LinkKernel:
    assert isinstance(posterior.kernel, LinkKernel)
    return posterior.kernel


def _terms(
    kernel: LinkKernel, log_parameters: Float[np.ndarray, " parameter"]
) -> dict[str, ArrayLike]:
    """What the formula holds of one kernel."""
    size = np.exp(log_parameters)
    match kernel:
        case AutoregressiveKernel():
            features = (len(size) - 1 - kernel.linear) // 2 - 1
            (rho, *rho_length), rest = size[: features + 1], size[features + 1 :]
            link, delta, delta_length = rest[0], rest[1], rest[2 : features + 2]
            line = rest[-1] if kernel.linear else 0.0
            return {
                "rho_length": rho_length,
                "delta_length": delta_length,
                "link_length": link,
                "curve": rho * link**2 if kernel.linear else rho,
                "held": float(kernel.linear),
                "offset": rho * RANGE**2 * kernel.linear,
                "left": delta,
                "line": line,
                "level": line,
            }
        case StraightKernel():
            line, delta, *delta_length = size
            return {
                "rho_length": np.ones(len(delta_length)),
                "delta_length": delta_length,
                "link_length": np.inf,
                "curve": 0.0,
                "held": 0.0,
                "offset": 0.0,
                "left": delta,
                "line": line,
                "level": 0.0,
            }
        case _:
            assert_never(kernel)
