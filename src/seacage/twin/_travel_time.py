"""Time that the water takes from the buoy to the cage."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int, Shaped

from seacage.conventions import InputError
from seacage.records import Record
from seacage.twin._metocean import Metocean

SLACK = 1e-6  # water slower than this counts as this fast [m/s]
# Samples further apart tell nothing of the current between them [s]
LONGEST_GAP_S = 7200.0

Instants = Int[np.ndarray, " row"]  # [us] since 1970
Current = Float[np.ndarray, "row 2"]  # towards (east, north) [m/s]


@dataclass(frozen=True, slots=True, kw_only=True)
class TravelTime:
    """How long a current takes from the buoy to the cage: distance over its speed, up to a limit.

    It is advection by the current that the buoy measures, whatever its direction: with a long
    distance the time is the limit in any current, as of a tide that comes later. Left out: a cage
    that lies upstream of its buoy.
    """

    # That the water takes to the cage [m]; 0 where the buoy's current is the cage's own
    distance_m: float = 0.0
    longest_s: float = 0.0  # limit in slow water [s]

    def __post_init__(self) -> None:
        if not all(0.0 <= one < math.inf for one in (self.distance_m, self.longest_s)):
            raise InputError(
                f"TravelTime: distance_m = {self.distance_m:g} and longest_s = {self.longest_s:g} "
                "are no travel. Give numbers of at least 0."
            )

    @property
    def history_s(self) -> float:
        """How far back the buoy's samples are needed [s]: sound ones may be a gap before."""
        return self.longest_s + LONGEST_GAP_S if self.distance_m else 0.0

    def of(self, velocity: Current) -> Float[np.ndarray, " row"]:
        """Travel time of some currents [s]."""
        speed = np.maximum(np.linalg.norm(velocity, axis=1), SLACK)
        return np.minimum(self.distance_m / speed, self.longest_s)

    def current_at(
        self,
        # Of the sound samples, ascending; one at least
        time: Int[np.ndarray, " sample"],
        # As ``Metocean.currents``: the first two say how fast it comes, the others may be NaN
        velocity: Float[np.ndarray, "sample component"],
        at: Instants,  # not before the first of them
    ) -> Float[np.ndarray, "row component"]:
        """Current at the cage at some times, from the samples that the buoy had sent by then.

        The newest sample says how fast the water comes. Between two samples the current is
        straight; across a gap, and before the first sample, it is taken as the newest is.
        """
        newest = np.searchsorted(time, at, side="right") - 1
        travel = np.rint(1e6 * self.of(velocity[newest, :2])).astype(np.int64)
        left = np.minimum(at - travel, time[newest])
        before = np.searchsorted(time, left, side="right") - 1
        after = np.minimum(before + 1, newest)
        step = np.maximum(time[after] - time[before], 1)
        share = ((left - time[before]) / step)[:, None]
        between = (1.0 - share) * velocity[before] + share * velocity[after]
        known = (before >= 0) & (before < newest) & (step <= 1e6 * LONGEST_GAP_S)
        return np.where(known[:, None] & np.isfinite(between), between, velocity[newest])

    def water_at(self, buoy: Record, time: Shaped[np.ndarray, " t"]) -> Metocean:
        """Water at the cage at some times, from what a buoy had reported by then.

        Waves are those of the newest sample, and all is NaN before the first or where the newest
        value failed its checks.
        """
        if len(time):  # all others are of no use, and there may be many
            first = time.min() - np.timedelta64(round(1e6 * self.history_s), "us")
            start, end = np.searchsorted(buoy.time, [first, time.max()], side="right").tolist()
            buoy = buoy.rows(slice(max(start - 1, 0), max(end, 1)))
        rows = np.searchsorted(buoy.time, time, side="right") - 1
        reported = Metocean.of_record(buoy)
        water = reported.rows(rows)
        sound = np.isfinite(reported.current_velocity).all(axis=1)
        known = (rows >= 0) & np.isfinite(water.current_velocity).all(axis=1)
        currents = np.full_like(water.currents, np.nan)
        if known.any():
            currents[known] = self.current_at(
                microseconds(buoy.time[sound]), reported.currents[sound], microseconds(time[known])
            )
        return water.with_currents(currents)


def microseconds(time: Shaped[np.ndarray, " t"]) -> Instants:
    """Whole microseconds since 1970."""
    return time.astype("datetime64[us]").astype(np.int64)
