"""Progress of long work, reported to its caller."""

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called as (stage, done, total), from the caller's own thread."""


def no_progress(stage: str, done: int, total: int) -> None:
    """Ignore progress, where no callback is given."""
