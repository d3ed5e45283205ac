"""When a row of the validation table holds."""

import math

import pytest

from validation import Kind, Row


def row(reference, ours, tolerance=0.1, **more):
    return Row(
        what="a number",
        unit="m",
        reference=reference,
        ours=ours,
        kind=Kind.MEASURED,
        source="nowhere",
        tolerance=tolerance,
        reason="an example",
        **more,
    )


@pytest.mark.parametrize(
    ("reference", "ours", "holds"),
    [
        (1.0, 1.05, True),
        (1.0, 0.8, False),
        ((1.0, 2.0), 1.5, True),
        ((1.0, 2.0), 2.05, True),
        ((1.0, 2.0), 2.2, False),
        ((-math.inf, 2.0), -1e9, True),
        ((-math.inf, 2.0), 2.2, False),
        (1.0, (0.5, 1.5), True),
        (1.0, (1.05, 1.5), True),
        (1.0, (1.2, 1.5), False),
        ((1.0, 2.0), (1.9, 3.0), True),
        (1.0, math.nan, False),
        (1.0, (math.nan, 1.0), False),
    ],
)
def test_a_row_holds_when_no_gap_is_wider_than_the_tolerance(reference, ours, holds):
    assert row(reference, ours).holds is holds
    assert row(reference, ours).fails is not holds


def test_a_row_that_was_not_computed_neither_holds_nor_fails():
    absent = row(1.0, None, note="no file")
    assert not absent.holds
    assert not absent.fails
    assert absent.verdict == "–"


def test_a_published_envelope_may_be_missed():
    missed = row(1.0, 2.0, must_hold=False, note="the gear is not printed")
    assert missed.verdict == "no"
    assert not missed.fails
