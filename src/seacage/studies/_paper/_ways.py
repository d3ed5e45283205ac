"""Ways of teaching a twin, judged on the same readings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np
from jaxtyping import Shaped

from seacage.studies._chain import Chain, Recipe
from seacage.studies._sensor_scores import Readings, SensorScore, compared, score_sensor
from seacage.studies._split import split
from seacage.twin import Training, Twin

SPREAD, IN_A_ROW, HEARING = (
    "Current, spread",
    "Current, minutes in a row",
    "Current and waves, spread",
)
"""Names of the ways: the page's own, the paper's minutes read as a row, and one that hears more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """One way of teaching a twin.

    Parameters
    ----------
    name
        In tables and figures.
    training
        What it is.
    """

    name: str
    training: Training


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WayScore:
    """How a way of teaching did on days that did not teach.

    Parameters
    ----------
    name
        Of the way.
    taught
        Sensors whose lesson was believed; the others answer at level 1.
    sensors
        The score of each sensor.
    """

    name: str
    taught: tuple[str, ...]
    sensors: tuple[SensorScore, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Judged:
    """All ways, and the readings behind the first.

    Parameters
    ----------
    twin
        Of the first way, which the page shows.
    readings
        By sensor, of the first way.
    ways
        Their scores, on the same readings each.
    """

    twin: Twin
    readings: Mapping[str, Readings]
    ways: tuple[WayScore, ...]

    @property
    def sensors(self) -> tuple[SensorScore, ...]:
        """Scores of the first way."""
        return self.ways[0].sensors


def ways_of(recipe: Recipe, *, waves: bool) -> tuple[Way, ...]:
    """What a study compares: the page's own way first.

    Settled studies have one way; in time the paper's few minutes in a row stand beside it, and
    with waves at the buoy and in the campaign the twin that hears them.
    """
    spread = recipe.training
    ways = [Way(name=SPREAD, training=spread)]
    if recipe.in_time:
        ways.append(Way(name=IN_A_ROW, training=replace(spread, choice="paper")))
    if waves:
        hearing = replace(spread, inputs=("current", "waves"))
        ways.append(Way(name=HEARING, training=hearing))
    return tuple(ways)


def has_waves(chain: Chain) -> bool:
    """Whether a twin of this chain can hear waves: the buoy has them and the campaign, too."""
    return "hs_m" in chain.field.buoy.values and chain.in_waves


def judge(chain: Chain, ways: Sequence[Way]) -> Judged:
    """Teach in each way, and score all on the same readings of the days that judge."""
    days = chain.recipe.teaching_days
    _, judging = split(chain.field, teaching_days=days)
    _, truth = split(chain.truth, teaching_days=days)
    truth = replace(truth, buoy=judging.buoy)  # what was heard, gaps and all, not what was true
    twins = [Twin.read(chain.trained(way.training)) for way in ways]
    answers = [twin.predict_record(chain.field.buoy) for twin in twins]
    said = [compared(answer, judging) for answer in answers]
    exact = compared(answers[0], truth)
    common = {name: reduce(np.intersect1d, (one[name].time for one in said)) for name in said[0]}
    total, scores = len(ways) * len(common), []
    for number, (way, twin, readings) in enumerate(zip(ways, twins, said, strict=True)):
        sensors: list[SensorScore] = []
        for name, time in common.items():
            chain.report("score", number * len(common) + len(sensors), total)
            sensors.append(
                score_sensor(
                    _at(readings[name], time),
                    seed=chain.recipe.seed,
                    truth=None if number else exact[name],
                )
            )
        scores.append(
            WayScore(name=way.name, taught=tuple(twin.provenance.lessons), sensors=tuple(sensors))
        )
    chain.report("score", total, total)
    first = {name: _at(said[0][name], time) for name, time in common.items()}
    return Judged(twin=twins[0], readings=first, ways=tuple(scores))


def _at(readings: Readings, time: Shaped[np.ndarray, " t"]) -> Readings:
    return readings.at(np.isin(readings.time, time))
