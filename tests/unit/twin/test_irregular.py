"""The tests for irregularity, on half-hours made up from a known cause."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Flag
from seacage.records import Sample
from seacage.twin._irregular import Sense
from seacage.twin._irregular_block import Block
from seacage.twin._irregular_bridle import Parting, judged_bridles, parted
from seacage.twin._irregular_drag import Drag
from seacage.twin._irregular_sensor import judged_sensors, wandering
from seacage.twin._irregular_shared import shared_water, standing_alone
from seacage.twin._irregular_told import Suspicion

ACE = Cage.named("ace")
NAMES = ACE.sensor_names
SLOPE = np.array(
    [
        *([-1.5, -8.0], [-2.0, -12.0], [-4.0, -25.0]),
        *([2e4, 6e4], [3e3, 2e4], [1e4, 7e4], [-3e4, 6e4], [-4e3, 2e4]),
    ]
)
OWN = np.array([0.2, 0.3, 1.1, 6e3, 3e3, 6e3, 5e3, 3e3])
TENSION = 1e3 * np.array([1.0, 5.0, 1.0, 1.0, 5.0, 1.0, 40.0, 20.0, 42.0, 41.0, 18.0, 38.0])
NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
NOBODY = frozenset[str]()


def block(error, names=NAMES) -> Block:
    """A half-hour in a current to the north, of these sensors."""
    rows = [NAMES.index(name) for name in names]
    return Block(
        sensors=tuple(names),
        error=np.asarray(error, dtype=float)[rows],
        own=OWN[rows],
        gradient=SLOPE[rows],
        current=np.array([0.1, 0.5]),
        tension=TENSION,
    )


def noise(seed: int, count: int, *, memory: float = 0.55, size: float = 0.6) -> np.ndarray:
    """What is each sensor's own, remembered from block to block as on the virtual field."""
    random = np.random.default_rng(seed)
    own, now = [], np.zeros(len(NAMES))
    for _ in range(count):
        now = memory * now + np.sqrt(1 - memory**2) * random.normal(size=len(NAMES))
        own.append(size * now * OWN)
    return np.array(own)


def eddies(seed: int, count: int, sd: float = 0.04) -> np.ndarray:
    """What all sensors feel of the water."""
    return np.random.default_rng(seed).normal(scale=sd, size=(count, 2)) @ SLOPE.T


def only(name: str, size: float) -> np.ndarray:
    return np.where(np.array(NAMES) == name, size, 0.0)


def judged(errors) -> dict[str, Sense]:
    """Judged block by block; who was raised has no say from then on."""
    senses, raised = {name: Sense() for name in NAMES}, frozenset[str]()
    for error in errors:
        senses = judged_sensors(senses, block(error), distrusted=raised, beside=NOBODY, anew=False)
        raised |= {name for name, sense in senses.items() if wandering(sense) >= 1.0}
    return senses


def test_a_current_that_the_buoy_did_not_tell_makes_no_sensor_stand_alone():
    error = SLOPE @ np.array([0.08, -0.1])
    assert np.abs(standing_alone(block(error), np.ones(8, bool))).max() < 1.0
    water, _ = shared_water(block(error), np.arange(8))
    assert water[1] == pytest.approx(-0.1, abs=0.02)  # along the current, where all sensors feel it


@pytest.mark.parametrize("name", NAMES)
def test_a_sensor_that_is_off_stands_alone_and_the_others_do_not(name):
    error = only(name, 8.0 * OWN[NAMES.index(name)])
    distance = standing_alone(block(error), np.ones(8, bool))
    assert np.argmax(np.abs(distance)) == NAMES.index(name)
    assert np.abs(np.delete(distance, NAMES.index(name))).max() < 1.0


def test_where_nobody_else_is_trusted_nothing_is_said():
    assert np.isnan(standing_alone(block(np.zeros(8)), np.zeros(8, bool))).all()


def test_quiet_weeks_raise_no_sensor():
    count = 21 * 48
    senses = judged(noise(1, count) + eddies(2, count))
    assert max(wandering(sense) for sense in senses.values()) < 1.0


def test_a_drift_raises_its_sensor_alone_and_within_days():
    days = 7
    errors = noise(3, days * 48) + eddies(4, days * 48)
    errors += np.linspace(0.0, 0.1 * days, days * 48)[:, None] * only("depth-1", 1.0)
    raised = {name for name, sense in judged(errors).items() if wandering(sense) >= 1.0}
    assert raised == {"depth-1"}


def test_a_sensor_that_is_usually_off_by_as_much_is_not_raised():
    errors = noise(5, 14 * 48) + eddies(6, 14 * 48) + only("depth-2", 0.8 * OWN[1])
    assert wandering(judged(errors)["depth-2"]) < 1.0


def test_a_sensor_that_was_mended_is_believed_within_two_days():
    errors = noise(7, 192)
    errors[96:] += only("depth-1", 10.0 * OWN[0])
    senses = judged(errors)
    assert wandering(senses["depth-1"]) > 1.0
    for error in noise(8, 96):
        senses = judged_sensors(
            senses, block(error), distrusted=frozenset({"depth-1"}), beside=NOBODY, anew=False
        )
    assert wandering(senses["depth-1"]) < 0.5


def test_the_other_bridles_of_a_corner_hold_it_where_it_was():
    for bridle in range(ACE.bridle_count):
        corner = np.flatnonzero(ACE.bridle_corner == ACE.bridle_corner[bridle])
        after = parted(ACE, bridle, TENSION)
        assert after[bridle] == 0.0
        assert (after >= 0.0).all()
        elsewhere = np.setdiff1d(np.arange(12), corner)
        np.testing.assert_array_equal(after[elsewhere], TENSION[elsewhere])
    middle = parted(ACE, 7, TENSION)  # as settled cages with that bridle cut: half of it each
    assert middle[[6, 8]] - TENSION[[6, 8]] == pytest.approx([10.3e3, 10.3e3], rel=0.01)


def partings(errors, names=NAMES) -> dict[str, Parting]:
    senses, found = {name: Sense() for name in NAMES}, dict[str, Parting]()
    for error in errors:
        found = judged_bridles(found, block(error, names), ACE, senses, NOBODY, NOBODY)
    return found


def cut(bridle: int, share: float = 0.8) -> np.ndarray:
    """What shackles read beyond the twin's word when a bridle has parted."""
    shift = share * (parted(ACE, bridle, TENSION) - TENSION)
    return np.array([0.0] * 3 + [shift[one.bridle] for one in ACE.shackles])


@pytest.mark.parametrize("bridle", [7, 10])
def test_a_parted_bridle_is_told_by_its_own_shackle_and_its_neighbours(bridle):
    found = partings(noise(9, 16) + eddies(10, 16) + cut(bridle))
    assert max(found, key=lambda name: found[name].whole) == ACE.bridle_names[bridle]
    assert found[ACE.bridle_names[bridle]].value >= 1.0


def test_a_shackle_that_reads_nothing_while_its_neighbours_are_as_usual_is_no_parted_bridle():
    dead = only("shackle-2", -TENSION[7])
    found = partings(noise(11, 48) + eddies(12, 48) + dead)
    assert found["bridle-8"].whole > 10.0
    assert found["bridle-8"].value < 1.0
    assert not found["bridle-8"].undecided


def test_no_bridle_parts_in_a_quiet_week():
    count = 7 * 48
    found = partings(noise(13, count) + eddies(14, count))
    assert max(one.value for one in found.values()) < 1.0


def test_one_shackle_at_a_corner_says_nothing_about_its_bridles():
    assert partings([cut(7)], ("depth-1", "depth-2", "depth-3", "shackle-2")) == {}


def test_a_cage_that_loses_drag_is_told_and_one_that_grows_is_not():
    drag = SLOPE @ np.array([0.1, 0.5]) / 2.0
    rows = list(range(8))
    quiet = noise(15, 5 * 48) + eddies(16, 5 * 48)
    torn, grown = Drag(), Drag()
    for error in quiet:
        torn, grown = torn.judged(block(error), rows), grown.judged(block(error), rows)
    for day, error in enumerate(noise(17, 4 * 48) + eddies(18, 4 * 48)):
        torn = torn.judged(block(error - 0.3 * drag), rows)
        grown = grown.judged(block(error + 0.05 * day / 48 * drag), rows)
        if torn.value >= 1.0:
            break
    assert torn.value >= 1.0
    assert grown.value < 0.5


def test_in_the_first_day_no_net_is_torn():
    drag = Drag()
    for _ in range(40):
        drag = drag.judged(block(-5.0 * SLOPE @ np.array([0.1, 0.5])), list(range(8)))
    assert drag.lost == 0.0


def reading(minutes: float, metres: float, flag: Flag = Flag.GOOD) -> Sample:
    return Sample(
        stream="depth-1",
        t=NOON + timedelta(minutes=minutes),
        values={"depth_m": metres},
        flags={"depth_m": flag},
    )


def test_a_sensor_that_repeats_itself_is_stuck_and_one_that_does_not_is_not():
    still = moving = seldom = Sense()
    for minutes in range(0, 40, 2):
        still = still.taken(reading(minutes, 14.0), (14.0, 0.3))
        moving = moving.taken(reading(minutes, 14.0 + 0.01 * (minutes % 3)), (14.0, 0.3))
    for minutes in (0, 20, 40):
        seldom = seldom.taken(reading(minutes, 14.0), (14.0, 0.3))
    assert still.stuck
    assert not moving.stuck
    assert not seldom.stuck


def test_a_reading_that_failed_its_checks_is_heard_and_not_averaged():
    sense = Sense().taken(reading(0, 90.0, Flag.FAIL), (14.0, 0.3))
    assert sense.heard == NOON
    assert sense.count == 0


def test_a_parted_bridle_is_the_only_cause_told_at_its_corner():
    senses = {name: replace(Sense(), above=30.0) for name in ("shackle-1", "shackle-2")}
    certain = Parting(whole=40.0, shared=6.0)
    likely = Parting(whole=30.0, shared=6.0)
    suspicion = Suspicion(senses=senses, partings={"bridle-8": certain, "bridle-9": likely})
    values = {one.alarm: one.value for one in suspicion.numbers(ACE, active=NOBODY)}
    assert {name for name, value in values.items() if value and value >= 1.0} == {"bridle.bridle-8"}


def test_a_shackle_may_be_right_where_a_bare_bridle_may_have_parted():
    senses = {"shackle-5": replace(Sense(), above=30.0)}
    suspicion = Suspicion(senses=senses, partings={"bridle-12": Parting(whole=48.0, shared=0.0)})
    (told,) = (one for one in suspicion.numbers(ACE, active=NOBODY) if "shackle" in one.alarm)
    assert told.value >= 1.0
    assert "bridle-12" in told.detail
