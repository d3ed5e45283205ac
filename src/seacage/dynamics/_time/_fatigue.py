"""Fatigue of a line: the damage-equivalent load of its tension."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

FREQUENCY = 1.0  # of the equivalent load's cycles [Hz]


def damage_equivalent_load(
    tension: Sequence[Float[np.ndarray, "t line"]],
    slope: Float[np.ndarray, " line"],
    *,
    every: float,
) -> Float[np.ndarray, " line"]:
    """Range of the constant cycles at 1 Hz that wear each line as its own tension does [N].

    (Σ nᵢ ΔTᵢᵐ / (1 Hz · duration))^(1/m), the cycles counted by rainflow, half cycles as halves.
    Left out: the effect of the mean tension, bending over the fairlead, and corrosion.

    ``tension``: of each simulation of one sea [N].
    ``slope``: m of each line's T–N curve, NaN where there is none, which gives NaN [-].
    ``every``: between samples [s].

    Source: rainflow: ASTM E1049-85 (2011), 5.4.4.
    """
    duration = every * sum(map(len, tension))
    load = np.full(len(slope), np.nan)
    for line in np.flatnonzero(np.isfinite(slope)):
        m = slope[line]
        cycles = np.concatenate([_cycles(one[:, line]) for one in tension])
        # over the largest range, or a slope of 13 leaves the finite numbers
        largest = max(cycles[:, 0].max(initial=0.0), np.finfo(float).tiny)
        damage = np.sum(cycles[:, 1] * (cycles[:, 0] / largest) ** m)
        load[line] = largest * (damage / (FREQUENCY * duration)) ** (1.0 / m)
    return load


def _cycles(series: Float[np.ndarray, " t"]) -> Float[np.ndarray, "cycle 2"]:
    """Range and count, 1 or 1/2, of each rainflow cycle."""
    import rainflow

    change = np.sign(np.diff(series))
    moving = np.flatnonzero(change)
    turns = moving[1:][change[moving[1:]] != change[moving[:-1]]]  # all but these it would skip
    reversals = series[np.concatenate([[0], turns, [len(series) - 1]])].astype(np.float64)
    found = [(size, count) for size, _, count, _, _ in rainflow.extract_cycles(reversals.tolist())]
    return np.array(found).reshape(-1, 2)
