"""The live connection of the page."""

import asyncio
import json
import time
from contextlib import suppress

from fastapi import APIRouter, HTTPException, WebSocket, WebSocketDisconnect, WebSocketException

from seacage.service._auth._authorization import COOKIE, gate_of, source_of
from seacage.service._auth._token_store import Grant
from seacage.service._live._cage import LiveCage

_FIRST_MESSAGE_S = 5.0
_FIRST_MESSAGE_BYTES = 1000
_REASON_BYTES = 123  # as many as a closing frame holds
# Codes of a closing: the page tells its reader which it was
NOT_TEXT, UNKNOWN_TOKEN, NO_SCOPE, NO_CAGE, TOO_LATE, TOO_OFTEN = 1003, 4401, 4403, 4404, 4408, 4429
sockets = APIRouter()


@sockets.websocket("/api/v1/cages/{cage}/live")
async def live(socket: WebSocket, cage: str) -> None:
    """Send what does not change once, then the newest state whenever the reader is ready.

    The first message of the client is ``{"token": …}``: a URL would end up in logs. A page that
    has signed in sends null.
    """
    gate = gate_of(socket)
    gate.connections.asks(socket, source_of(socket))
    if not gate.from_our_page(socket):
        await socket.close()  # before it is accepted: the browser gets a 403
        return
    try:
        await socket.accept()
        token, grant = await _admit(socket, cage)
        await _serve(socket, token, grant, cage)
    except WebSocketDisconnect:
        pass
    except WebSocketException as refusal:
        socket.app.state.service.metrics.closed.labels(str(refusal.code)).inc()
        reason = refusal.reason.encode("utf-8", "replace")[:_REASON_BYTES].decode("utf-8", "ignore")
        with suppress(WebSocketDisconnect, RuntimeError):  # the client was quicker to close
            await socket.close(refusal.code, reason)


async def _serve(socket: WebSocket, token: str | None, grant: Grant, cage: str) -> None:
    """Send until the client leaves or its token ends."""
    gate, one = gate_of(socket), socket.app.state.service.cages[cage]
    gate.live[grant.id] += 1
    work = {asyncio.create_task(_send(socket, one, token)), asyncio.create_task(_listen(socket))}
    try:
        done, _ = await asyncio.wait(work, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    finally:
        gate.live[grant.id] -= 1
        for task in work:
            task.cancel()
        await asyncio.gather(*work, return_exceptions=True)


async def _listen(socket: WebSocket) -> None:
    """Notice that the client has left; nothing more is asked of it."""
    while True:
        await _text(socket)


async def _text(socket: WebSocket) -> str:
    message = await socket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message["code"])
    if message.get("text") is None:
        raise WebSocketException(NOT_TEXT, "The service reads text alone.")
    return message["text"]


async def _send(socket: WebSocket, one: LiveCage, token: str | None) -> None:
    known = ""
    shown = socket.app.state.service.metrics.shown.labels(one.name)
    with one.subscribe() as mailbox:
        while True:
            snapshot = await mailbox.get()
            if _grant(socket, token) is None:  # revoked, or signed out, since
                raise WebSocketException(UNKNOWN_TOKEN, "This token, or its session, has ended.")
            fresh = bool(known)  # the first was made before anybody waited for it
            try:
                if one.topology.topology_id != known:
                    known = one.topology.topology_id
                    await socket.send_text(one.topology.model_dump_json())
                await socket.send_bytes(snapshot.frame)
            except RuntimeError as error:  # the client's closing came between
                raise WebSocketDisconnect(1006) from error
            if fresh:
                shown.observe(time.monotonic() - snapshot.made)


async def _admit(socket: WebSocket, cage: str) -> tuple[str | None, Grant]:
    """Read the token, None where the session's cookie stands for it, and find what it may do.

    Raises WebSocketException: with the code and the reason to close for.
    """
    gate, token = gate_of(socket), await _first_message(socket)
    grant = _grant(socket, token)
    if grant is None:
        raise _not_known(socket)
    gate.connections.knows(socket, grant.id)
    if not grant.allows("read", cage, site=gate.site):
        raise WebSocketException(NO_SCOPE, "This token does not have the scope read.")
    if cage not in socket.app.state.service.cages:
        raise WebSocketException(NO_CAGE, f"No cage is called {cage!r}.")
    limits = gate.limits
    if gate.live[grant.id] >= limits.live_per_token or gate.live.total() >= limits.live_clients:
        raise WebSocketException(
            TOO_OFTEN, "There are as many live connections as may be. Try again later."
        )
    return token, grant


def _grant(socket: WebSocket, token: str | None) -> Grant | None:
    found = gate_of(socket).identify(token, socket.cookies.get(COOKIE))
    return found and found[0]


def _not_known(socket: WebSocket) -> WebSocketException:
    try:
        gate_of(socket).refuse(source_of(socket), sent=True)
    except HTTPException as error:
        if error.status_code == 429:
            return WebSocketException(TOO_OFTEN, error.detail)
    return WebSocketException(
        UNKNOWN_TOKEN, 'The first message is {"token": …} with a token that is known.'
    )


async def _first_message(socket: WebSocket) -> str | None:
    """Read the token of the first message; null stands for the page's session."""
    try:
        async with asyncio.timeout(_FIRST_MESSAGE_S):
            text = await _text(socket)
        token = json.loads(text[:_FIRST_MESSAGE_BYTES])["token"]
    except TimeoutError as error:  # a slow machine's page may try again: no token was even read
        why = f"The first message did not come within {_FIRST_MESSAGE_S:g} s."
        raise WebSocketException(TOO_LATE, why) from error
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise _not_known(socket) from error
    if token is not None and not isinstance(token, str):
        raise _not_known(socket)
    return token
