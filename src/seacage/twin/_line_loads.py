"""Level 1 of all lines' loads in waves: the surrogate, and the seas that it learned."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from seacage.surrogates import Domain, FittedLoadGP, Loads, sea_features
from seacage.twin._metocean import Metocean

NO_WAVES = "Hs, wave direction and Tp are not all known; loads in waves need them."
NOT_TRAINED = "Outside the currents and waves that the loads of lines were learned in."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineLoads:
    """Surrogate of the loads of lines in waves.

    Parameters
    ----------
    names, kinds
        Of the lines, the bridles first.
    surrogate
        Of their loads.
    domain
        Of the currents' speed [m/s], Hs [m], log(Tp / 1 s) and log(Tp / (5 sqrt(Hs))) that it was
        trained on.
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    surrogate: FittedLoadGP
    domain: Domain

    def predict(
        self, water: Metocean, *, duration: float = 1800.0, spread: bool = True
    ) -> tuple[Loads, Bool[np.ndarray, " case"], tuple[str, ...]]:
        """Loads in each row of water, whether it is in the domain, and why not or why none.

        A sea lower than any of the training has the loads of the lowest, their scatter in
        proportion to its height. Where a number of the water is not known there is none. Without
        ``spread`` standard deviations and intervals are NaN, and the answer costs a small part.
        """
        table = water.table
        known = np.asarray(np.isfinite(table).all(axis=1))
        some = Metocean.from_table(np.where(known[:, None], table, 0.0))
        lowest, least_ratio, most_ratio = self.domain.lower[1], *self._ratios
        low = some.hs < lowest
        held = np.where(low, lowest, some.hs)
        ratio = np.clip(_ratio(some.tp, held), least_ratio, most_ratio)
        tp = np.where(low, 5.0 * np.sqrt(held) * ratio, np.maximum(some.tp, 1e-3))
        near = replace(some, hs=held, tp=tp)
        inside = known & self.domain.contains(_places(near))
        x = load_features(near)
        loads = self.surrogate.predict(x, hs=some.hs, duration=duration, spread=spread)
        reason = np.where(known, np.where(inside, "", NOT_TRAINED), NO_WAVES)
        return loads.known(known), inside, tuple(reason.tolist())

    @property
    def _ratios(self) -> tuple[float, float]:
        least, most = np.exp([self.domain.lower[3], self.domain.upper[3]])
        return float(least), float(most)


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


def _places(water: Metocean) -> Float[np.ndarray, "case 4"]:
    speed, ratio = np.linalg.norm(water.current_velocity, axis=1), _ratio(water.tp, water.hs)
    return np.column_stack([speed, water.hs, np.log(water.tp), np.log(ratio)])


def _ratio(tp: Float[np.ndarray, " case"], hs: Float[np.ndarray, " case"]) -> np.ndarray:
    return np.maximum(tp, 1e-3) / (5.0 * np.sqrt(hs))
