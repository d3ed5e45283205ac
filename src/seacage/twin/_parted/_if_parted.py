"""Answer to what would be if a line parted."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage, mooring_lines

# Bears its buoy's lift, and no more than all of it: it is no line that would go next
BUOY_LINE = "buoy line"


@dataclass(frozen=True, kw_only=True, eq=False)
class IfParted:
    """Loads and state of a cage of which one line has parted, once the transient has died.

    By level 1, so without intervals. NaN where ``reason`` or ``in_domain`` says that nothing is
    known.
    """

    cage: Cage  # as it was simulated
    # The line that has parted, and its kind
    parted: tuple[str, ...]
    kinds: tuple[str, ...]
    # Of the lines whose loads these are, the parted one among them
    line_names: tuple[str, ...]
    line_kinds: tuple[str, ...]
    # Mean tension, and the expected largest of three hours; 0 of the line itself [N]
    mean: Float[np.ndarray, "case parted line"]
    maximum_3h: Float[np.ndarray, "case parted line"]
    # Volume inside the net over that in still water, of the whole cage [-]
    volume_share: Float[np.ndarray, "case parted"]
    # Least height of the net above the sea bed, the lowest that a node came in a case's time [m]
    clearance: Float[np.ndarray, "case parted"]
    # Of the collar's centre from its place in still water, horizontally, in the mean [m]
    drift: Float[np.ndarray, "case parted"]
    # Whether the sea is inside what was learned of the line
    in_domain: Bool[np.ndarray, "case parted"]
    reason: tuple[str, ...]  # one sentence for a sea of which nothing is known, else ""

    @property
    def largest_mean(self) -> Int[np.ndarray, "case parted"]:
        """Number of the line with the largest mean, buoy lines aside; 0 where none is known."""
        return self._most_loaded(self.mean)

    @property
    def largest_maximum_3h(self) -> Int[np.ndarray, "case parted"]:
        """Number of the line with the largest expected maximum, as ``largest_mean``."""
        return self._most_loaded(self.maximum_3h)

    @property
    def utilisation(self) -> Float[np.ndarray, "case parted"]:
        """Largest share of a capacity that a line would bear; NaN where none is known [-]."""
        share = self._load / self._strength[0]
        known = np.isfinite(share)
        most = np.where(known, share, 0.0).max(axis=-1)
        return np.where(known.any(axis=-1), most, np.nan)

    @property
    def second_would_part(self) -> Float[np.ndarray, "case parted"]:
        """1 where another line would bear its breaking load, 0 where none, NaN where not known.

        A breaking load that the cage's file does not give leaves it open, unless another line
        goes in any case.
        """
        share = (self._load / self._strength[1])[..., self._holds]
        goes = np.any(np.nan_to_num(share) >= 1.0, axis=-1)
        return np.where(goes, 1.0, np.where(np.isfinite(share).all(axis=-1), 0.0, np.nan))

    @property
    def _load(self) -> Float[np.ndarray, "case parted line"]:
        """The expected maximum, or the mean where no waves are known [N]."""
        return np.where(np.isfinite(self.maximum_3h), self.maximum_3h, self.mean)

    def _most_loaded(self, load: Float[np.ndarray, "case parted line"]) -> np.ndarray:
        return np.argmax(np.where(self._holds, np.nan_to_num(load), -1.0), axis=-1)

    @property
    def _holds(self) -> Bool[np.ndarray, " line"]:
        return np.array([kind != BUOY_LINE for kind in self.line_kinds])

    @property
    def _strength(self) -> Float[np.ndarray, "2 line"]:
        """Capacity and breaking load of each line; NaN where the cage's file has none [N]."""
        lines = mooring_lines(self.cage, anchored=True).named(self.line_names)
        return np.stack([lines.capacity, lines.breaking_load])
