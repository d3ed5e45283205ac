"""Result codes of a solve and quality flags of a sample."""

from enum import IntEnum


class Result(IntEnum):
    """How a solve ended. The kernel cannot raise, so it returns one of these."""

    CONVERGED = 0
    NOT_CONVERGED = 1
    DIVERGED = 2
    DROWNED = 3


RESULTS: dict[Result, str] = {
    Result.CONVERGED: "it ended as it should: at rest within the limit, or at the end of its time",
    Result.NOT_CONVERGED: "the iterations ran out before the residual fell below its limit",
    Result.DIVERGED: "the nodes left all bounds of speed or place; the case carries no answer",
    Result.DROWNED: "the collar or a corner buoy is under water in the mean; the numbers are kept",
}


class Flag(IntEnum):
    """QARTOD flags of one value (IOOS QARTOD manuals, primary-level flags)."""

    GOOD = 1
    NOT_EVALUATED = 2
    SUSPECT = 3
    FAIL = 4
    MISSING = 9
