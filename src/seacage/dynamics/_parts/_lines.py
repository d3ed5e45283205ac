"""Lines whose tension is reported: bridles, and what a whole mooring has besides."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage


@dataclass(frozen=True, slots=True, kw_only=True)
class Lines:
    """Ropes and chains, each watched at one of its bars."""

    names: tuple[str, ...]
    kinds: tuple[str, ...]  # "bridle", "frame line", "anchor line", "line"
    bars: Int[np.ndarray, " line"]  # where a line's tension is taken
    capacity: Float[np.ndarray, " line"]  # breaking load over material factor, or NaN [N]
    pretension: Float[np.ndarray, " line"]  # or NaN [N]
    tn_slope: Float[np.ndarray, " line"]  # m of the T–N curve, or NaN [-]

    @classmethod
    def alike(
        cls,
        names: Sequence[str],
        kind: str,
        bars: Int[np.ndarray, " line"],
        *,
        capacity: Float[np.ndarray, " line"] | float = np.nan,
        pretension: float = np.nan,
        tn_slope: float | None = None,
    ) -> "Lines":
        """Lines of one kind."""
        count = len(names)
        return cls(
            names=tuple(names),
            kinds=(kind,) * count,
            bars=bars,
            capacity=np.full(count, capacity),
            pretension=np.full(count, pretension),
            tn_slope=np.full(count, np.nan if tn_slope is None else tn_slope),
        )

    @classmethod
    def bridles_of(cls, cage: Cage, bars: Int[np.ndarray, " bridle"]) -> "Lines":
        """A cage's bridles."""
        return cls.alike(
            cage.bridle_names,
            "bridle",
            bars,
            capacity=cage.bridle_capacity,
            pretension=cage.bridles.pretension,
            tn_slope=cage.bridles.tn_slope,
        )

    def joined(self, other: "Lines") -> "Lines":
        """These, and then others."""
        return Lines(
            names=self.names + other.names,
            kinds=self.kinds + other.kinds,
            bars=np.concatenate([self.bars, other.bars]),
            capacity=np.concatenate([self.capacity, other.capacity]),
            pretension=np.concatenate([self.pretension, other.pretension]),
            tn_slope=np.concatenate([self.tn_slope, other.tn_slope]),
        )
