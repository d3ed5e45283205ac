"""Stretches of time in which something is the matter."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.campaigns._buoy_records import span_of

AnyPerT = Shaped[np.ndarray, " t"]
PerSpell = Float[np.ndarray, " spell"]

_HOUR, _WEEK = 3600.0, 604800.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spells:
    """Stretches of time, each from its start up to its end; they may overlap."""

    # UTC, datetime64[us]
    start: Shaped[np.ndarray, " spell"]
    end: Shaped[np.ndarray, " spell"]

    @classmethod
    def by_chance(
        cls, time: AnyPerT, rng: np.random.Generator, *, per_week: float, mean_h: float = 0.0
    ) -> Self:
        """Spells that begin by chance between some times and last for exponential times."""
        span = span_of(time)
        start = rng.uniform(0.0, span, size=rng.poisson(per_week * span / _WEEK))
        return cls._after(time[0], start, rng.exponential(mean_h * _HOUR, size=len(start)))

    @classmethod
    def at_shares(cls, time: AnyPerT, windows: Sequence[tuple[float, float]]) -> Self:
        """Windows that begin at shares of the time between the first and the last of some times.

        ``windows``: share [-] and length [h] of each.
        """
        share, hours = np.reshape(windows, (-1, 2)).T
        return cls._after(time[0], share * span_of(time), hours * _HOUR)

    @classmethod
    def _after(cls, first: np.datetime64, start: PerSpell, length: PerSpell) -> Self:
        begin, end = (
            first + np.round(seconds * 1e6).astype("timedelta64[us]")
            for seconds in (start, start + length)
        )
        return cls(start=begin, end=end)

    def rows(self, time: AnyPerT) -> list[slice]:
        """Rows of ascending times within each spell that has any."""
        edges = np.searchsorted(time, np.array([self.start, self.end]))
        return [slice(first, last) for first, last in edges.T.tolist() if first < last]

    def cover(self, time: AnyPerT) -> Bool[np.ndarray, " t"]:
        """Whether each of some ascending times lies in a spell."""
        covered = np.zeros(len(time), dtype=bool)
        for rows in self.rows(time):
            covered[rows] = True
        return covered
