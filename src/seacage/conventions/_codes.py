"""Result codes of a solve, quality flags of a sample, and origins of numbers."""

from collections.abc import Mapping
from enum import IntEnum, StrEnum

import numpy as np
from jaxtyping import Bool, Int


class Result(IntEnum):
    """End of a solve. The kernel cannot raise, so it returns one of these."""

    CONVERGED = 0
    NOT_CONVERGED = 1
    DIVERGED = 2
    DROWNED = 3
    OUTSIDE_VALIDITY = 4
    SLACK = 5


RESULTS: dict[Result, str] = {
    Result.DIVERGED: "the nodes left all bounds of speed or place; the case carries no answer",
    Result.DROWNED: "the collar is under water in the mean, or a corner buoy wholly for a tenth of "
    "the time; the numbers are kept",
    Result.NOT_CONVERGED: "the iterations ran out before the residual fell below its limit",
    Result.SLACK: "no bridle ever bears a hundredth of its pretension; the numbers are kept",
    Result.OUTSIDE_VALIDITY: "a load law was used beyond where it is known; the numbers are kept",
    Result.CONVERGED: "it ended as it should: at rest within the limit, or at the end of its time",
}
"""Meanings, the gravest first: it stands for several findings about a case."""


def gravest(
    result: Int[np.ndarray, "*case"], findings: Mapping[Result, Bool[np.ndarray, "*case"]]
) -> Int[np.ndarray, "*case"]:
    """The gravest of each case's result and what else was found of it."""
    held = [(result == code) | findings.get(code, False) for code in RESULTS]
    return np.select(held, [int(code) for code in RESULTS])


def has_answer(result: Int[np.ndarray, "*case"]) -> Bool[np.ndarray, "*case"]:
    """Whether each result carries an answer to learn from: an equilibrium afloat, sound or not."""
    return np.isin(result, (Result.CONVERGED, Result.OUTSIDE_VALIDITY, Result.SLACK))


class Flag(IntEnum):
    """QARTOD flags of one value (IOOS QARTOD manuals, primary-level flags)."""

    GOOD = 1
    NOT_EVALUATED = 2
    SUSPECT = 3
    FAIL = 4
    MISSING = 9


class Origin(StrEnum):
    """How a record or a table row was made; every table row and figure says which."""

    MEASURED = "measured"
    COMPUTED = "computed"
    VIRTUAL_FIELD = "virtual field"
