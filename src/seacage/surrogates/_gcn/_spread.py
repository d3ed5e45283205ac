"""Standard deviation of a network's answer, from held-out cases."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
import scipy
from jaxtyping import Float, Int

from seacage.conventions import ModelError
from seacage.surrogates._arrays import Arrays, array

CaseFeature = Float[np.ndarray, "case feature"]
PerRow = Float[np.ndarray, " row"]
RowFeature = Float[np.ndarray, "row feature"]
NEIGHBOURS = 10  # held-out cases whose misses make the size of a miss at a place
TWO_SIGMA = 1.959963984540054  # standard deviations that hold 95 % of a Gaussian
NOISE_SHARE = (0.01, 0.98)  # least and largest share of the variance that may be called noise


# No slots here: the reach is computed once and kept.
@dataclass(frozen=True, kw_only=True, eq=False)
class Spread:
    """Standard deviation of a network's answer, by coordinate and by place among its cases.

    A network has no variance of its own, so its held-out cases give one: each
    coordinate has the miss that 95 % of them stay within (split conformal), made larger or
    smaller by the misses of the nearest of them. Beyond the farthest that a held-out case lay
    from its nearest training case, it grows in proportion to that distance.
    """

    # Standardised features of the cases that trained the network, and of the others
    train: Float[np.ndarray, "train feature"]
    held_out: Float[np.ndarray, "held feature"]
    size: Float[np.ndarray, " held"]  # of the miss of each held-out case, 1 on average
    miss: Float[np.ndarray, "node 3"]  # of each coordinate, where the size is 1 [m]
    # Share of the variance that differs between neighbouring cases
    noise: Float[np.ndarray, "node 3"]

    @classmethod
    def of(
        cls,
        x: CaseFeature,  # standardised features of all cases
        residual: Float[np.ndarray, "case node 3"],  # truth less the network's answer [m]
        *,
        # Which cases are which
        train: Int[np.ndarray, " train"],
        held_out: Int[np.ndarray, " held"],
    ) -> Self:
        """From the residuals of a network."""
        missed = residual[held_out]
        # Coordinates that never move are never missed, and must not divide by 0.
        tiny = 1e-9 * max(1.0, float(np.abs(residual).max()))
        typical = np.sqrt(np.mean(missed**2, axis=0)) + tiny
        size = np.sqrt(np.mean((missed / typical) ** 2, axis=(1, 2))) + 1e-9
        without_itself = _nearest_mean(x[held_out], x[held_out], size**2, skip=1)
        around = np.sqrt(without_itself)[:, None, None]
        enough = min(1.0, math.ceil(0.95 * (len(missed) + 1)) / len(missed))
        scaled = np.quantile(np.abs(missed) / around, enough, axis=0, method="higher")
        miss = scaled / TWO_SIGMA + tiny
        rough = _roughness(x[train], residual[train])
        return cls(
            train=x[train],
            held_out=x[held_out],
            size=size,
            miss=miss,
            noise=np.clip(rough / typical**2, *NOISE_SHARE),
        )

    def std(
        self,
        x: RowFeature,  # one row per case
        *,
        # Of a case as it was learned from; otherwise without what differs between neighbours
        noisy: bool,
    ) -> Float[np.ndarray, "row node 3"]:
        """At standardised features [m]."""
        around = np.sqrt(_nearest_mean(x, self.held_out, self.size**2))
        grown = np.maximum(1.0, _distances(x, self.train).min(axis=1) / self._reach)
        kept = grown[:, None, None] ** 2 - (0.0 if noisy else self.noise)
        return around[:, None, None] * self.miss * np.sqrt(kept)

    @cached_property
    def _reach(self) -> float:
        """Largest distance of a held-out case from its nearest training case."""
        return max(1e-6, float(_distances(self.held_out, self.train).min(axis=1).max()))

    def to_arrays(self) -> Arrays:
        """By the names of its parts."""
        parts = {"taught": self.train} | {
            name: getattr(self, name) for name in ("held_out", "size", "miss", "noise")
        }
        return {name: np.ascontiguousarray(part) for name, part in parts.items()}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, np.ndarray], *, features: int, nodes: int) -> Self:
        """The other way.

        Raises ModelError: an array is missing, of another shape, or not finite.
        """
        held_out = array(arrays, "held_out", None, features)
        noise = array(arrays, "noise", nodes, 3)
        if not np.all((noise > 0.0) & (noise < 1.0)):
            raise ModelError(
                "The saved GCN calls less than none or more than all of its spread noise. "
                "The file is damaged. Train the model again."
            )
        return cls(
            train=array(arrays, "taught", None, features),
            held_out=held_out,
            size=array(arrays, "size", len(held_out)),
            miss=array(arrays, "miss", nodes, 3),
            noise=noise,
        )


def _distances(x: RowFeature, cases: CaseFeature) -> Float[np.ndarray, "row case"]:
    return scipy.spatial.distance.cdist(x, cases)


def _nearest_mean(
    x: RowFeature, cases: CaseFeature, values: Float[np.ndarray, " case"], *, skip: int = 0
) -> PerRow:
    """Mean over the nearest cases, but for so many of the very nearest."""
    order = np.argsort(_distances(x, cases), axis=1, kind="stable")
    return values[order[:, skip : skip + NEIGHBOURS]].mean(axis=1)


def _roughness(
    x: CaseFeature, residual: Float[np.ndarray, "case node 3"]
) -> Float[np.ndarray, "node 3"]:
    """Variance of what neighbours do not share: half the mean square of their difference."""
    beside = np.argsort(_distances(x, x), axis=1, kind="stable")[:, 1]
    return 0.5 * np.mean((residual - residual[beside]) ** 2, axis=0)
