"""The input in force: the newest reading of the buoy that is not ahead of the clock."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from seacage.conventions import Flag, duration_text
from seacage.records import Sample
from seacage.twin._metocean import Metocean


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """The input that holds at a time.

    Parameters
    ----------
    metocean
        One row; None before the first.
    age_s
        Of its oldest part [s].
    trouble
        Why it cannot be used, in one sentence; "" where it can.
    """

    metocean: Metocean | None
    age_s: float | None
    trouble: str


def reading_at(
    newest: Mapping[str, Sample],
    now: datetime,
    *,
    buoy: str,
    keys: Sequence[str],
    stale_after_s: float,
) -> Reading:
    """Return the buoy's newest value of each key, if it is sound and fresh.

    The newest reading governs: where it failed its checks there is no input until the next
    good one, as an older value is no measurement of the water since.
    One that is ahead of the clock does not govern yet.

    Parameters
    ----------
    newest, now
        The buoy's last sample with each key, and the clock.
    buoy, keys
        Its name, and the quantities that the models take.
    stale_after_s
        Longest time for which a value is held [s].
    """
    missing = [key for key in keys if key not in newest]
    if missing:
        return Reading(metocean=None, age_s=None, trouble=f"{buoy} has not sent {missing[0]} yet.")

    columns = {
        key: np.array([sample.values[key] if _usable(sample, key) else np.nan])
        for key, sample in newest.items()
    }
    age = max((now - newest[key].t).total_seconds() for key in keys)
    bad = [key for key in keys if not _usable(newest[key], key)]
    if bad:
        trouble = fault_of(buoy, bad[0], newest[bad[0]].flags[bad[0]])
    elif age > stale_after_s:
        trouble = (
            f"The last reading of {buoy} is {duration_text(age)} old; "
            f"{duration_text(stale_after_s)} is the limit."
        )
    else:
        trouble = ""
    return Reading(metocean=Metocean.from_columns(columns, 1), age_s=age, trouble=trouble)


def _usable(sample: Sample, key: str) -> bool:
    """Whether a value may reach a model."""
    return sample.flags[key] not in {Flag.FAIL, Flag.MISSING}


def fault_of(buoy: str, key: str, flag: int) -> str:
    """Return why a value is no input."""
    word = Flag(flag).name.lower().replace("_", " ")
    return f"{buoy}: {key} is flagged {flag:d} ({word}); there is no valid input."
