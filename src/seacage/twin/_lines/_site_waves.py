"""Waves of a site, which stand for what a buoy does not say of them."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from seacage.surrogates import LoadPrediction, Loads
from seacage.twin._metocean import Metocean

MEMBERS = 128  # kept, evenly from the lowest to the highest
SEAS = 32  # of them, which stand for waves of which nothing is known
NEAREST = 32  # of them in height, from which a period is taken
PERIODS = 8  # quantiles that stand for its distribution
LEAST = 20  # with height, direction and period


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SiteWaves:
    """Waves that stand for those of a site, all as likely."""

    # Hs [m], unit vector they travel along, east and north [-], and Tp [s], the lowest first
    table: Float[np.ndarray, "member 4"]
    origin: str  # where they come from, as in a sentence

    @classmethod
    def of(cls, water: Metocean, origin: str) -> Self | None:
        """Take some of the waves of a campaign or a record; None where there are too few."""
        known = water.table[:, 2:]
        known = known[np.isfinite(known).all(axis=1) & (known[:, 0] > 0.0) & (known[:, 3] > 0.0)]
        if len(known) < LEAST:
            return None
        ordered = known[np.argsort(known[:, 0], kind="stable")]
        return cls(table=ordered[_evenly(len(ordered), MEMBERS)], origin=origin)

    def members(self, water: Metocean) -> tuple[Metocean, Int[np.ndarray, " member"]]:
        """Seas that each row of water may be, and the row of each.

        A period that is not known has the distribution that it has in waves of the same height,
        as Tp / (5 √Hs); where height or direction are not known any of the site's waves may be.
        """
        if not len(water):
            return water, np.arange(0)
        table, (no_waves, no_tp) = water.table, self.gaps(water)
        parts = [one[None] for one in table]
        for row in np.flatnonzero(no_tp):
            parts[row] = parts[row].repeat(PERIODS, axis=0)
            parts[row][:, 5] = self._periods(float(table[row, 2]))
        for row in np.flatnonzero(no_waves):
            some = self.table[_evenly(len(self.table), SEAS)]
            parts[row] = np.column_stack([np.tile(table[row, :2], (len(some), 1)), some])
        count = [len(one) for one in parts]
        return Metocean.from_table(np.concatenate(parts)), np.repeat(np.arange(len(count)), count)

    def gaps(self, water: Metocean) -> tuple[Bool[np.ndarray, " case"], Bool[np.ndarray, " case"]]:
        """Rows whose height or direction is not known, and those whose period alone is not."""
        known, waves = np.isfinite(water.table), np.isfinite(water.table[:, 2:5]).all(axis=1)
        return known[:, 0] & ~waves, known[:, 0] & waves & ~known[:, 5]

    def _periods(self, hs: float) -> Float[np.ndarray, " period"]:
        away = np.abs(self.table[:, 0] - hs)
        near = self.table[np.argsort(away, kind="stable")[:NEAREST]]
        ratio = near[:, 3] / np.sqrt(near[:, 0])
        return np.sqrt(hs) * np.quantile(ratio, (np.arange(PERIODS) + 0.5) / PERIODS)


def mean_over_members(
    values: Shaped[np.ndarray, "member *part"], row: Int[np.ndarray, " member"]
) -> Float[np.ndarray, "case *part"]:
    """Mean over the members of each row; of truths their share."""
    start = np.flatnonzero(np.diff(row, prepend=-1))
    count = np.diff(start, append=len(row)).reshape(-1, *(1,) * (values.ndim - 1))
    return np.add.reduceat(values, start, axis=0, dtype=float) / count


def mix(loads: Loads, row: Int[np.ndarray, " member"]) -> Loads:
    """Loads of each row over its members, all as likely.

    The scatter of the members is in the standard deviations. The damage-equivalent load is that
    of the mean damage of lines of slope 3.
    """
    start = np.flatnonzero(np.diff(row, prepend=-1))
    count = np.diff(start, append=len(row))[:, None]

    def over(values: Float[np.ndarray, "member line"]) -> Float[np.ndarray, "case line"]:
        return mean_over_members(values, row)

    def scatter(values: Float[np.ndarray, "member line"]) -> Float[np.ndarray, "case line"]:
        return over((values - over(values)[row]) ** 2)

    def above(part: LoadPrediction, power: float) -> LoadPrediction:
        size = np.where(count > 1, over(part.size**power) ** (1.0 / power), part.size[start])
        return replace(
            part,
            base=over(part.base),
            size=size,
            log_std=np.sqrt(over(part.log_std**2) + scatter(np.log(np.maximum(part.size, 1e-9)))),
            gumbel=over(part.gumbel),
        )

    mean = replace(
        loads.mean,
        mean=over(loads.mean.mean),
        std=np.sqrt(over(loads.mean.std**2) + scatter(loads.mean.mean)),
    )
    powers = {"std": 1.0, "maximum_3h": 1.0, "damage_equivalent": 3.0}
    return replace(
        loads, mean=mean, **{name: above(getattr(loads, name), m) for name, m in powers.items()}
    )


def _evenly(count: int, most: int) -> Int[np.ndarray, " member"]:
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)
