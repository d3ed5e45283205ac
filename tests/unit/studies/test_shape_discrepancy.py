from dataclasses import replace

import numpy as np
import pytest

from predicted_nets import CAGE, currents, drifting, erring_twin, water
from seacage.campaigns import TrueShapes
from seacage.studies import Reliability, learned_discrepancy, score_paths, score_points
from seacage.testing import stand_in_twin
from stand_in import StandIn


def truth(count: int, seed: int) -> TrueShapes:
    random = np.random.default_rng(seed)
    velocity = currents(count, random)
    predicted = stand_in_twin().predict(water(velocity)).node_position
    return TrueShapes(current_velocity=velocity, node_position=drifting(predicted, random))


def test_a_table_holds_every_event_once():
    p = np.array([0.0, 0.05, 0.5, 0.52, 1.0])
    happened = np.array([False, True, True, True, True])
    scores = Reliability(p=p, observed=happened, speed=np.zeros(5))
    assert scores.table(bins=2) == [
        (2, pytest.approx(0.025), 0.5),
        (3, pytest.approx(2.02 / 3.0), 1.0),
    ]


def test_a_twin_that_knows_its_error_foretells_better_than_one_that_does_not():
    shapes = truth(30, seed=7)

    def brier(twin):
        scores = score_points(twin, shapes, points=40)
        return np.mean((scores.p - scores.observed) ** 2)

    assert brier(erring_twin()) < 0.9 * brier(stand_in_twin())


def test_paths_are_scored_as_points_are():
    scores = score_paths(erring_twin(), truth(20, seed=8), paths=3)
    assert len(scores.p) == len(scores.observed) == len(scores.speed) == 60
    assert abs(scores.p.mean() - scores.observed.mean()) < 0.1
    assert scores.p[scores.observed].mean() > scores.p[~scores.observed].mean() + 0.3


def test_the_error_is_learned_from_the_virtual_field_against_the_twins_own_answers(monkeypatch):
    monkeypatch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
    messages = []
    learned = learned_discrepancy(
        stand_in_twin(),
        seeds=(3,),
        cases=30,
        workers=1,
        progress=lambda *report: messages.append(report),
    )
    assert learned.origin == "virtual field"
    assert learned.ring.shape == (30, CAGE.rings + 1, 3)
    assert messages[-1] == ("shape error", 30, 30)
    # The stand-in's nets lean otherwise than the formula's, downstream most at the tip.
    fast = np.hypot(*learned.current_velocity.T) > 0.5
    assert np.abs(learned.ring[fast, -1]).max() > 1.0
    assert replace(stand_in_twin(), discrepancy=learned).discrepancy is learned
