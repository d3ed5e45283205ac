"""Intervals that adapt to the sensors that are there: their readings judge what was said."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from seacage.conventions import Flag, InputError
from seacage.records import Sample
from seacage.surrogates import AdaptiveConformal

DEVIATIONS = 1.96
"""Half the width of an interval, in standard deviations; it holds 95 %."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracked:
    """What a twin said of a sensor, and how well its intervals have held.

    Parameters
    ----------
    factor
        Of the standard deviation, from the readings so far [-].
    said
        Mean and standard deviation of the last answer, as trained [N] or [m]; None where it was
        not valid.
    judged
        Time of the last reading that counted.
    """

    factor: float = 1.0
    said: tuple[float, float] | None = None
    judged: datetime | None = None


def judged_by(tracked: Tracked, sample: Sample, *, rate: float, every_s: float) -> Tracked:
    """Let a reading judge what was said before it came.

    Sound readings alone count, and one in so many seconds: those between are the same error
    again.

    Parameters
    ----------
    tracked
        Of the sensor.
    sample
        Of the sensor, with its flags, in SI by its key.
    rate
        Step of the factor's logarithm per reading that counts; 0 changes nothing [-].
    every_s
        Between readings that count [s].
    """
    ((key, value),) = sample.values.items()
    soon = tracked.judged and sample.t < tracked.judged + timedelta(seconds=every_s)
    if tracked.said is None or soon or sample.flags.get(key) != Flag.GOOD or not rate > 0.0:
        return tracked
    mean, std = tracked.said
    reading = value * (1000.0 if key == "tension_kn" else 1.0)
    held = abs(reading - mean) <= DEVIATIONS * tracked.factor * std
    factor = AdaptiveConformal(rate=rate).stepped(tracked.factor, held=held)
    return replace(tracked, factor=factor, judged=sample.t)


def answered_with(
    tracked: Mapping[str, Tracked], said: Mapping[str, tuple[float, float] | None]
) -> dict[str, Tracked]:
    """Remember what was said of each sensor, to be judged by its next reading."""
    return {
        name: replace(tracked.get(name, Tracked()), said=numbers) for name, numbers in said.items()
    }


def factors_to_json(tracked: Mapping[str, Tracked]) -> str:
    """Write how far the intervals of each sensor were adapted, and when it was last judged."""
    return json.dumps(
        {
            name: {"factor": one.factor, "judged": one.judged and one.judged.isoformat()}
            for name, one in tracked.items()
        }
    )


def factors_from_json(text: str) -> dict[str, Tracked]:
    """Read back what ``factors_to_json`` wrote; what was last said is said anew.

    Raises
    ------
    InputError
        The text is something else.
    """
    try:
        return {
            name: Tracked(
                factor=float(one["factor"]),
                judged=None if one["judged"] is None else datetime.fromisoformat(one["judged"]),
            )
            for name, one in json.loads(text).items()
        }
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputError(
            f"factors_from_json: this is not what factors_to_json wrote ({error}). Begin anew."
        ) from error
