"""A virtual ADCP: the current at several depths, at the buoy or at the cage, in the buoy's rows."""

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage import ocean
from seacage.campaigns._buoy_records import seconds_of
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.campaigns._virtual_field._weather import Even, Weather, current_at_buoy, shear
from seacage.conventions import compass
from seacage.records import Record, bin_keys, check_record

Place = Literal["buoy", "cage"]
RowBin2 = Float[np.ndarray, "row bin 2"]

BINS = np.arange(5.0, 31.0, 5.0)  # depth of the middle of each bin [m]
# Errors, as makers state them of ten-minute means of profilers of 400 to 600 kHz: of each component
# of a bin [m/s], of the compass, which stays [deg], and the share of bins without a value [-]
_NOISE, _COMPASS_DEG, _LOST = 0.015, 2.0, 0.03
# Distance in which the correlation of two places' shear falls to 1/e: judgement [m]
_ALIKE_M = 3000.0


def with_bins(buoy: Record, velocity: RowBin2, *, seed: int) -> Record:
    """A buoy's record with the current at each depth, as an ADCP would report it."""
    rng = np.random.default_rng([seed, *b"adcp"])
    turned = np.full(velocity.shape[:2], np.deg2rad(rng.normal(scale=_COMPASS_DEG)))
    seen = ocean.turn_vectors(velocity, turned) + rng.normal(scale=_NOISE, size=velocity.shape)
    seen[rng.uniform(size=velocity.shape[:2]) < _LOST] = np.nan
    values, flags = dict(buoy.values), dict(buoy.flags)
    for depth, one in zip(BINS.tolist(), np.moveaxis(seen, 1, 0), strict=True):
        speed, to = np.linalg.norm(one, axis=1), compass(one)
        own = dict(zip(bin_keys(depth), (np.round(speed, 3), np.round(to, 1)), strict=True))
        checked = check_record(replace(buoy, values=own, flags={}, notes=()))
        values, flags = {**values, **checked.values}, {**flags, **checked.flags}
    note = f"Current at {', '.join(f'{depth:g}' for depth in BINS)} m by a virtual ADCP."
    return replace(buoy, values=values, flags=flags, notes=(*buoy.notes, note))


def bins_of_settled(
    buoy: Record,
    place: Place,
    at_cage: tuple[Even, Even],
    *,
    hidden: TruthParameters,
    rng: np.random.Generator,
    seed: int,
) -> RowBin2:
    """True velocity in each bin at each of the buoy's times, beside a settled cage [m/s].

    ``at_cage``: mean of the current over the net's depth there, and its shear. ``rng``: the one
    that the current at the cage was drawn by, begun anew.
    """
    mean, sheared = at_cage
    second = seconds_of(buoy.time, buoy.time[0])
    if place == "cage":
        return ocean.over_depth(mean.at(second), sheared.at(second), BINS)
    surface, arrives = current_at_buoy(buoy, second, hidden=hidden, rng=rng)
    there = _at_distance(sheared, hidden, seed).at(arrives)
    return ocean.over_depth(surface + 0.5 * there, there, BINS)


def bins_of_simulated(
    buoy: Record,
    place: Place,
    weather: Weather,
    *,
    hidden: TruthParameters,
    rng: np.random.Generator,
    seed: int,
) -> RowBin2:
    """True velocity in each bin at each of the buoy's times, beside a simulated cage [m/s].

    ``weather``: at the cage. ``rng``: as of ``bins_of_settled``.
    """
    second = seconds_of(buoy.time, buoy.time[0])
    if place == "cage":
        levels = np.array([weather.current(one) for one in second.tolist()])
    else:
        surface, arrives = current_at_buoy(buoy, second, hidden=hidden, rng=rng)
        own = None if weather.shear is None else _at_distance(weather.shear, hidden, seed)
        levels = np.array(
            [
                replace(weather, surface=Even(step=1.0, values=np.tile(now, (2, 1))), shear=own)
                .current(then)
                for now, then in zip(surface, arrives.tolist(), strict=True)
            ]
        )  # fmt: skip
    share = [np.interp(BINS, weather.level_depth, unit) for unit in np.eye(len(levels[0]))]
    return np.einsum("tlx,lb->tbx", levels, np.array(share))


def _at_distance(sheared: Even, hidden: TruthParameters, seed: int) -> Even:
    """The shear at the buoy, in times of its water's arrival at the cage: partly another."""
    alike = math.exp(-hidden.current.distance_m / _ALIKE_M)
    other = shear(hidden.profile, len(sheared.values), sheared.step, seed=seed + 2**32)
    mixed = alike * sheared.values + math.sqrt(1.0 - alike**2) * other
    return replace(sheared, values=mixed)
