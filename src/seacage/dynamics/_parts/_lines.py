"""Lines whose tension is reported: bridles, and what a whole mooring has besides."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage


@dataclass(frozen=True, slots=True, kw_only=True)
class Lines:
    """Ropes and chains by their names."""

    names: tuple[str, ...]
    kinds: tuple[str, ...]  # "bridle", "frame line", "anchor line", "line"
    capacity: Float[np.ndarray, " line"]  # breaking load over material factor, or NaN [N]
    pretension: Float[np.ndarray, " line"]  # or NaN [N]
    tn_slope: Float[np.ndarray, " line"]  # m of the T–N curve, or NaN [-]

    @classmethod
    def alike(
        cls,
        names: Sequence[str],
        kind: str,
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
            capacity=np.full(count, capacity),
            pretension=np.full(count, pretension),
            tn_slope=np.full(count, np.nan if tn_slope is None else tn_slope),
        )

    def joined(self, other: "Lines") -> "Lines":
        """These, and then others."""
        return Lines(
            names=self.names + other.names,
            kinds=self.kinds + other.kinds,
            capacity=np.concatenate([self.capacity, other.capacity]),
            pretension=np.concatenate([self.pretension, other.pretension]),
            tn_slope=np.concatenate([self.tn_slope, other.tn_slope]),
        )


def mooring_lines(cage: Cage, *, anchored: bool) -> Lines:
    """A cage's bridles; with its frame on anchors also frame lines and anchor lines."""
    parts, anchors = cage.bridles, cage.anchor_lines
    bridles = Lines.alike(
        cage.bridle_names,
        "bridle",
        capacity=cage.bridle_capacity,
        pretension=parts.pretension,
        tn_slope=parts.tn_slope,
    )
    if not anchored:
        return bridles
    sides = range(1, len(cage.corner_position) + 1)
    frame = [f"frame-{number}" for number in sides]
    moored = [f"anchor-{number + 1}" for number in range(len(sides) * anchors.per_corner)]
    return bridles.joined(
        Lines.alike(frame, "frame line", tn_slope=cage.frame.rope_tn_slope)
    ).joined(
        Lines.alike(
            moored, "anchor line", pretension=anchors.pretension, tn_slope=anchors.rope_tn_slope
        )
    )
