"""Durations as people read them, and how often one fits into another."""

import math

from seacage.conventions._errors import InputError


def duration_text(seconds: float) -> str:
    """Short text of a duration: "45 s", "20 min", "4 h" or "3 days".

    The unit is the largest of which the duration holds two; one decimal is kept where it is not 0.

    ``seconds``: the duration, not below 0 [s].
    """
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.1f}".removesuffix(".0") + f" {unit}"
    return f"{seconds:.0f} s"


def count_times(whole: float, part: float, what: str, *, least: int = 1) -> int:
    """Number of times that one time fits into another, to the last bit of a step.

    ``whole`` and ``part``: [s].
    ``what``: of the whole, for the message, such as "follow: duration".
    ``least``: smallest number that is allowed.

    Raises InputError: no whole number, or too small a one.
    """
    count = round(whole / part) if part > 0.0 and math.isfinite(whole) else -1
    if count < least or not math.isclose(count * part, whole, rel_tol=1e-9, abs_tol=1e-9):
        raise InputError(f"{what} = {whole:g} s is no whole number of {part:g} s. Give a multiple.")
    return count
