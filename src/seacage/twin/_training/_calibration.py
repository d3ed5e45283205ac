"""Who judges whose lesson: a sensor its own, or sensors that stayed those that did not."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from seacage.surrogates import conformal_factor, variance_components
from seacage.twin._correction import LEAST_SHARE, Correction, Spread
from seacage.twin._models import Models
from seacage.twin._pairs import Pairs
from seacage.twin._provenance import Lesson
from seacage.twin._training._held_out import (
    DAY,
    Judged,
    apart,
    blocks_in,
    evenly,
    span_s,
    stretches,
    white_noise,
    without_in_turn,
)

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


def own_spread(model: Correction, kept: Judged, blocks: int) -> Spread:
    """Calibrate by a sensor's own readings, each judged by a lesson without its days.

    Two variances are fitted to the squared errors, each as large as it has to be: the lesson's
    own, scaled, and that of the current which the buoy does not tell. Both are then scaled so
    that the intervals hold their share, and a little more where the blocks are few.

    Parameters
    ----------
    model
        Of all the lesson.
    kept
        Readings beside lessons without them.
    blocks
        Independent readings that they are worth.
    """
    terms = np.column_stack([kept.doubt, kept.steepness**2])
    # Some are below 0, as the noise is known on average alone.
    square = kept.error**2 - kept.white
    scale2, water2 = variance_components(terms, square).tolist()
    # A twin that is as good as its sensors can be is still not perfect.
    least = LEAST_SHARE * float(np.mean(kept.error**2)) / float(np.mean(kept.doubt))
    scale2 = max(scale2, least) if water2 == 0.0 else scale2
    fitted = replace(model.spread, scale=math.sqrt(scale2), water_sd=math.sqrt(water2), by="own")
    factor = conformal_factor(kept.score(fitted), independent=max(blocks, 2))
    return replace(fitted, scale=fitted.scale * factor, water_sd=fitted.water_sd * factor)


def carried_spread(model: Correction, others: Sequence[Judged], days: float) -> Spread:
    """Calibrate a short lesson by how much such lessons failed sensors that stayed longer.

    Each sensor that stayed was taught on the short lesson's own hours, and judged on its other
    days. How much too sure of itself it was there is taken to be alike for all sensors of a
    cage, for it is what those hours lacked: other currents, and a net that grows.

    Parameters
    ----------
    model
        Of the short lesson.
    others
        Readings of each sensor that stayed, beside its short lesson.
    days
        On which they judged, all sensors together.
    """
    plain = Spread()
    independent = max(days, 2.0)
    factors = [conformal_factor(one.score(plain), independent=independent) for one in others]
    return replace(model.spread, scale=float(np.mean(factors)), by="carried")


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
