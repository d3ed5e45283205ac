"""What JSON bodies and settings share, names, times and strictness, and bodies of the service."""

from datetime import UTC, datetime
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from seacage.conventions import read_packaged_table

Name = Annotated[str, Field(min_length=1, max_length=64)]  # of a cage, a stream, a sensor
_YEARS = range(1900, 2200)


def _require_text(t: object) -> object:
    # A bare number, also as text, would be taken for seconds since 1970.
    if not isinstance(t, datetime) and not (isinstance(t, str) and t[4:5] == "-"):
        raise ValueError("a time is written in ISO 8601, as 2018-01-26T23:08:00Z, not as a number")
    return t


def _with_zone(t: datetime) -> datetime:
    if t.tzinfo is None:
        raise ValueError("a time says its zone, as in 2018-01-26T23:08:00Z")
    return t


def _of_our_time(t: datetime) -> datetime:
    # At the ends of the calendar, another zone's time does not exist.
    if _with_zone(t).year not in _YEARS:
        raise ValueError(f"no time here is from the year {t.year}; check the source's clock")
    return t


# With its zone
Time = Annotated[datetime, BeforeValidator(_require_text), AfterValidator(_of_our_time)]
_FIRST, _LAST = datetime(1900, 1, 1, tzinfo=UTC), datetime(2200, 1, 1, tzinfo=UTC)


def _reachable(t: datetime) -> datetime:
    return min(max(_with_zone(t), _FIRST), _LAST)


# A time that something is asked of: far away from all that is stored, one is as good as any
Reach = Annotated[datetime, BeforeValidator(_require_text), AfterValidator(_reachable)]


class AbstractRequest(BaseModel):
    """A body that is sent: nothing is converted, and nothing unknown is let pass."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)


class AbstractSection(BaseModel):
    """A section of the settings: nothing unknown is let pass."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class AbstractAnswer(BaseModel):
    """A body that is answered; it may be made of any object that has its fields."""

    model_config = ConfigDict(frozen=True, from_attributes=True)


EXAMPLE_T = "2018-01-26T23:08:00Z"


def with_examples(described: dict[str, Any]) -> dict[str, Any]:
    """Give each body of a description its example, with the nulls that FastAPI would leave out."""
    bodies = described["components"]["schemas"]
    for name, example in read_packaged_table("seacage.service._schemas", "examples.json").items():
        bodies[name]["examples"] = [example]
    return described


class SignIn(AbstractRequest):
    """A token, given once for a session."""

    token: Annotated[str, Field(min_length=1, max_length=200)]


class SessionOut(AbstractAnswer):
    """Who is signed in, and what a write has to repeat in the header X-CSRF-Token."""

    who: str
    scopes: list[str]
    csrf: str
    expires: datetime


class Problem(AbstractAnswer):
    """Why a request was refused, in one sentence."""

    detail: str


class Health(AbstractAnswer):
    """Whether the service lives, and whether it can do its work."""

    status: str
