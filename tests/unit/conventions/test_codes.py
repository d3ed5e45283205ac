"""Codes keep their numbers, for files and wires outlive versions."""

from itertools import product

import numpy as np

from seacage.conventions import (
    RESULTS,
    Flag,
    InputError,
    ModelError,
    Origin,
    RecordError,
    Result,
    SeacageError,
    gravest,
    has_answer,
)


def test_quality_flags_are_those_of_qartod():
    expected = {"GOOD": 1, "NOT_EVALUATED": 2, "SUSPECT": 3, "FAIL": 4, "MISSING": 9}
    assert {flag.name: flag.value for flag in Flag} == expected


def test_the_worse_flag_is_the_larger():
    assert Flag.GOOD < Flag.SUSPECT < Flag.FAIL < Flag.MISSING


def test_results_keep_their_numbers_and_each_has_a_message():
    expected = {"CONVERGED": 0, "NOT_CONVERGED": 1, "DIVERGED": 2, "DROWNED": 3}
    expected |= {"OUTSIDE_VALIDITY": 4, "SLACK": 5}
    assert {result.name: result.value for result in Result} == expected
    assert set(RESULTS) == set(Result)


def test_the_gravest_finding_names_a_case_however_they_are_put():
    order = (
        Result.DIVERGED,
        Result.DROWNED,
        Result.NOT_CONVERGED,
        Result.SLACK,
        Result.OUTSIDE_VALIDITY,
        Result.CONVERGED,
    )
    for (grave, worse), (light, other) in product(enumerate(order), repeat=2):
        found = gravest(np.array([worse, other]), {other: np.array([True, False])})
        assert found.tolist() == [order[min(grave, light)], other]


def test_what_was_computed_soundly_afloat_is_an_answer():
    every = np.array(list(Result))
    good = {Result.CONVERGED, Result.OUTSIDE_VALIDITY, Result.SLACK}
    assert set(every[has_answer(every)]) == good
    assert has_answer(np.array(-1)) == np.False_  # a case that has not been run


def test_an_origin_reads_as_people_write_it():
    assert [str(origin) for origin in Origin] == ["measured", "computed", "virtual field"]


def test_every_error_can_be_caught_as_one():
    for error in (InputError, RecordError, ModelError):
        assert issubclass(error, SeacageError)


def test_refused_input_is_also_a_value_error():
    assert issubclass(RecordError, InputError)
    assert issubclass(InputError, ValueError)
