"""The live connection of the page."""

import asyncio
import json
import time

from fastapi import APIRouter, HTTPException, WebSocket, WebSocketDisconnect

from seacage.service._access._guard import COOKIE, gate_of, source_of
from seacage.service._access._tokens import Grant
from seacage.service._live._cage import LiveCage

_FIRST_MESSAGE_S = 5.0
_FIRST_MESSAGE_BYTES = 1000
UNKNOWN_TOKEN, NO_SCOPE, NO_CAGE, TOO_LATE, TOO_OFTEN = 4401, 4403, 4404, 4408, 4429
"""Codes of a closing: the page tells its reader which it was."""

sockets = APIRouter()


@sockets.websocket("/api/v1/cages/{cage}/live")
async def live(socket: WebSocket, cage: str) -> None:
    """Send what does not change once, then the newest state whenever the reader is ready.

    The first message of the client is ``{"token": …}``: a URL would end up in logs. A page that
    has signed in sends null.
    """
    if not gate_of(socket).from_our_page(socket):
        await socket.close()  # before it is accepted: the browser gets a 403
        return
    await socket.accept()
    token, refusal = await _admitted(socket, cage)
    if refusal is not None:
        await socket.close(*refusal)
        return
    one: LiveCage = socket.app.state.service.cages[cage]
    sending = asyncio.create_task(_send(socket, one, token))
    try:
        while True:  # nothing more is asked; this only notices that the client has left
            await socket.receive_text()
    except WebSocketDisconnect:
        pass
    finally:
        sending.cancel()
        await asyncio.gather(sending, return_exceptions=True)


async def _send(socket: WebSocket, one: LiveCage, token: str | None) -> None:
    known = ""
    shown = socket.app.state.service.metrics.shown.labels(one.name)
    with one.watched() as mailbox:
        while True:
            snapshot = await mailbox.take()
            if _grant(socket, token) is None:  # revoked, or signed out, since
                await socket.close(UNKNOWN_TOKEN, "This token, or its session, has ended.")
                return
            fresh = bool(known)  # the first was made before anybody waited for it
            if one.topology.topology_id != known:
                known = one.topology.topology_id
                await socket.send_text(one.topology.model_dump_json())
            await socket.send_bytes(snapshot.frame)
            if fresh:
                shown.observe(time.monotonic() - snapshot.made)


async def _admitted(socket: WebSocket, cage: str) -> tuple[str | None, tuple[int, str] | None]:
    """Hear the token, None where the session's cookie stands for it, and why not to go on."""
    gate, cages = gate_of(socket), socket.app.state.service.cages
    if sum(one.watchers for one in cages.values()) >= gate.limits.live_clients:
        return None, (TOO_OFTEN, "There are as many live connections as may be. Try again later.")
    try:
        said, token = await _first_message(socket)
    except TimeoutError:  # a slow machine's page may try again: its token was not even heard
        return None, (TOO_LATE, f"The first message did not come within {_FIRST_MESSAGE_S:g} s.")
    grant = _grant(socket, token) if said else None
    if grant is None:
        return token, _not_known(socket)
    if not grant.allows("read", cage, site=gate.site):
        return token, (NO_SCOPE, "This token does not have the scope read.")
    if cage not in cages:
        return token, (NO_CAGE, f"No cage is called {cage!r}."[:100])
    return token, None


def _grant(socket: WebSocket, token: str | None) -> Grant | None:
    found = gate_of(socket).known(token, socket.cookies.get(COOKIE))
    return found and found[0]


def _not_known(socket: WebSocket) -> tuple[int, str]:
    try:
        gate_of(socket).refuse(source_of(socket))
    except HTTPException as error:
        if error.status_code == 429:
            return TOO_OFTEN, error.detail
    return UNKNOWN_TOKEN, 'The first message is {"token": …} with a token that is known.'


async def _first_message(socket: WebSocket) -> tuple[bool, str | None]:
    """Read whether a first message came, and its token; null stands for the page's session."""
    try:
        async with asyncio.timeout(_FIRST_MESSAGE_S):
            text = await socket.receive_text()
        token = json.loads(text[:_FIRST_MESSAGE_BYTES])["token"]
    except (WebSocketDisconnect, ValueError, KeyError, TypeError):
        return False, None
    return token is None or isinstance(token, str), token
