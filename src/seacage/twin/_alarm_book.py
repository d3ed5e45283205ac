"""All alarms of a cage, and what their tests remember: kept through a restart to the bit."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from functools import cache
from typing import TYPE_CHECKING, Self

from seacage.conventions import InputError
from seacage.twin._alarms import Alarm, Changed
from seacage.twin._faults import Suspicion

if TYPE_CHECKING:
    from pydantic import TypeAdapter

FORMAT = "seacage alarms 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmBook:
    """The state of all alarms of one cage.

    Parameters
    ----------
    alarms
        By name, those that have been judged at least once.
    t
        The twin's clock at the last assessment; None before the first.
    suspicion
        What the tests for irregularity remember.
    format
        What ``from_json`` knows it by.
    """

    alarms: Mapping[str, Alarm] = field(default_factory=dict[str, Alarm])
    t: datetime | None = None
    suspicion: Suspicion = field(default_factory=Suspicion)
    format: str = FORMAT

    @classmethod
    def new(cls) -> Self:
        """Return the book of a cage that was never assessed."""
        return cls()

    @classmethod
    def from_json(cls, text: str) -> "AlarmBook":
        """Read back what ``to_json`` wrote.

        Raises
        ------
        InputError
            The text is something else, or of another version.
        """
        from pydantic import ValidationError

        try:
            book = _adapter().validate_json(text)
        except ValidationError as error:
            first = error.errors()[0]
            where = ".".join(str(part) for part in first["loc"]) or "the text"
            raise InputError(
                f"AlarmBook.from_json: {where}: {first['msg']}. Begin with AlarmBook.new()."
            ) from error
        if book.format != FORMAT:
            raise InputError(
                f"AlarmBook.from_json: this is {book.format!r}, and this seacage reads {FORMAT!r}. "
                "Begin with AlarmBook.new()."
            )
        return book

    def to_json(self) -> str:
        """Write everything; ``from_json`` gives an equal book back."""
        return _adapter().dump_json(self).decode()

    def with_alarm(self, alarm: Alarm) -> Self:
        """Return a copy in which one alarm has changed, as by what somebody did with it."""
        return replace(self, alarms={**self.alarms, alarm.name: alarm})

    def changed(self, changed: Changed) -> Self:
        """Return a copy with what a person's action made of an alarm."""
        return self.with_alarm(changed[0])

    def at(self, now: datetime, *, jump_s: float) -> Self:
        """Return the book for a look at this time.

        Where the clock has jumped, nothing is known of the time between: what waits on a delay,
        and what the tests were averaging, begins anew. What is raised stays raised.
        """
        if self.t is None or timedelta(seconds=-60.0) < now - self.t < timedelta(seconds=jump_s):
            return replace(self, t=now)
        alarms = {
            name: replace(alarm, crossed=None, said=None if alarm.said is None else now)
            for name, alarm in self.alarms.items()
        }
        return replace(self, t=now, alarms=alarms, suspicion=self.suspicion.interrupted())


@cache
def _adapter() -> "TypeAdapter[AlarmBook]":
    from pydantic import TypeAdapter

    return TypeAdapter(AlarmBook)
