"""Codes keep their numbers, for files and wires outlive versions."""

from seacage.conventions import (
    RESULTS,
    Flag,
    InputError,
    ModelError,
    Origin,
    RecordError,
    Result,
    SeacageError,
)


def test_quality_flags_are_those_of_qartod():
    expected = {"GOOD": 1, "NOT_EVALUATED": 2, "SUSPECT": 3, "FAIL": 4, "MISSING": 9}
    assert {flag.name: flag.value for flag in Flag} == expected


def test_the_worse_flag_is_the_larger():
    assert Flag.GOOD < Flag.SUSPECT < Flag.FAIL < Flag.MISSING


def test_results_keep_their_numbers_and_each_has_a_message():
    expected = {"CONVERGED": 0, "NOT_CONVERGED": 1, "DIVERGED": 2, "DROWNED": 3}
    assert {result.name: result.value for result in Result} == expected
    assert set(RESULTS) == set(Result)


def test_an_origin_reads_as_people_write_it():
    assert [str(origin) for origin in Origin] == ["measured", "computed", "virtual field"]


def test_every_error_can_be_caught_as_one():
    for error in (InputError, RecordError, ModelError):
        assert issubclass(error, SeacageError)


def test_refused_input_is_also_a_value_error():
    assert issubclass(RecordError, InputError)
    assert issubclass(InputError, ValueError)
