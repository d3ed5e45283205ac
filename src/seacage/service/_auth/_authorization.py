"""Authorization of a request: its token or session, the scope that it takes, and its rate."""

import hmac
import ipaddress
import math
import time
from collections import Counter
from datetime import UTC, datetime
from typing import Annotated, NoReturn

from fastapi import Depends, HTTPException, Request
from fastapi.security import APIKeyCookie, HTTPAuthorizationCredentials, HTTPBearer
from fastapi.security.utils import get_authorization_scheme_param
from starlette.requests import HTTPConnection

from seacage.service._auth._audit import Audit
from seacage.service._auth._connections import Connections, Reads
from seacage.service._auth._limits import Limits, Rates
from seacage.service._auth._sessions import Session, Sessions
from seacage.service._auth._token_store import Grant, Tokens
from seacage.service._live._metrics import Metrics

COOKIE = "seacage_session"  # name of the cookie of a session
CSRF_HEADER = "x-csrf-token"  # what a write by cookie repeats from the session
READING = {"GET", "HEAD", "OPTIONS"}  # methods that change nothing
_FORWARDED = {"forwarded", "x-forwarded-for", "x-real-ip"}
_bearer = HTTPBearer(auto_error=False, description="A token from `seacage token new`.")
_cookie = APIKeyCookie(
    name=COOKIE, auto_error=False, description="A session of the page; writes need X-CSRF-Token."
)
Credentials = Annotated[HTTPAuthorizationCredentials | None, Depends(_bearer)]
Cookie = Annotated[str | None, Depends(_cookie)]


class Gate:
    """What every door of a service asks before it opens.

    ``tokens`` and ``metrics``: those that are known, and where it is counted who is turned away.
    ``limits``: how much one asker may ask.
    ``audit``: where it is written down who did what.
    ``site``: that the cages lie at: a scope may name it in place of a cage.
    """

    def __init__(
        self,
        tokens: Tokens,
        *,
        metrics: Metrics,
        limits: Limits | None = None,
        audit: Audit | None = None,
        site: str = "",
    ) -> None:
        self.tokens, self.site = tokens, site
        self.limits, self.audit = limits or Limits(), audit or Audit(None)
        some = self.limits
        self.sessions = Sessions(tokens, lasting_s=some.session_s, most=some.sessions_per_token)
        self.connections = Connections(some, metrics)
        self.live = Counter[str]()  # open live connections, by the id of their token
        self.reads = Reads(rows=some.read_rows, rows_per_token=some.read_rows_per_token)
        self._asked = Rates(per_s=some.requests_per_s, burst=some.burst)
        self._refused = Rates(per_s=some.refusals_per_s, burst=some.refusal_burst)

    def identify(
        self, token: str | None, cookie: str | None
    ) -> tuple[Grant, Session | None] | None:
        """Find who asks, by token, else by the cookie of a session."""
        if token is not None:
            grant = self.tokens.grant(token)
            return None if grant is None else (grant, None)
        return self.sessions.find(cookie, datetime.now(UTC)) if cookie else None

    def admit(self, connection: HTTPConnection) -> tuple[Grant, Session | None]:
        """Find who asks, by what the headers carry. Raises HTTPException: as for ``refuse``."""
        scheme, sent = get_authorization_scheme_param(connection.headers.get("authorization"))
        token = sent if sent and scheme.lower() == "bearer" else None
        cookie = connection.cookies.get(COOKIE)
        found = self.identify(token, cookie)
        if found is None:
            self.refuse(source_of(connection), sent=bool(token or cookie))
        self.connections.knows(connection, found[0].id)
        return found

    def pace(self, grant: Grant) -> None:
        """Hold up whoever asks too often. Raises HTTPException: 429, with the time to wait."""
        _hold_up(self._asked.wait_s(grant.id, time.monotonic()), "This token asks too often.")

    def refuse(self, source: str, *, sent: bool) -> NoReturn:
        """Refuse whoever is not known, and say whether a token or a session was sent at all.

        Raises HTTPException: 401, or 429 where the address has tried often.
        """
        wait_s = self._refused.wait_s(source, time.monotonic())
        _hold_up(wait_s, "This address has tried too many tokens that are not known.")
        unknown = "This token or session is not known here: mistyped, revoked, or at its end. "
        raise HTTPException(
            401,
            f"{unknown if sent else ''}Send a token as 'Authorization: Bearer …'; "
            "`seacage token new` makes one.",
            {"WWW-Authenticate": "Bearer" + sent * ' error="invalid_token"'},
        )

    def from_our_page(self, connection: HTTPConnection) -> bool:
        """Whether our own page asks, one that is allowed to, or no page at all."""
        origin, host = connection.headers.get("origin"), connection.headers.get("host")
        return same_origin(origin, host) or origin in self.limits.origins


def gate_of(connection: HTTPConnection) -> Gate:
    """The gate of the service that is asked."""
    return connection.app.state.service.gate


def source_of(connection: HTTPConnection) -> str:
    """The address that asks, as a trusted proxy names it; what is no address is ``?``."""
    host = connection.client.host if connection.client else ""
    return host if _address(host) else "?"


class Permit:
    """A dependency that lets pass who holds a token for an action on the path's cage.

    What follows finds the name of the token as ``request.state.who``, and its id as
    ``request.state.token``.

    ``action``: the scope it takes. ``open_to_loopback``: ask no token of this machine's own
    programs; what a proxy brings is not theirs.
    """

    def __init__(self, action: str, *, open_to_loopback: bool = False) -> None:
        self._action, self._open_to_loopback = action, open_to_loopback

    async def __call__(self, request: Request, _bearer: Credentials, _cookie: Cookie) -> None:
        if self._open_to_loopback and _is_local(request):
            return
        gate = gate_of(request)
        grant, session = gate.admit(request)
        state = request.state
        state.who, state.token, state.action = grant.who, grant.id, self._action
        state.grant = grant
        gate.pace(grant)
        if session and request.method not in READING:
            check_csrf(request, session)
        if not grant.allows(self._action, request.path_params.get("cage"), site=gate.site):
            raise HTTPException(403, f"This token does not have the scope {self._action}.")


def _who(request: Request) -> str:
    return request.state.who


Who = Annotated[str, Depends(_who)]  # the name of the token that asks; after a ``Permit``


def check_csrf(request: Request, session: Session) -> None:
    """Let a cookie write only for our own page, which knows what no other page can read.

    Raises HTTPException: 403 where another page asks, or the header is missing or wrong.
    """
    sent = request.headers.get(CSRF_HEADER, "")
    same = hmac.compare_digest(sent.encode(), session.csrf.encode())
    if not same or not gate_of(request).from_our_page(request):
        raise HTTPException(
            403, "A write by cookie repeats the session's `csrf` in the header X-CSRF-Token."
        )


def same_origin(origin: str | None, host: str | None) -> bool:
    """Whether our own page asks, or no page at all.

    A browser always says which page asks; a program says nothing and needs its token anyway.
    """
    return origin is None or origin in {f"http://{host}", f"https://{host}"}


def _hold_up(wait_s: float, why: str) -> None:
    if wait_s > 0.0:
        seconds = max(1, math.ceil(wait_s))
        raise HTTPException(429, f"{why} Ask again in {seconds} s.", {"Retry-After": str(seconds)})


def _is_local(connection: HTTPConnection) -> bool:
    address = _address(source_of(connection))
    return bool(address and address.is_loopback) and _FORWARDED.isdisjoint(connection.headers)


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None
