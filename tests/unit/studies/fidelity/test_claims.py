"""Claims whose verdicts follow from the numbers."""

from dataclasses import replace

import numpy as np

from seacage.studies._fidelity._claims import claims
from seacage.studies._fidelity._fouling import FoulingGap
from seacage.studies._fidelity._gap import SensorGap
from seacage.studies._fidelity._null_case import Gain, Gains, NullCase
from seacage.studies._fidelity._rescaling import Rescaling
from seacage.studies._interval import Interval

BELOW = Interval(mean=-0.5, low=-0.6, high=-0.4)
AROUND = Interval(mean=-0.1, low=-0.2, high=0.1)
ABOVE = Interval(mean=0.5, low=0.4, high=0.6)

GAPS = tuple(
    SensorGap(
        sensor=sensor,
        unit=unit,
        windows=100,
        truth=2.0,
        low=1.5,
        bias=BELOW,
        mae=0.6,
        sectors=(),
    )
    for sensor, unit in (
        ("depth-1", "m"),
        ("depth-2", "m"),
        ("depth-3", "m"),
        ("shackle-1", "kN"),
        ("shackle-2", "kN"),
    )
)
RESCALING = Rescaling(
    sensor="depth-1",
    unit="m",
    factor=1.2,
    turn=-10.0,
    gain=1.1,
    offset=0.2,
    teaching=50,
    judging=50,
    low_mae=1.0,
    left_mae=0.4,
    above_least=ABOVE,
    emulation_mae=0.01,
)
GAIN = Gain(
    sensor="depth-1",
    unit="m",
    mean_s=600.0,
    teaching=50,
    judging=50,
    low_mae=1.0,
    multi_mae=1.1,
    gain=AROUND,
)
NULL = NullCase(
    null=Gains(sensors=(GAIN,), together=AROUND),
    real=Gains(sensors=(replace(GAIN, gain=ABOVE),), together=ABOVE),
    unjudged=(),
)
FOULING = FoulingGap(
    sensors=("depth-1",),
    units=("m",),
    current_to=0.0,
    growth=np.array([0.0, 1.0]),
    speed=np.array([0.5]),
    gap=np.array([[[1.0]], [[2.0]]]),
    distance=np.array([[1.0], [2.0]]),
    distance_without_drift=np.array([[0.5], [0.6]]),
    met=(),
)


def claims_of(*, gaps=GAPS, rescalings=(RESCALING,), null=NULL, fouling=FOULING):
    return claims(gaps, rescalings, null, fouling)


def with_null(gain: Interval, together: Interval = AROUND) -> NullCase:
    sensors = (replace(GAIN, gain=gain),)
    return replace(NULL, null=Gains(sensors=sensors, together=together))


def test_all_claims_hold_where_all_numbers_say_so():
    assert [claim.verdict for claim in claims_of()] == ["holds"] * 6


def test_one_depth_sensor_that_is_overestimated_misses_the_first_claim():
    over = (*GAPS[:2], replace(GAPS[2], low=2.5, bias=ABOVE), *GAPS[3:])
    assert claims_of(gaps=over)[0].verdict == "missed"


def test_one_shackle_may_be_overestimated_where_the_mean_of_all_is_not():
    over = replace(GAPS[4], low=2.3, bias=ABOVE)
    depths, loads = claims_of(gaps=(*GAPS[:4], over))[:2]
    assert (depths.verdict, loads.verdict) == ("holds", "holds")
    assert "2.00 kN in truth and 1.90 kN" in loads.finding
    assert "overestimates shackle-2 on average" in loads.finding
    assert claims_of(gaps=(*GAPS[:4], replace(over, low=2.6)))[1].verdict == "missed"
    assert claims_of(gaps=GAPS[:3])[1].finding == "No shackle was there."


def test_a_rescaling_that_leaves_too_little_is_named():
    claim = claims_of(
        rescalings=(RESCALING, replace(RESCALING, sensor="shackle-4", left_mae=0.09))
    )[2]
    assert claim.verdict == "missed"
    assert "at shackle-4." in claim.finding


def test_a_gain_where_there_is_nothing_to_gain_misses_both_claims_of_the_null_case():
    gained, covered = claims_of(null=with_null(ABOVE))[3:5]
    assert (gained.verdict, covered.verdict) == ("missed", "missed")
    assert "It gains at depth-1" in gained.finding


def test_a_loss_there_is_reported_as_the_price_of_learning_from_noise():
    gained, covered = claims_of(null=with_null(BELOW))[3:5]
    assert (gained.verdict, covered.verdict) == ("holds", "missed")
    assert "Below zero: depth-1." in covered.finding
    assert "most at depth-1, 500 mm, where the field's gain is 500 mm" in covered.finding


def test_all_sensors_together_may_miss_zero_where_none_does_alone():
    gained, covered = claims_of(null=with_null(AROUND, together=BELOW))[3:5]
    assert (gained.verdict, covered.verdict) == ("holds", "missed")
    assert "All together lie below zero" in covered.finding


def test_sensors_that_could_not_be_scored_are_named():
    claim = claims_of(null=replace(NULL, unjudged=("shackle-1", "shackle-2")))[3]
    assert "shackle-1 and shackle-2 had too few readings" in claim.finding


def test_a_gap_that_narrows_at_one_current_misses_the_last_claim():
    narrowing = replace(
        FOULING,
        speed=np.array([0.3, 0.5]),
        gap=np.array([[[1.0], [1.0]], [[0.9], [2.0]]]),
        distance=np.ones((2, 2)),
        distance_without_drift=np.ones((2, 2)),
    )
    assert claims_of(fouling=narrowing)[5].verdict == "missed"
