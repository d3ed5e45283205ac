"""Lines whose tension is reported: bridles, and what a whole mooring has besides."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage._cage import Cage
from seacage.cage._structure import Structure


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MooringLines:
    """Ropes and chains of a mooring, the bridles first.

    Parameters
    ----------
    names, kinds
        Such as "anchor-1" and "bridle", "frame line", "anchor line", "buoy line" or a structure's
        "line" and "tie".
    capacity
        Breaking load over material factor; NaN where it is not known [N].
    pretension
        In still water; NaN where it is not known [N].
    tn_slope
        m of the T–N curve; NaN where it is not known [-].
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    capacity: Float[np.ndarray, " line"]
    pretension: Float[np.ndarray, " line"]
    tn_slope: Float[np.ndarray, " line"]

    @classmethod
    def alike(
        cls,
        names: Sequence[str],
        kind: str,
        *,
        capacity: Float[np.ndarray, " line"] | float = np.nan,
        pretension: float = np.nan,
        tn_slope: float | None = None,
    ) -> "MooringLines":
        """Lines of one kind."""
        count = len(names)
        return cls(
            names=tuple(names),
            kinds=(kind,) * count,
            capacity=np.full(count, capacity),
            pretension=np.full(count, pretension),
            tn_slope=np.full(count, np.nan if tn_slope is None else tn_slope),
        )

    def joined(self, *others: "MooringLines") -> "MooringLines":
        """These, and then others."""
        every = (self, *others)
        return MooringLines(
            names=sum((one.names for one in every), ()),
            kinds=sum((one.kinds for one in every), ()),
            capacity=np.concatenate([one.capacity for one in every]),
            pretension=np.concatenate([one.pretension for one in every]),
            tn_slope=np.concatenate([one.tn_slope for one in every]),
        )


def mooring_lines(cage: Cage | Structure, *, anchored: bool) -> MooringLines:
    """A cage's bridles; with its frame on anchors also frame lines, anchor lines and buoy lines.

    A structure's lines, and the ropes of its ties.
    """
    if isinstance(cage, Structure):
        ropes = MooringLines.alike(cage.rope_names, "tie")
        return MooringLines.alike(cage.bridle_names, "line").joined(ropes)
    parts, anchors = cage.bridles, cage.anchor_lines
    bridles = MooringLines.alike(
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
        MooringLines.alike(frame, "frame line", tn_slope=cage.frame.rope_tn_slope),
        MooringLines.alike(
            moored, "anchor line", pretension=anchors.pretension, tn_slope=anchors.rope_tn_slope
        ),
        MooringLines.alike([f"buoy-{number}" for number in sides], "buoy line"),
    )
