"""Currents over depth that a buoy's current at one depth may stand for."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from seacage.ocean import turn_vectors
from seacage.surrogates import Prediction
from seacage.twin._metocean import Metocean

DRAWS = 16  # profiles that stand for all that may be
LEAST_PROFILES = 100  # of a record, to draw from them
Row2 = Float[np.ndarray, "row 2"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Profiles:
    """Profiles as they were measured or simulated, over the current at one depth.

    They are in the frame of that current: what the mean over depth has beside it, along it and to
    its left, and the shear likewise [m/s]. Left out: that larger currents have other ones.
    """

    draws: Float[np.ndarray, "draw 4"]

    @classmethod
    def of(cls, current: Row2, profile: Float[np.ndarray, "row 4"]) -> "Profiles":
        """Choose some of many, evenly over what the mean has along the current.

        ``current``: at one depth. ``profile``: mean and shear at the same times.
        """
        beside = profile - np.hstack([current, np.zeros_like(current)])
        own = _turn(beside, -_direction(current))
        # Of equal parts in that order, the row in the middle
        middle = (np.arange(DRAWS) + 0.5) * len(own) / DRAWS
        return cls(draws=own[np.argsort(own[:, 0], kind="stable")][middle.astype(int)])

    @classmethod
    def of_water(cls, water: Metocean) -> "Profiles | None":
        """Profiles in the rows of water that have one; None where these are too few."""
        if water.profile is None:
            return None
        both = np.isfinite(np.hstack([water.current_velocity, water.profile])).all(axis=1)
        if both.sum() < LEAST_PROFILES:
            return None
        return cls.of(water.current_velocity[both], water.profile[both])

    def members(self, water: Metocean) -> Metocean:
        """Each row of water with each profile, the profiles of a row one after another."""
        count = len(self.draws)
        every = water.rows(np.repeat(np.arange(len(water)), count))
        current = every.current_velocity
        profile = _turn(np.tile(self.draws, (len(water), 1)), _direction(current))
        return replace(every, profile=profile + np.hstack([current, np.zeros_like(current)]))


def without_profile(water: Metocean) -> Bool[np.ndarray, " case"]:
    """Rows whose current over depth is not known."""
    if water.profile is None:
        return np.ones(len(water), dtype=bool)
    return np.asarray(np.isnan(water.profile).any(axis=1))


def mix(block: Mapping[str, Any], members: int) -> dict[str, Any]:
    """Fields of an answer in rows of so many members each: their means, by total variance."""
    mixed = {name: _mean_of(one, members) for name, one in block.items()}
    apart = _by_member(block["node_position"], members).var(axis=1)
    for name, more in (
        ("node_std", apart),
        ("node_sigma", apart.max(axis=2)),
        ("volume_std", _by_member(block["volume_fraction"], members).var(axis=1)),
    ):
        mixed[name] = np.sqrt(np.mean(_by_member(block[name], members) ** 2, axis=1) + more)
    return mixed


def _mean_of(value: Any, members: int) -> Any:
    if isinstance(value, Prediction):
        mean, std = (_by_member(one, members) for one in (value.mean, value.std))
        variance = np.mean(std**2, axis=1) + mean.var(axis=1)
        return Prediction(mean=mean.mean(axis=1), std=np.sqrt(variance))
    mean = _by_member(value, members).mean(axis=1)
    return mean >= 0.5 if value.dtype == bool else mean


def _by_member(value: np.ndarray, members: int) -> np.ndarray:
    return value.reshape(-1, members, *value.shape[1:])


def _direction(current: Row2) -> Float[np.ndarray, " row"]:
    """Angle of each current, clockwise from east [rad]."""
    return -np.arctan2(current[:, 1], current[:, 0])


def _turn(
    pairs: Float[np.ndarray, "row 4"], clockwise: Float[np.ndarray, " row"]
) -> Float[np.ndarray, "row 4"]:
    return np.hstack([turn_vectors(pairs[:, at], clockwise) for at in (slice(2), slice(2, 4))])
