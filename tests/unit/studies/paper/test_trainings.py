"""Ways of teaching a twin."""

from seacage.studies._chain import Recipe
from seacage.studies._paper._trainings import HEARING, IN_A_ROW, SPREAD, ways_of

IN_TIME = Recipe(method="simulate")


def test_a_settled_study_has_one_way():
    assert ways_of(Recipe(), waves=False) == {SPREAD: Recipe().training}


def test_in_time_the_papers_minutes_and_the_waves_stand_beside_it():
    ways = ways_of(IN_TIME, waves=True)
    assert list(ways) == [SPREAD, IN_A_ROW, HEARING]
    spread, row, hearing = ways.values()
    assert row.choice == "paper"
    assert row.inputs == spread.inputs == ("current",)
    assert hearing.inputs == ("current", "waves")
    assert hearing.choice == spread.choice == "spread"


def test_without_waves_nobody_can_hear_them():
    assert list(ways_of(IN_TIME, waves=False)) == [SPREAD, IN_A_ROW]


def test_a_silence_does_not_end_a_training_window_that_the_days_end():
    training = IN_TIME.training
    assert training.pause_s == 86400.0 * IN_TIME.teaching_days
    assert training.days == IN_TIME.teaching_days
