"""What surrounds every request: how much is sent, what a browser may do, what is written down."""

from fastapi import HTTPException
from starlette.datastructures import MutableHeaders
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from seacage.service._auth._authorization import READING, Gate, source_of

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
_REFUSALS = {401, 403, 429}
_PLAIN = {"read", "ingest"}  # questions and samples: too many to write down, and no deeds
_SIGN_IN, _SIGN_IN_BYTES = "/session", 4096


class Shield:
    """Add the browser's rules to every answer, bound bodies, and keep the audit.

    No body is read of whoever is not known, but that of who signs in. Written down are refusals,
    and what people change. Rows that a long answer took out of the
    budget are given back when it has gone.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        gate: Gate = scope["app"].state.service.gate
        connection, source = HTTPConnection(scope), source_of(HTTPConnection(scope))
        gate.connections.asks(connection, source)
        signs_in, received = scope["path"] == _SIGN_IN, 0
        limit = _SIGN_IN_BYTES if signs_in else gate.limits.body_bytes
        known = signs_in or scope["method"] in READING

        async def count_body() -> Message:
            nonlocal known, received
            known = known or bool(gate.admit(connection))
            message = await receive()
            received += len(message.get("body", b""))
            if received > limit:
                raise HTTPException(413, f"A request may have {limit} bytes. Send less at once.")
            return message

        async def add_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers.setdefault(name, value)
                _audit(gate, scope, source, message["status"])
            await send(message)

        try:
            await self._app(scope, count_body, add_headers)
        finally:
            if (reading := scope.get("state", {}).get("reading")) is not None:
                gate.reads.give_back(*reading)


def _audit(gate: Gate, scope: Scope, source: str, status: int) -> None:
    state = scope.get("state", {})
    deed = scope["method"] not in READING and state.get("action", "read") not in _PLAIN
    if deed or status in _REFUSALS:
        gate.audit.write(
            f"{scope['method']} {scope['path'][:200]}",
            who=state.get("who", ""),
            token=state.get("token", ""),
            source=source,
            status=status,
        )
