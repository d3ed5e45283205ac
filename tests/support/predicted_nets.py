"""Predicted nets for the tests of clearance: a formula's twin, with an error that is known."""

from dataclasses import replace
from datetime import UTC, datetime
from functools import cache

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Origin
from seacage.testing import stand_in_twin
from seacage.twin import Answered, Discrepancy, Metocean, PredictedNet, Twin

CAGE = Cage.named("ace").altered(mesh={"spokes": 8})
"""That of the formula's twin."""

NOW = datetime(2020, 1, 18, tzinfo=UTC)


water = Metocean.without_waves


def answered(twin: Twin, east: float, north: float, *, age_s: float = 60.0) -> Answered:
    query = water(np.array([[east, north]]))
    return Answered(t=NOW, answer=twin.predict(query), metocean=query, input_age_s=age_s)


def drifting(shapes: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """True shapes: the predicted ones, carried off as a whole, and crumpled."""
    drift = random.normal(size=(len(shapes), 1, 3)) * [1.5, 0.5, 0.5] + [1.0, 0.0, 0.0]
    return shapes + drift + 0.3 * random.normal(size=shapes.shape)


def currents(count: int, random: np.random.Generator) -> np.ndarray:
    speed, angle = random.uniform(0.0, 0.9, count), random.uniform(0.0, 2.0 * np.pi, count)
    return np.column_stack([speed * np.cos(angle), speed * np.sin(angle)])


@cache
def erring_twin(*, cases: int = 400, seed: int = 0) -> Twin:
    """A twin that has learned how its nets drift."""
    random, twin = np.random.default_rng(seed), stand_in_twin()
    velocity = currents(cases, random)
    answer = twin.predict(water(velocity))
    shapes = answer.node_position
    known = Discrepancy.fit(
        twin.cage,
        velocity,
        predicted=shapes,
        true=drifting(shapes, random),
        origin=Origin.VIRTUAL_FIELD,
        level=answer.shape_level,
    )
    return replace(twin, discrepancy=known)


def level_1_twin() -> Twin:
    """A twin without level 2, which does not know how far its nets are off."""
    twin = stand_in_twin()
    return replace(twin, models=twin.models.level_1)


def unlike_twin() -> Twin:
    """A twin whose depth sensors are lifted much further than those of any cage of the family."""
    twin = stand_in_twin()
    upper = {
        name: replace(one, gain=0.5 * one.gain) if name.startswith("depth") else one
        for name, one in twin.models.upper.items()
    }
    return replace(twin, models=replace(twin.models, upper=upper))


def net_in(twin: Twin, east: float, north: float) -> PredictedNet:
    return PredictedNet.of(twin, answered(twin, east, north))
