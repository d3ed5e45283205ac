"""The JSON of sessions, refusals and the state of the service itself."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from seacage.service._schemas._base import AbstractAnswer, AbstractRequest


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
