"""Sessions of the page: a cookie that no script can read stands for a token."""

import secrets
from collections import OrderedDict
from dataclasses import dataclass
from datetime import datetime, timedelta

from seacage.service._access._tokens import Grant, Tokens, digest

_MOST_SESSIONS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """Somebody who has signed in.

    Parameters
    ----------
    token_sha256
        Of the token that was given; once it is revoked the session is worth nothing.
    csrf
        What a write has to repeat in a header, for a cookie is sent by itself.
    expires
        When it ends.
    """

    token_sha256: str
    csrf: str
    expires: datetime


class Sessions:
    """The sessions of this process: a restart ends them all.

    Parameters
    ----------
    tokens
        That they stand for.
    lasting_s
        How long one lasts [s].
    """

    def __init__(self, tokens: Tokens, *, lasting_s: float) -> None:
        self._tokens, self._lasting = tokens, timedelta(seconds=lasting_s)
        self._open: OrderedDict[str, Session] = OrderedDict()

    def begin(self, grant: Grant, now: datetime) -> tuple[str, Session]:
        """Open a session; only the hash of its cookie is kept."""
        cookie = secrets.token_urlsafe(32)
        session = Session(
            token_sha256=grant.sha256, csrf=secrets.token_urlsafe(32), expires=now + self._lasting
        )
        self._open[digest(cookie)] = session
        if len(self._open) > _MOST_SESSIONS:
            self._open.popitem(last=False)
        return cookie, session

    def find(self, cookie: str, now: datetime) -> tuple[Session, Grant] | None:
        """Find who a cookie stands for; None where it or its token has ended."""
        session = self._open.get(digest(cookie))
        if session is None or session.expires <= now:
            return None
        grant = self._tokens.kept(session.token_sha256)
        return None if grant is None else (session, grant)

    def end(self, cookie: str) -> None:
        """Close a session, if there is one."""
        self._open.pop(digest(cookie), None)
