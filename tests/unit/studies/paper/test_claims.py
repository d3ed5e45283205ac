"""The paper's statements against made-up numbers."""

from dataclasses import replace

import pytest

from example_scores import scored, sensor, shapes, way
from seacage.studies._paper._claims import paper_claims
from seacage.studies._paper._trainings import IN_A_ROW

DEPTH = sensor("depth-1", unit="m", low_bias=0.5)
LOAD = sensor("shackle-1")


def verdict(of: str, some=None, study=None) -> str:
    """Of the one claim that has these words."""
    found = [
        claim
        for claim in paper_claims(some or scored(DEPTH, LOAD), study or shapes())
        if of in claim.claim
    ]
    assert len(found) == 1, of
    return found[0].verdict


@pytest.mark.parametrize(
    ("gains", "expected"),
    [((2.0, 2.0), "reproduced"), ((2.0, -1.0), "partly"), ((-1.0, -1.0), "not reproduced")],
)
def test_a_gain_is_reproduced_where_it_is_proven_at_all_sensors(gains, expected):
    loads = [sensor(f"shackle-{i}", gain_low=low) for i, low in enumerate(gains, 1)]
    assert verdict("mooring loads", scored(DEPTH, *loads)) == expected


def test_a_fit_that_turns_past_the_diagonal_as_far_is_no_closer():
    assert verdict("closer to the diagonal") == "reproduced"
    assert verdict("closer to the diagonal", scored(sensor("shackle-1", slope=1.6))) == (
        "not reproduced"
    )


def test_underestimated_is_too_deep():
    assert verdict("underestimate") == "reproduced"
    high = sensor("depth-1", unit="m", low_bias=-0.5)
    assert verdict("underestimate", scored(high, LOAD)) == "not reproduced"
    assert verdict("underestimate", scored(LOAD)) == "not evaluated"


def test_readings_that_scatter_no_more_than_their_means_do_not_oscillate():
    assert verdict("oscillate") == "not reproduced"
    swaying = replace(LOAD, raw=replace(LOAD.raw, multi_mae=2.0))
    assert verdict("oscillate", scored(DEPTH, swaying)) == "reproduced"


def test_minutes_in_a_row_are_scored_where_they_were_tried():
    assert verdict("few minutes") == "not evaluated"
    poor = way(sensor("depth-1", unit="m", gain_low=-2.0, gain_high=-1.0), LOAD, name=IN_A_ROW)
    assert verdict("few minutes", scored(DEPTH, LOAD, more=(poor,))) == "partly"


def test_a_sensor_that_a_few_minutes_never_trained_is_no_success():
    untaught = replace(
        way(sensor("depth-1", unit="m", gain_low=0.0), LOAD, name=IN_A_ROW), trained=()
    )
    assert verdict("few minutes", scored(DEPTH, LOAD, more=(untaught,))) == "not reproduced"


@pytest.mark.parametrize(("variance", "expected"), [(0.99, "partly"), (0.90, "not reproduced")])
def test_three_modes_that_leave_a_node_metres_wrong_are_not_enough(variance, expected):
    assert verdict("Three principal", study=shapes(variance=variance)) == expected


def test_a_mean_within_a_metre_is_not_yet_a_net_within_a_metre():
    assert verdict("below 1 m") == "partly"
    assert verdict("below 1 m", study=shapes(pca=3.0, network=3.0)) == "not reproduced"


def test_errors_that_do_not_grow_with_the_speed_are_not_reported_to():
    assert verdict("faster") == "reproduced"
    study = shapes()
    assert verdict("faster", study=replace(study, current_speed=study.current_speed[::-1])) == (
        "not reproduced"
    )


def test_the_network_has_to_win_to_be_reported_to_win():
    assert verdict("graph network predicts") == "not reproduced"
    assert verdict("graph network predicts", study=shapes(network=0.2)) == "reproduced"
    assert verdict("graph network predicts", study=shapes(network=None)) == "not evaluated"


def test_a_spread_is_compared_along_x_and_z():
    assert verdict("vary more") == "not reproduced"
    assert verdict("vary more", study=shapes(network=0.2)) == "reproduced"


def test_every_claim_has_its_numbers():
    for claim in paper_claims(scored(DEPTH, LOAD), shapes()):
        assert claim.finding
        assert "nan" not in claim.finding
