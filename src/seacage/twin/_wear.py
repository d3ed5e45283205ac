"""Damage of lines minute by minute, from what a buoy measured."""

from collections.abc import Sequence
from datetime import datetime

import numpy as np
from jaxtyping import Float

from seacage.conventions import YEAR
from seacage.records import Sample, instant
from seacage.twin._metocean import WATER_KEYS, Metocean
from seacage.twin._state import is_usable
from seacage.twin._twin import Twin

MINUTE_S = 60.0


def damage_of_minutes(
    twin: Twin,
    samples: Sequence[Sample],  # of its buoy, in the order of their times, with their flags
    start: datetime,  # of the first minute
    count: int,  # of minutes
    *,
    known: dict[bytes, Float[np.ndarray, " line"]],  # damage of seas met before, which is added to
) -> Float[np.ndarray, "minute line"]:
    """Share of each line's life that each minute used up; NaN in a minute without an answer.

    A minute has the sea of the buoy's newest reading at its begin. Where any number of it is not
    known, failed its checks or is stale there is no answer, nor outside the training domain.
    """
    at = instant(start) + np.arange(count) * np.timedelta64(60, "s")
    stale = np.timedelta64(int(1e6 * twin.timeouts.stale_after_s), "us")
    columns = dict[str, np.ndarray]()
    for key in WATER_KEYS:
        own = [one for one in samples if key in one.values]
        t = np.array([instant(one.t) for one in own], dtype="datetime64[us]")
        values = [one.values[key] if is_usable(one, key) else np.nan for one in own]
        place = np.searchsorted(t, at, side="right") - 1
        if own:
            fresh = (place >= 0) & (at - t[place] <= stale)
            columns[key] = np.where(fresh, np.array(values)[place], np.nan)
    table = Metocean.from_columns(columns, count).table
    damage = np.full((count, len(twin.models.lines.names)), np.nan)
    for row in np.flatnonzero(np.isfinite(table).all(axis=1)).tolist():
        sea = table[row].tobytes()
        if sea not in known:
            loads = twin.models.answer(Metocean.from_table(table[row : row + 1]), [""]).line
            if loads is None or loads.damage_per_year is None:
                break
            known[sea] = loads.damage_per_year[0] * MINUTE_S / YEAR
        damage[row] = known[sea]
    return damage
