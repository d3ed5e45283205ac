"""How long work tells its caller where it is."""

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called as (stage, done, total), from the caller's own thread."""


def no_progress(stage: str, done: int, total: int) -> None:
    """Where nobody asked for progress."""
