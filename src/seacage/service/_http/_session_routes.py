"""Signing in, for the page: a token is given once and a cookie stands for it."""

import asyncio
from datetime import UTC, datetime
from typing import Annotated

from fastapi import APIRouter, Header, HTTPException, Request, Response

from seacage.service._auth._authorization import COOKIE, Cookie, check_csrf, gate_of, source_of
from seacage.service._auth._sessions import Session
from seacage.service._auth._token_store import Grant
from seacage.service._http._dependencies import BODY, REFUSED
from seacage.service._schemas._base import SessionOut, SignIn

sessions = APIRouter(prefix="/session", tags=["session"])
Csrf = Annotated[
    str | None, Header(alias="X-CSRF-Token", max_length=200, description="Of the session.")
]


@sessions.post("", status_code=201, responses=REFUSED | BODY)
async def sign_in(request: Request, response: Response, body: SignIn) -> SessionOut:
    """Give a token, get a cookie that no script can read; a write by it repeats ``csrf``."""
    gate = gate_of(request)
    if not gate.from_our_page(request):
        raise HTTPException(403, "Only the page of this service may sign in by itself.")
    grant = gate.tokens.grant(body.token)
    if grant is None:
        gate.refuse(source_of(request), sent=True)
    gate.pace(grant)
    gate.connections.knows(request, grant.id)
    _remember(request, grant)
    # Threads wait for the disk: the loop serves others meanwhile.
    await asyncio.to_thread(gate.sessions.end, request.cookies.get(COOKIE, ""))
    cookie, session = await asyncio.to_thread(gate.sessions.begin, grant, datetime.now(UTC))
    _hand_over(request, response, cookie)
    return _session_out(grant, session)


@sessions.get("", responses=REFUSED)
async def who_am_i(request: Request, response: Response, cookie: Cookie) -> SessionOut:
    """Say who is signed in, as a page asks that was loaded again; the session lasts anew."""
    grant, session = _session(request, cookie)
    assert cookie is not None
    renew = gate_of(request).sessions.renew
    session = await asyncio.to_thread(renew, cookie, datetime.now(UTC)) or session
    _hand_over(request, response, cookie)
    return _session_out(grant, session)


@sessions.delete("", status_code=204, responses=REFUSED)
async def sign_out(request: Request, response: Response, cookie: Cookie, _: Csrf = None) -> None:
    """End the session."""
    grant, session = _session(request, cookie)
    _remember(request, grant)
    check_csrf(request, session)
    await asyncio.to_thread(gate_of(request).sessions.end, cookie or "")
    response.delete_cookie(COOKIE, httponly=True, samesite="strict")


def _hand_over(request: Request, response: Response, cookie: str) -> None:
    response.set_cookie(
        COOKIE,
        cookie,
        max_age=int(gate_of(request).limits.session_s),
        secure=request.url.scheme == "https",
        httponly=True,
        samesite="strict",
    )


def _session(request: Request, cookie: str | None) -> tuple[Grant, Session]:
    gate = gate_of(request)
    found = gate.identify(None, cookie)
    if found is None or found[1] is None:
        gate.refuse(source_of(request), sent=bool(cookie))
    gate.pace(found[0])
    return found[0], found[1]


def _remember(request: Request, grant: Grant) -> None:
    state = request.state
    state.who, state.token, state.action = grant.who, grant.id, "session"


def _session_out(grant: Grant, session: Session) -> SessionOut:
    return SessionOut(
        who=grant.who, scopes=list(grant.scopes), csrf=session.csrf, expires=session.expires
    )
