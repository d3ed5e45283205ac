"""Durations as people read them."""


def duration_text(seconds: float) -> str:
    """Short text of a duration: "45 s", "20 min", "4 h" or "3 days".

    The unit is the largest of which the duration holds two; one decimal is kept where it is not 0.

    Parameters
    ----------
    seconds
        The duration, not below 0 [s].
    """
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.1f}".removesuffix(".0") + f" {unit}"
    return f"{seconds:.0f} s"
