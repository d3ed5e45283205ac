"""Who judges whose lesson: a sensor its own, or sensors that stayed those that did not."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from seacage.twin._align import Pairs
from seacage.twin._calibration import (
    DAY,
    Judged,
    apart,
    blocks_in,
    carried_spread,
    evenly,
    own_spread,
    span_s,
    stretches,
    white_noise,
    without_in_turn,
)
from seacage.twin._correction import Correction
from seacage.twin._models import Models
from seacage.twin._provenance import Lesson

SHORT = 2.0 * DAY
"""A lesson shorter than this says little of other days [s]."""

LEAST_PAIRS = 20
"""Readings of a sensor that stayed, in a short lesson's hours."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Taught:
    """What one sensor has to teach.

    Parameters
    ----------
    lesson
        Its window.
    pairs, chosen
        All its readings, and those that teach.
    calibrates
        Whether the others are to calibrate.
    """

    lesson: Lesson
    pairs: Pairs
    chosen: Pairs
    calibrates: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Lessons:
    """All that the sensors of a cage have to teach, and how they do.

    Parameters
    ----------
    models
        Level 1.
    taught
        By sensor.
    restarts, seed
        Of the searches.
    choose
        Which readings teach.
    judged
        What lessons on other sensors' hours were found to miss, by sensor and hours; filled as
        it is asked for.
    """

    models: Models
    taught: Mapping[str, Taught]
    restarts: int
    seed: int
    choose: Callable[[Pairs], Pairs]
    judged: dict[tuple[str, int, int], Judged] = field(
        default_factory=dict[tuple[str, int, int], Judged]
    )

    def learned(self, sensor: str, chosen: Pairs) -> Correction:
        """Level 2 of a sensor from some of its readings, not calibrated."""
        x = chosen.metocean.features(self.models.inputs)
        lower = self.models.lower(sensor)
        return Correction.learned(chosen, x, lower, restarts=self.restarts, seed=self.seed)

    def stayed(self, short: Pairs) -> list[str]:
        """Sensors with a day at least beside a short lesson, that taught in its hours too."""
        return [
            name
            for name, one in self.taught.items()
            if one.calibrates
            and span_s(one.pairs) >= SHORT
            and len(_within(one.pairs, short)) >= LEAST_PAIRS
            and _days_apart(one.pairs, short) >= 1.0
        ]


def calibrated(model: Correction, lessons: Lessons, sensor: str) -> Correction:
    """Calibrate what a sensor taught.

    Parameters
    ----------
    model
        What it taught, not calibrated.
    lessons
        Of all sensors.
    sensor
        Its name.
    """
    pairs = lessons.taught[sensor].pairs
    model = _less_noise(model, lessons, pairs)
    stayed = lessons.stayed(pairs) if span_s(pairs) < SHORT else []
    if stayed:
        others = [_judged_short(lessons, name, pairs) for name in stayed]
        days = sum(_days_apart(lessons.taught[name].pairs, pairs) for name in stayed)
        return replace(model, spread=carried_spread(model, others, days))
    blocks = blocks_in(pairs)
    if blocks < 2:
        return model
    judging = evenly(pairs)
    x = judging.metocean.features(lessons.models.inputs)
    mean, doubt = without_in_turn(model, lessons.taught[sensor].chosen, judging, x)
    column = lessons.models.cage.sensor_names.index(sensor)
    kept = Judged(
        error=judging.value - mean,
        doubt=doubt,
        steepness=model.gain * lessons.models.steepness(judging.metocean)[:, column],
        white=model.spread.white,
    )
    return replace(model, spread=own_spread(model, kept, blocks))


def _less_noise(model: Correction, lessons: Lessons, pairs: Pairs) -> Correction:
    """Tell a model what of the scatter is the instrument's."""
    rows = pairs.rows(stretches(len(pairs)))
    x = rows.metocean.features(lessons.models.inputs)
    error = rows.value - model.behind(x, model.rest.lower.predict(x)).mean
    return replace(model, spread=replace(model.spread, white=white_noise(error, rows.time)))


def _judged_short(lessons: Lessons, sensor: str, short: Pairs) -> Judged:
    """What a sensor that stayed would have missed, had it gone with the short lesson."""
    first, last = (
        round(one.astype("datetime64[s]").astype(int) / 3600) for one in short.time[[0, -1]]
    )
    key = sensor, first, last
    if key not in lessons.judged:
        pairs = lessons.taught[sensor].pairs
        model = lessons.learned(sensor, lessons.choose(_within(pairs, short)))
        model = _less_noise(model, lessons, _within(pairs, short))
        judging = evenly(apart(pairs, short))
        x = judging.metocean.features(lessons.models.inputs)
        low = model.rest.lower.predict(x)
        behind = model.behind(x, low)
        lessons.judged[key] = Judged(
            error=judging.value - behind.mean,
            doubt=behind.std**2,
            steepness=0.0 * behind.std,
            white=model.spread.white,
        )
    return lessons.judged[key]


def _within(pairs: Pairs, short: Pairs) -> Pairs:
    return pairs.rows((pairs.time >= short.time[0]) & (pairs.time <= short.time[-1]))


def _days_apart(pairs: Pairs, short: Pairs) -> float:
    """Days on which a sensor judges a short lesson."""
    left = apart(pairs, short)
    return 0.0 if len(left) == 0 else (span_s(pairs) - span_s(short)) / DAY - 1.0
