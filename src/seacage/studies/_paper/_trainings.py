"""Ways of training a twin, scored on the same readings."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import reduce

import numpy as np
from jaxtyping import Shaped

from seacage.studies._chain import Chain, Recipe
from seacage.studies._sensor_scores import Answers, Readings, SensorScore, compare, score_sensor
from seacage.studies._split import split
from seacage.twin import Training, Twin

# Names of the ways: the page's own, the paper's minutes read as a row, and one with waves
SPREAD, IN_A_ROW, HEARING = (
    "Current, spread",
    "Current, minutes in a row",
    "Current and waves, spread",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WayScore:
    """Score of a way of training on validation days."""

    name: str  # of the way
    # Sensors with a level-2 model; the others answer at level 1
    trained: tuple[str, ...] = field(metadata={"key": "taught"})
    sensors: tuple[SensorScore, ...]  # the score of each sensor


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScoredWays:
    """All ways, and the readings behind the first."""

    twin: Twin  # of the first way, which the page shows
    readings: Mapping[str, Readings]  # by sensor, of the first way
    ways: tuple[WayScore, ...]  # their scores, on the same readings each

    @property
    def sensors(self) -> tuple[SensorScore, ...]:
        """Scores of the first way."""
        return self.ways[0].sensors


def ways_of(recipe: Recipe, *, waves: bool) -> dict[str, Training]:
    """Trainings that a study compares, by their names in tables: the page's own way first.

    Settled studies have one way; in time the paper's few minutes in a row stand beside it, and
    with waves at the buoy and in the campaign the twin that has them as inputs.
    """
    spread = recipe.training
    ways = {SPREAD: spread}
    if recipe.in_time:
        ways[IN_A_ROW] = replace(spread, choice="paper")
    if waves:
        ways[HEARING] = replace(spread, inputs=("current", "waves"))
    return ways


def has_waves(chain: Chain) -> bool:
    """Whether waves can be inputs of a twin of this chain: buoy and campaign have them."""
    return "hs_m" in chain.field.buoy.values and chain.in_waves


def compare_ways(chain: Chain, ways: Mapping[str, Training]) -> ScoredWays:
    """Train in each way, and score all on the same readings of the validation days."""
    days = chain.recipe.teaching_days
    _, judging = split(chain.field, teaching_days=days)
    _, truth = split(chain.truth, teaching_days=days)
    truth = replace(truth, buoy=judging.buoy)  # as reported, gaps and all
    twins = [Twin.read(chain.ensure_twin(training)) for training in ways.values()]
    answers = [Answers.of(twin, chain.field.buoy) for twin in twins]
    compared = [compare(each, judging) for each in answers]
    exact = compare(answers[0], truth)
    common = {
        name: reduce(np.intersect1d, (one[name].time for one in compared)) for name in compared[0]
    }
    total, scores = len(ways) * len(common), []
    for number, (way, twin, readings) in enumerate(zip(ways, twins, compared, strict=True)):
        sensors: list[SensorScore] = []
        for name, time in common.items():
            chain.progress("score", number * len(common) + len(sensors), total)
            sensors.append(
                score_sensor(
                    _at(readings[name], time),
                    seed=chain.recipe.seed,
                    truth=None if number else exact[name],
                )
            )
        scores.append(
            WayScore(
                name=way, trained=tuple(twin.provenance.training_windows), sensors=tuple(sensors)
            )
        )
    chain.progress("score", total, total)
    first = {name: _at(compared[0][name], time) for name, time in common.items()}
    return ScoredWays(twin=twins[0], readings=first, ways=tuple(scores))


def _at(readings: Readings, time: Shaped[np.ndarray, " t"]) -> Readings:
    return readings.rows(np.isin(readings.time, time))
