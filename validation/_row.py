"""One comparison, and the sections that group them."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum

Span = float | tuple[float, float]
"""A number, or the least and the most that it may be (infinite where there is no bound)."""


class Kind(StrEnum):
    """What stands behind a reference."""

    MEASURED = "measured"
    CLOSED_FORM = "closed form"
    PUBLISHED_MODEL = "published model"
    OTHER_PROGRAM = "other program"
    IN_HOUSE_MODEL = "in-house model"  # a simpler prototype of this project's own
    OURSELVES = "our own"  # a finer step, a mirrored sea: what must not change the answer


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A reference beside our own number.

    It holds when the gap between the two is within the tolerance. Where the reference is an
    interval ours must lie in it; where ours is one (an ensemble of plausible cages) it must
    contain the reference.

    Attributes
    ----------
    what
        The quantity and its conditions, so that a reader can repeat it. No two rows of the
        table share it.
    unit
        Of reference, ours and tolerance; "-" for none.
    reference, ours
        In the unit. Ours is None where the row could not be computed: ``note`` then says why.
    kind, source
        What stands behind the reference, and where it is printed.
    tolerance
        Largest gap, in the unit.
    reason
        Why this tolerance.
    must_hold
        Whether a miss is a failure. Only for a published field envelope, a number whose
        conditions are not published whole, or a known weakness, it is not; ``note`` then says
        why we miss it.
    detail
        What each member of an ensemble gives.
    note
        What a reader must know to judge the row.
    """

    what: str
    unit: str
    reference: Span
    ours: Span | None
    kind: Kind
    source: str
    tolerance: float
    reason: str
    must_hold: bool = True
    detail: str = ""
    note: str = ""

    @property
    def gap(self) -> float:
        """Distance between reference and ours; NaN where there is none of ours."""
        if self.ours is None:
            return math.nan
        low, high = ends(self.reference)
        our_low, our_high = ends(self.ours)
        gap = max(0.0, low - our_high, our_low - high)
        return math.nan if math.isnan(our_low + our_high) else gap

    @property
    def holds(self) -> bool:
        """Whether the gap is within the tolerance; a number that is not one holds nothing."""
        return self.gap <= self.tolerance

    @property
    def verdict(self) -> str:
        """yes, no, or – where the row was not computed."""
        if self.ours is None:
            return "–"
        return "yes" if self.holds else "no"

    @property
    def fails(self) -> bool:
        """Whether the whole table fails for this row."""
        return self.must_hold and self.ours is not None and not self.holds


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """Rows that belong together; a slow one simulates for more than a few seconds."""

    title: str
    about: str
    rows: Callable[[], Iterable[Row]]
    slow: bool = False


def ends(span: Span) -> tuple[float, float]:
    """Least and most of a number or an interval."""
    return span if isinstance(span, tuple) else (span, span)
