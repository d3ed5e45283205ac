"""What stands before every request: who asks, how much they send, what a browser may do."""

import ipaddress
from typing import Annotated

from fastapi import Depends, HTTPException, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from seacage.service._tokens import Tokens

BODY_LIMIT = 1_000_000
"""Of a request [bytes]."""

_HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; "
        "font-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cache-control": "no-cache",
}

_bearer = HTTPBearer(auto_error=False, description="A token from `seacage token new`.")

Credentials = Annotated[HTTPAuthorizationCredentials | None, Depends(_bearer)]


class Permit:
    """A dependency that lets pass who holds a token for an action on the path's cage.

    Parameters
    ----------
    action
        The scope it takes.
    open_to_loopback
        Ask no token of this machine.
    """

    def __init__(self, action: str, *, open_to_loopback: bool = False) -> None:
        self._action, self._open_to_loopback = action, open_to_loopback

    def __call__(self, request: Request, credentials: Credentials) -> None:
        if self._open_to_loopback and _is_loopback(request.client.host if request.client else ""):
            return
        tokens: Tokens = request.app.state.service.tokens
        grant = tokens.grant(credentials.credentials) if credentials else None
        if grant is None:
            raise HTTPException(
                401,
                "Send a token as 'Authorization: Bearer …'; `seacage token new` makes one.",
                {"WWW-Authenticate": "Bearer"},
            )
        if not grant.allows(self._action, request.path_params.get("cage")):
            raise HTTPException(403, f"This token does not have the scope {self._action}.")


def same_origin(origin: str | None, host: str | None) -> bool:
    """Whether a WebSocket was opened by our own page, or by no page at all.

    A browser always says which page asks; a program says nothing and needs its token anyway.
    """
    return origin is None or origin in {f"http://{host}", f"https://{host}"}


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Shield:
    """Add the browser's rules to every answer and cut bodies that are too long.

    Parameters
    ----------
    app
        What is shielded.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        received = 0

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b""))
            if received > BODY_LIMIT:
                raise HTTPException(
                    413, f"A request may have {BODY_LIMIT} bytes. Send less at once."
                )
            return message

        async def ruled(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        await self._app(scope, counted, ruled)
