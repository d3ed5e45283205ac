"""Factors on the intervals of the sensors, adapted online to the coverage of their readings.

Ten minutes of readings count at once, when ten minutes more have passed: by then late samples have
come. So the intervals of a time depend on the samples alone, and not on the order in which they
came or on when the service was stopped.
"""

import json
import math
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from statistics import median

from seacage.conventions import Flag, InputError
from seacage.records import Sample
from seacage.surrogates import AdaptiveConformal
from seacage.twin._answer import INTERVAL_SD
from seacage.twin._pairs import reading_of

ADAPTATION_BLOCK = timedelta(minutes=10)
"""Length of a block of readings that the intervals are adapted to at once."""
BLOCK_US = ADAPTATION_BLOCK // timedelta(microseconds=1)
# Of a line without a living shackle, the power of the depths' factor that its own is: a load
# changes less with the net than a depth does (decision 95)
LOAD_POWER = 1 / 3
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)

# Mean and standard deviation of a sensor's reading, as trained [N] or [m]
MeanStd = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracked:
    """Prediction of a sensor's reading, and the factor on its interval."""

    factor: float = 1.0  # of the standard deviation, from the readings so far [-]
    expected: MeanStd | None = None  # by the last answer; None where it was not valid
    counted: datetime | None = None  # time of the last reading that counted


def adapted_at(t: datetime) -> datetime:
    """Time at which a reading of some time takes effect on the intervals."""
    return block_begin(t) + 2 * ADAPTATION_BLOCK


def adapted_at_us(t: int) -> int:
    """``adapted_at`` in microseconds since 1970 UTC."""
    return t - t % BLOCK_US + 2 * BLOCK_US


def block_begin(t: datetime) -> datetime:
    """Begin of the block that a time belongs to."""
    return t - (t - _EPOCH) % ADAPTATION_BLOCK


def counts(tracked: Tracked, sample: Sample, *, every_s: float) -> bool:
    """Whether a sensor's interval adapts to one of its readings.

    Sound readings alone count, and one in so many seconds: those between are the same error
    again.
    """
    due = tracked.counted is None or sample.t >= tracked.counted + timedelta(seconds=every_s)
    return due and reading_of(sample)[1] == Flag.GOOD


def adapt_factor(tracked: Tracked, sample: Sample, expected: MeanStd, *, rate: float) -> Tracked:
    """Return a sensor's state after a reading that counts.

    ``tracked``: of the sensor.
    ``sample``: of the sensor, in the unit of its key.
    ``expected``: in the water at its time.
    ``rate``: step of the factor's logarithm; 0 changes nothing [-].
    """
    (mean, std), (reading, _) = expected, reading_of(sample)
    held = abs(reading - mean) <= INTERVAL_SD * tracked.factor * std
    factor = AdaptiveConformal(rate=rate).stepped(tracked.factor, held=held)
    return replace(tracked, factor=factor, counted=sample.t)


def factor_of_depths(
    tracked: Mapping[str, Tracked], depths: Iterable[str], silent: Container[str]
) -> float:
    """Factor on the interval of a depth that no reading adapts: the median of living sensors'.

    A net that has grown since the training takes all depths away from what was learned. Where no
    sensor lives their last factors stand. Never below 1, as another sensor's luck is none of its.

    ``depths``: names of the depth sensors. ``silent``: of the silent sensors.
    """
    known = {name: tracked[name] for name in depths if name in tracked and tracked[name].counted}
    living = [one for name, one in known.items() if name not in silent] or [*known.values()]
    logs = [math.log(one.factor) for one in living]
    return max(math.exp(median(logs)), 1.0) if logs else 1.0


def with_predictions(
    tracked: Mapping[str, Tracked], expected: Mapping[str, MeanStd | None]
) -> dict[str, Tracked]:
    """Keep an answer's prediction of each sensor."""
    return {
        name: replace(tracked.get(name, Tracked()), expected=one) for name, one in expected.items()
    }


def factors_to_json(tracked: Mapping[str, Tracked]) -> str:
    """Write the factor of each sensor, and the time of the last reading that counted."""
    return json.dumps(
        {
            name: {"factor": one.factor, "judged": one.counted and one.counted.isoformat()}
            for name, one in tracked.items()
        }
    )


def factors_from_json(text: str | None) -> dict[str, Tracked]:
    """Read back what ``factors_to_json`` wrote, if anything; the predictions are made again.

    Raises InputError: the text is something else.
    """
    if text is None:
        return {}
    try:
        return {
            name: Tracked(
                factor=float(one["factor"]),
                counted=None if one["judged"] is None else datetime.fromisoformat(one["judged"]),
            )
            for name, one in json.loads(text).items()
        }
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputError(
            f"factors_from_json: this is not what factors_to_json wrote ({error}). Begin anew."
        ) from error
