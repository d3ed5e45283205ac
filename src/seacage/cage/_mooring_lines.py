"""Lines whose tension is reported: bridles, and what a whole mooring has besides."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.cage._cage import Cage
from seacage.cage._parts import AnchorLines, Bridles, Frame
from seacage.cage._structure import Structure

_NUMBERS = ("breaking_load", "capacity", "pretension", "tn_slope", "tn_load")  # of each line


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MooringLines:
    """Ropes and chains of a mooring, the bridles first; NaN where a number is not known.

    Source: API RP 2SK (2005), fatigue analysis: T–N curves.
    """

    names: tuple[str, ...]  # such as "anchor-1"
    # "bridle", "frame line", "anchor line", "buoy line" or a structure's "line" and "tie"
    kinds: tuple[str, ...]
    breaking_load: Float[np.ndarray, " line"]  # [N]
    capacity: Float[np.ndarray, " line"]  # breaking load over material factor [N]
    pretension: Float[np.ndarray, " line"]  # in still water [N]
    # m of the T–N curve N · R^m = K, R the range of tension over breaking load [-]
    tn_slope: Float[np.ndarray, " line"]
    # Range of which a single cycle would use up the life, breaking load · K^(1/m) [N]
    tn_load: Float[np.ndarray, " line"]

    @classmethod
    def alike(
        cls,
        names: Sequence[str],
        kind: str,
        *,
        breaking_load: float | None = None,
        material_factor: float | None = None,
        pretension: float = np.nan,
        tn_slope: float | None = None,
        tn_intercept: float | None = None,
    ) -> "MooringLines":
        """Lines of one kind."""
        count, one_cycle = len(names), np.nan
        if breaking_load and tn_slope and tn_intercept:
            one_cycle = breaking_load * tn_intercept ** (1.0 / tn_slope)
        capacity = breaking_load / material_factor if breaking_load and material_factor else np.nan
        return cls(
            names=tuple(names),
            kinds=(kind,) * count,
            breaking_load=np.full(count, breaking_load or np.nan),
            capacity=np.full(count, capacity),
            pretension=np.full(count, pretension),
            tn_slope=np.full(count, np.nan if tn_slope is None else tn_slope),
            tn_load=np.full(count, one_cycle),
        )

    def damage_rate(
        self, equivalent: Float[np.ndarray, "*case line"]
    ) -> Float[np.ndarray, "*case line"]:
        """Share of the life that damage-equivalent loads at 1 Hz [N] use up in a second [1/s]."""
        return (equivalent / self.tn_load) ** self.tn_slope

    def named(self, names: Sequence[str]) -> "MooringLines":
        """Lines of some names, in their order; nothing is known of one that is not here."""
        other = [name for name in names if name not in self.names]
        every = self.joined(MooringLines.alike(other, "line"))
        rows = [every.names.index(name) for name in names]
        return MooringLines(
            names=tuple(names),
            kinds=tuple(every.kinds[row] for row in rows),
            **{key: getattr(every, key)[rows] for key in _NUMBERS},
        )

    def joined(self, *others: "MooringLines") -> "MooringLines":
        """These, and then others."""
        every = (self, *others)
        return MooringLines(
            names=sum((one.names for one in every), ()),
            kinds=sum((one.kinds for one in every), ()),
            **{key: np.concatenate([getattr(one, key) for one in every]) for key in _NUMBERS},
        )


def mooring_lines(cage: Cage | Structure, *, anchored: bool) -> MooringLines:
    """A cage's bridles; with its frame on anchors also frame lines, anchor lines and buoy lines.

    A structure's lines, and the ropes of its ties.
    """
    if isinstance(cage, Structure):
        ropes = MooringLines.alike(cage.rope_names, "tie")
        return MooringLines.alike(cage.bridle_names, "line").joined(ropes)
    parts, anchors = cage.bridles, cage.anchor_lines
    known = {"pretension": parts.pretension, **_rope(parts, prefix="")}
    bridles = MooringLines.alike(cage.bridle_names, "bridle", **known)
    if not anchored:
        return bridles
    sides = range(1, len(cage.corner_position) + 1)
    frame = [f"frame-{number}" for number in sides]
    moored = [f"anchor-{number + 1}" for number in range(len(sides) * anchors.per_corner)]
    return bridles.joined(
        MooringLines.alike(frame, "frame line", **_rope(cage.frame)),
        MooringLines.alike(moored, "anchor line", pretension=anchors.pretension, **_rope(anchors)),
        MooringLines.alike([f"buoy-{number}" for number in sides], "buoy line"),
    )


def _rope(part: Frame | AnchorLines | Bridles, prefix: str = "rope_") -> dict[str, Any]:
    keys = ("breaking_load", "material_factor", "tn_slope", "tn_intercept")
    return {key: getattr(part, prefix + key) for key in keys}
