"""All alarms of a cage and the state of its fault detector, saved exactly through a restart."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from functools import cache
from typing import TYPE_CHECKING, Self

from seacage.conventions import InputError
from seacage.twin._alarms._alarm import Alarm
from seacage.twin._faults import FaultDetector
from seacage.twin._json_keys import json_keys

if TYPE_CHECKING:
    from pydantic import TypeAdapter

BOOK_FORMAT = "seacage alarms 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmBook:
    """The state of all alarms of one cage."""

    # By name, those that have been assessed at least once
    alarms: Mapping[str, Alarm] = field(default_factory=dict[str, Alarm])
    t: datetime | None = None  # the twin's clock at the last assessment; None before the first
    detector: FaultDetector = field(default_factory=FaultDetector)  # state of the fault detector
    format: str = BOOK_FORMAT  # of the JSON, checked by ``from_json``
    # Hash of the twin whose residuals the detector knows; empty where it is not known
    twin: str = ""

    __pydantic_config__ = json_keys(detector="suspicion")

    @classmethod
    def new(cls) -> Self:
        """Return the book of a cage that was never assessed."""
        return cls()

    @classmethod
    def from_json(cls, text: str) -> "AlarmBook":
        """Read back what ``to_json`` wrote.

        Raises InputError: the text is something else, or of another version.
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
        if book.format != BOOK_FORMAT:
            raise InputError(
                f"AlarmBook.from_json: this is {book.format!r}, and this seacage reads "
                f"{BOOK_FORMAT!r}. Begin with AlarmBook.new()."
            )
        return book

    def to_json(self) -> str:
        """Write everything; ``from_json`` gives an equal book back."""
        return _adapter().dump_json(self, by_alias=True).decode()

    def with_alarm(self, alarm: Alarm) -> Self:
        """Return a copy in which one alarm has changed."""
        return replace(self, alarms={**self.alarms, alarm.name: alarm})

    def retargeted(self, twin: str) -> Self:
        """Return the book for the answers of a twin.

        What the fault detector has learned of another twin's residuals is forgotten; alarms stay
        as they are.
        """
        same = self.twin in ("", twin)
        detector = self.detector if same else self.detector.relearning()
        return replace(self, twin=twin, detector=detector)

    def at(self, now: datetime, *, jump_s: float) -> Self:
        """Return the book for an assessment at this time.

        Where the clock has jumped, nothing is known of the time between: delays and the fault
        detector's block start again. Raised alarms stay raised.
        """
        if self.t is None or timedelta(seconds=-60.0) < now - self.t < timedelta(seconds=jump_s):
            return replace(self, t=now)
        alarms = {
            name: replace(alarm, crossed=None, notified=None if alarm.notified is None else now)
            for name, alarm in self.alarms.items()
        }
        return replace(self, t=now, alarms=alarms, detector=self.detector.interrupted())


@cache
def _adapter() -> "TypeAdapter[AlarmBook]":
    from pydantic import TypeAdapter

    return TypeAdapter(AlarmBook)
