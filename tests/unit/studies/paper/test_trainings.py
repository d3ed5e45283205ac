"""Ways of teaching a twin."""

from seacage.studies._chain import Recipe
from seacage.studies._paper._trainings import HEARING, IN_A_ROW, SPREAD, ways_of

IN_TIME = Recipe(method="simulate")


def test_a_settled_study_has_one_way():
    (way,) = ways_of(Recipe(), waves=False)
    assert way.name == SPREAD
    assert way.training == Recipe().training


def test_in_time_the_papers_minutes_and_the_waves_stand_beside_it():
    spread, row, hearing = ways_of(IN_TIME, waves=True)
    assert (spread.name, row.name, hearing.name) == (SPREAD, IN_A_ROW, HEARING)
    assert row.training.choice == "paper"
    assert row.training.inputs == spread.training.inputs == ("current",)
    assert hearing.training.inputs == ("current", "waves")
    assert hearing.training.choice == spread.training.choice == "spread"


def test_without_waves_nobody_can_hear_them():
    assert [way.name for way in ways_of(IN_TIME, waves=False)] == [SPREAD, IN_A_ROW]


def test_a_silence_does_not_end_a_training_window_that_the_days_end():
    training = IN_TIME.training
    assert training.pause_s == 86400.0 * IN_TIME.teaching_days
    assert training.days == IN_TIME.teaching_days
