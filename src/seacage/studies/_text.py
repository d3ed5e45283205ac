"""Numbers, shares, lists of names and claims as a report writes them."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A sentence that the numbers support or contradict."""

    claim: str
    holds: bool | None  # whether the numbers support it; None where a run that it needs is missing
    finding: str

    @property
    def verdict(self) -> str:
        """In a word."""
        return {True: "holds", False: "missed", None: "not evaluated"}[self.holds]


def number(value: float) -> str:
    """Three digits that matter, with a true minus."""
    written = f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:#.3g}".rstrip(".")
    return written.replace("-", "\N{MINUS SIGN}")


def percent(share: float, *, digits: int = 0) -> str:
    """A share in percent, which stays with its sign on one line."""
    written = f"{100.0 * share:.{digits}f}\N{NARROW NO-BREAK SPACE}%"
    return written.replace("-", "\N{MINUS SIGN}")


def join_names(names: Iterable[str]) -> str:
    """Names as a sentence lists them."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last
