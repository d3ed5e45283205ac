"""Level 1 of all lines' loads in waves: the surrogate, and the seas that it learned."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.surrogates import Domain, FittedLoadGP, FittedMotionGP, Loads, Prediction, sea_features
from seacage.twin._lines._site_waves import SiteWaves, mean_over_members, mix
from seacage.twin._metocean import Metocean

NO_WAVES = "Hs, wave direction and Tp are not all known; loads in waves need them."
NOT_TRAINED = "Outside the currents and waves that the loads of lines were learned in."
ANY_WAVES = (
    "Hs or the wave direction is not known, so of the lines' loads the means alone are, over {}."
)
ANY_TP = "Tp is not known; it is taken to be distributed as at the same Hs in {}."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HeldSeas:
    """Seas as the surrogates of lines' loads are asked for them."""

    x: Float[np.ndarray, "case 7"]  # features, of no lower waves than the training had
    hs: Float[np.ndarray, " case"]  # as it is, which scales the waves' effect where it is lower [m]
    known: Bool[np.ndarray, " case"]  # where all of the water is known
    inside: Bool[np.ndarray, " case"]  # where it is inside what was learned
    places: Float[np.ndarray, "case 4"]  # in the axes of a domain


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineLoads:
    """Surrogate of the loads of lines in waves."""

    # Of the lines, the bridles first
    names: tuple[str, ...]
    kinds: tuple[str, ...]
    surrogate: FittedLoadGP  # of their loads
    # Of the currents' speed [m/s], Hs [m], log(Tp / 1 s) and log(Tp / (5 sqrt(Hs))) that it was
    # trained on
    domain: Domain
    waves: SiteWaves | None = None  # of the site, for buoys that lack some; None in older twins
    motion: FittedMotionGP | None = None  # of the nodes in the same seas; None if not learned

    def predict(
        self, water: Metocean, *, spread: bool = True
    ) -> tuple[Loads, Bool[np.ndarray, " case"], tuple[str, ...]]:
        """Loads in each row of water, whether it is in the domain, and why not or why none.

        A sea lower than any of the training has the loads of the lowest, their scatter in
        proportion to its height. Where Tp is not known, loads are over its distribution at the
        same Hs among the site's waves; where Hs or the direction is not, the means are over all of
        those, with a standard deviation of no less than they spread, and the rest is NaN. Without
        ``spread`` other standard deviations and intervals are NaN, and the answer costs a small
        part. With it they are wider outside the domain, by how far the loads move beyond its edge.
        """
        if self.waves is None or np.isfinite(water.table).all():
            loads, inside = self._predict(water, spread=spread)
        else:
            no_waves = self.gaps(water)[0]
            members, row = self.members(water)
            loads, near = self._predict(members, spread=spread)
            std = loads.mean.std
            if not spread:
                std = np.broadcast_to(np.where(no_waves[row, None], 0.0, np.nan), std.shape)
            mixed = mix(replace(loads, mean=Prediction(mean=loads.mean.mean, std=std)), row)
            loads = replace(mixed.known(~no_waves), mean=mixed.mean)
            inside = mean_over_members(near, row) >= 0.5
        return loads, inside, self.reasons(water, inside)

    def members(self, water: Metocean) -> tuple[Metocean, Int[np.ndarray, " member"]]:
        """Seas that each row of water may be, and the row of each; itself where there is no gap."""
        return self.waves.members(water) if self.waves else (water, np.arange(len(water)))

    def gaps(self, water: Metocean) -> tuple[Bool[np.ndarray, " case"], Bool[np.ndarray, " case"]]:
        """Rows whose height or direction, and those whose period alone is taken from the site's."""
        none = np.zeros(len(water), dtype=bool)
        return self.waves.gaps(water) if self.waves else (none, none)

    def reasons(self, water: Metocean, inside: Bool[np.ndarray, " case"]) -> tuple[str, ...]:
        """One sentence for each row whose loads are none, of other waves or extrapolated."""
        reason = np.where(np.isfinite(water.table).all(axis=1), "", NO_WAVES)
        if self.waves is not None:
            for gap, sentence in zip(self.gaps(water), (ANY_WAVES, ANY_TP), strict=True):
                reason = np.where(gap, sentence.format(self.waves.origin), reason)
        return tuple(np.where(inside | (reason == NO_WAVES), reason, NOT_TRAINED).tolist())

    def node_motion(self, water: Metocean) -> Float[np.ndarray, "case node 2"] | None:
        """Standard deviations of the nodes' places, horizontally and upwards [m]; None without.

        NaN where height or direction of the waves is not known; over the distribution of Tp
        where that is not.
        """
        if self.motion is None:
            return None
        no_waves = self.gaps(water)[0][:, None]
        in_waves = Metocean.from_table(np.where(no_waves, np.nan, water.table))
        members, row = self.members(in_waves)
        seas = self.hold(members)
        variance = self.motion.mean(seas.x, hs=seas.hs) ** 2
        variance[~seas.known] = np.nan
        return np.sqrt(mean_over_members(variance, row))

    def _predict(self, water: Metocean, *, spread: bool) -> tuple[Loads, Bool[np.ndarray, " case"]]:
        """Loads in each row of water that is all known, and whether it is in the domain."""
        seas = self.hold(water)
        loads = self.surrogate.predict(seas.x, hs=seas.hs, spread=spread)
        beyond = seas.known & ~seas.inside
        if spread and beyond.any():
            some = _with_zeros(water).limited(
                current_speed=self.domain.upper[0], hs=self.domain.upper[1]
            )
            x = load_features(self._near(some, clip=True))
            loads = loads.widened(self.surrogate.predict(x, hs=seas.hs, spread=False), beyond)
        return loads.known(seas.known), seas.inside

    def hold(self, water: Metocean) -> HeldSeas:
        """Seas that the surrogate can be asked for: the lowest of the training for lower ones."""
        some = _with_zeros(water)
        known = np.asarray(np.isfinite(water.table).all(axis=1))
        near = self._near(some)
        places = _places(near)
        inside = known & self.domain.contains(places)
        return HeldSeas(
            x=load_features(near), hs=some.hs, known=known, inside=inside, places=places
        )

    def _near(self, water: Metocean, *, clip: bool = False) -> Metocean:
        """Water as low as the lowest of the training; with ``clip`` of a period of it too."""
        least_ratio, most_ratio = np.exp([self.domain.lower[3], self.domain.upper[3]])
        low = water.hs < self.domain.lower[1]
        held = np.where(low, self.domain.lower[1], water.hs)
        ratio = np.clip(_ratio(water.tp, held), least_ratio, most_ratio)
        tp = np.where(low | clip, 5.0 * np.sqrt(held) * ratio, np.maximum(water.tp, 1e-3))
        return replace(water, hs=held, tp=tp)


def sea_domain(water: Metocean) -> Domain:
    """Domain of the currents and waves of a training."""
    return Domain.of(_places(water))


def load_features(water: Metocean) -> Float[np.ndarray, "case 7"]:
    """Features of the loads of lines."""
    return sea_features(
        water.current_velocity, hs=water.hs, tp=water.tp, wave_direction=water.wave_direction
    )


def period_span(water: Metocean) -> float:
    """Largest Tp / (5 sqrt(Hs)) of some seas over the least [-]."""
    ratio = _ratio(water.tp, water.hs)
    return float(ratio.max() / ratio.min())


def _with_zeros(water: Metocean) -> Metocean:
    """Water with zeros in rows that are not all known."""
    table = water.table
    return Metocean.from_table(np.where(np.isfinite(table).all(axis=1, keepdims=True), table, 0.0))


def _places(water: Metocean) -> Float[np.ndarray, "case 4"]:
    speed, ratio = np.linalg.norm(water.current_velocity, axis=1), _ratio(water.tp, water.hs)
    return np.column_stack([speed, water.hs, np.log(water.tp), np.log(ratio)])


def _ratio(tp: Float[np.ndarray, " case"], hs: Float[np.ndarray, " case"]) -> np.ndarray:
    return np.maximum(tp, 1e-3) / (5.0 * np.sqrt(hs))
