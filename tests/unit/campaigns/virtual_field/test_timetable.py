"""How the time of a virtual field is cut."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.campaigns import Timetable, generated_current
from seacage.campaigns._virtual_field._timetable import Stretch, cut, reading_times, side_by_side
from seacage.conventions import InputError
from seacage.dynamics import Damage

NEVER = np.zeros(100, bool)
CUT, HOLE = Damage(bridle=7), Damage(hole=(3, 4, 2))


def rows(stretches: tuple[Stretch, ...]) -> list[tuple[int, int]]:
    return [(one.first, one.readings) for one in stretches]


def test_a_record_is_cut_into_equal_stretches_and_a_shorter_last_one() -> None:
    assert rows(cut(100, 30, always=NEVER)) == [(0, 30), (30, 30), (60, 30), (90, 10)]


def test_one_stretch_in_some_leaves_first_last_and_those_always_wanted() -> None:
    always = NEVER.copy()
    always[55] = True
    assert rows(cut(100, 10, one_in=4, always=NEVER)) == [(0, 10), (40, 10), (80, 10), (90, 10)]
    assert (50, 10) in rows(cut(100, 10, one_in=4, always=always))


def test_what_breaks_begins_a_stretch_and_stays_broken() -> None:
    stretches = cut(100, 30, always=NEVER, breaks=[(70, HOLE), (40, CUT)])
    assert rows(stretches) == [(0, 30), (30, 10), (40, 30), (70, 30)]
    assert [one.breaking for one in stretches] == [(), (), (CUT,), (HOLE,)]
    assert [one.damaged for one in stretches] == [(), (), (), (CUT,)]


def test_the_stretch_after_a_break_has_the_damage_from_its_beginning() -> None:
    *_, last = cut(100, 30, always=NEVER, breaks=[(40, CUT), (40, HOLE)])
    assert last == Stretch(first=70, readings=30, damaged=(CUT, HOLE))


def test_what_breaks_is_simulated_however_few_stretches_are() -> None:
    stretches = cut(100, 10, one_in=100, always=NEVER, breaks=[(55, CUT)])
    assert rows(stretches) == [(0, 10), (55, 10), (95, 5)]


@pytest.mark.parametrize(
    ("hours", "minutes", "stretches"),
    # whole vectors of 16, as nearly as ten minutes allow
    [(1.0, 10, 6), (10.0, 20, 30), (36.0, 70, 31), (48.0, 90, 32), (1152.0, 60, 1152)],
)
def test_stretches_fill_the_lanes(hours: float, minutes: float, stretches: int) -> None:
    start = datetime(2020, 1, 18, tzinfo=UTC)
    # its last word comes a step before the end
    buoy = generated_current(0, start=start, days=hours / 24.0, every_s=360.0)
    timetable = Timetable.over(buoy)
    assert timetable.stretch == 60.0 * minutes
    each, _ = timetable.readings(2.0)
    readings = len(reading_times(buoy, 2.0))
    assert len(cut(readings, each, always=np.zeros(readings, bool))) == stretches


def test_a_net_of_longer_bars_takes_longer_steps() -> None:
    buoy = generated_current(0, start=datetime(2020, 1, 18, tzinfo=UTC), days=0.1, every_s=360.0)
    steps = [Timetable.over(buoy, refined=times).time_step for times in (1, 2)]
    assert steps == [0.002, 0.001] == [0.002, Timetable.over(buoy).time_step]


def test_every_reading_belongs_to_one_stretch() -> None:
    stretches = cut(100, 7, always=NEVER, breaks=[(0, CUT), (41, HOLE), (99, CUT)])
    covered = np.concatenate([np.arange(100)[one.rows] for one in stretches])
    np.testing.assert_array_equal(covered, np.arange(100))


def test_stretches_beside_each_other_are_equally_broken_and_one_that_breaks_is_alone() -> None:
    stretches = cut(100, 10, always=NEVER, breaks=[(50, CUT)])
    groups = side_by_side(stretches, 3)
    assert [len(group) for group in groups] == [3, 2, 1, 3, 1]
    assert groups[2][0].breaking == (CUT,)
    assert {(one.damaged, one.breaking) for group in groups[3:] for one in group} == {((CUT,), ())}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"one_in": 0}, "one stretch in 0"),
        ({"stretch": 3500.0}, "stretch = 3500 s is no whole number of 600 s"),
        ({"mean": 0.0}, "stretch = 3600 s is no whole number of 0 s"),
        ({"stretch": float("inf")}, "stretch = inf s"),
    ],
)
def test_a_timetable_that_cannot_be_is_refused(change: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Timetable(**change)


def test_a_mean_is_a_whole_number_of_readings() -> None:
    assert Timetable().readings(2.0) == (1800, 300)
    with pytest.raises(InputError, match="mean = 600 s is no whole number of 7 s"):
        Timetable().readings(7.0)


@pytest.mark.parametrize(("minutes", "every_s"), [(0, 60.0), (5, 60.0), (60, 0.0), (60, 3600.0)])
def test_a_record_too_short_for_two_readings_is_refused(minutes: int, every_s: float) -> None:
    start = datetime(2020, 1, 18, tzinfo=UTC)
    buoy = generated_current(0, start=start, days=1.0)
    short = buoy.between(start, start + timedelta(minutes=minutes))
    with pytest.raises(InputError, match="holds no two readings"):
        reading_times(short, every_s)
