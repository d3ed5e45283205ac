"""Events of a step of the twin."""

from dataclasses import dataclass
from datetime import datetime

from seacage.records import Sample
from seacage.twin._answer import Answer
from seacage.twin._metocean import Metocean


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answered:
    """An answer of the twin, with or without a number."""

    t: datetime  # the twin's clock
    answer: Answer  # one row
    metocean: Metocean | None  # the water at the cage, one row; None before the first reading
    input_age_s: float | None  # of the buoy's reading [s]
    reported: Metocean | None = None  # by the buoy, where its water has still to arrive

    @property
    def at_buoy(self) -> Metocean | None:
        """The buoy's reading, one row; None before the first."""
        return self.metocean if self.reported is None else self.reported


@dataclass(frozen=True, slots=True, kw_only=True)
class Flagged:
    """A sample was set aside, or a value in it did not pass its checks."""

    sample: Sample  # as it came, with its flags
    reason: str  # one sentence for a person
    used: bool  # False where the sample was set aside whole and changed nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamSilent:
    """A stream has sent no sample for longer than its timeout; reported once."""

    stream: str
    since: datetime


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamBack:
    """A silent stream sends again."""

    stream: str
    t: datetime


Event = Answered | Flagged | StreamSilent | StreamBack
"""An event of a twin's step."""
